// Parameters of the contact laws of a pair of materials, as the deck gives them: data alone, so that a change
// of a law recompiles only what evaluates it.
#pragma once

#include "base/types.hpp"

namespace scree {

// Parameters of liquid bridges (physics/liquid_bridge.hpp).
struct LiquidBridge {
  Real volume = 0;           // V / r^3, r: the smaller radius [-]; 0: no liquid
  Real surface_tension = 0;  // gamma [N/m]
  Real contact_angle = 0;    // theta [rad]
  Real viscosity = 0;        // mu [Pa s]
  Real least_gap = 0;        // s_min: gap over R* below which the viscous force does not grow [-]
  bool soulie = false;       // true: force after Soulie et al.; false: after Willett et al.

  bool acts() const { return volume > 0 && surface_tension > 0; }
};

// Parameters of the normal law: F = K d^n + C d_dot (Jung, Jun, Sohn, 2013, Eqs. 18-24), or Hertz's law with
// the modulus E* in place of K and n. A damping ratio in place of C gives the damper of
// physics/restitution.hpp, whose restitution depends on neither speed nor mass.
struct NormalLawParameters {
  Real normal_stiffness = 0;  // K [N/m^n]
  Real normal_damping = 0;    // C [N s/m]
  Real exponent = 1;          // n [-]
  bool tension = false;  // true: Eq. 18 as printed, F may be tensile before separation; false: F is cut at
                         // zero
  Real effective_modulus = 0;  // E* [Pa]
  Real damping_ratio = 0;      // zeta [-]
  // Adhesion and cohesion (physics/cohesion.hpp).
  Real adhesion_work = 0;  // w [J/m^2]
  bool jkr = false;        // true: JKR (Johnson, Kendall, Roberts); false: DMT (Derjaguin, Muller, Toporov)
  Real attraction = 0;     // constant cohesive force [N]
  Real range = 0;          // distance beyond touch over which it decreases to zero [m]
  // Elastic-plastic adhesion (physics/eepa.hpp), with `adhesion_work` as its g and `attraction` as its -f0.
  Real plasticity_ratio = 0;   // l = 1 - k1/k2 [-]; 0: the pair is elastic
  Real adhesion_exponent = 0;  // chi [-]; 0: n
  LiquidBridge bridge{};

  // Whether particles of these materials interact.
  bool acts() const { return normal_stiffness > 0 || effective_modulus > 0; }
  bool is_plastic() const { return plasticity_ratio > 0; }
  // Plastic pairs count as cohesive without adhesion, too: they are laws of the same kind.
  bool is_cohesive() const { return adhesion_work > 0 || attraction > 0 || is_plastic() || bridge.acts(); }
  NormalLawParameters without_cohesion() const {
    return {normal_stiffness, normal_damping, exponent, tension, effective_modulus, damping_ratio};
  }
  // Whether law_of_size() depends on the partners' sizes.
  bool depends_on_size() const { return effective_modulus > 0 || damping_ratio > 0 || bridge.viscosity > 0; }
};

// Friction parameters.
struct Friction {
  Real friction = 0;       // mu [-]
  Real stiffness = 0;      // k_t of `LinearSlider` [N/m]
  Real shear_modulus = 0;  // G* of `MindlinSlider` [Pa]
  Real damping_ratio = 0;  // zeta of the tangential dashpot [-]
};

// Parameters of the rolling and twisting resistance.
struct RollingParameters {
  Real friction = 0;           // mu_r of `ElasticPlasticRolling` [-]
  Real stiffness_factor = 0;   // of its spring [-]; 0: the stiffness is given
  Real stiffness = 0;          // k_r [N m]
  Real damping_ratio = 0;      // zeta of its dashpot [-]
  Real damping = 0;            // C of `ViscousRolling` [N m s]
  Real twisting_friction = 0;  // mu of `MarshallTwisting` [-]
};

}  // namespace scree
