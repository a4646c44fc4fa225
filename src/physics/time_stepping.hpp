// Newmark, HHT and velocity-Verlet updates of one unknown, and their step limits.
// Hilber, Hughes, Taylor, Earthquake Eng. Struct. Dyn. 5 (1977); Negrut, Rampalli, Ottarsson, Sajdak,
// J. Comput. Nonlinear Dyn. 2 (2007); Jung, Jun, Sohn (2013), Eqs. 1-3, 13.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// Coefficients of HHT for hht_alpha in [-1/3, 0] (Eq. 3).
struct HhtCoefficients {
  Real hht_alpha;
  Real newmark_gamma;
  Real newmark_beta;
  // Local error of the position per h^2 (a_{n+1} - a_n). HHT's a_n stands for the force at t_n + alpha h, so
  // the step's h^3 term is beta + alpha/2 and the exact one 1/6.
  Real error_constant;
};

SCREE_HD HhtCoefficients hht_coefficients(Real hht_alpha) {
  const Real beta = (1 - hht_alpha) * (1 - hht_alpha) / 4;
  return {hht_alpha, (1 - 2 * hht_alpha) / 2, beta, beta + hht_alpha / 2 - Real(1) / 6};
}

// Position at the end of a step of length h from the accelerations at both ends (Eq. 1).
SCREE_HD Vec3 newmark_position(const HhtCoefficients& c, Real h, Vec3 x, Vec3 v, Vec3 a0, Vec3 a1) {
  return x + h * v + (h * h / 2) * ((1 - 2 * c.newmark_beta) * a0 + (2 * c.newmark_beta) * a1);
}

// Velocity at the end of a step (Eq. 2).
SCREE_HD Vec3 newmark_velocity(const HhtCoefficients& c, Real h, Vec3 v, Vec3 a0, Vec3 a1) {
  return v + h * ((1 - c.newmark_gamma) * a0 + c.newmark_gamma * a1);
}

// Residual of Eq. 16 without constraints [N]; f0, f1: total force at the start and the end of the step.
SCREE_HD Vec3 hht_residual(const HhtCoefficients& c, Real mass, Vec3 a1, Vec3 f1, Vec3 f0) {
  const Real scale = 1 / (1 + c.hht_alpha);
  return (mass * scale) * a1 - f1 + (c.hht_alpha * scale) * f0;
}

// Energy that a step takes out of the motion [J]: trapezoidal work of the forces minus the change of kinetic
// energy. Zero for hht_alpha = 0.
SCREE_HD Real integrator_loss(Real mass, Vec3 dx, Vec3 v0, Vec3 v1, Vec3 f0, Vec3 f1) {
  return Real(0.5) * (dot(f0 + f1, dx) - mass * dot(v0 + v1, v1 - v0));
}

}  // namespace scree
