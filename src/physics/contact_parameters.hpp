// Parameters of the contact laws of a pair of materials, as the deck gives them: data alone, so that a change
// of a law recompiles only what evaluates it.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "physics/own_parameters.hpp"

namespace scree {

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
  AnyParameters own{};     // of one law alone

  // Whether particles of these materials interact.
  bool acts() const { return normal_stiffness > 0 || effective_modulus > 0; }
  bool is_cohesive() const { return adhesion_work > 0 || attraction > 0 || own->attracts(); }
  // Whether F = K d.
  bool is_linear() const { return exponent == 1 && own->is_linear(); }
  NormalLawParameters without_cohesion() const {
    NormalLawParameters law{normal_stiffness, normal_damping,    exponent,
                            tension,          effective_modulus, damping_ratio};
    if (!own->attracts()) law.own = own;
    return law;
  }
  // All numbers on which trial impacts depend. The structured bindings name every member, so that a new
  // member does not compile until it is added here.
  std::vector<Real> numbers() const {
    const auto& [k, c, n, tensile, e, zeta, work, is_jkr, pull, reach, of_law] = *this;
    std::vector<Real> all{k, c, n, Real(tensile), e, zeta, work, Real(is_jkr), pull, reach};
    const std::vector<Real> more = of_law->numbers();
    all.push_back(of_law ? 1 : 0), all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  // Whether law_of_size() depends on the partners' sizes.
  bool depends_on_size() const {
    return effective_modulus > 0 || damping_ratio > 0 || own->depends_on_size();
  }
};

// Friction parameters.
struct Friction {
  Real friction = 0;       // mu [-]
  Real stiffness = 0;      // k_t of `LinearSlider` [N/m]
  Real shear_modulus = 0;  // G* of `MindlinSlider` [Pa]
  Real damping_ratio = 0;  // zeta of the tangential dashpot [-]
  AnyParameters own{};     // of one law alone

  std::vector<Real> numbers() const {  // as NormalLawParameters::numbers()
    const auto& [mu, k_t, g, zeta, of_law] = *this;
    std::vector<Real> all{mu, k_t, g, zeta, Real(of_law ? 1 : 0)};
    const std::vector<Real> more = of_law->numbers();
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

// Parameters of the rolling and twisting resistance.
struct RollingParameters {
  Real friction = 0;           // mu_r of `ElasticPlasticRolling` [-]
  Real stiffness_factor = 0;   // of its spring [-]; 0: the stiffness is given
  Real stiffness = 0;          // k_r [N m]
  Real damping_ratio = 0;      // zeta of its dashpot [-]
  Real damping = 0;            // C of `ViscousRolling` [N m s]
  Real twisting_friction = 0;  // mu of `MarshallTwisting` [-]
  AnyParameters own{};         // of one law alone

  bool act() const { return friction > 0 || damping > 0 || twisting_friction > 0 || own; }
  std::vector<Real> numbers() const {  // as NormalLawParameters::numbers()
    const auto& [mu, factor, k_r, zeta, c, twisting, of_law] = *this;
    std::vector<Real> all{mu, factor, k_r, zeta, c, twisting, Real(of_law ? 1 : 0)};
    const std::vector<Real> more = of_law->numbers();
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

}  // namespace scree
