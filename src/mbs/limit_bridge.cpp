#include "mbs/limit_bridge.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr int kMany = 6;         // iterates, after which Newton's method counts as cycling
constexpr int kDoublings = 200;  // of an interval, far beyond any effort
constexpr int kHalvings = 60;    // of an interval, down to round-off
constexpr Real kSame = 1e-6;  // relative to the efforts: at this distance the law's own slope serves as well

Real slope_fraction(const JointEffort& effort) {
  const Dual& wanted = effort.wanted;
  return wanted.by_rate != 0 ? effort.by_rate / wanted.by_rate : effort.by_value / wanted.by_value;
}

}  // namespace

void LimitBridge::guide(const JointLaw& law, const LawStep& step, JointEffort& effort) {
  const Real limit = law.limit();
  if (!std::isfinite(limit)) return;
  const Point at{effort.wanted.value, effort.effort};
  const Real own = slope_fraction(effort);
  if (!iterate_ || iterate_->wanted != at.wanted) {
    share_ = own;
    if (iterate_) {
      const Point on{at.wanted, iterate_->effort + taken_ * (at.wanted - iterate_->wanted)};
      crossed_ = crossed_ || ++iterates_ >= kMany ||
                 (std::min(std::abs(at.wanted), std::abs(iterate_->wanted)) > limit &&
                  at.wanted * iterate_->wanted < 0);
      if (crossed_ && line_) share_ = share_to_line(law, step, at, on).value_or(own);
      line_ = on;
    }
    iterate_ = at;
  }
  if (share_ == own) return;
  effort.by_value = share_ * effort.wanted.by_value, effort.by_rate = share_ * effort.wanted.by_rate;
}

// The law increases with `wanted`, the line decreases: they intersect once.
std::optional<Real> LimitBridge::share_to_line(const JointLaw& law, const LawStep& step, const Point& at,
                                               const Point& on) const {
  const Real slope = (on.effort - line_->effort) / (on.wanted - line_->wanted);
  if (!(slope < 0) || !std::isfinite(slope)) return {};
  const auto above = [&](Real wanted) {
    return law.limited_at(step, wanted) > on.effort + slope * (wanted - on.wanted);
  };
  const Real direction = above(at.wanted) ? -1 : 1, size = std::abs(at.wanted) + law.limit();
  Real near = 0, far = kSame * size;
  for (int i = 0; i < kDoublings && above(at.wanted + direction * far) == (direction < 0); ++i)
    near = far, far *= 2;
  for (int i = 0; i < kHalvings; ++i) {
    const Real middle = (near + far) / 2;
    (above(at.wanted + direction * middle) == (direction < 0) ? near : far) = middle;
  }
  if (!(near > kSame * size)) return {};
  const Real intersection = at.wanted + direction * near;
  return (law.limited_at(step, intersection) - at.effort) / (intersection - at.wanted);
}

}  // namespace scree
