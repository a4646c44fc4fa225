// Properties of all contact laws that a deck can choose. A law added to the list is covered as soon as
// kPairs has parameters that choose it; without them the first test fails.
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "model/derived/choose_law.hpp"
#include "random_contact.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

constexpr int kCases = 300;
constexpr Real kStep = 0.05;
constexpr Real kRoundOff = 1e-12;            // of differences of energies of springs, which are about 1
constexpr Real kStepWithoutReversal = 1e-4;  // displacements are short beside the elongation of springs

NormalLawParameters wet(NormalLawParameters law, bool soulie) {
  law.own = BridgeParameters({.volume = 0.02,
                              .surface_tension = 0.8,
                              .contact_angle = 0.3,
                              .viscosity = 0.1,
                              .least_gap = 0.05,
                              .soulie = soulie});
  return law;
}

struct NamedPair {
  const char* name;
  NormalLawParameters law;
};
const NamedPair kPairs[] = {
    {"linear", {100, 0.5, 1, false}},
    {"linear, with tension", {100, 0.5, 1, true}},
    {"constant restitution", {100, 0, 1, false, 0, 0.2}},
    {"power law", {100, 0.5, 1.5, false}},
    {"Hertz", {0, 0, 1, false, 100, 0.2}},
    {"linear, attraction", {100, 0, 1, false, 0, 0.2, 0, false, 2, 0.2}},
    {"linear, attraction without range", {100, 0, 1, false, 0, 0.2, 0, false, 2, 0}},
    {"Hertz, DMT", {0, 0, 1, false, 100, 0.2, 0.5, false}},
    {"JKR", {0, 0, 1, false, 100, 0.2, 0.5, true}},
    {"EEPA, linear", {100, 0, 1, false, 0, 0.2, 0.5, false, 0.3, 0, Plasticity(0.6, 2)}},
    {"EEPA, Hertz", {0, 0, 1, false, 100, 0.2, 0.5, false, 0.3, 0, Plasticity(0.6, 2.5)}},
    {"linear, bridges", wet({100, 0, 1, false, 0, 0.2}, false)},
    {"linear, bridges after Soulie", wet({100, 0, 1, false, 0, 0.2}, true)},
    {"Hertz, bridges", wet({0, 0, 1, false, 100, 0.2}, false)}};

Contact contact_with(const NormalLawParameters& law, bool friction, bool rolling) {
  Contact contact;
  contact.laws = {law};
  if (friction)
    contact.friction = {{.friction = 0.3, .stiffness = 40, .shear_modulus = 40, .damping_ratio = 0.2}};
  if (rolling)
    contact.rolling = {{.friction = 0.2,
                        .stiffness_factor = 2.25,
                        .damping_ratio = 0.3,
                        .damping = 0.1,
                        .twisting_friction = 0.3}};
  return contact;
}

// Calls use(law) with the law that runs choose for a pair, for all of kPairs, with and without friction and
// rolling resistance as far as there are such laws.
template <class Use>
void for_each_law(const Use& use) {
  for (const NamedPair& pair : kPairs)
    for (const bool friction : {false, true})
      for (const bool rolling : {false, true}) {
        CAPTURE(pair.name, friction, rolling);
        try {
          with_contact_laws(contact_with(pair.law, friction, rolling),
                            [&](const auto& laws) { use(laws.front()); });
        } catch (const std::logic_error&) {
          CHECK(needs_friction(pair.law));  // with friction only
        }
      }
}

template <std::size_t kFirst = 0, class Normal>
std::size_t number_of(const Normal& normal) {
  if constexpr (std::is_same_v<typename std::tuple_element_t<kFirst, LawFamilies>::Normal, Normal>)
    return kFirst;
  else
    return number_of<kFirst + 1>(normal);
}

// History of a contact, with a state of the normal law where it has one.
template <class Law>
typename Law::History history_of(const Law&, const RandomContact& c) {
  return {c.history.spring, c.history.moment, c.history.touched,
          Law::State::read([](int k) { return Real(0.02) * (k + 1); })};
}

template <class Law>
typename Law::Outcome outcome_of(const Law& law, const RandomContact& c) {
  if constexpr (Law::kNeedsMotion)
    return law.respond(c.pair, history_of(law, c));
  else
    return {law.respond(c.pair, {}).load, {}, {}, {}, {}};
}

}  // namespace

TEST_CASE("the pairs of this test choose every normal law") {
  std::vector<int> chosen(std::tuple_size_v<LawFamilies>, 0);
  for_each_law([&](const auto& law) { ++chosen[number_of(law.normal)]; });
  for (const int times : chosen) CHECK(times > 0);
}

TEST_CASE("every law is odd or even under exchange of the partners, to the last bit") {
  for_each_law([](const auto& law) {
    for (const Real closeness : {1.05, 0.95}) {
      CAPTURE(closeness);
      RandomNumbers random;
      for (int k = 0; k < kCases; ++k, random.vector()) {
        const RandomContact one = contact_of(random, kStep, false, closeness),
                            other = contact_of(random, kStep, true, closeness);
        const auto history = history_of(law, one), mirrored = history_of(law, other);
        REQUIRE(law.closed(one.pair, history) == law.closed(other.pair, mirrored));
        if (!law.closed(one.pair, history)) continue;
        const auto f = outcome_of(law, one), g = outcome_of(law, other);
        CHECK((f.load.force == -g.load.force && f.load.loss == g.load.loss));
        CHECK((f.load.torque_i == g.load.torque_j && f.load.torque_j == g.load.torque_i));
        CHECK((f.history.spring == -g.history.spring && f.history.moment == -g.history.moment));
        CHECK((f.history.touched == g.history.touched && f.history.normal == g.history.normal));
        CHECK((f.friction.sum() == g.friction.sum() && f.rolling.sum() == g.rolling.sum()));
        CHECK(f.twisting.sum() == g.twisting.sum());
        const ContactEnergy e = law.energy_of(one.pair, history), d = law.energy_of(other.pair, mirrored);
        CHECK((e.sum == d.sum && e.cohesion == d.cohesion));
        CHECK(e.springs.sum() == d.springs.sum());
      }
    }
  });
}

TEST_CASE("dampers and unloading springs of every law dissipate") {
  for_each_law([](const auto& law) {
    RandomNumbers random;
    for (int k = 0; k < kCases; ++k, random.vector()) {
      const auto out = outcome_of(law, contact_of(random, kStepWithoutReversal, false));
      if constexpr (!std::decay_t<decltype(law)>::kNeedsMotion) CHECK(out.load.loss >= 0);
      for (const SpringLosses& losses : {out.friction, out.rolling, out.twisting})
        CHECK((losses.dashpot >= 0 && losses.unloading >= -kRoundOff));
    }
  });
}

}  // namespace scree
