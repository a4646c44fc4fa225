#include "coupling/body_link.hpp"

#include <span>

namespace scree {

BodyLink::BodyLink(const Model& model, const Ranks& ranks)
    : ranks_(ranks),
      motion_(model.bodies.size()),
      step_wrench_{std::vector<BodyWrench>(model.bodies.size()), {}},
      end_wrench_(model.bodies.size()) {
  if (model.bodies.empty()) return;
  ranks_.on_root([&] { multibody_ = std::make_unique<Multibody>(model); });
}

void BodyLink::set_initial_state(MultibodyState& bodies, const std::vector<BodyWrench>& wrench) {
  if (has_bodies()) ranks_.on_root([&] { bodies = multibody_->initial_state(wrench); });
}

void BodyLink::solve_acceleration(MultibodyState& bodies, Real t) {
  if (has_bodies()) ranks_.on_root([&] { multibody_->solve_acceleration(bodies, t, end_wrench_); });
  bodies.wrench = end_wrench_;
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
  if (has_bodies()) ranks_.on_root([&] { multibody_->accept(bodies, end_wrench_); });
  bodies.wrench = end_wrench_;
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
  ranks_.broadcast(std::span<BodyMotion>(motion_));
  list.place_bodies(motion_);
}

void BodyLink::broadcast_motion(RankList& list) {
  if (!has_bodies()) return;
  if (multibody_) motion_ = multibody_->motion();
  broadcast(list);
}

void BodyLink::broadcast_motion(RankList& list, const MultibodyState& state, Real tau) {
  if (!has_bodies()) return;
  if (multibody_) multibody_->motion(state, tau, motion_);
  broadcast(list);
}

void BodyLink::reduce_wrench(ImplicitStep& step) {
  if (has_bodies()) step.reduce_wrench(step_wrench_, end_wrench_);
}

void BodyLink::reduce_end_wrench(ExplicitRun& run) {
  if (has_bodies()) run.reduce_wrench(end_wrench_);
}

void BodyLink::reduce_end_wrench(RankParticles& particles) {
  if (has_bodies()) particles.reduce_wrench(end_wrench_);
}

void BodyLink::set_mean_wrench(const std::vector<BodyWrench>& start, const std::vector<BodyWrench>& sum,
                               int substeps) {
  step_wrench_.stiffness.clear();
  for (std::size_t b = 0; b < sum.size(); ++b) {
    step_wrench_.wrench[b].force = (Real(2) / substeps) * sum[b].force - start[b].force;
    step_wrench_.wrench[b].torque = (Real(2) / substeps) * sum[b].torque - start[b].torque;
  }
}

}  // namespace scree
