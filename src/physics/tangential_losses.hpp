// Dissipation of friction, rolling and twisting, by kind.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// Kinds of dissipation beside that of the normal force: in sliders, in their dashpots, and in springs whose
// stiffness decreases. One line for each: its name, the field of the particles and the column of the history
// that accumulate it, what dissipates, and the FieldParts of these fields
// (dem/particles/particle_fields.hpp). OF: passed on to LINE. The laws that distinguish the kinds return them
// (ContactOutcomeOf::losses()); laws with friction alone have the first.
// clang-format off
#define SCREE_LOSS_KINDS(LINE, OF)                                                                           \
  LINE(OF, kFrictionLoss, friction_loss, loss_friction, "friction", kRotation)                               \
  LINE(OF, kRollingLoss, rolling_loss, loss_rolling, "rolling resistance", kRotation | kRolling)             \
  LINE(OF, kTwistingLoss, twisting_loss, loss_twisting, "twisting resistance", kRotation | kRolling)
// clang-format on

// Uses of the lines: the names, the pointers to the fields of a set of arrays, and the losses themselves.
#define SCREE_LOSS_NAME(of, kind, ...) kind,
#define SCREE_LOSS_POINTER(of, kind, field, ...) (of).field.data(),
#define SCREE_LOSS_VALUE(of, kind, ...) (of)[kind],

enum LossKind { SCREE_LOSS_KINDS(SCREE_LOSS_NAME, ) kLossKinds };

// Dissipation by the first kKinds kinds, over one or several steps [J].
template <int kKinds>
struct LossesByKind {
  Real of[kKinds];

  template <int kMore>
  SCREE_HD void add(const LossesByKind<kMore>& part) {
    static_assert(kMore >= kKinds);
    for (int k = 0; k < kKinds; ++k) of[k] += part.of[k];
  }
  SCREE_HD void scale(Real share) {
    for (int k = 0; k < kKinds; ++k) of[k] *= share;
  }
  SCREE_HD void fill(Real value) {
    for (int k = 0; k < kKinds; ++k) of[k] = value;
  }
  SCREE_HD Real sum() const {
    Real all = of[0];
    for (int k = 1; k < kKinds; ++k) all += of[k];
    return all;
  }
  // Adds the losses to those of particle i. All values are read before any is written, so that the loads
  // overlap.
  SCREE_HD void accumulate(Real* const (&losses)[kLossKinds], Index i) const {
    Real before[kKinds];
    for (int k = 0; k < kKinds; ++k) before[k] = of[k] != 0 ? losses[k][i] : 0;
    for (int k = 0; k < kKinds; ++k)
      if (of[k] != 0) losses[k][i] = before[k] + of[k];
  }
  friend bool operator==(const LossesByKind&, const LossesByKind&) = default;
};
template <>
struct LossesByKind<0> {
  template <int kMore>
  SCREE_HD void add(const LossesByKind<kMore>&) {}
  SCREE_HD void scale(Real) {}
  SCREE_HD void fill(Real) {}
  SCREE_HD void accumulate(Real* const (&)[kLossKinds], Index) const {}
};
using TangentialLosses = LossesByKind<kLossKinds>;

}  // namespace scree
