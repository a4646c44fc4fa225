#include "model/builder/mixing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/springs_in_series.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

namespace {

std::string pair_text(const std::string& a, const std::string& b) {
  return fmt::format("[\"{}\", \"{}\"]", a, b);
}

std::string text_of(const DeckValue& value) {
  if (const auto* number = std::get_if<Real>(&value.data)) return fmt::format("{}", *number);
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
  if (const auto* word = std::get_if<std::string>(&value.data)) return '"' + *word + '"';
  throw std::logic_error("mixing: a value of another type");
}

// A pair that is combined from the pairs of two materials with themselves.
class Combination {
 public:
  Combination(const DeckTable& contact, const LikePairs& like, const std::string& name_a,
              const std::string& name_b)
      : rule_(contact.choice<Mixing>("mixing")),
        name_a_(name_a),
        name_b_(name_b),
        a_(find(contact, like, name_a)),
        b_(find(contact, like, name_b)),
        out_(a_.keys(), fmt::format("contact.mixing: pair {}", pair_text(name_a, name_b)),
             contact.location()) {
    set("materials", std::vector{name_a, name_b});
  }

  DeckTable result() const { return out_; }
  void take_as_declared();  // all keys but those of the functions below
  void take_stiffness();
  void take_restitution();
  void take_tangential_stiffness();
  void take_twisting();
  void take_adhesion();

 private:
  const DeckTable& find(const DeckTable& contact, const LikePairs& like, const std::string& name) const;
  bool both(const std::string& key) const;
  [[noreturn]] void fail(const DeckTable& at, const std::string& key, const std::string& problem) const;
  template <class T>
  void set(const std::string& key, T value) {
    DeckValue made{std::move(value), out_.location(), ""};
    if constexpr (!std::is_same_v<T, std::vector<std::string>>) made.shown = text_of(made);
    out_.set(key, std::move(made));
  }
  void take_same(const std::string& key);
  void take_mean(const std::string& key);
  void take_series(const std::string& key);
  void set_series(const std::string& key, Real of_a, Real of_b, Real exponent = 1);

