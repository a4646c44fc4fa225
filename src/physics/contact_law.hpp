// The law of a contact at one instant, composed of a normal, a tangential and a rolling law.
#pragma once

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

// The force of one contact along its normal, and its derivatives with respect to overlap and overlap rate. F
// > 0 pushes the two apart.
template <class T>
struct ContactForceOf {
  T force;      // F [N]
  T stiffness;  // of the elastic part, [N/m]: dF/dd where the damping does not depend on d
  T damping;    // dF/d(d_dot) [N s/m]
  T loss;       // power taken out of the mechanical energy, (F - elastic force) d_dot [W]
};
using ContactForce = ContactForceOf<Real>;

// Of a closed contact: overlap d > 0 [m], overlap rate d_dot [m/s], positive when approaching.
template <class NormalLaw, class T>
SCREE_HD ContactForceOf<T> contact_force(const NormalLaw& law, T d, T d_dot) {
  const T elastic = law.elastic(d), damping = law.damping(d);
  const T force = elastic + damping * d_dot;
  if (force < 0 && !law.tension) return {0, 0, 0, -elastic * d_dot};
  return {force, law.slope(d), damping, damping * d_dot * d_dot};
}

// What one contact does to its partners.
template <class T, class Vector>
struct ContactLoadOf {
  Vector force;               // on i, and its opposite on j [N]
  T loss;                     // power that the law takes out of the mechanical energy [W]
  Vector torque_i, torque_j;  // about the centres [N m]
};

// No force across the normal, no torque against rolling: laws that add nothing. One that does has acts = true
// and
//   add(pair state, normal force, load)
struct Frictionless {
  static constexpr bool acts = false;
};
struct FreeRolling {
  static constexpr bool acts = false;
};

template <class NormalLaw, class TangentialLaw = Frictionless, class RollingLaw = FreeRolling>
struct ContactLaw {
  using Normal = NormalLaw;
  NormalLaw normal;
  TangentialLaw tangential{};
  RollingLaw rolling{};

  // The load of a closed contact. Pure: the same for both partners but for the sign of what is odd.
  template <class T, class Vector>
  SCREE_HD ContactLoadOf<T, Vector> load(const PairStateOf<T, Vector>& pair) const {
    const auto law = normal.template as<T>().of_pair(pair.size);
    const ContactForceOf<T> f = contact_force(law, pair.geometry.overlap, pair.geometry.rate(pair.velocity));
    ContactLoadOf<T, Vector> load{pair.geometry.along(f.force), f.loss, {}, {}};
    if constexpr (TangentialLaw::acts) tangential.add(pair, f.force, load);
    if constexpr (RollingLaw::acts) rolling.add(pair, f.force, load);
    return load;
  }
};

}  // namespace scree
