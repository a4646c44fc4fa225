// What laws of friction, rolling and twisting need to know of a contact along its normal.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// At the end of a step, and at its start (0), where all is zero if the contact was open.
struct NormalContact {
  Real grip;  // what Coulomb's limit counts: the force after the cut, and what adhesion adds; >= 0 [N]
  Real radius, radius0;        // of the circle of contact [m]
  Real stiffness, stiffness0;  // elastic, of the normal force [N/m]
};

// Of its partners a normal law may say more than the functions of the overlap that normal_laws.hpp lists:
//   reach()                how far beyond touch they can have a contact [m]; else none
//   kNeck = true           only after touch: it is made at d = 0, and holds down to -reach()
//   making_loss()          with a neck: what making a contact takes [J]
//   contact_radius(d)      of the circle of contact [m]; else sqrt(R* d)
//   contact_stiffness(d)   for rolling [N/m], where slope(d) will not do
//   adhesion(d)            what attraction adds to the load that limits friction [N]; else 0
//   cohesion(d)            what attraction adds to energy(d) [J]; else 0

template <class NormalLaw>
inline constexpr bool kHasNeck = false;
template <class NormalLaw>
requires requires { NormalLaw::kNeck; }
inline constexpr bool kHasNeck<NormalLaw> = NormalLaw::kNeck;

template <class NormalLaw>
inline constexpr bool kReachesBeyondTouch = requires(const NormalLaw& law, const PairSize& size) {
  law.of_pair(size).reach();
};

// How far beyond touch partners can have a contact [m]: what a search for contacts adds to the sum of their
// radii.
template <class Pair>
SCREE_HD Real reach_of(const Pair& pair) {
  if constexpr (requires { pair.reach(); })
    return pair.reach();
  else
    return 0;
}
template <class NormalLaw>
SCREE_HD Real reach_beyond_touch(const NormalLaw& law, const PairSize& size) {
  return reach_of(law.of_pair(size));
}

template <class NormalLaw>
inline constexpr bool kMayAttract = requires(const NormalLaw& law, const PairSize& size) {
  law.of_pair(size).cohesion(0);
};

template <class Pair>
SCREE_HD Real cohesion_of(const Pair& pair, Real d) {
  if constexpr (requires { pair.cohesion(d); })
    return pair.cohesion(d);
  else
    return 0;
}

template <class NormalLaw>
SCREE_HD Real contact_radius(const NormalLaw& law, const PairSize& size, Real d) {
  if constexpr (kHasNeck<NormalLaw>)
    return d > -law.reach() ? law.contact_radius(d) : 0;
  else if constexpr (requires { law.contact_radius(d); })
    return d > 0 ? law.contact_radius(d) : 0;
  else
    return d > 0 ? std::sqrt(size.effective_radius() * d) : 0;
}

template <class NormalLaw>
SCREE_HD Real contact_stiffness(const NormalLaw& law, Real d) {
  if constexpr (kHasNeck<NormalLaw>)
    return d > -law.reach() ? law.contact_stiffness(d) : 0;
  else if constexpr (requires { law.contact_stiffness(d); })
    return law.contact_stiffness(d);
  else
    return d > 0 ? law.slope(d) : 0;
}

// Of a closed contact; force: after the cut [N]; d, d0: overlaps at the end and the start of the step [m].
template <class NormalLaw>
SCREE_HD NormalContact normal_contact(const NormalLaw& law, const PairSize& size, Real force, Real d,
                                      Real d0) {
  Real grip = force;
  if constexpr (requires { law.adhesion(d); }) grip += law.adhesion(d);
  return {grip > 0 ? grip : 0, contact_radius(law, size, d), contact_radius(law, size, d0),
          contact_stiffness(law, d), contact_stiffness(law, d0)};
}

}  // namespace scree
