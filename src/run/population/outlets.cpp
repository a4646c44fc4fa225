#include "run/population/outlets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"
#include "run/population/carrier_motion.hpp"

namespace scree {
namespace {

// Round-off of an instant, relative to the interval.
constexpr Real kInstantRoundOff = 1e-9;

constexpr std::size_t kSumWords = FixedSum::kNumbers;

FixedSum sum_of(const OutletState& state, std::size_t outlet) {
  FixedSum sum;
  std::copy_n(state.mass.begin() + static_cast<std::ptrdiff_t>(kSumWords * outlet), kSumWords, sum.word);
  return sum;
}

}  // namespace

Real OutletState::mass_of(int outlet) const { return sum_of(*this, as_size(outlet)).value(); }

std::int64_t OutletState::removed_of_all() const {
  return std::accumulate(removed.begin(), removed.end(), std::int64_t{0});
}

OutletState Outlets::start() const {
  const std::size_t n = model_.outlets.size();
  OutletState state;
  state.removed.assign(n, 0), state.instants.assign(n, 0), state.mass.assign(kSumWords * n, 0);
  return state;
}

// A little before the instant: a step may end there up to round-off.
Real Outlets::next_of(std::size_t k, const OutletState& state) const {
  const Outlet& of = model_.outlets[k];
  const Real t = of.start + (static_cast<Real>(state.instants[k]) - kInstantRoundOff) * of.interval;
  return t <= of.end ? t : kInfinity;
}

Real Outlets::next(const OutletState& state) const {
  Real earliest = kInfinity;
  for (std::size_t k = 0; k < model_.outlets.size(); ++k) earliest = std::min(earliest, next_of(k, state));
  return earliest;
}

Outlets::Open Outlets::open_at(Real t, std::span<const BodyMotion> motion, OutletState& state) const {
  Open open;
  for (std::size_t k = 0; k < model_.outlets.size(); ++k) {
    if (t < next_of(k, state)) continue;
    const Outlet& of = model_.outlets[k];
    state.instants[k] = std::llround(std::floor((t - of.start) / of.interval + kInstantRoundOff)) + 1;
    const CarrierMotion carrier(model_, of.carrier, motion);
    OutletRegion region = of.region;
    region.origin = carrier.point(region.origin);
    for (Vec3* axis : {&region.x, &region.y, &region.z}) *axis = carrier.direction(*axis);
    open.numbers.push_back(static_cast<int>(k)), open.regions.push_back(region);
  }
  return open;
}

void Outlets::account(const std::vector<EscapedParticle>& leaving, const Open& open,
                      OutletState& state) const {
  for (const EscapedParticle& particle : leaving) {
    if (particle.outlet < 0) continue;
    const auto k = as_size(open.numbers[as_size(particle.outlet)]);
    ++state.removed[k];
    FixedSum sum = sum_of(state, k);
    sum.add(particle.mass), sum.normalize();
    std::copy_n(sum.word, kSumWords, state.mass.begin() + static_cast<std::ptrdiff_t>(kSumWords * k));
  }
}

}  // namespace scree
