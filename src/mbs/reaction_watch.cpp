#include "mbs/reaction_watch.hpp"

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
      gap_(constraint_scale.size()) {}

bool ReactionWatch::alternates(const std::vector<Real>& change, Real applied_change,
                               const std::vector<Real>& gap) const {
  return applied_change < alternating_ && cosine(change, change_) < kOpposite &&
         cosine(gap, gap_) < kOpposite;
}

void ReactionWatch::observe(const MultibodyState& start, const MultibodyState& end,
                            const std::vector<Real>& gap) {
  std::vector<Real> change(change_.size()), scaled_gap(gap.size());
  Real applied_change = 0;
  alternating_ = 0;
  for (std::size_t i = 0; i < change.size(); ++i) {
    const Real scale = coordinate_scale_[i];
    const Real before = start.applied[i] - start.force[i], after = end.applied[i] - end.force[i];
    change[i] = scale * (after - before);
    alternating_ = std::max(alternating_, std::abs(change[i]) / 2);
    mean_ = std::max(mean_, scale * std::abs(after + before) / 2);
    fastest_ = std::max(fastest_, std::abs(end.velocity[i]) / scale);
    applied_change = std::max(applied_change, scale * std::abs(end.applied[i] - start.applied[i]));
  }
  largest_gap_ = 0;
  for (std::size_t j = 0; j < gap.size(); ++j) {
    scaled_gap[j] = gap[j] / constraint_scale_[j];
    largest_gap_ = std::max(largest_gap_, std::abs(scaled_gap[j]));
  }
  steps_ = alternates(change, applied_change, scaled_gap) ? steps_ + 1 : 0;
  if (steps_ <= 1) first_ = alternating_;
  change_ = std::move(change);
  gap_ = std::move(scaled_gap);
  if (oscillates()) worst_share_ = std::max(worst_share_, share());
}

bool ReactionWatch::oscillates() const { return steps_ >= kSteps && alternating_ >= kGrowth * first_; }

}  // namespace scree
