#include "dem/search/skin_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/derived/touching.hpp"

namespace scree {
namespace {

// Skins to choose from, over the smallest radius.
constexpr std::array<Real, 9> kSkins{0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0};
// A list that ended after fewer steps says little about the motion.
constexpr std::int64_t kFewestSteps = 2;

}  // namespace

bool lists_leave_no_trace(const Model& model) {
  return model.integrator.particles == ParticleIntegrator::velocity_verlet &&
         model.integrator.precision == Precision::full;
}

bool chooses_skin(const Model& model) {
  return model.contact.skin_is_default && lists_leave_no_trace(model) && model.particles.totals.count > 0;
}

Real widest_skin_of_domain(const Model& model) {
  const Space& space = model.space;
  const Real lengths[3] = {space.max.x - space.min.x, space.max.y - space.min.y, space.max.z - space.min.z};
  Real widest = kInfinity;
  for (int axis = 0; axis < 3; ++axis)
    if (space.boundary[2 * axis] == Boundary::periodic)
      widest = std::min(
          widest, lengths[axis] / 2 - 2 * radius_range(model).largest - model.contact.interaction_range);
  return widest;
}

SkinChoice::SkinChoice(const Model& model, const ListCosts& costs)
    : costs_(costs),
      unit_(chooses_skin(model) ? radius_range(model).smallest : 0),
      limit_(widest_skin_of_domain(model)),
      next_(model.contact.skin),
      dimension_(model.space.dimension) {}

// Of a step and its share of a list, over that of walking rows without skin. step: displacement of the
// fastest particle in a step [m]. A list lasts skin / (2 step) steps.
Real SkinChoice::cost(Real skin, Real step) const {
  const Real diameter = 2 * unit_;
  const auto volume = [&](Real reach) {
    const Real width = 1 + reach / diameter;
    return dimension_ == 3 ? width * width * width : width * width;
  };
  const Real steps = std::max<Real>(1, skin / (2 * step));
  return (costs_.fixed + costs_.search * volume(skin)) / steps + volume(costs_.walked * skin);
}

void SkinChoice::note(Real moved, std::int64_t steps) {
  if (unit_ == 0 || steps < kFewestSteps || !std::isfinite(moved)) return;
  const Real step = moved / static_cast<Real>(steps);
  Real least = kInfinity;
  const Real smallest = kSkins.front() * unit_;
  for (const Real share : kSkins) {
    const Real skin = share * unit_;
    if (skin > std::max(limit_, smallest) || !(cost(skin, step) < least)) continue;
    least = cost(skin, step), next_ = skin;
  }
}

// A list's entries are as many as its volume is large.
Real SkinChoice::limit_in_memory(Real free, Real entries, Real bytes_per_entry) const {
  const Real width = 2 * unit_ + next_, growth = 1 + free / std::max<Real>(1, entries * bytes_per_entry);
  return width * (dimension_ == 3 ? std::cbrt(growth) : std::sqrt(growth)) - 2 * unit_;
}

std::pair<Real, Real> skins_to_choose_from(const Model& model) {
  const Real unit = radius_range(model).smallest;
  return {kSkins.front() * unit,
          std::max(model.contact.skin, std::min(kSkins.back() * unit, widest_skin_of_domain(model)))};
}

}  // namespace scree
