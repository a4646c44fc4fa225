#include "coupling/body_link.hpp"

#include <algorithm>
#include <span>

#include "base/error.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {

BodyLink::BodyLink(const Model& model, const Ranks& ranks)
    : ranks_(ranks), bodies_(model.bodies.size()), walls_(model), loaded_(model) {
  const std::size_t carriers = SurfaceSet(model).carriers();
  motion_.resize(carriers), end_wrench_.resize(carriers), step_wrench_.wrench.resize(carriers);
  walls_before_.resize(walls_.size()), walls_after_.resize(walls_.size());
  walls_.at(0, std::span(motion_).subspan(bodies_));
  if (bodies_ > 0) ranks_.on_root([&] { multibody_ = std::make_unique<Multibody>(model); });
}

std::vector<BodyWrench> BodyLink::wrench_of_bodies() const {
  return {end_wrench_.begin(), end_wrench_.begin() + static_cast<std::ptrdiff_t>(bodies_)};
}

void BodyLink::set_initial_state(MultibodyState& bodies, const std::vector<BodyWrench>& wrench) {
  if (has_bodies()) ranks_.on_root([&] { bodies = multibody_->initial_state(wrench); });
}

std::vector<std::string> BodyLink::start_warnings() {
  std::vector<std::string> warnings;
  if (bodies_ > 0) ranks_.on_root([&] { warnings = multibody_->start_warnings(); });
  return warnings;
}

void BodyLink::solve_acceleration(MultibodyState& bodies, Real t) {
  const std::vector<BodyWrench> wrench = wrench_of_bodies();
  if (has_bodies()) ranks_.on_root([&] { multibody_->solve_acceleration(bodies, t, wrench); });
  take_wrench(bodies);
}

void BodyLink::take_wrench(MultibodyState& state) const {
  state.wrench = has_driven_walls() ? end_wrench_ : wrench_of_bodies();
  state.slide_power.clear();
  if (!walls_.run()) return;
  for (std::size_t c = bodies_; c < end_wrench_.size(); ++c)
    state.slide_power.push_back(end_wrench_[c].slide_power);
}

void BodyLink::predict(const MultibodyState& bodies, Real t, Real h, Real end) {
  end_ = end;
  if (multibody_) multibody_->predict(bodies, t, h);
}

IterationNorms BodyLink::correct() {
  IterationNorms norms;
  if (!has_bodies()) return norms;
  ranks_.on_root([&] {
    try {
      norms = multibody_->correct(step_wrench_);
    } catch (const SimulationError& error) {
      const std::string dead_point = multibody_->dead_point();
      if (dead_point.empty()) throw;
      throw SimulationError(std::string(error.what()) + "; " + dead_point);
    }
  });
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
  take_wrench(bodies);
}

void BodyLink::book_walls(MultibodyState& bodies, Real t, Real end, const std::vector<BodyWrench>& wrench) {
  if (!has_driven_walls() || !ranks_.is_root()) return;
  walls_.at(t, walls_before_), walls_.at(end, walls_after_);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    BodyWrench& start = bodies.wrench[bodies_ + w];
    if (walls_.run())
      start.slide_power = bodies.slide_power[w], bodies.slide_power[w] = end_wrench_[bodies_ + w].slide_power;
    bodies.driver_work -=
        work_between(walls_before_[w], start, walls_after_[w], wrench[bodies_ + w], end - t);
    start = end_wrench_[bodies_ + w];
  }
}

void BodyLink::check_reactions() {
  if (has_bodies()) ranks_.on_root([&] { multibody_->check_reactions(); });
}

std::string BodyLink::trouble() {
  return of_root([&] { return multibody_->trouble(); });
}

std::string BodyLink::dead_point() {
  return of_root([&] { return multibody_->dead_point(); });
}

std::string BodyLink::of_root(const std::function<std::string()>& tell) {
  std::string text;
  if (!has_bodies()) return text;
  ranks_.on_root([&] { text = tell(); });
  std::size_t length = text.size();
  ranks_.broadcast(length);
  text.resize(length);
  ranks_.broadcast(std::span<char>(text));
  return text;
}

// Rank 0 also computes the motion of walls: on other machines sine and cosine may differ in the last bits.
void BodyLink::broadcast(RankList& list, Real t) {
  const std::span<BodyMotion> motion(motion_);
  if (walls_.move()) walls_.at(t, motion.subspan(bodies_));
  if (carriers_move()) ranks_.broadcast(walls_.move() ? motion : motion.first(bodies_));
  list.place_bodies(motion_);
}

void BodyLink::place(const std::vector<BodyMotion>& bodies) {
  std::copy(bodies.begin(), bodies.end(), motion_.begin());
}

void BodyLink::broadcast_motion(RankList& list) {
  if (!has_carriers()) return;
  if (multibody_) place(multibody_->motion());
  broadcast(list, end_);
}

void BodyLink::broadcast_motion(RankList& list, const MultibodyState& state, Real tau, Real t) {
  if (!has_carriers()) return;
  if (multibody_) {
    multibody_->motion(state, tau, of_bodies_);
    place(of_bodies_);
  }
  broadcast(list, t);
}

void BodyLink::reduce_wrench(ImplicitStep& step) {
  if (has_carriers()) step.reduce_wrench(step_wrench_, end_wrench_);
}

void BodyLink::reduce_end_wrench(ExplicitRun& run) {
  if (has_carriers()) run.reduce_wrench(end_wrench_, contacts_);
}

void BodyLink::reduce_end_wrench(RankParticles& particles) {
  if (has_carriers()) particles.reduce_wrench(end_wrench_);
}

bool BodyLink::is_loaded(Real h) {
  if (!has_bodies() || !loaded_.can_be()) return false;
  bool loaded = ranks_.is_root() && loaded_.are_loaded(contacts_, h);
  ranks_.broadcast(loaded);
  return loaded;
}

void BodyLink::open_loaded(Real h) {
  if (!multibody_) return;
  loaded_.open(contacts_, h, multibody_->motion(), step_wrench_.wrench, end_wrench_);
  loaded_.give(step_wrench_);
}

void BodyLink::follow_load(bool found) {
  if (!multibody_) return;
  if (found)
    loaded_.follow(multibody_->motion(), end_wrench_);
  else
    loaded_.extrapolate(multibody_->motion());
  loaded_.give(step_wrench_);
}

void BodyLink::average_accelerations(MultibodyState& bodies) {
  if (multibody_) multibody_->average_accelerations(bodies, loaded_.averaged_share());
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
