// Normal quantities of a contact that the laws of friction, rolling and twisting depend on.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// Normal quantities at the end of a step, and at its start (0), where all are zero if the contact was open.
struct NormalContact {
  // Load in Coulomb's limit: normal force after the cut, plus the adhesive part; >= 0 [N].
  Real friction_load;
  Real radius, radius0;        // contact radius [m]
  Real stiffness, stiffness0;  // elastic stiffness of the normal force [N/m]
  Real effective_radius;       // R* [m]
};

// Optional members of a normal law's pair type, beside the functions of the overlap in normal_laws.hpp:
//   interaction_range()    beyond touch [m]; default: none
//   kHysteretic = true     JKR, bridges: contacts form at touch, d = 0, and break at d = -interaction_range()
//   formation_loss()       with kHysteretic: energy that the formation of a contact dissipates [J]
//   contact_radius(d)      [m]; default: sqrt(R* d)
//   contact_stiffness(d)   for rolling [N/m]; default: slope(d)
//   slope_of(radius)       slope(d) from contact_radius(d), which is a root less; default: slope(d)
//   elastic_of(radius, d), damping_of(radius)   likewise
//   radius                 R*, where the law uses it itself
//   adhesion(d)            adhesive part of the load that limits friction [N]; default: 0
//   friction_load(F, d)    that load where it is not the normal force F plus adhesion(d) [N]
//   cohesion(d)            adhesive part of energy(d) [J]; default: 0
// A law whose force depends on more than the overlap has a type `State` with the numbers that a contact keeps
// from step to step, all even under exchange of the partners, and zero for new contacts: `NoState` below has
// its members. Its pair type has
//   after(old, d)          the pair at the end of a step along a straight path from the state `old` to the
//                          overlap d, with the new `state`; the functions above hold for that state
//   dissipated             by this step, beside the damper; never negative [J]

struct NoState {
  static constexpr int kNumbers = 0;

  // As `ContactLaw::read_history()` and `write_history()`.
  template <class Number>
  SCREE_HD static NoState read(const Number&) {
    return {};
  }
  template <class Store>
  SCREE_HD void write(const Store&) const {}
  friend bool operator==(const NoState&, const NoState&) = default;
};

template <class NormalLaw>
struct NormalStateOf {
  using State = NoState;
};
template <class NormalLaw>
requires requires { typename NormalLaw::State; }
struct NormalStateOf<NormalLaw> {
  using State = typename NormalLaw::State;
};
template <class NormalLaw>
inline constexpr bool kHasState = NormalStateOf<NormalLaw>::State::kNumbers > 0;

// The law of a pair after a step; `pair` itself without a state.
template <class Pair, class State>
SCREE_HD decltype(auto) after_step(const Pair& pair, const State& old, Real d) {
  if constexpr (State::kNumbers > 0)
    return pair.after(old, d);
  else
    return (pair);
}

template <class NormalLaw>
inline constexpr bool kIsHysteretic = false;
template <class NormalLaw>
requires requires { NormalLaw::kHysteretic; }
inline constexpr bool kIsHysteretic<NormalLaw> = NormalLaw::kHysteretic;

template <class NormalLaw>
inline constexpr bool kActsBeyondTouch = requires(const NormalLaw& law, const PairSize& size) {
  law.of_pair(size).interaction_range();
};

// Interaction range beyond touch [m]: added to the sum of the radii in the search for contacts.
template <class Pair>
SCREE_HD Real interaction_range_of(const Pair& pair) {
  if constexpr (requires { pair.interaction_range(); })
    return pair.interaction_range();
  else
    return 0;
}

template <class NormalLaw>
inline constexpr bool kMayBeCohesive = requires(const NormalLaw& law, const PairSize& size) {
  law.of_pair(size).cohesion(0);
};

template <class Pair>
SCREE_HD Real cohesion_of(const Pair& pair, Real d) {
  if constexpr (requires { pair.cohesion(d); })
    return pair.cohesion(d);
  else
    return 0;
}

// R* [m].
template <class NormalLaw>
SCREE_HD Real effective_radius(const NormalLaw& law, const PairSize& size) {
  if constexpr (requires { law.radius; })
    return law.radius;
  else
    return size.effective_radius();
}

template <class NormalLaw>
SCREE_HD Real contact_radius(const NormalLaw& law, Real effective_radius, Real d) {
  if constexpr (kIsHysteretic<NormalLaw>)
    return d > -law.interaction_range() ? law.contact_radius(d) : 0;
  else if constexpr (requires { law.contact_radius(d); })
    return d > 0 ? law.contact_radius(d) : 0;
  else
    return d > 0 ? root(effective_radius * d) : 0;
}

// radius: of the contact at this overlap [m].
template <class NormalLaw>
SCREE_HD Real contact_stiffness(const NormalLaw& law, Real d, [[maybe_unused]] Real radius) {
  if constexpr (kIsHysteretic<NormalLaw>)
    return d > -law.interaction_range() ? law.contact_stiffness(d) : 0;
  else if constexpr (requires { law.contact_stiffness(d); })
    return law.contact_stiffness(d);
  else if constexpr (requires { law.slope_of(radius); })
    return d > 0 ? law.slope_of(radius) : 0;
  else
    return d > 0 ? law.slope(d) : 0;
}

// Normal quantities of a closed contact. force: after the cut [N]; d, d0: overlaps at the end and the start
// of the step [m].
template <class NormalLaw>
SCREE_HD NormalContact normal_contact(const NormalLaw& law, const PairSize& size, Real force, Real d,
                                      Real d0) {
  Real load = force;
  if constexpr (requires { law.friction_load(force, d); })
    load = law.friction_load(force, d);
  else if constexpr (requires { law.adhesion(d); })
    load += law.adhesion(d);
  const Real r = effective_radius(law, size), radius = contact_radius(law, r, d),
             radius0 = contact_radius(law, r, d0);
  return {load > 0 ? load : 0,
          radius,
          radius0,
          contact_stiffness(law, d, radius),
          contact_stiffness(law, d0, radius0),
          r};
}

}  // namespace scree
