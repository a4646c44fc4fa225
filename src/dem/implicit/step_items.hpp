// Per-particle kernels of the stages of a step that need no neighbours.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/contact/contact_items.hpp"
#include "dem/contact/system_items.hpp"
#include "partition/subdomain.hpp"
#include "physics/orientation.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Unknowns of an implicit step: position, velocity and acceleration at the iterate, and the state at the
// start of the step.
struct StepViews {
  Vec4 *position, *velocity;  // iterate at t_{n+1}
  Vec3* acceleration;         // iterate a_{n+1} [m/s^2]
  const Vec4 *start_position, *start_velocity;
  const Vec3 *start_acceleration, *start_force;
  HhtCoefficients hht;
  Real h;     // [s]
  Vec3 snap;  // Subdomain::snap_constant
};

// Acceleration at the start of the simulation.
struct StartAccelerationItem {
  const Vec3* force;     // [N]
  const Vec4* velocity;  // mass in w
  Vec3* acceleration;

  SCREE_HD void operator()(Index i) const { acceleration[i] = (1 / velocity[i].w) * force[i]; }
};

// Newmark's position and velocity from the current iterate of the acceleration.
struct NewmarkItem {
  StepViews step;

  SCREE_HD void operator()(Index i) const {
    const Vec4 x = step.start_position[i], v = step.start_velocity[i];
    const Vec3 a0 = step.start_acceleration[i], a1 = step.acceleration[i];
    const Vec3 dx = newmark_displacement(step.hht, step.h, xyz(v), a0, a1);
    step.position[i] = vec4(xyz(x) + snap(dx, step.snap), x.w);
    step.velocity[i] = vec4(newmark_velocity(step.hht, step.h, xyz(v), a0, a1), v.w);
  }
};

// Minus the residual of Eq. 16, and the inverse of the diagonal block of the Newton matrix.
struct ResidualItem {
  StepViews step;
  const Vec3* force;  // at the iterate [N]
  ContactMatrix matrix;
  Vec3* residual;  // [N]
  Sym3* inverse_block;
  Real* stiffness_ratio;  // norm of the block's contact part over its mass part

  SCREE_HD void operator()(Index i) const {
    const Real mass = step.velocity[i].w, scaled_mass = mass / (1 + step.hht.hht_alpha);
    residual[i] = -hht_residual(step.hht, mass, step.acceleration[i], force[i], step.start_force[i]);
    Sym3 block = matrix.diagonal[i];
    const Real rows[3] = {std::abs(block.xx) + std::abs(block.xy) + std::abs(block.xz),
                          std::abs(block.xy) + std::abs(block.yy) + std::abs(block.yz),
                          std::abs(block.xz) + std::abs(block.yz) + std::abs(block.zz)};
    const Real largest =
        rows[0] > rows[1] ? (rows[0] > rows[2] ? rows[0] : rows[2]) : (rows[1] > rows[2] ? rows[1] : rows[2]);
    stiffness_ratio[i] = largest / scaled_mass;
    block += Sym3{scaled_mass, 0, 0, scaled_mass, 0, scaled_mass};
    inverse_block[i] = inverse(block);
  }
};

// Norms of a Newton iteration for one particle; the norms of the iteration are their maxima.
struct StepNorms {
  Real residual;          // [N]
  Real correction_bound;  // bound of the position correction that the residual can still cause, over the
                          // radius
  Real force;             // at the iterate and at the start of the step [N]
  Real stiffness_ratio;   // see ResidualItem
};

// Largest residual over the largest force, from the maxima over all particles.
inline Real scaled_residual(const StepNorms& largest) {
  return largest.residual == 0 ? 0 : largest.residual / largest.force;
}

struct StepNormsItem {
  StepViews step;
  const Vec3* residual;
  const Real *magnitude, *stiffness_ratio;

  SCREE_HD StepNorms operator()(Index i) const {
    const Real r = norm(residual[i]), mass = step.velocity[i].w;
    const Real bound =
        newmark_position_gain(step.hht, step.h) * r * (1 + step.hht.hht_alpha) / (mass * step.position[i].w);
    const Real at_start = norm(step.start_force[i]) + mass * norm(step.start_acceleration[i]);
    return {r, bound, magnitude[i] + at_start, stiffness_ratio[i]};
  }
};

// Applies a fraction of a correction to the accelerations. Returns the full position correction over the
// particle's radius.
struct CorrectItem {
  Vec3* acceleration;
  const Vec3* correction;
  const Vec4* position;  // radius in w
  Real share;
  Real weight;  // newmark_position_gain [s^2]

  SCREE_HD Real operator()(Index i) const {
    acceleration[i] += share * correction[i];
    return weight * norm(correction[i]) / position[i].w;
  }
};

