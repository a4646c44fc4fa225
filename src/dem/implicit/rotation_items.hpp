// Per-particle kernels of implicit steps with rotation, in the stages without contact evaluation: rotation,
// residual, linear solve. step_items.hpp has those without rotation.
#pragma once

#include "dem/implicit/friction_items.hpp"
#include "dem/implicit/step_items.hpp"
#include "physics/orientation.hpp"

namespace scree {

// Unknowns of the rotation, beside `StepViews`.
struct RotationViews {
  Vec4 *spin, *mean_spin;  // iterate at t_{n+1} and mean over the step; w: moment of inertia
  Vec3* acceleration;      // iterate [rad/s^2]
  const Vec4* start_spin;
  const Vec3* start_acceleration;
};

// Newmark's spin at the end of the step and mean spin over it from the current iterate of the acceleration;
// the rotation over the step takes the role of the displacement.
struct SpinUpdateItem {
  StepViews step;
  RotationViews rotation;

  SCREE_HD void operator()(Index i) const {
    const Vec4 w = rotation.start_spin[i];
    const Vec3 a0 = rotation.start_acceleration[i], a1 = rotation.acceleration[i];
    rotation.spin[i] = vec4(newmark_velocity(step.hht, step.h, xyz(w), a0, a1), w.w);
    const Vec3 turn = newmark_displacement(step.hht, step.h, xyz(w), a0, a1);
    rotation.mean_spin[i] = vec4((1 / step.h) * turn, w.w);
  }
};

// Minus the residuals of Eq. 16 for translation and rotation, the latter over the radius; masses of the
// Newton matrix and the inverse of its block.
template <bool kRolls>
struct FrictionResidualItem {
  StepViews step;
  RotationViews rotation;
  StepForces forces;
  StepTorques torques;
  Twist* residual;  // [N]
  ScaledMass* mass;
  BlockSlices inverse_block;
  Real* stiffness_ratio;  // bound of the block's contact part over its mass part

  template <class Rows>
  SCREE_HD void operator()(Index i, const FrictionMatrix& matrix, const Rows& rows,
                           Index first_surface) const {
    const Real weight = hht_inertia_weight(step.hht), radius = step.position[i].w;
    const Real m = step.velocity[i].w, inertia = rotation.start_spin[i].w;
    const Vec3 force =
        -hht_residual(step.hht, m, step.acceleration[i], forces.step_force[i], step.start_force[i]);
    const Vec3 torque =
        -hht_residual(step.hht, inertia, rotation.acceleration[i], torques.step[i], torques.start[i]);
    residual[i] = {force, (1 / radius) * torque};
    const ScaledMass masses{weight * m, weight * inertia / (radius * radius)};
    mass[i] = masses;
    Block6 block;
    matrix.for_each_entry<kRolls>(rows, i, [&](const auto& entry) { entry.add_to(block); });
    for (Index k = 0; k < matrix.surface_count[i]; ++k) {
      const FrictionEntry& entry = matrix.surface_entries[first_surface + k];
      entry.add_to(block);
      if constexpr (kRolls)
        matrix.surface_rolling[first_surface + k].add_to(
            block, Vec3{entry.normal.x, entry.normal.y, entry.normal.z});
    }
    stiffness_ratio[i] = largest_row(block, masses.move, masses.turn);
    block.move += Sym3{masses.move, 0, 0, masses.move, 0, masses.move};
    block.turn += Sym3{masses.turn, 0, 0, masses.turn, 0, masses.turn};
    inverse_block.put(i, Block6f::inverse_of(block));
  }
};

struct FrictionNorms : StepNorms {
  Real phase_squared;  // see FrictionSystemItem
};

struct FrictionNormsItem {
  StepViews step;
  const Twist* residual;
  const ScaledMass* mass;
  const Real *magnitude, *stiffness_ratio, *phase_squared;
  // Null for laws without rolling resistance. With it a moment may act without a force, and the angular
  // acceleration belongs to the scale of the residual.
  const Vec3* start_angular_acceleration = nullptr;

  SCREE_HD FrictionNorms operator()(Index i) const {
    const Real move = norm(residual[i].move), turn = norm(residual[i].turn);
    const Real by_move = move / mass[i].move, by_rotation = turn / mass[i].turn;
    const Real gain = newmark_position_gain(step.hht, step.h) / step.position[i].w;
    const Real at_start = norm(step.start_force[i]) + step.velocity[i].w * norm(step.start_acceleration[i]);
    FrictionNorms out;
    out.residual = move > turn ? move : turn;
    out.correction_bound = gain * (by_move > by_rotation ? by_move : by_rotation);
    out.force = magnitude[i] + at_start;
    if (start_angular_acceleration != nullptr)
      out.force += mass[i].turn * step.position[i].w * norm(start_angular_acceleration[i]);
    out.stiffness_ratio = stiffness_ratio[i], out.phase_squared = phase_squared[i];
    return out;
  }
};

struct TwistSizeItem {
  const Twist* twist;

