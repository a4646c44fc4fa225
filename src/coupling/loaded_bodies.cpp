#include "coupling/loaded_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"

namespace scree {

namespace {

// PressedBody::load from which on a body is loaded. With wrenches at the predicted position steps are
// unstable from 2 on.
constexpr Real kLoaded = 0.2;

// Least cosine between the two vectors of an update.
constexpr Real kAlong = 1e-3;
// Displacements below this share of the lever arm `reach` are round-off.
constexpr Real kRoundOff = 1e-13;

template <std::size_t n>
Real inner(const std::array<Real, n>& a, const std::array<Real, n>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), Real(0));
}

}  // namespace

void WrenchSlope::begin(Real stiffness, Real reach) {
  reach_ = reach > 0 ? reach : 1;
  slope_ = {};
  for (std::size_t k = 0; k < 6; ++k) slope_[k][k] = stiffness;
}

WrenchSlope::Vector WrenchSlope::moved(const BodyMotion& from, const BodyMotion& to) const {
  const Vec3 move = to.position - from.position, turn = reach_ * rotation_between(from, to);
  return {move.x, move.y, move.z, turn.x, turn.y, turn.z};
}

WrenchSlope::Vector WrenchSlope::product(const Vector& move) const {
  Vector out;
  for (std::size_t k = 0; k < 6; ++k) out[k] = inner(slope_[k], move);
  return out;
}

void WrenchSlope::observe(const BodyMotion& from, const BodyMotion& to, const BodyWrench& change) {
  const Vector move = moved(from, to), expected = product(move);
  const Real size = std::sqrt(inner(move, move));
  if (!(size > kRoundOff * (reach_ + norm(to.position)))) return;
  const Vec3 force = change.force, couple = reciprocal(reach_) * change.torque;
  Vector fall{-force.x, -force.y, -force.z, -couple.x, -couple.y, -couple.z};
  if (!(inner(fall, move) > 0)) fall = {};  // contacts have opened: no stiffness along this displacement
  Vector missing;
  for (std::size_t k = 0; k < 6; ++k) missing[k] = fall[k] - expected[k];
  const Real along = inner(missing, move);
  if (!(std::abs(along) > kAlong * std::sqrt(inner(missing, missing)) * size)) return;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) slope_[i][j] += missing[i] * missing[j] / along;
}

BodyWrench WrenchSlope::change(const BodyMotion& from, const BodyMotion& to) const {
  const Vector f = product(moved(from, to));
  return {{-f[0], -f[1], -f[2]}, -reach_ * Vec3{f[3], f[4], f[5]}};
}

std::array<Real, 21> WrenchSlope::packed() const {
  std::array<Real, 21> out{};
  const auto unit = [this](std::size_t k) { return k < 3 ? 1 : reach_; };
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j)
      out[as_size(packed6(as_index(i), as_index(j)))] = unit(i) * unit(j) * (slope_[i][j] + slope_[j][i]) / 2;
  return out;
}

LoadedBodies::LoadedBodies(const Model& model)
    : model_(model),
      coefficients_(hht_coefficients(model.integrator.hht_alpha)),
      bodies_(pressed_bodies(model)),
      slope_(bodies_.size()) {
  can_be_ = std::ranges::any_of(bodies_, [](const PressedBody& body) { return body.stiffness > 0; });
}

bool LoadedBodies::are_loaded(const std::vector<std::int64_t>& contacts, Real h) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].load(contacts[b], h) > kLoaded) return true;
  return false;
}

// Over a unit displacement the contact force decreases by K, and by C times the change of velocity that
// Newmark's formulas give with it.
void LoadedBodies::open(const std::vector<std::int64_t>& contacts, Real h,
                        const std::vector<BodyMotion>& motion, const std::vector<BodyWrench>& mean,
                        const std::vector<BodyWrench>& predicted) {
  const Real rate = newmark_velocity_gain(coefficients_, h) / newmark_position_gain(coefficients_, h);
  motion_.assign(motion.begin(), motion.begin() + std::ssize(bodies_));
  mean_ = mean, predicted_ = predicted, now_ = predicted;
  averaged_ = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const PressedBody& body = bodies_[b];
    const auto count = static_cast<Real>(contacts[b]);
    slope_[b].begin(count * (body.stiffness + rate * body.damping), body.reach);
    averaged_ = std::max(averaged_, std::min(Real(1), count * h * body.damping / body.mass));
  }
  watch(contacts, h);
}

void LoadedBodies::follow(const std::vector<BodyMotion>& motion, const std::vector<BodyWrench>& found) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    slope_[b].observe(motion_[b], motion[b],
                      {found[b].force - now_[b].force, found[b].torque - now_[b].torque});
    now_[b] = found[b], motion_[b] = motion[b];
  }
}

void LoadedBodies::extrapolate(const std::vector<BodyMotion>& motion) {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    now_[b] += slope_[b].change(motion_[b], motion[b]), motion_[b] = motion[b];
}

void LoadedBodies::give(ContactWrenches& step) const {
  step.stiffness.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    step.wrench[b].force = mean_[b].force + (now_[b].force - predicted_[b].force);
    step.wrench[b].torque = mean_[b].torque + (now_[b].torque - predicted_[b].torque);
    if (bodies_[b].stiffness > 0) step.stiffness.push_back({as_index(b), slope_[b].packed(), {}});
  }
}

void LoadedBodies::watch(const std::vector<std::int64_t>& contacts, Real h) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Real phase = bodies_[b].phase(contacts[b], h);
    if (phase > worst_.phase) worst_ = {b, contacts[b], phase, h};
  }
}

std::string LoadedBodies::warning() const {
  if (!(worst_.phase > kMostLoadedPhase)) return "";
  const Real step = worst_.step * kMostLoadedPhase / worst_.phase;
  return fmt::format(
      "body \"{}\" had {} simultaneous contacts with particles, on which it oscillates by {:.3g} rad per "
      "step of {:.3g} s, too fast for this step; set time.step to at most {:.2g} s{}",
      model_.bodies[worst_.body].name, worst_.contacts, worst_.phase, worst_.step, Real(0.95) * step,
      model_.integrator.substeps > 1 ? " with integrator.substeps = 1" : "");
}

}  // namespace scree
