// Per-particle kernels of implicit steps with friction: forces and torques, Newton matrix, energy accounting.
// Shared by the CPU and CUDA backends.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "dem/implicit/friction_matrix.hpp"

namespace scree {

template <class Laws, class Rows>
using FrictionWalk = ContactWalk<Laws, Rows, OverFrictionStep>;

// Contact torques on the particles; for forces see StepForces.
struct StepTorques {
  Vec3 *start, *step, *end;  // about the centre [N m]
};

// Sums over the contacts of one particle; moments over its radius.
struct FrictionSums {
  Vec3 step_force, end_force;                  // [N]
  Vec3 start_moment, step_moment, end_moment;  // [N]
  Real magnitude = 0;                          // [N]

  SCREE_HD static FrictionSums of(const FrictionalContact& c) {
    const Vec3 n = c.normal.normal;
    return {c.normal.step.force * n - c.lever_arm_ratio * c.friction.step,
            c.normal.end_force * n - c.lever_arm_ratio * c.friction.end,
            cross(c.normal0, c.friction.start),
            cross(n, c.friction.step),
            cross(n, c.friction.end),
            std::abs(c.normal.step.force) + norm(c.friction.step)};
  }
  SCREE_HD static FrictionSums of(const RollingFrictionalContact& c) {
    FrictionSums out = of(static_cast<const FrictionalContact&>(c));
    const Real inverse = 1 / c.radius_i;
    out.start_moment -= inverse * c.rolling.start, out.step_moment -= inverse * c.rolling.step;
    out.end_moment -= inverse * c.rolling.end;
    // A viscous moment also acts without a force.
    out.magnitude += inverse * (norm(c.rolling.start) + norm(c.rolling.step));
    return out;
  }
  // No contact: adding it changes no bit, not even the sign of a zero.
  SCREE_HD static FrictionSums nothing() {
    constexpr Real z = -0.0;
    constexpr Vec3 zero{z, z, z};
    return {zero, zero, zero, zero, zero, z};
  }
  SCREE_HD FrictionSums& operator+=(const FrictionSums& part) {
    step_force += part.step_force, end_force += part.end_force;
    start_moment += part.start_moment, step_moment += part.step_moment, end_moment += part.end_moment;
    magnitude += part.magnitude;
    return *this;
  }
};

// Force, torque and row of the Newton matrix of particle i.
template <class Laws, class Rows>
struct FrictionSystemItem {
  FrictionWalk<Laws, Rows> walk;
  Vec3 gravity;
  NewtonWeights weights;
  StepForces out;
  StepTorques torques;
  FrictionMatrix matrix;
  // Largest 2 K h^2 / m of the contacts that item i has evaluated; with shared rows these may be other
  // particles' contacts. Only the maximum over all items is used.
  Real* phase_squared;

  using Self = typename FrictionWalk<Laws, Rows>::Self;
  using Contact = FrictionalContactOf<LawOf<Laws>>;
  static constexpr bool kRolls = LawOf<Laws>::Rolling::acts;
  struct Total {
    FrictionSums sums;
    Real largest_phase = 0;
    Index entries = 0;  // in the row of the matrix
  };

  SCREE_HD void operator()(Index i) const {
    const Self self = walk.self(i);
    Total total = weight(self);
    add_neighbors(self, total);
    finish(self, total);
  }

  // The parts of the kernel, in this order.
  SCREE_HD Total weight(const Self& self) const {
    const Vec3 force = walk.in.velocity[self.i].w * gravity;
    return {{force, force, {}, {}, {}, norm(force)}};
  }
  SCREE_HD_CALLER
  SCREE_HD void add_neighbors(const Self& self, Total& total) const {
    if constexpr (kShared<Rows>) {
      total.entries = walk.in.rows.sum_contacts(self.i, walk.kinematics.test(walk.in, self),
                                                SharedContact{*this, total.largest_phase}, total.sums);
    } else {
      walk.neighbors(self, contact_of(), [&](const Contact& c, Index j) {
        total.sums += take(c, self.i, j, total.entries++, total.largest_phase);
      });
    }
  }
  SCREE_HD void finish(const Self& self, Total& total) const {
    const Index i = self.i;
    FrictionSums& sums = total.sums;
    Index surfaces = 0;
    walk.surfaces(self, contact_of(), [&](const Contact& c, Index surface) {
      sums += FrictionSums::of(c), update_phase(c, i, total.largest_phase);
      const Index partner =
          walk.in.numbers.is_static(surface) ? FrictionalPath::kWall : static_cast<Index>(c.slot);
      const Index entry = walk.in.surface_offsets[i] + surfaces++;
      matrix.surface_entries[entry] = FrictionEntry::of(c, weights, partner);
      if constexpr (kRolls) matrix.surface_rolling[entry] = RollingEntry::of(c, weights, c.radius_i);
    });
    const Real radius = walk.in.position[i].w;
    matrix.count[i] = total.entries, matrix.surface_count[i] = surfaces;
    out.step_force[i] = sums.step_force, out.end_force[i] = sums.end_force;
    out.magnitude[i] = sums.magnitude;
    torques.start[i] = radius * sums.start_moment, torques.step[i] = radius * sums.step_moment;
    torques.end[i] = radius * sums.end_moment;
    phase_squared[i] = total.largest_phase;
  }

 private:
  // Evaluates contacts of any row; k: index of the contact in its row.
  struct SharedContact {
    const FrictionSystemItem& item;
    Real& largest_phase;

