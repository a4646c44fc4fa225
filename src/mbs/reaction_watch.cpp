#include "mbs/reaction_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr Real kOpposite = -0.9;  // cosine between two steps
constexpr int kSteps = 50;
constexpr Real kGrowth = 10;

Real cosine(const std::vector<Real>& a, const std::vector<Real>& b) {
  Real ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
  }
  return ab == 0 ? 0 : ab / std::sqrt(aa * bb);
}

}  // namespace

ReactionWatch::ReactionWatch(const std::vector<Real>& coordinate_scale,
                             const std::vector<Real>& constraint_scale)
    : coordinate_scale_(coordinate_scale),
      constraint_scale_(constraint_scale),
      change_(coordinate_scale.size()),
      gap_(constraint_scale.size()),
      next_change_(coordinate_scale.size()),
      next_gap_(constraint_scale.size()) {}

bool ReactionWatch::alternates(Real applied_change) const {
  return applied_change < alternating_ && cosine(next_change_, change_) < kOpposite &&
         cosine(next_gap_, gap_) < kOpposite;
}

void ReactionWatch::observe(const MultibodyState& start, const MultibodyState& end,
                            const std::vector<Real>& gap) {
  Real applied_change = 0;
  alternating_ = 0;
  for (std::size_t i = 0; i < next_change_.size(); ++i) {
    const Real scale = coordinate_scale_[i];
    const Real before = start.applied[i] - start.force[i], after = end.applied[i] - end.force[i];
    next_change_[i] = scale * (after - before);
    alternating_ = std::max(alternating_, std::abs(next_change_[i]) / 2);
    mean_ = std::max(mean_, scale * std::abs(after + before) / 2);
    fastest_ = std::max(fastest_, std::abs(end.velocity[i]) / scale);
    applied_change = std::max(applied_change, scale * std::abs(end.applied[i] - start.applied[i]));
  }
  largest_gap_ = 0;
  for (std::size_t j = 0; j < gap.size(); ++j) {
    next_gap_[j] = gap[j] / constraint_scale_[j];
    largest_gap_ = std::max(largest_gap_, std::abs(next_gap_[j]));
  }
  steps_ = alternates(applied_change) ? steps_ + 1 : 0;
  if (steps_ <= 1) first_ = alternating_;
  change_.swap(next_change_);
  gap_.swap(next_gap_);
  if (oscillates()) worst_ratio_ = std::max(worst_ratio_, share());
}

bool ReactionWatch::oscillates() const { return steps_ >= kSteps && alternating_ >= kGrowth * first_; }

std::string oscillation_text(Real share, Real hht_alpha) {
  constexpr Real kLeastAlpha = -1.0 / 3;  // least hht_alpha (deck/keys_setup.cpp)
  const bool none = hht_alpha == 0;       // of either sign
  return fmt::format(
      "within the steps the reactions of joints and drivers, not those recorded, change sign at every step "
      "and have grown to {:.0f} times their mean: an oscillation of the method, which integrator.hht_alpha = "
      "{:g} {}; set it {}below zero, e.g. {:g}",
      share, none ? 0 : hht_alpha, none ? "does not damp" : "damps too little", none ? "" : "further ",
      none ? -0.05 : std::max(2 * hht_alpha, kLeastAlpha));
}

}  // namespace scree
