// Tangential laws: tangential force from the slip. The history stores the force of the spring, T [N], along
// the slip of i relative to j (-T acts on i). It stores the force and not the elongation, because the force
// is what persists where the stiffness changes.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/root.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_parameters.hpp"
#include "physics/contact_parts.hpp"
#include "physics/normal_contact.hpp"
#include "physics/spring_slider.hpp"

namespace scree {

// Every law below has
//   acts, kHistory                 whether it is to be evaluated; how many numbers of history it has
//   stiffness_at(radius)           stiffness of the spring at this contact radius [N/m]
//   slider(size, motion, normal)   spring and slider of a contact for a step

// Effective mass of the slip: 1/m_t = 1/m* + R_i^2/I_i + R_j^2/I_j [kg]; 2/7 of m* for spheres.
SCREE_HD Real slip_mass(const PairSize& size, const ContactMotion& c) {
  return inverse((inverse(size.mass_i) + inverse(size.mass_j)) +
                 (quotient(c.arm_i * c.arm_i, c.inertia_i) + quotient(c.arm_j * c.arm_j, c.inertia_j)));
}

// Dashpot of a damping ratio, 2 zeta sqrt(m k) [N s/m].
SCREE_HD Real dashpot_of(Real damping_ratio, Real mass, Real stiffness) {
  return 2 * damping_ratio * root(mass * stiffness);
}

// Tangential dashpot [N s/m]; skipped without damping, as in most runs.
SCREE_HD Real slip_dashpot(Real damping_ratio, const PairSize& size, const ContactMotion& c, Real stiffness) {
  return damping_ratio > 0 ? dashpot_of(damping_ratio, slip_mass(size, c), stiffness) : 0;
}

// Limit of the spring force T: mu F_n |r| / (R_i + R_j), for which the force on the centres obeys Coulomb's
// law.
SCREE_HD Real coulomb_limit(Real friction, const NormalContact& normal, const ContactMotion& c) {
  return friction * normal.friction_load * reciprocal(c.lever_arm_ratio);
}

// Default tangential stiffness for a linear stiffness [N/m]: two solid spheres in contact then have equal
// normal and tangential periods.
inline Real standard_slip_stiffness(Real stiffness) { return Real(2) / 7 * stiffness; }

// T' = k_t c while |T| < mu F_n, c the slip rate; dashpot 2 zeta sqrt(m_t k_t). Cundall and Strack,
// Geotechnique 29 (1979).
struct LinearSlider {
  static constexpr bool acts = true;
  static constexpr int kHistory = 3;
  Real stiffness = 0;      // k_t > 0 [N/m]; usually 2/7 to 1 of the normal stiffness
  Real friction = 0;       // mu [-]
  Real damping_ratio = 0;  // zeta [-]

  static LinearSlider of(const Friction& p) { return {p.stiffness, p.friction, p.damping_ratio}; }
  SCREE_HD Real stiffness_at(Real) const { return stiffness; }
  SCREE_HD SpringSlider slider(const PairSize& size, const ContactMotion& c,
                               const NormalContact& normal) const {
    return {stiffness, stiffness, slip_dashpot(damping_ratio, size, c, stiffness),
            coulomb_limit(friction, normal, c)};
  }
};

// Effective shear modulus G* of two materials [Pa]: 1/G* = sum 2 (2 - nu) (1 + nu) / E = sum (2 - nu) / G. A
// rigid partner has an infinite E.
SCREE_HD Real effective_shear_modulus(Real young_i, Real poisson_i, Real young_j, Real poisson_j) {
  return 1 /
         (2 * (2 - poisson_i) * (1 + poisson_i) / young_i + 2 * (2 - poisson_j) * (1 + poisson_j) / young_j);
}

// k_t = 8 G* a with the contact radius a, and the rescale rule where a changes. Mindlin, J. Appl. Mech. 16
// (1949), without partial slip in an annulus; damping as in `LinearSlider`.
struct MindlinSlider {
  static constexpr bool acts = true;
  static constexpr int kHistory = 3;
  Real shear_modulus = 0;  // G* [Pa]
  Real friction = 0;       // mu [-]
  Real damping_ratio = 0;  // zeta [-]

  static MindlinSlider of(const Friction& p) { return {p.shear_modulus, p.friction, p.damping_ratio}; }
  SCREE_HD Real stiffness_at(Real radius) const { return 8 * shear_modulus * radius; }
  SCREE_HD SpringSlider slider(const PairSize& size, const ContactMotion& c,
                               const NormalContact& normal) const {
    const Real stiffness = stiffness_at(normal.radius);
    return {stiffness, stiffness_at(normal.radius0), slip_dashpot(damping_ratio, size, c, stiffness),
            coulomb_limit(friction, normal, c)};
  }
};

}  // namespace scree