// Local position error of an implicit step over the radius.
struct StepErrorItem {
  StepViews step;

  SCREE_HD Real operator()(Index i) const {
    return hht_position_error(step.hht, step.h, step.start_acceleration[i], step.acceleration[i],
                              step.position[i].w);
  }
};

// Squared distance between two positions of an item [m^2].
struct DisplacementItem {
  const Vec4 *from, *to;

  SCREE_HD Real operator()(Index i) const {
    const Vec3 d = xyz(to[i]) - xyz(from[i]);
    return dot(d, d);
  }
};

// Term of (residual, correction) in the slope of the potential along a correction [N m/s^2].
struct SlopeTerm {
  Real value[1];
};
struct SlopeItem {
  const Vec3 *residual, *correction;

  SCREE_HD SlopeTerm operator()(Index i) const { return {{dot(residual[i], correction[i])}}; }
};

// residual_i -= (A d)_i for the Newton matrix A = mass / (1 + alpha) + contacts.
template <class Rows>
struct SubtractMatrixItem {
  ContactMatrix matrix;
  Rows rows;
  const Vec4* velocity;  // mass in w
  Real inverse_scale;    // hht_inertia_weight
  const Vec4* d;         // all items
  Vec3* residual;

  SCREE_HD void operator()(Index i) const {
    const Vec3 di = xyz(d[i]);
    Vec3 sum = (velocity[i].w * inverse_scale) * di + matrix.diagonal[i] * di;
    std::int64_t slot = rows.first(i);
    for (Index left = matrix.count[i]; left > 0; --left, slot += Rows::stride()) {
      const ContactEntry entry = matrix.entries[slot];
      const Vec3 b = entry.b();
      sum -= dot(b, xyz(d[entry.neighbor])) * b;
    }
    residual[i] -= sum;
  }
};

struct NormItem {
  const Vec3* vector;

  SCREE_HD Real operator()(Index i) const { return norm(vector[i]); }
};

// Closes an implicit step: adds the integrator's energy loss, and sets force and acceleration for the start
// of the next step.
struct AcceptItem {
  StepViews step;
  StepForces forces;
  Vec3* force;            // [N]
  Real* integrator_loss;  // [J]

  SCREE_HD void operator()(Index i) const {
    const Vec4 v0 = step.start_velocity[i];
    const Vec3 dx = xyz(step.position[i]) - xyz(step.start_position[i]);
    integrator_loss[i] += ::scree::integrator_loss(v0.w, dx, xyz(v0), xyz(step.velocity[i]),
                                                   step.start_force[i], forces.step_force[i]);
    step.acceleration[i] += hht_event_acceleration(step.hht, v0.w, forces.step_force[i], forces.end_force[i]);
    force[i] = forces.end_force[i];
  }
};

// Particle state of a velocity-Verlet step for the items below.
struct VerletViews {
  Vec4 *position, *velocity;  // velocity within a step: the predicted v + h a_n, which the contact law uses;
                              // or see `spin`
  Vec3* acceleration;
  Real* contact_loss;  // [J]
  Real* loss_power;    // at the last time level [W]
  Real h;              // [s]
  Vec3 snap;           // Subdomain::snap_constant
  // Null unless particles rotate. Then the velocities and angular velocities within a step are those of
  // mid-step, and loss_power is the mean over a whole step, accumulated when it is closed.
  Vec4* spin = nullptr;  // angular velocity, moment of inertia
  Vec3* angular_acceleration = nullptr;
  Quaternion* orientation = nullptr;
  Real* losses[kLossKinds] = {};  // parts of contact_loss by LossKind, for laws that distinguish these [J]
};

// State of a rotating particle at an instant, from which the next step starts.
struct RotatingState {
  Vec4 position, velocity;
  Vec3 acceleration;
  Vec4 spin;
  Vec3 angular_acceleration;
};

// Opens a step of a rotating particle. Returns the square of the displacement.
SCREE_HD Real verlet_open(const VerletViews& out, Index i, const RotatingState& s) {
  const Vec3 velocity = verlet_half_kick(out.h, xyz(s.velocity), s.acceleration);
  const Vec3 spin = verlet_half_kick(out.h, xyz(s.spin), s.angular_acceleration);
  const Vec3 dx = snap(out.h * velocity, out.snap);
  out.position[i] = vec4(xyz(s.position) + dx, s.position.w);
  out.velocity[i] = vec4(velocity, s.velocity.w), out.spin[i] = vec4(spin, s.spin.w);
  out.orientation[i] = rotated_by(out.orientation[i], spin, out.h);
  return dot(dx, dx);
}

