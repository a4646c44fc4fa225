#include "mbs/joint_force.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mbs/joint_coordinate.hpp"

namespace scree {

namespace {

// A coordinate carries round-off of 1e-16 of its size, and so does the effort; this fraction of the elastic
// scale stays far above it.
constexpr Real kRoundingFraction = 1e-6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

JointForce::JointForce(std::string name, std::unique_ptr<Constraint> coordinate,
                       std::unique_ptr<JointLaw> law)
    : name_(std::move(name)), coordinate_(std::move(coordinate)), law_(std::move(law)) {}

Real JointForce::load_of(const SystemInstant& at) const {
  if (at.multipliers == nullptr) return last_.load;
  Real square = 0;
  for (const int row : load_rows_) {
    const Real lambda = (*at.multipliers)[scree::at(row)];
    square += lambda * lambda;
  }
  return std::sqrt(square);
}

void JointForce::open_step(const BodyPoses& poses, const SystemInstant& at, Real h, Real memory) {
  step_ = {coordinate_at(*coordinate_, poses, at, gradient_), memory, h};
  step_.start.load = last_.load = load_of(at);
  if (h > 0 && law_->needs_second()) step_.start.second = second_rate(*coordinate_, poses, at, gradient_);
  start_effort_ = law_->effort(step_.start, memory).effort;
  in_step_ = h > 0;
  bridge_ = {};
}

Real JointForce::add_force(const BodyPoses& poses, const SystemInstant& at, Real length,
                           std::vector<Real>& force) {
  const Real load = load_of(at);
  last_ = coordinate_at(*coordinate_, poses, at, gradient_);
  last_.load = load;
  effort_ = in_step_ ? law_->step_effort(step_, last_) : law_->effort(last_, memory());
  if (in_step_) bridge_.guide(*law_, step_, effort_);
  for (std::size_t i = 0; i < gradient_.size(); ++i)
    force[scree::at(gradient_.column(i))] += effort_.effort * gradient_.value(i);
  const Real rounded = kRoundingFraction * std::abs(effort_.by_value * last_.value);
  return std::max(effort_.size, rounded) * (is_angle() ? 1 : length);
}

// At the first call: finds all coordinates of the gradient and of H.
void JointForce::find_coordinates() {
  for (std::size_t i = 0; i < gradient_.size(); ++i) coordinates_.push_back(gradient_.column(i));
  for (std::size_t i = 0; i < hessian_.size(); ++i) coordinates_.push_back(hessian_.column(i));
  std::sort(coordinates_.begin(), coordinates_.end());
  coordinates_.erase(std::unique(coordinates_.begin(), coordinates_.end()), coordinates_.end());
  in_gradient_ = local_indices(gradient_), in_hessian_ = local_indices(hessian_);
  for (RotationColumns& turn : rotations_) {
    const auto found = std::find(coordinates_.begin(), coordinates_.end(), turn.first);
    turn.is_read = found != coordinates_.end();
    turn.at = scree::at(static_cast<int>(found - coordinates_.begin()));
  }
}

std::vector<std::size_t> JointForce::local_indices(const SparseTerm& term) const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < term.size(); ++i)
    indices.push_back(scree::at(static_cast<int>(
        std::lower_bound(coordinates_.begin(), coordinates_.end(), term.column(i)) - coordinates_.begin())));
  return indices;
}

// A rotation in space has all three of its columns among the coordinates, or none.
void JointForce::pull_back(const BodyPoses& poses) {
  displaced_ = along_;
  for (const RotationColumns& turn : rotations_) {
    if (!turn.is_read) continue;
    const std::size_t k = turn.at;
    const Vec3 g =
        transposed_times(poses.spatial[turn.body].inverse_tangent, {along_[k], along_[k + 1], along_[k + 2]});
    displaced_[k] = g.x, displaced_[k + 1] = g.y, displaced_[k + 2] = g.z;
  }
}

void JointForce::add_derivatives(const BodyPoses& poses, const SystemInstant& at,
                                 SystemDerivatives& derivatives) {
  SparseTerm &stiffness = derivatives.stiffness, &damping = derivatives.damping;
  const Real one = 1;
  bridge_.take();
  hessian_.begin();
  coordinate_->hessian(poses, &one, hessian_);
  if (coordinates_.empty()) find_coordinates();
  along_.assign(coordinates_.size(), 0), rotation_rate_.assign(coordinates_.size(), 0);
  for (std::size_t i = 0; i < gradient_.size(); ++i) along_[in_gradient_[i]] += gradient_.value(i);
  for (std::size_t i = 0; i < hessian_.size(); ++i) {
    rotation_rate_[in_hessian_[i]] += hessian_.value(i) * at.velocity[scree::at(hessian_.row(i))];
    stiffness.add(hessian_.row(i), hessian_.column(i), -effort_.effort * hessian_.value(i));
  }
  pull_back(poses);
  stiffness.add_block(coordinates_, [&](std::size_t i, std::size_t j) {
    return -along_[i] * (effort_.by_value * along_[j] + effort_.by_rate * rotation_rate_[j]);
  });
  damping.add_block(coordinates_, [&](std::size_t i, std::size_t j) {
    return -effort_.by_rate * along_[i] * displaced_[j];
  });
  // |lambda| has no gradient at F = 0; 0 is one of its subgradients there.
  const Real inverse = last_.load > 0 ? 1 / last_.load : 0;
  for (const int row : load_rows_) {
    const Real part = -effort_.by_load * inverse * (*at.multipliers)[scree::at(row)];
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      derivatives.reaction.add(row, coordinates_[i], part * along_[i]);
  }
}

JointWork JointForce::work() const {
  const Real done = (start_effort_ + effort_.effort) / 2 * (last_.value - step_.start.value);
  if (law_->drives()) return {0, done};
  const Real stored = law_->energy(last_.value, memory()) - law_->energy(step_.start.value, step_.memory);
  return {-done - stored, 0};
}

Real JointForce::elastic_energy(const BodyPoses& poses, Real t, Real memory) const {
  Real c = 0;
  coordinate_->value(poses, t, &c);
  return law_->energy(c, memory);
}

void JointForce::add_reaction(const BodyPoses& poses, Real effort, Vec3& force, Vec3& torque) const {
  const Real multiplier = -effort;
  coordinate_->add_reaction(poses, &multiplier, force, torque);
}

JointForce::Sample JointForce::sample(const BodyPoses& poses, const SystemInstant& at, Real memory) const {
  SparseTerm gradient;
  CoordinateInstant instant = coordinate_at(*coordinate_, poses, at, gradient);
  instant.load = load_of(at);
  if (at.acceleration != nullptr) instant.second = second_rate(*coordinate_, poses, at, gradient);
  return {instant, law_->effort(instant, memory).effort};
}

}  // namespace scree
