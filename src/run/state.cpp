#include "run/state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/bit_hash.hpp"
#include "base/error.hpp"

namespace scree {
namespace {

// One list of members serves both directions: pack() and unpack() visit the same fields in the same order.
class Writer {
 public:
  explicit Writer(Checkpoint& out) : out_(out) {}
  void operator()(const char* name, const Real& value) { out_.reals[name] = {value}; }
  void operator()(const char* name, const std::int64_t& value) { out_.integers[name] = {value}; }
  void operator()(const char* name, const bool& value) { out_.integers[name] = {value ? 1 : 0}; }
  void operator()(const char* name, const std::vector<Real>& values) { out_.reals[name] = values; }
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

// Over the bits of what it visits; a checkpoint of a million particles must not wait for it.
class Hasher {
 public:
  void operator()(const char*, const Real& value) { hash_.add(value); }
  void operator()(const char*, const std::int64_t& value) { hash_.add(value); }
  void operator()(const char*, const bool& value) { hash_.add(std::int64_t{value}); }
  void operator()(const char*, const std::vector<Real>& values) {
    for (const Real value : values) hash_.add(value);
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

template <class Visitor, class StateType>
void visit_clock(Visitor& visit, StateType& clock) {
  visit("clock/time", clock.time);
  visit("clock/start", clock.start);
  visit("clock/end", clock.end);
  visit("clock/grid_steps", clock.grid_steps);
  visit("clock/grid_done", clock.grid_done);
  visit("clock/level", clock.level);
  visit("clock/parts_left", clock.parts_left);
  visit("clock/next_step", clock.next_step);
  visit("clock/just_rejected", clock.just_rejected);
}

template <class Visitor, class LedgerType>
void visit_ledger(Visitor& visit, LedgerType& ledger) {
  visit("balance/kinetic", ledger.kinetic);
  visit("balance/gravitational", ledger.gravitational);
  visit("balance/elastic_force_elements", ledger.elastic_force_elements);
  visit("balance/elastic_contacts", ledger.elastic_contacts);
  visit("balance/dissipated_force_elements", ledger.dissipated_force_elements);
  visit("balance/dissipated_contacts", ledger.dissipated_contacts);
  visit("balance/dissipated_integrator", ledger.dissipated_integrator);
  visit("balance/driver_work", ledger.driver_work);
  visit("balance/carried_out", ledger.carried_out);
}

template <class Visitor, class StateType>
void visit_state(Visitor& visit, StateType& state) {
  visit_clock(visit, state.clock);
  visit("counts/steps", state.counts.steps);
  visit("counts/newton_iterations", state.counts.newton_iterations);
  visit("counts/linear_iterations", state.counts.linear_iterations);
  visit("counts/rejected_error", state.counts.rejected_error);
  visit("counts/rejected_newton", state.counts.rejected_newton);
  visit("bodies/position", state.bodies.position);
  visit("bodies/velocity", state.bodies.velocity);
  visit("bodies/acceleration", state.bodies.acceleration);
  visit("bodies/multipliers", state.bodies.multipliers);
  visit("bodies/force", state.bodies.force);
  visit("bodies/applied", state.bodies.applied);
  visit("bodies/wrench", state.bodies.wrench);
  visit("bodies/dissipated", state.bodies.dissipated);
  visit("bodies/integrator_loss", state.bodies.integrator_loss);
  visit("bodies/driver_work", state.bodies.driver_work);
  visit("shapes/contact_loss", state.shapes.contact_loss);
  visit("shapes/loss_power", state.shapes.loss_power);
  visit("shapes/integrator_loss", state.shapes.integrator_loss);
  visit("carried_out/left", state.carried_out.left);
  visit("carried_out/removed", state.carried_out.removed);
  visit("carried_out/energy", state.carried_out.energy);
  visit("carried_out/contact_loss", state.carried_out.contact_loss);
  visit("carried_out/integrator_loss", state.carried_out.integrator_loss);
  visit("balance/open", state.balance.open);
  visit("balance/start", state.balance.start);
  visit("balance/exchanged", state.balance.exchanged);
  visit_ledger(visit, state.balance.last);
}

// Not part of the hash: how much a run has written says nothing about what it computed.
template <class Visitor, class StateType>
void visit_output(Visitor& visit, StateType& state) {
  visit("clock/histories", state.clock.histories);
  visit("clock/snapshots", state.clock.snapshots);
  visit("clock/checkpoints", state.clock.checkpoints);
  visit("output/history_rows", state.history_rows);
  visit("output/snapshots", state.snapshots);
}

constexpr int kRealsPerParticle = 15, kIntegersPerParticle = 5;

void pack_reals(const ParticleRecord& p, Real* to) {
  for (const Vec3& v : {p.position, p.velocity, p.acceleration, p.force})
    for (const Real value : {v.x, v.y, v.z}) *to++ = value;
  for (const Real value : {p.contact_loss, p.loss_power, p.integrator_loss}) *to++ = value;
}

void pack_integers(const ParticleRecord& p, std::int64_t* to) {
  for (const std::int64_t value : {p.global_id, std::int64_t{p.image.x}, std::int64_t{p.image.y},
                                   std::int64_t{p.image.z}, std::int64_t{p.drifting}})
    *to++ = value;
}

ParticleRecord unpack_particle(const Real* r, const std::int64_t* k) {
  const auto vector = [r](int at) { return Vec3{r[at], r[at + 1], r[at + 2]}; };
  const auto whole = [k](int at) { return static_cast<std::int32_t>(k[at]); };
  return {k[0],      vector(0), vector(3),
          vector(6), vector(9), r[12],
          r[13],     r[14],     {whole(1), whole(2), whole(3)},
          k[4] != 0};
}

template <class T>
CheckpointRows<T> rows_of(const std::vector<ParticleRecord>& particles, int width,
                          void (*pack_one)(const ParticleRecord&, T*)) {
  return {width, std::ssize(particles), [=, &particles](std::int64_t first, std::int64_t count, T* to) {
            for (std::int64_t i = first; i < first + count; ++i, to += width)
              pack_one(particles[static_cast<std::size_t>(i)], to);
          }};
}

// Piece by piece: besides the records there is room for one piece.
std::vector<ParticleRecord> unpack_particles(const Checkpoint& in) {
  constexpr std::int64_t kPiece = 65536;
  const CheckpointRows<Real>& reals = in.real_row_array("particles/reals");
  const CheckpointRows<std::int64_t>& integers = in.integer_row_array("particles/integers");
  if (reals.width != kRealsPerParticle || integers.width != kIntegersPerParticle ||
      reals.count != integers.count)
    throw IoError(in.path + ": the particles' arrays do not fit together");
  std::vector<ParticleRecord> particles;
  particles.reserve(static_cast<std::size_t>(reals.count));
  std::vector<Real> r(kPiece * kRealsPerParticle);
  std::vector<std::int64_t> k(kPiece * kIntegersPerParticle);
  for (std::int64_t first = 0; first < reals.count; first += kPiece) {
    const std::int64_t count = std::min(kPiece, reals.count - first);
    reals.copy(first, count, r.data()), integers.copy(first, count, k.data());
    for (std::int64_t i = 0; i < count; ++i)
      particles.push_back(unpack_particle(&r[static_cast<std::size_t>(i * kRealsPerParticle)],
                                          &k[static_cast<std::size_t>(i * kIntegersPerParticle)]));
  }
  return particles;
}

}  // namespace

Checkpoint pack(const State& state) {
  Checkpoint out;
  Writer writer(out);
  visit_state(writer, state), visit_output(writer, state);
  out.real_rows["particles/reals"] = rows_of(state.particles, kRealsPerParticle, pack_reals);
  out.integer_rows["particles/integers"] = rows_of(state.particles, kIntegersPerParticle, pack_integers);
  return out;
}

std::uint64_t state_hash(const State& state, bool with_rest) {
  std::uint64_t sum = 0;
  for (const ParticleRecord& p : state.particles) {
    BitHash one;
    one.add(p.global_id);
    for (const Vec3& v : {p.position, p.velocity, p.acceleration, p.force}) one.add(v);
    for (const Real value : {p.contact_loss, p.loss_power, p.integrator_loss}) one.add(value);
    for (const std::int64_t value : {p.image.x, p.image.y, p.image.z}) one.add(value);
    one.add(std::int64_t{p.drifting});
    sum += one.hash();
  }
  if (!with_rest) return sum;
  Hasher rest;
  visit_state(rest, state);
  return sum + rest.hash();
}

State unpack(const Checkpoint& checkpoint) {
  State state;
  Reader reader(checkpoint);
  visit_state(reader, state), visit_output(reader, state);
  state.particles = unpack_particles(checkpoint);
  return state;
}

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw IoError(path + ": not a valid checkpoint: " + what);
}

void check_ids_increase(const std::string& path, GlobalId before, GlobalId id) {
  if (id <= before)
    refuse(path, fmt::format("particle {} comes after particle {}; ids must increase", id, before));
}

void check_particles(const State& state, const std::string& path, std::int64_t particles) {
  const ParticleRecord* before = nullptr;
  for (const ParticleRecord& p : state.particles) {
    if (p.global_id < 0 || p.global_id >= particles)
      refuse(path, fmt::format("particle id {}; the deck has the ids 0 to {}", p.global_id, particles - 1));
    if (before != nullptr) check_ids_increase(path, before->global_id, p.global_id);
    before = &p;
    Real values[kRealsPerParticle];
    pack_reals(p, values);
    for (const Real value : values)
      if (!std::isfinite(value))
        refuse(path, fmt::format("a value of particle {} is not finite", p.global_id));
  }
}

}  // namespace

void check_state(const State& state, const std::string& path, std::int64_t particles, const Ranks& ranks) {
  const std::int64_t found = ranks.sum(std::ssize(state.particles)), removed = state.carried_out.removed;
  if (found != particles - removed)
    refuse(path,
           fmt::format("{} particles; the deck has {}, of which {} were removed", found, particles, removed));
  ranks.together([&] {
    FiniteCheck finite;
    visit_state(finite, state);
    if (!finite.name().empty()) refuse(path, "'" + finite.name() + "' is not finite");
    check_particles(state, path, particles);
  });
  std::vector<GlobalId> ends;  // of the ranks' parts: the first id and the last
  if (!state.particles.empty()) ends = {state.particles.front().global_id, state.particles.back().global_id};
  ends = ranks.gather_everywhere(ends);
  for (std::size_t k = 2; k < ends.size(); k += 2) check_ids_increase(path, ends[k - 1], ends[k]);
}

}  // namespace scree
