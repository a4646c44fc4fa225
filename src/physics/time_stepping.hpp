// Newmark, HHT and velocity-Verlet updates of one unknown, and their step limits.
// Hilber, Hughes, Taylor, Earthquake Eng. Struct. Dyn. 5 (1977); Negrut, Rampalli, Ottarsson, Sajdak,
// J. Comput. Nonlinear Dyn. 2 (2007); Jung, Jun, Sohn (2013), Eqs. 1-3, 13.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// Coefficients of HHT for hht_alpha in [-1/3, 0] (Eq. 3).
struct HhtCoefficients {
  Real hht_alpha;
  Real newmark_gamma;
  Real newmark_beta;
  // Local error of the position per h^2 (a_{n+1} - a_n). In HHT a_n corresponds to the force at t_n + alpha
  // h, so that the h^3 term of the step is beta + alpha/2, while the exact one is 1/6.
  Real error_constant;
};

SCREE_HD HhtCoefficients hht_coefficients(Real hht_alpha) {
  const Real beta = (1 - hht_alpha) * (1 - hht_alpha) / 4;
  return {hht_alpha, (1 - 2 * hht_alpha) / 2, beta, beta + hht_alpha / 2 - Real(1) / 6};
}

// Displacement over a step of length h from the accelerations at both ends (Eq. 1). Vector: Vec3 or Real.
template <class Vector>
SCREE_HD Vector newmark_displacement(const HhtCoefficients& c, Real h, Vector v, Vector a0, Vector a1) {
  return h * v + (h * h / 2) * ((1 - 2 * c.newmark_beta) * a0 + (2 * c.newmark_beta) * a1);
}

// Velocity at the end of a step (Eq. 2).
template <class Vector>
SCREE_HD Vector newmark_velocity(const HhtCoefficients& c, Real h, Vector v, Vector a0, Vector a1) {
  return v + h * ((1 - c.newmark_gamma) * a0 + c.newmark_gamma * a1);
}

// Derivatives of position and velocity at the end of a step with respect to the acceleration there (Eqs. 1,
// 2) [s^2], [s].
SCREE_HD Real newmark_position_gain(const HhtCoefficients& c, Real h) { return c.newmark_beta * h * h; }
SCREE_HD Real newmark_velocity_gain(const HhtCoefficients& c, Real h) { return h * c.newmark_gamma; }

// Weight of the inertia forces, and of the mass in the Newton matrix (Eq. 16).
SCREE_HD Real hht_inertia_weight(const HhtCoefficients& c) { return 1 / (1 + c.hht_alpha); }

// Residual of Eq. 16 without constraints [N]; f0, f1: total force at the start and the end of the step.
SCREE_HD Vec3 hht_residual(const HhtCoefficients& c, Real mass, Vec3 a1, Vec3 f1, Vec3 f0) {
  const Real scale = hht_inertia_weight(c);
  return (mass * scale) * a1 - f1 + (c.hht_alpha * scale) * f0;
}

// Acceleration for which `hht_residual()` is zero.
SCREE_HD Vec3 hht_acceleration(const HhtCoefficients& c, Real mass, Vec3 f1, Vec3 f0) {
  return (1 / mass) * ((1 + c.hht_alpha) * f1 - c.hht_alpha * f0);
}

// Correction from the acceleration that a step was solved with to the one at its end, where a contact opened
// or closed within the step.
SCREE_HD Vec3 hht_event_acceleration(const HhtCoefficients& c, Real mass, Vec3 step_force, Vec3 end_force) {
  return ((1 + c.hht_alpha) / mass) * (end_force - step_force);
}

// Energy that the integrator removes in a step [J]: trapezoidal work of the forces minus the change of
// kinetic energy. Zero for hht_alpha = 0.
SCREE_HD Real integrator_loss(Real mass, Vec3 dx, Vec3 v0, Vec3 v1, Vec3 f0, Vec3 f1) {
  return Real(0.5) * (dot(f0 + f1, dx) - mass * dot(v0 + v1, v1 - v0));
}

// Velocity Verlet (Swope, Andersen, Berens, Wilson, J. Chem. Phys. 76, 1982): displacement over the step.
SCREE_HD Vec3 verlet_displacement(Real h, Vec3 v, Vec3 a0) { return h * v + (h * h / 2) * a0; }

// Predicted velocity at the end of the step, to second order in h, before the force there is known.
SCREE_HD Vec3 verlet_predicted_velocity(Real h, Vec3 v, Vec3 a0) { return v + h * a0; }

// Velocity at the end of the step from the predicted one.
SCREE_HD Vec3 verlet_velocity(Real h, Vec3 predicted, Vec3 a0, Vec3 a1) {
  return predicted + (h / 2) * (a1 - a0);
}

// Velocity Verlet in terms of the mid-step velocity v + (h/2) a_n, which one force evaluation advances to the
// next step.
SCREE_HD Vec3 verlet_middle_velocity(Real h, Vec3 predicted, Vec3 a0) { return predicted - (h / 2) * a0; }
SCREE_HD Vec3 verlet_next_middle(Real h, Vec3 middle, Vec3 a) { return middle + h * a; }
SCREE_HD Vec3 verlet_predicted_from_middle(Real h, Vec3 middle, Vec3 a0) { return middle + (h / 2) * a0; }
SCREE_HD Vec3 verlet_acceleration(Real h, Vec3 predicted, Vec3 middle) {
  return (2 / h) * (predicted - middle);
}

// Half a step's change of the velocity or of the angular velocity: from the start of the step to its middle,
// and from the middle to its end.
SCREE_HD Vec3 verlet_half_kick(Real h, Vec3 v, Vec3 a) { return v + (h / 2) * a; }

// Mid-step velocity and displacement after this many steps under a constant acceleration.
SCREE_HD Vec3 verlet_middle_after(Real steps, Real h, Vec3 middle, Vec3 a) {
  return middle + (steps * h) * a;
}
SCREE_HD Vec3 verlet_displacement_of(Real steps, Real h, Vec3 middle, Vec3 a) {
  return (steps * h) * (middle + ((steps + 1) / 2 * h) * a);
}

// The energy error of velocity Verlet is the difference of this function of state between the two instants
// [J].
SCREE_HD Real verlet_energy_shift(Real h, Real mass, Vec3 a) { return mass * h * h / 8 * dot(a, a); }

// Local position error of a step, relative to `length` (Negrut et al. 2007).
SCREE_HD Real hht_position_error(const HhtCoefficients& c, Real h, Vec3 a0, Vec3 a1, Real length) {
  const Vec3 da = a1 - a0;
  return c.error_constant * h * h * std::sqrt(dot(da, da)) / length;
}

}  // namespace scree