// Opens a step: position at its end, and the velocity that the contact law uses there, to second order.
// Returns the square of the displacement.
SCREE_HD Real verlet_open(const VerletViews& out, Index i, Vec4 x, Vec4 v, Vec3 a) {
  const Vec3 dx = snap(verlet_displacement(out.h, xyz(v), a), out.snap);
  out.position[i] = vec4(xyz(x) + dx, x.w);
  out.velocity[i] = vec4(verlet_predicted_velocity(out.h, xyz(v), a), v.w);
  return dot(dx, dx);
}

// Opens a step from the committed state.
struct VerletStartItem {
  VerletViews state;

  SCREE_HD Real operator()(Index i) const {
    if (state.spin != nullptr)
      return verlet_open(state, i,
                         {state.position[i], state.velocity[i], state.acceleration[i], state.spin[i],
                          state.angular_acceleration[i]});
    if (state.loss_power[i] != 0) state.contact_loss[i] += state.h / 2 * state.loss_power[i];
    return verlet_open(state, i, state.position[i], state.velocity[i], state.acceleration[i]);
  }
};

// Closes a step: velocity and acceleration at its end from the force there. state.velocity is not the array
// that the contacts read, because other particles need the old velocities.
template <class Laws, class Rows>
struct VerletFinishItem {
  ContactForceItem<Laws, Rows, true> forces;
  VerletViews state;

  // Returns |a|^2, which reveals a force that is not finite.
  SCREE_HD Real operator()(Index i) const { return finish(i, forces.total(i)); }

  // Continues with the result of forces.total(i).
  using Total = typename ContactForceItem<Laws, Rows, true>::Total;
  SCREE_HD Real finish(Index i, const Total& total) const {
    forces.store(i, total);
    const Vec4 v = forces.walk.in.velocity[i];
    const Vec3 a = reciprocal(v.w) * forces.force[i];
    if constexpr (LawOf<Laws>::kNeedsMotion) {
      const Vec4 w = forces.walk.in.spin[i];
      const Vec3 angular_acceleration = forces.angular_acceleration[i];
      state.velocity[i] = vec4(verlet_half_kick(state.h, xyz(v), a), v.w);
      state.spin[i] = vec4(verlet_half_kick(state.h, xyz(w), angular_acceleration), w.w);
      state.contact_loss[i] += state.h * forces.loss_power[i];
      total.losses.accumulate(state.losses, i);
    } else {
      state.velocity[i] = vec4(verlet_velocity(state.h, xyz(v), state.acceleration[i], a), v.w);
      if (forces.loss_power[i] != 0) state.contact_loss[i] += state.h / 2 * forces.loss_power[i];
    }
    state.acceleration[i] = a;
    return dot(a, a);
  }
};

// Closes a step and opens the next of the same length: VerletFinishItem and VerletStartItem in one pass over
// memory, bit for bit.
template <class Laws, class Rows>
struct VerletAdvanceItem {
  ContactForceItem<Laws, Rows, true> forces;
  VerletViews state;

  SCREE_HD Real operator()(Index i) const { return advance(i, forces.total(i)); }

  // Continues with the result of forces.total(i).
  using Total = typename ContactForceItem<Laws, Rows, true>::Total;
  SCREE_HD Real advance(Index i, const Total& total) const {
    const Vec4 v = forces.walk.in.velocity[i];
    const Vec3 a = reciprocal(v.w) * total.force;
    if constexpr (LawOf<Laws>::kNeedsMotion) return advance_rotating(i, total, a);
    const Vec3 v1 = verlet_velocity(state.h, xyz(v), state.acceleration[i], a);
    state.acceleration[i] = a;
    if (total.loss_power != 0) {
      state.contact_loss[i] += state.h / 2 * total.loss_power;
      state.contact_loss[i] += state.h / 2 * total.loss_power;
    }
    return verlet_open(state, i, forces.walk.in.position[i], vec4(v1, v.w), a);
  }

 private:
  SCREE_HD Real advance_rotating(Index i, const Total& total, Vec3 a) const {
    const auto& in = forces.walk.in;
    const Vec4 v = in.velocity[i], w = in.spin[i];
    const Vec3 angular_acceleration = reciprocal(w.w) * total.torque;
    if (total.loss_power != 0) state.contact_loss[i] += state.h * total.loss_power;
    total.losses.accumulate(state.losses, i);
    return verlet_open(
        state, i,
        {in.position[i], vec4(verlet_half_kick(state.h, xyz(v), a), v.w), a,
         vec4(verlet_half_kick(state.h, xyz(w), angular_acceleration), w.w), angular_acceleration});
  }
};

}  // namespace scree