  Mixing rule_;
  const std::string &name_a_, &name_b_;
  const DeckTable &a_, &b_;
  DeckTable out_;
};

const DeckTable& Combination::find(const DeckTable& contact, const LikePairs& like,
                                   const std::string& name) const {
  const auto pair = like.find(name);
  if (pair == like.end())
    contact.fail("mixing", fmt::format("{}, which can meet, needs the pair {} in [[contact.pairs]], to be "
                                       "combined of; give that pair, or this one",
                                       pair_text(name_a_, name_b_), pair_text(name, name)));
  return *pair->second;
}

void Combination::fail(const DeckTable& at, const std::string& key, const std::string& problem) const {
  at.fail(key, fmt::format("{}, so that contact.mixing cannot make the pair {}; give it in [[contact.pairs]]",
                           problem, pair_text(name_a_, name_b_)));
}

// Whether both pairs have the key, or neither.
bool Combination::both(const std::string& key) const {
  if (a_.has(key) == b_.has(key)) return a_.has(key);
  const bool in_a = a_.has(key);
  const std::string& other = in_a ? name_b_ : name_a_;
  fail(in_a ? a_ : b_, key, fmt::format("the pair {} has none", pair_text(other, other)));
}

void Combination::take_same(const std::string& key) {
  if (!both(key)) return;
  const DeckValue &of_a = a_.values().at(key), &of_b = b_.values().at(key);
  if (text_of(of_a) != text_of(of_b))
    fail(b_, key,
         fmt::format("differs from the {} of the pair {}", text_of(of_a), pair_text(name_a_, name_a_)));
  out_.set(key, of_a);
}

void Combination::take_mean(const std::string& key) {
  if (both(key)) set(key, mixed(rule_, a_.real(key), b_.real(key)));
}

void Combination::set_series(const std::string& key, Real of_a, Real of_b, Real exponent) {
  if ((of_a == 0) != (of_b == 0)) {
    const std::string& other = of_a == 0 ? name_b_ : name_a_;
    fail(of_a == 0 ? a_ : b_, key,
         fmt::format("is 0, and that of the pair {} is not", pair_text(other, other)));
  }
  set(key, in_series(of_a, of_b, exponent));
}

void Combination::take_series(const std::string& key) {
  if (both(key)) set_series(key, a_.real(key), b_.real(key));
}

// Springs in series at equal force, whose overlaps depend on the exponent.
void Combination::take_stiffness() {
  if (both("stiffness"))
    set_series("stiffness", a_.real("stiffness"), b_.real("stiffness"), a_.real("exponent"));
}

void Combination::take_as_declared() {
  for (const Key& key : a_.keys().keys) {
    if (key.combining == Combining::same) take_same(key.name);
    if (key.combining == Combining::mean) take_mean(key.name);
    if (key.combining == Combining::series) take_series(key.name);
    if (key.combining == Combining::none)
      throw std::logic_error("mixing: the key " + key.name + " has no rule");
  }
}

// A contact without restitution and damping has a restitution of 1.
void Combination::take_restitution() {
  const bool rebounds = a_.has("restitution") || b_.has("restitution");
  for (const DeckTable* pair : {&a_, &b_})
    if (rebounds && pair->real("damping") > 0) {
      const std::string& other = pair == &a_ ? name_b_ : name_a_;
      fail(*pair, "damping", fmt::format("the pair {} has a restitution", pair_text(other, other)));
    }
  const auto restitution = [](const DeckTable& pair) {
    return pair.has("restitution") ? pair.real("restitution") : 1;
  };
  if (rebounds) set("restitution", mixed(rule_, restitution(a_), restitution(b_)));
}

// Left out, it follows from a linear stiffness; left out in both pairs, so does that of the combined pair.
void Combination::take_tangential_stiffness() {
  const char* key = "tangential_stiffness";
  if (!a_.has(key) && !b_.has(key)) return;
  const auto of = [&](const DeckTable& pair, const DeckTable& other) {
    if (pair.has(key)) return pair.real(key);
    if (pair.has("stiffness") && pair.real("exponent") == 1)
      return standard_slip_stiffness(pair.real("stiffness"));
    fail(other, key, "what the other pair has follows from no stiffness that is given");
  };
  set_series(key, of(a_, b_), of(b_, a_));
}

// Left out, with rolling resistance, it equals the friction.
void Combination::take_twisting() {
  const char* key = "twisting_friction";
  if (!a_.has(key) && !b_.has(key)) return;
  const auto rolls = [&](const DeckTable& pair) {
    const auto acts = [&](const char* of) { return pair.has(of) && pair.real(of) > 0; };
    return acts("rolling_friction") || acts("rolling_damping");
  };
  const auto of = [&](const DeckTable& pair) {
    if (!pair.has(key) && !rolls(pair)) both(key);
    return pair.real(pair.has(key) ? key : "friction");
  };
  set(key, mixed(rule_, of(a_), of(b_)));
}

// Mean of the works of adhesion; the geometric mean holds for surfaces with dispersion forces only (Girifalco
// and Good, J. Phys. Chem. 61, 1957).
void Combination::take_adhesion() {
  const auto has_work = [](const DeckTable& pair) {
    return pair.has("work_of_adhesion") || pair.has("surface_energy");
  };
  const auto work = [](const DeckTable& pair) {
    return pair.has("surface_energy") ? 2 * pair.real("surface_energy") : pair.real("work_of_adhesion");
  };
  if (has_work(a_) && has_work(b_)) {
    take_same("adhesion");
    set("work_of_adhesion", mixed(rule_, work(a_), work(b_)));
  } else {
    both("work_of_adhesion"), both("surface_energy");
  }
}

}  // namespace

Real mixed(Mixing rule, Real a, Real b) {
  if (a == b) return a;
  switch (rule) {
    case Mixing::geometric:
      return std::sqrt(a * b);
    case Mixing::arithmetic:
      return (a + b) / 2;
    case Mixing::harmonic:
      return 2 * a * b / (a + b);
    case Mixing::minimum:
      return std::min(a, b);
    case Mixing::maximum:
      return std::max(a, b);
    case Mixing::none:
      break;
  }
  throw std::logic_error("mixing: no rule");
}

LikePairs like_pairs(const DeckTable& contact) {
  LikePairs like;
  for (const DeckTable& pair : contact.tables("pairs")) {
    if (!pair.has("materials")) continue;
    const std::vector<std::string>& names = pair.texts("materials");
    if (names.size() == 2 && names[0] == names[1]) like.emplace(names[0], &pair);
  }
  return like;
}

DeckTable combined_pair(const DeckTable& contact, const LikePairs& like, const std::string& name_a,
                        const std::string& name_b) {
  Combination pair(contact, like, name_a, name_b);
  pair.take_stiffness(), pair.take_restitution();
  pair.take_as_declared();
  pair.take_tangential_stiffness(), pair.take_twisting(), pair.take_adhesion();
  return pair.result();
}

std::string keys_of(const DeckTable& pair) {
  std::string text;
  for (const Key& key : pair.keys().keys) {
    if (key.name == "materials" || !pair.has(key.name)) continue;
    const std::string value = text_of(pair.values().at(key.name));
    const bool standard =
        !key.default_value.empty() && (value == key.default_value || value + ".0" == key.default_value);
    if (!standard) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key.name, value);
  }
  return text.empty() ? "no key, as Hertz's law takes the moduli" : text;
}

}  // namespace scree
