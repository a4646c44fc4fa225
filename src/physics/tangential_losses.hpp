// Dissipation of friction, rolling and twisting, by kind.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// Kinds of dissipation beside that of the normal force: in sliders, in their dashpots, and in springs whose
// stiffness decreases.
enum LossKind { kFrictionLoss, kRollingLoss, kTwistingLoss, kLossKinds };

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
