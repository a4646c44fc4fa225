// Visitors of all values of a state; state.cpp has the one list of the values' names.
#pragma once

#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>
#include <string>
#include <vector>

#include "base/bit_hash.hpp"
#include "base/error.hpp"
#include "model/data/body_exchange.hpp"
#include "output/checkpoint.hpp"
#include "physics/tangential_losses.hpp"
#include "run/state/stop_watch.hpp"

namespace scree {

inline constexpr const char *kPositions = "bodies/position", *kCountedAngles = "bodies/counted_angles";

// Packs values into a checkpoint. One list of members serves pack() and unpack(), so that both visit the same
// fields in the same order.
class Writer {
 public:
  explicit Writer(Checkpoint& out) : out_(out) {}
  void operator()(const char* name, const Real& value) { out_.reals[name] = {value}; }
  void operator()(const char* name, const std::int64_t& value) { out_.integers[name] = {value}; }
  void operator()(const char* name, const bool& value) { out_.integers[name] = {value ? 1 : 0}; }
  void operator()(const char* name, const std::vector<Real>& values) { out_.reals[name] = values; }
  // Writes values that most runs do not have, if there are any.
  void if_any(const char* name, const std::vector<Real>& values) {
    if (!values.empty()) (*this)(name, values);
  }
  void if_any(const char* name, const std::vector<std::int64_t>& values) {
    if (!values.empty()) out_.integers[name] = values;
  }
  void if_any(const char* name, const Real& value) {
    if (value != 0) (*this)(name, value);
  }
  void if_any(const char* name, const TangentialLosses& losses) {
    if (losses != TangentialLosses{}) out_.reals[name] = {std::begin(losses.of), std::end(losses.of)};
  }
  void watches(const std::vector<StopWatch>& watches) { add_watches(watches, out_); }
  void poses(const std::vector<Real>& position, std::size_t angles) {
    const auto end = position.end() - static_cast<std::ptrdiff_t>(angles);
    out_.reals[kPositions].assign(position.begin(), end);
    if (angles > 0) out_.reals[kCountedAngles].assign(end, position.end());
  }
  void operator()(const char* name, const std::vector<BodyWrench>& wrenches) {
    std::vector<Real>& values = out_.reals[name];
    for (const BodyWrench& w : wrenches)
      for (const Vec3& v : {w.force, w.torque}) values.insert(values.end(), {v.x, v.y, v.z});
  }

 private:
  Checkpoint& out_;
};

class Reader {
 public:
  explicit Reader(const Checkpoint& in) : in_(in) {}
  void operator()(const char* name, Real& value) { value = single(name, in_.real_array(name)); }
  void operator()(const char* name, std::int64_t& value) { value = single(name, in_.integer_array(name)); }
  void operator()(const char* name, bool& value) { value = single(name, in_.integer_array(name)) != 0; }
  void operator()(const char* name, std::vector<Real>& values) { values = in_.real_array(name); }
  void if_any(const char* name, std::vector<Real>& values) {
    if (in_.reals.count(name) > 0) (*this)(name, values);
  }
  void if_any(const char* name, std::vector<std::int64_t>& values) {
    if (in_.integers.count(name) > 0) values = in_.integer_array(name);
  }
  void if_any(const char* name, Real& value) {
    if (in_.reals.count(name) > 0) (*this)(name, value);
  }
  void if_any(const char* name, TangentialLosses& losses) {
    if (in_.reals.count(name) == 0) return;
    const std::vector<Real>& values = in_.real_array(name);
    if (values.size() != kLossKinds)
      throw IoError(in_.path + ": '" + name + "' has another number of values");
    std::ranges::copy(values, losses.of);
  }
  void watches(std::vector<StopWatch>& watches) { watches = watches_in(in_); }
  void poses(std::vector<Real>& position, std::size_t& angles) {
    position = in_.real_array(kPositions);
    angles = 0;
    if (in_.reals.count(kCountedAngles) == 0) return;
    const std::vector<Real>& counted = in_.real_array(kCountedAngles);
    angles = counted.size();
    position.insert(position.end(), counted.begin(), counted.end());
  }
  void operator()(const char* name, std::vector<BodyWrench>& wrenches) {
    const std::vector<Real>& values = in_.real_array(name);
    wrenches.resize(values.size() / 6);
    for (std::size_t b = 0; b < wrenches.size(); ++b) {
      const Real* v = &values[6 * b];
      wrenches[b].force = {v[0], v[1], v[2]}, wrenches[b].torque = {v[3], v[4], v[5]};
    }
  }

