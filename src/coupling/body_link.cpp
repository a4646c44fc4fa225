#include "coupling/body_link.hpp"

#include <algorithm>
#include <span>

#include "dem/surfaces.hpp"

namespace scree {

BodyLink::BodyLink(const Model& model, const Ranks& ranks) : ranks_(ranks), bodies_(model.bodies.size()) {
  const std::size_t carriers = SurfaceSet(model).carriers();
  motion_.resize(carriers), end_wrench_.resize(carriers), step_wrench_.wrench.resize(carriers);
  for (std::size_t c = bodies_; c < carriers; ++c) motion_[c].kind = BodyKind::spatial;
  if (bodies_ > 0) ranks_.on_root([&] { multibody_ = std::make_unique<Multibody>(model); });
}

std::vector<BodyWrench> BodyLink::wrench_of_bodies() const {
  return {end_wrench_.begin(), end_wrench_.begin() + static_cast<std::ptrdiff_t>(bodies_)};
}

void BodyLink::set_initial_state(MultibodyState& bodies, const std::vector<BodyWrench>& wrench) {
  if (has_bodies()) ranks_.on_root([&] { bodies = multibody_->initial_state(wrench); });
}

void BodyLink::solve_acceleration(MultibodyState& bodies, Real t) {
  bodies.wrench = wrench_of_bodies();
  if (has_bodies()) ranks_.on_root([&] { multibody_->solve_acceleration(bodies, t, bodies.wrench); });
}

void BodyLink::predict(const MultibodyState& bodies, Real t, Real h) {
  if (multibody_) multibody_->predict(bodies, t, h);
}

IterationNorms BodyLink::correct() {
  IterationNorms norms;
  if (!has_bodies()) return norms;
  ranks_.on_root([&] { norms = multibody_->correct(step_wrench_); });
  ranks_.broadcast(norms);
  return norms;
}

Real BodyLink::error() const {
  Real error = multibody_ ? multibody_->error() : 0;
  if (has_bodies()) ranks_.broadcast(error);
  return error;
}

void BodyLink::accept(MultibodyState& bodies) {
  const std::vector<BodyWrench> wrench = wrench_of_bodies();
  if (has_bodies()) ranks_.on_root([&] { multibody_->accept(bodies, wrench); });
  bodies.wrench = wrench;
}

void BodyLink::check_reactions() {
  if (has_bodies()) ranks_.on_root([&] { multibody_->check_reactions(); });
}

std::string BodyLink::trouble() {
  std::string text;
  if (!has_bodies()) return text;
  ranks_.on_root([&] { text = multibody_->trouble(); });
  std::size_t length = text.size();
  ranks_.broadcast(length);
  text.resize(length);
  ranks_.broadcast(std::span<char>(text));
  return text;
}

void BodyLink::broadcast(RankList& list) {
  if (has_bodies()) ranks_.broadcast(std::span<BodyMotion>(motion_).first(bodies_));
  list.place_bodies(motion_);
}

void BodyLink::place(const std::vector<BodyMotion>& bodies) {
  std::copy(bodies.begin(), bodies.end(), motion_.begin());
}

void BodyLink::broadcast_motion(RankList& list) {
  if (!has_carriers()) return;
  if (multibody_) place(multibody_->motion());
  broadcast(list);
}

void BodyLink::broadcast_motion(RankList& list, const MultibodyState& state, Real tau) {
  if (!has_carriers()) return;
  if (multibody_) {
    multibody_->motion(state, tau, of_bodies_);
    place(of_bodies_);
  }
  broadcast(list);
}

void BodyLink::reduce_wrench(ImplicitStep& step) {
  if (has_carriers()) step.reduce_wrench(step_wrench_, end_wrench_);
}

void BodyLink::reduce_end_wrench(ExplicitRun& run) {
  if (has_carriers()) run.reduce_wrench(end_wrench_);
}

void BodyLink::reduce_end_wrench(RankParticles& particles) {
  if (has_carriers()) particles.reduce_wrench(end_wrench_);
}

void BodyLink::set_mean_wrench(const std::vector<BodyWrench>& start, const std::vector<BodyWrench>& sum,
                               int substeps) {
  step_wrench_.stiffness.clear();
  for (std::size_t b = 0; b < start.size(); ++b) {
    step_wrench_.wrench[b].force = (Real(2) / substeps) * sum[b].force - start[b].force;
    step_wrench_.wrench[b].torque = (Real(2) / substeps) * sum[b].torque - start[b].torque;
  }
}

}  // namespace scree