  SCREE_HD Real operator()(Index i) const { return largest_part(twist[i]); }
};

// Applies a fraction of a correction of both accelerations, that of the rotation times the radius. Returns
// the full correction of position or rotation over the radius.
struct FrictionCorrectItem {
  Vec3 *acceleration, *angular_acceleration;
  const Twistf* correction;
  Real unit;             // of the correction, direction_unit [N]
  const Vec4* position;  // radius in w
  Real share;
  Real weight;  // newmark_position_gain [s^2]

  SCREE_HD Real operator()(Index i) const {
    const Real radius = position[i].w;
    const Twist by = unit * in_double(correction[i]);
    acceleration[i] += share * by.move;
    angular_acceleration[i] += (share / radius) * by.turn;
    return weight * largest_part(by) / radius;
  }
};

// residual_i -= (A d)_i for the Newton matrix A = masses + contacts. Directions and their products with
// contact entries are in single precision, because they are most of the memory traffic beside the entries.
template <class Rows, bool kRolls>
struct SubtractFrictionItem {
  FrictionMatrix matrix;
  Rows rows;
  const Index* surface_offsets;
  const ScaledMass* mass;
  bool consistent;  // see FrictionEntry
  const Twistf* d;  // of all items
  Real unit;        // of d, direction_unit [N]
  Twist* residual;

  SCREE_HD void operator()(Index i) const {
    const Twistf own = d[i];
    Twistf products{};
    matrix.for_each_entry<kRolls>(rows, i, [&](const auto& entry) {
      const Twistf other = d[entry.normal.neighbor];
      products += product_of(entry, own, other, consistent);
    });
    for (Index k = 0; k < matrix.surface_count[i]; ++k) {
      const FrictionEntry& entry = matrix.surface_entries[surface_offsets[i] + k];
      products += entry.apply(own.move, own.turn, consistent);
      if constexpr (kRolls)
        products.turn = products.turn + matrix.surface_rolling[surface_offsets[i] + k].apply(
                                            Vec3f{entry.normal.x, entry.normal.y, entry.normal.z}, own.move,
                                            own.turn, consistent);
    }
    const Twist of_mass{mass[i].move * in_double(own.move), mass[i].turn * in_double(own.turn)};
    residual[i] -= unit * (of_mass + in_double(products));
  }
};

// Whether the Newton matrix includes the change of friction with the overlap, from the largest 2 K h^2 / m:
// Newton's method then needs hardly more iterations than without friction. But the matrix is not symmetric,
// and where contacts are much shorter than the step the linear iteration would not converge.
SCREE_HD bool is_consistent(Real phase_squared) { return phase_squared <= Real(2.5) * Real(2.5); }

struct TwistDirectionItem {
  BlockSlices inverse_block;
  const Twist* residual;
  Real from_last, from_residual;  // ChebyshevWeights, the latter over the unit of d

  SCREE_HD Twistf next(Index i, Twistf d) const {
    return static_cast<float>(from_last) * d + inverse_block[i] * in_single(from_residual * residual[i]);
  }
};

// Local error of position or rotation of an implicit step over the radius.
struct RotationErrorItem {
  StepViews step;
  RotationViews rotation;

  SCREE_HD Real operator()(Index i) const {
    const Real move = StepErrorItem{step}(i);
    const Real turn =
        hht_position_error(step.hht, step.h, rotation.start_acceleration[i], rotation.acceleration[i], 1);
    return move > turn ? move : turn;
  }
};

// Accelerations at the end of a step that balance its forces exactly: the next step, which starts from them,
// does not inherit the residual of the iteration. Otherwise a residual too small to be corrected would act
// permanently, and a pile without rolling resistance would creep.
struct BalanceItem {
  StepViews step;
  RotationViews rotation;
  StepForces forces;
  StepTorques torques;

  SCREE_HD void operator()(Index i) const {
    step.acceleration[i] =
        hht_acceleration(step.hht, step.velocity[i].w, forces.step_force[i], step.start_force[i]);
    rotation.acceleration[i] =
        hht_acceleration(step.hht, rotation.spin[i].w, torques.step[i], torques.start[i]);
  }
};

// Closes the rotation of an implicit step, see `AcceptItem`.
struct AcceptRotationItem {
  StepViews step;
  RotationViews rotation;
  StepTorques torques;
  Quaternion* orientation;
  Real* integrator_loss;  // [J]

  SCREE_HD void operator()(Index i) const {
    const Vec4 w0 = rotation.start_spin[i];
    const Vec3 mean = xyz(rotation.mean_spin[i]);
    integrator_loss[i] += ::scree::integrator_loss(w0.w, step.h * mean, xyz(w0), xyz(rotation.spin[i]),
                                                   torques.start[i], torques.step[i]);
    rotation.acceleration[i] += hht_event_acceleration(step.hht, w0.w, torques.step[i], torques.end[i]);
    orientation[i] = rotated_by(orientation[i], mean, step.h);
  }
};

}  // namespace scree
