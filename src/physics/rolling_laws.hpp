// Rolling and twisting laws: moments against rolling and against twisting. Both springs are parts of one
// vector M [N m] in the contact history, along the rotation of i relative to j (-M acts on i): its tangential
// and its normal part.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_parameters.hpp"
#include "physics/contact_parts.hpp"
#include "physics/spring_slider.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

// Every rolling law has acts, kHistory, the stiffness of its spring, and rolling(contact, old), the step of
// the tangential moment from the previous one, rotated with the contact; and rolling_at(contact, spring,
// rate), the moment at an instant. Every twisting law has twisting(contact, old) and twisting_at() for the
// normal moment. For implicit steps (step_rolling.hpp) both have slider(contact), and rolling laws
// viscosity(), the coefficient of a moment without limit. limit_per_load(contact): limit over load [m].

// Effective inertia of rolling about the contact: 1/I_r = sum 1/(I + m R^2) [kg m^2].
SCREE_HD Real rolling_inertia(const PairSize& size, const ContactMotion& c) {
  const auto inverse_of = [](Real inertia, Real mass, Real arm) {
    return inertia < kInfinity ? reciprocal(inertia + mass * arm * arm) : 0;
  };
  return reciprocal(inverse_of(c.inertia_i, size.mass_i, c.arm_i) +
                    inverse_of(c.inertia_j, size.mass_j, c.arm_j));
}

// Elastic-plastic spring and dashpot, "EPSD": M' = k_r w while |M| < mu_r R* F_n, w the rolling rate; dashpot
// 2 zeta sqrt(I_r k_r), within the limit together with the spring. k_r = factor K mu_r^2 R*^2, K the elastic
// stiffness dF/dd of the contact; the authors use factors of 2.25 in 3D and 3 in 2D. Ai, Chen, Rotter, Ooi,
// Powder Technol. 206 (2011), model C, in which the dashpot may exceed the limit.
struct ElasticPlasticRolling {
  static constexpr bool acts = true;
  static constexpr int kHistory = 3;
  Real friction = 0;          // mu_r [-]
  Real damping_ratio = 0;     // zeta [-]
  Real stiffness_factor = 0;  // [-]; 0: the stiffness is given
  Real stiffness = 0;         // k_r [N m]

  // k_r [N m]; of_contact: stiffness of the contact [N/m].
  SCREE_HD Real stiffness_at(const PairSize& size, Real of_contact) const {
    return stiffness_at(friction * size.effective_radius(), of_contact);
  }
  // arm: mu_r R* [m].
  SCREE_HD Real stiffness_at(Real arm, Real of_contact) const {
    return stiffness + stiffness_factor * arm * arm * of_contact;
  }
  SCREE_HD SpringSlider slider(const RollingContact& c) const {
    const Real arm = friction * c.normal.effective_radius, k = stiffness_at(arm, c.normal.stiffness),
               k0 = stiffness_at(arm, c.normal.stiffness0);
    const Real dashpot =
        damping_ratio > 0 ? dashpot_of(damping_ratio, rolling_inertia(c.size, c.motion), k) : 0;
    return {k, k0, dashpot, arm * c.normal.friction_load};
  }
  SCREE_HD Real viscosity() const { return 0; }
  SCREE_HD Real limit_per_load(const RollingContact& c) const { return friction * c.normal.effective_radius; }
  SCREE_HD SpringStep rolling(const RollingContact& c, Vec3 old) const {
    return spring_step(slider(c), old, c.motion.rolling, c.motion.h);
  }
  SCREE_HD Vec3 rolling_at(const RollingContact& c, Vec3 spring, Vec3 rate) const {
    return acting_at(slider(c), spring, rate);
  }
};

// M = C w: no history and no static resistance.
struct ViscousRolling {
  static constexpr bool acts = true;
  static constexpr int kHistory = 0;
  Real damping = 0;  // C [N m s]

  SCREE_HD Real stiffness_at(const PairSize&, Real) const { return 0; }
  SCREE_HD SpringSlider slider(const RollingContact&) const { return {}; }
  SCREE_HD Real viscosity() const { return damping; }
  SCREE_HD Real limit_per_load(const RollingContact&) const { return 0; }
  SCREE_HD SpringStep rolling(const RollingContact& c, Vec3) const {
    SpringStep out{};
    out.acting = (damping / c.motion.h) * c.motion.rolling;
    out.losses.dashpot = dot(out.acting, c.motion.rolling);
    return out;
  }
  SCREE_HD Vec3 rolling_at(const RollingContact&, Vec3, Vec3 rate) const { return damping * rate; }
};

// M' = (k_t a^2 / 2) w while |M| < 2/3 a mu F_n, w the twisting rate, with the tangential law's stiffness and
// (a^2 / 2) times its dashpot: the resultant of sliders distributed over the contact area. Marshall, J.
// Comput. Phys. 228 (2009).
struct MarshallTwisting {
  static constexpr bool acts = true;
  static constexpr int kHistory = 3;
  Real friction = 0;  // mu [-]

