// Per-particle kernels of contacts over an implicit step: forces, Newton matrix, energy accounting. Shared by
// the CPU and CUDA backends.
#pragma once

#include <cstdint>

#include "dem/contact/contact_items.hpp"
#include "dem/contact/contact_walk.hpp"
#include "physics/contact_losses.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// One contact in the Newton matrix, in single precision: the matrix determines the path of the iteration, but
// the residual its result, and the entries are most of the memory traffic of a matrix product.
struct alignas(16) ContactEntry {
  float x, y, z;   // b [sqrt(kg)]
  Index neighbor;  // j

  SCREE_HD Vec3 b() const { return {x, y, z}; }
};

SCREE_HD ContactEntry contact_entry(Vec3 b, Index neighbor) {
  return {static_cast<float>(b.x), static_cast<float>(b.y), static_cast<float>(b.z), neighbor};
}

// Newton matrix of the contacts: row i is the sum over its entries of b (b . (x_i - x_j)), with b = sqrt(beta
// h^2 dF/dd + h gamma dF/d(d_dot)) n. Entries are at the neighbour list's slots, packed to the front of a
// row.
struct ContactMatrix {
  Index* count;           // entries of row i
  ContactEntry* entries;  // [slots of the list]
  Sym3* diagonal;         // sum of b b^T over the row, walls included [kg]
};

// Sums over the contacts of each particle in an implicit step; for "step" and "end" see `StepContact`.
struct StepForces {
  Vec3 *step_force, *end_force;  // gravity included [N]
  Real* magnitude;               // sum of |F| over contacts and gravity: the scale of the residual [N]
};

// Weights of stiffness and damping in the Newton matrix.
struct NewtonWeights {
  Real stiffness;  // newmark_position_gain [s^2]
  Real damping;    // newmark_velocity_gain [s]

  SCREE_HD Real of(const StepContactForce& c) const { return stiffness * c.stiffness + damping * c.damping; }
};

// Response of a contact to an implicit step by the normal law. kLosses: with the energy accounting.
template <bool kLosses = false>
struct RespondOverStep {
  bool resolve_events;

  template <class Law>
  SCREE_HD StepContact operator()(const Law& law, const ContactPath& c, const typename Law::History&) const {
    return of(law.normal.of_pair(c.size), c);
  }
  template <class Views>
  SCREE_HD const StepContact* stored(const Views& in, Index entry) const {
    return in.steps[entry].touches ? &in.steps[entry].contact : nullptr;
  }
  template <class NormalLaw>
  SCREE_HD StepContact of(const NormalLaw& law, const ContactPath& c) const {
    const ContactForce end =
        c.step.acts_at_end() ? contact_force(law, c.step.overlap1, c.step.rate1) : ContactForce{0, 0, 0, 0};
    StepContact out{{end.force, end.stiffness, end.damping}, end.force, c.normal1, {}};
    if (resolve_events) out.step = step_contact_force(law, c.step);
    if constexpr (kLosses) {
      const Real force0 = start_force(law, c.step);
      const Real work = Real(0.5) * dot(force0 * c.normal0 + out.step.force * c.normal1, c.displacement);
      out.losses = contact_losses(law, c.step, work);
    }
    return out;
  }
};

template <class Laws, class Rows>
using StepWalk = ContactWalk<Laws, Rows, OverImplicitStep>;

// Force and row of the Newton matrix of particle i in an implicit step.
template <class Laws, class Rows>
struct ContactSystemItem {
  StepWalk<Laws, Rows> walk;
  Vec3 gravity;
  NewtonWeights weights;
  StepForces out;
  ContactMatrix matrix;

  SCREE_HD void operator()(Index i) const {
    const Vec3 weight = walk.in.velocity[i].w * gravity;
    Vec3 step_force = weight, end_force = weight;
    Real magnitude = norm(weight);
    Index entries = 0;
    std::int64_t slot = walk.in.rows.first(i);
    Sym3 diagonal;
    const auto add = [&](const StepContact& c) {
      step_force += c.step.force * c.normal;
      end_force += c.end_force * c.normal;
      magnitude += std::abs(c.step.force);
      const Real s = weights.of(c.step);
      diagonal += outer(s, c.normal);
      return s;
    };
    const auto self = walk.self(i);
    const RespondOverStep<> of{walk.kinematics.start.resolve_events};
    walk.neighbors(self, of, [&](const StepContact& c, Index j) {
      const Real s = add(c);
      matrix.entries[slot] = contact_entry(std::sqrt(s) * c.normal, j);
      ++entries, slot += Rows::stride();
    });
    walk.surfaces(self, of, [&](const StepContact& c, Index) { add(c); });
    out.step_force[i] = step_force, out.end_force[i] = end_force;
    out.magnitude[i] = magnitude;
    matrix.count[i] = entries;
    matrix.diagonal[i] = diagonal;
  }
};

// Accounts for particle i's share of the energies of its contacts over an accepted step.
template <class Laws, class Rows>
struct ContactLossesItem {
  StepWalk<Laws, Rows> walk;
  Real *contact_loss, *integrator_loss;  // [J]

  SCREE_HD void operator()(Index i) const {
    ContactLosses sum;
    const auto self = walk.self(i);
    const RespondOverStep<true> of{walk.kinematics.start.resolve_events};
    walk.neighbors(self, of, [&](const StepContact& c, Index) { sum.add(c.losses, kPairShare); });
    walk.surfaces(self, of, [&](const StepContact& c, Index) { sum.add(c.losses, 1); });
    contact_loss[i] += sum.dissipated, integrator_loss[i] += sum.integrator;
  }
};

}  // namespace scree