    SCREE_HD FrictionSums operator()(Index i, Index j, std::int64_t slot, Index k) const {
      return item.take(item.walk.contact_at(item.contact_of(), i, j, slot), i, j, k, largest_phase);
    }
    SCREE_HD void prepare(std::int64_t slot) const { item.walk.prepare(slot); }
  };

  SCREE_HD RespondWithFriction<> contact_of() const { return {walk.kinematics.start, walk.in.spin}; }
  // Stores the k-th contact of row i as an entry of the matrix. Returns its contribution to the sums.
  SCREE_HD FrictionSums take(const Contact& c, Index i, Index j, Index k, Real& largest_phase) const {
    const std::int64_t slot = walk.in.rows.first(i) + static_cast<std::int64_t>(k) * Rows::stride();
    if (!c.acts) {
      matrix.entries.put_none(slot);
      return FrictionSums::nothing();
    }
    matrix.entries.put(slot, FrictionEntry::of(c, weights, j)), update_phase(c, i, largest_phase);
    if constexpr (kRolls)
      matrix.entries.rolling[slot] = RollingEntry::of(c, weights, c.radius_i / c.radius_j);
    return FrictionSums::of(c);
  }
  SCREE_HD void update_phase(const FrictionalContact& c, Index i, Real& largest_phase) const {
    const Real h = walk.kinematics.start.step.h;
    const Real phase = 2 * c.normal.step.stiffness * h * h / walk.in.velocity[i].w;
    largest_phase = phase > largest_phase ? phase : largest_phase;
  }
};

// Outputs of the energy accounting; losses: parts of `contact`, null where the law does not distinguish them
// [J].
struct FrictionLossOutputs {
  Real *contact, *integrator;
  Real* losses[kLossKinds];
};

// Sums of the energy accounting over a particle's share of its contacts [J].
template <int kKinds>
struct FrictionLossSums {
  Real dissipated = 0, integrator = 0;
  LossesByKind<kKinds> by_kind{};

  SCREE_HD static FrictionLossSums of(const FrictionLosses& one, Real share) {
    FrictionLossSums out{share * one.dissipated, share * one.integrator};
    for (int k = 0; k < kKinds; ++k) out.by_kind.of[k] = share * one.by_kind.of[k];
    return out;
  }
  // No contact: adding it changes no bit, not even the sign of a zero.
  SCREE_HD static FrictionLossSums nothing() {
    FrictionLossSums out{-0.0, -0.0};
    out.by_kind.fill(-0.0);
    return out;
  }
  SCREE_HD FrictionLossSums& operator+=(const FrictionLossSums& part) {
    dissipated += part.dissipated, integrator += part.integrator, by_kind.add(part.by_kind);
    return *this;
  }
};

// Accounts for particle i's share of the energies of its contacts over an accepted step, and stores their
// history.
template <class Laws, class Rows>
struct FrictionLossesItem {
  FrictionWalk<Laws, Rows> walk;
  FrictionLossOutputs to;

  using Self = typename FrictionWalk<Laws, Rows>::Self;
  using Sums = FrictionLossSums<kLossKindsOf<LawOf<Laws>>>;

  SCREE_HD void operator()(Index i) const {
    const Self self = walk.self(i);
    Sums sum;
    add_neighbors(self, sum);
    finish(self, sum);
  }

  // The parts of the kernel, in this order.
  SCREE_HD_CALLER
  SCREE_HD void add_neighbors(const Self& self, Sums& sum) const {
    if constexpr (kShared<Rows>) {
      walk.in.rows.sum_contacts(self.i, walk.kinematics.test(walk.in, self), SharedLosses{*this}, sum);
    } else {
      walk.template neighbors<true>(self, contact_of(), [&](const FrictionalContact& c, Index) {
        if (c.acts) sum += Sums::of(c.losses, kPairShare);
      });
    }
  }
  SCREE_HD void finish(const Self& self, Sums& sum) const {
    walk.template surfaces<true>(self, contact_of(),
                                 [&](const FrictionalContact& c, Index) { sum += Sums::of(c.losses, 1); });
    to.contact[self.i] += sum.dissipated, to.integrator[self.i] += sum.integrator;
    sum.by_kind.accumulate(to.losses, self.i);
  }

 private:
  // Accounts for contacts of any row.
  struct SharedLosses {
    const FrictionLossesItem& item;

    SCREE_HD Sums operator()(Index i, Index j, std::int64_t slot) const {
      const auto c = item.walk.contact_at(item.contact_of(), i, j, slot);
      const auto& history = item.walk.in.history;
      if (c.lasts) history.template write<LawOf<Laws>>(history.neighbors, slot, c.history);
      return c.acts ? Sums::of(c.losses, kPairShare) : Sums::nothing();
    }
    SCREE_HD void prepare(std::int64_t slot) const { item.walk.prepare(slot); }
  };

  SCREE_HD RespondWithFriction<true> contact_of() const { return {walk.kinematics.start, walk.in.spin}; }
};

// Stores the friction limits of particle i's contacts at the iterate, including limits that are already
// lagged.
template <class Laws, class Rows>
struct LaggedLimitItem {
  FrictionWalk<Laws, Rows> walk;
  LaggedLimits to;

  SCREE_HD void operator()(Index i) const {
    const auto self = walk.self(i);
    const RespondWithFriction<> of{walk.kinematics.start, walk.in.spin};
    walk.neighbors(self, of, [&](const FrictionalContact& c, Index) {
      if (c.acts) to.neighbors[c.slot] = c.friction.limit;
    });
    walk.surfaces(self, of,
                  [&](const FrictionalContact& c, Index) { to.surfaces[c.slot] = c.friction.limit; });
  }
};

}  // namespace scree