  // Twisting stiffness [N m]; a: contact radius [m], of_slip: k_t [N/m].
  SCREE_HD Real stiffness_at(Real a, Real of_slip) const { return a * a / 2 * of_slip; }
  SCREE_HD SpringSlider slider(const RollingContact& c) const {
    const Real a = c.normal.radius;
    return {stiffness_at(a, c.friction.stiffness), stiffness_at(c.normal.radius0, c.friction.stiffness0),
            a * a / 2 * c.friction.dashpot, Real(2) / 3 * a * friction * c.normal.friction_load};
  }
  SCREE_HD Real limit_per_load(const RollingContact& c) const {
    return Real(2) / 3 * c.normal.radius * friction;
  }
  SCREE_HD SpringStep twisting(const RollingContact& c, Vec3 old) const {
    return spring_step(slider(c), old, c.motion.twisting * c.motion.normal1, c.motion.h);
  }
  SCREE_HD Vec3 twisting_at(const RollingContact& c, Vec3 spring, Vec3 rate) const {
    return acting_at(slider(c), spring, rate);
  }
};

// Elastic-plastic and viscous rolling resistance, whose moments add; either may be zero.
struct EitherRolling {
  static constexpr bool acts = true;
  static constexpr int kHistory = 3;
  ElasticPlasticRolling spring{};
  ViscousRolling viscous{};

  SCREE_HD Real stiffness_at(const PairSize& size, Real of_contact) const {
    return spring.stiffness_at(size, of_contact);
  }
  SCREE_HD SpringSlider slider(const RollingContact& c) const {
    return spring.friction > 0 ? spring.slider(c) : SpringSlider{};
  }
  SCREE_HD Real viscosity() const { return viscous.damping; }
  SCREE_HD Real limit_per_load(const RollingContact& c) const { return spring.limit_per_load(c); }
  SCREE_HD SpringStep rolling(const RollingContact& c, Vec3 old) const {
    SpringStep out{};
    if (spring.friction > 0) out = spring.rolling(c, old);
    if (viscous.damping > 0) {
      const SpringStep part = viscous.rolling(c, old);
      out.acting += part.acting, out.losses += part.losses;
    }
    return out;
  }
  SCREE_HD Vec3 rolling_at(const RollingContact& c, Vec3 spring_moment, Vec3 rate) const {
    return spring.rolling_at(c, spring_moment, rate) + viscous.rolling_at(c, spring_moment, rate);
  }
};

// A rolling and a twisting law with one moment vector in the history.
template <class Rolling, class Twisting = FreeRolling>
struct RollingAndTwisting {
  static constexpr bool acts = true;
  static constexpr int kHistory = Rolling::kHistory > 0 || Twisting::kHistory > 0 ? 3 : 0;
  static constexpr bool kRolls = Rolling::acts, kTwists = Twisting::acts;
  Rolling rolling{};
  Twisting twisting{};

  // old: rotated with the contact.
  SCREE_HD RollingStep step(const RollingContact& c, Vec3 old) const {
    const Vec3 along = dot(old, c.motion.normal1) * c.motion.normal1;
    RollingStep out{};
    if constexpr (Rolling::acts) static_cast<SpringStep&>(out) = rolling.rolling(c, old - along);
    if constexpr (Twisting::acts) {
      SpringStep twist;  // assigned: gcc keeps an object that a function initializes in memory
      twist = twisting.twisting(c, along);
      out.spring += twist.spring, out.acting += twist.acting, out.twisting = twist.losses;
    }
    return out;
  }
  // The moment at an instant. spring: from the history [N m]; relative_spin: of i relative to j [rad/s].
  SCREE_HD Vec3 at(const RollingContact& c, Vec3 spring, Vec3 relative_spin) const {
    const Vec3 n = c.motion.normal1, along = dot(spring, n) * n, twist = dot(relative_spin, n) * n;
    Vec3 out;
    if constexpr (Rolling::acts) out = rolling.rolling_at(c, spring - along, relative_spin - twist);
    if constexpr (Twisting::acts) out += twisting.twisting_at(c, along, twist);
    return out;
  }
  // Elastic energy of the moment [J].
  SCREE_HD Real energy(const PairSize& size, const NormalContact& normal, Real of_slip, Vec3 normal1,
                       Vec3 moment) const {
    const Vec3 along = dot(moment, normal1) * normal1;
    Real out = 0;
    if constexpr (Rolling::acts)
      out += spring_energy(moment - along, rolling.stiffness_at(size, normal.stiffness));
    if constexpr (Twisting::acts) out += spring_energy(along, twisting.stiffness_at(normal.radius, of_slip));
    return out;
  }
};

// All rolling laws of a deck in one type, so that pairs of materials may differ and the kernels are compiled
// once.
struct AnyRolling : RollingAndTwisting<EitherRolling, MarshallTwisting> {
  static AnyRolling of(const RollingParameters& p) {
    return {{{{p.friction, p.damping_ratio, p.stiffness_factor, p.stiffness}, {p.damping}},
             {p.twisting_friction}}};
  }
};

}  // namespace scree