 private:
  template <class T>
  T single(const char* name, const std::vector<T>& values) const {
    if (values.size() != 1) throw IoError(in_.path + ": '" + name + "' is not a single value");
    return values[0];
  }
  const Checkpoint& in_;
};

// Hashes the bits of all values; it must be fast for a million particles.
class Hasher {
 public:
  void operator()(const char*, const Real& value) { hash_.add(value); }
  void operator()(const char*, const std::int64_t& value) { hash_.add(value); }
  void operator()(const char*, const bool& value) { hash_.add(std::int64_t{value}); }
  void operator()(const char*, const std::vector<Real>& values) {
    for (const Real value : values) hash_.add(value);
  }
  void if_any(const char* name, const std::vector<Real>& values) { (*this)(name, values); }
  void if_any(const char*, const std::vector<std::int64_t>& values) {
    for (const std::int64_t value : values) hash_.add(value);
  }
  void if_any(const char*, const Real& value) {
    if (value != 0) hash_.add(value);
  }
  void if_any(const char*, const TangentialLosses& losses) {
    if (losses != TangentialLosses{})
      for (const Real value : losses.of) hash_.add(value);
  }
  // Hashes poses, and of counted angles the full revolutions if any angle has made one: the rest of an angle
  // follows from the bodies' poses.
  void poses(const std::vector<Real>& position, std::size_t angles) {
    const auto revolutions = [](Real angle) { return std::nearbyint(angle / (2 * M_PI)); };
    const std::span<const Real> all(position), counted = all.last(angles);
    for (const Real value : all.first(all.size() - angles)) hash_.add(value);
    if (std::ranges::all_of(counted, [&](Real angle) { return revolutions(angle) == 0; })) return;
    for (const Real angle : counted) hash_.add(revolutions(angle));
  }
  void operator()(const char*, const std::vector<BodyWrench>& wrenches) {
    for (const BodyWrench& w : wrenches) hash_.add(w.force), hash_.add(w.torque);
  }
  std::uint64_t hash() const { return hash_.hash(); }

 private:
  BitHash hash_;
};

// Finds the first value that is not finite.
class FiniteCheck {
 public:
  void operator()(const char* name, const Real& value) { check(name, value); }
  void operator()(const char*, const std::int64_t&) {}
  void operator()(const char*, const bool&) {}
  void operator()(const char* name, const std::vector<Real>& values) {
    for (const Real value : values) check(name, value);
  }
  void if_any(const char* name, const std::vector<Real>& values) { (*this)(name, values); }
  void if_any(const char* name, const Real& value) { check(name, value); }
  void if_any(const char*, const std::vector<std::int64_t>&) {}
  void if_any(const char* name, const TangentialLosses& losses) {
    for (const Real value : losses.of) check(name, value);
  }
  void poses(const std::vector<Real>& position, std::size_t) { (*this)(kPositions, position); }
  void operator()(const char* name, const std::vector<BodyWrench>& wrenches) {
    for (const BodyWrench& w : wrenches)
      if (!is_finite(w.force) || !is_finite(w.torque)) check(name, std::nan(""));
  }
  const std::string& name() const { return name_; }  // empty if there is none

 private:
  void check(const char* name, Real value) {
    if (name_.empty() && !std::isfinite(value)) name_ = name;
  }
  std::string name_;
};

}  // namespace scree
