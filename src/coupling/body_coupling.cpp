#include "coupling/body_coupling.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "base/error.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {

BodyCoupling::BodyCoupling(const Model& model, const Ranks& ranks)
    : ranks_(ranks), bodies_(model.bodies.size()), walls_(model), loaded_(model) {
  const std::size_t parents = SurfaceSet(model).parents();
  motion_.resize(parents), end_wrench_.resize(parents), step_wrench_.wrench.resize(parents);
  walls_before_.resize(walls_.size()), walls_after_.resize(walls_.size());
  walls_.at(0, std::span(motion_).subspan(bodies_));
  if (bodies_ > 0) ranks_.on_root([&] { multibody_ = std::make_unique<Multibody>(model); });
}

std::vector<BodyWrench> BodyCoupling::wrench_of_bodies() const {
  return {end_wrench_.begin(), end_wrench_.begin() + static_cast<std::ptrdiff_t>(bodies_)};
}

void BodyCoupling::set_initial_state(MultibodyState& bodies, const std::vector<BodyWrench>& wrench) {
  if (has_bodies()) ranks_.on_root([&] { bodies = multibody_->initial_state(wrench); });
}

std::vector<std::string> BodyCoupling::start_warnings() {
  std::vector<std::string> warnings;
  if (bodies_ > 0) ranks_.on_root([&] { warnings = multibody_->start_warnings(); });
  return warnings;
}

void BodyCoupling::solve_acceleration(MultibodyState& bodies, Real t) {
  const std::vector<BodyWrench> wrench = wrench_of_bodies();
  if (has_bodies()) ranks_.on_root([&] { multibody_->solve_acceleration(bodies, t, wrench); });
  take_wrench(bodies);
}

void BodyCoupling::take_wrench(MultibodyState& state) const {
  const std::size_t count = has_driven_walls() ? end_wrench_.size() : bodies_;
  state.wrench.assign(end_wrench_.begin(), end_wrench_.begin() + static_cast<std::ptrdiff_t>(count));
  state.belt_power.clear();
  if (!walls_.run()) return;
  for (std::size_t c = bodies_; c < end_wrench_.size(); ++c)
    state.belt_power.push_back(end_wrench_[c].belt_power);
}

void BodyCoupling::predict(const MultibodyState& bodies, Real t, Real h, Real end) {
  end_ = end;
  if (multibody_) multibody_->predict(bodies, t, h);
}

void BodyCoupling::predict_ahead(const MultibodyState& bodies, Real t, Real h, Real end) {
  do_ahead([&] { predict(bodies, t, h, end), multibody_->prepare(); });
}

void BodyCoupling::begin_accept(const MultibodyState& bodies) {
  do_ahead([&] { multibody_->begin_accept(bodies); });
}

IterationNorms BodyCoupling::correct() {
  IterationNorms norms;
  if (has_bodies()) ranks_.on_root([&] { norms = correct_on_root(); }, std::span(&norms, 1));
  return norms;
}

IterationNorms BodyCoupling::correct_on_root() {
  try {
    return multibody_->correct(step_wrench_);
  } catch (const SimulationError& error) {
    const std::string dead_point = multibody_->dead_point();
    if (dead_point.empty()) throw;
    throw SimulationError(std::string(error.what()) + "; " + dead_point);
  }
}

Real BodyCoupling::error() const {
  Real error = multibody_ ? multibody_->error() : 0;
  if (has_bodies()) ranks_.broadcast(error);
  return error;
}

void BodyCoupling::accept(MultibodyState& bodies, bool deferred) {
  const auto close = [&] { multibody_->accept(bodies, wrench_of_bodies()); };
  if (has_bodies()) deferred ? defer(close) : ranks_.on_root(close);
  take_wrench(bodies);
}

void BodyCoupling::throw_deferred() {
  if (!has_bodies()) return;
  ranks_.on_root([&] { throw_of_root(); });
}

void BodyCoupling::account_walls(MultibodyState& bodies, Real t, Real end,
                                 const std::vector<BodyWrench>& wrench) {
  if (!has_driven_walls() || !ranks_.is_root()) return;
  walls_.at(t, walls_before_), walls_.at(end, walls_after_);
  add_work_of_walls(bodies, end - t, wrench);
}

// From walls_before_ to walls_after_, over a step of length h.
void BodyCoupling::add_work_of_walls(MultibodyState& bodies, Real h,
                                     const std::vector<BodyWrench>& wrench) const {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    BodyWrench& start = bodies.wrench[bodies_ + w];
    if (walls_.run())
      start.belt_power = bodies.belt_power[w], bodies.belt_power[w] = end_wrench_[bodies_ + w].belt_power;
    bodies.driver_work -= work_between(walls_before_[w], start, walls_after_[w], wrench[bodies_ + w], h);
    start = end_wrench_[bodies_ + w];
  }
}

std::vector<BodyMotion> BodyCoupling::motion_of_walls(std::span<const Real> instants) {
  std::vector<BodyMotion> motion;
  motion.reserve(instants.size() * motion_.size());
  for (const Real t : instants) {
    if (walls_.move() && ranks_.is_root()) walls_.at(t, motion_);
    motion.insert(motion.end(), motion_.begin(), motion_.end());
  }
  if (walls_.move()) ranks_.broadcast(std::span(motion));
  return motion;
}

void BodyCoupling::account_driven_walls(MultibodyState& bodies, std::span<const Real> instants,
                                        std::span<const BodyMotion> motion,
                                        std::span<const BodyWrench> wrenches) {
  const std::size_t steps = instants.size() - 1;
  walls_.at(instants.front(), walls_after_);
  for (std::size_t k = 0; k < steps; ++k) {
    const auto of_step = motion.subspan(k * walls_.size(), walls_.size());
    const auto loads = wrenches.subspan(k * walls_.size(), walls_.size());
    walls_before_.swap(walls_after_), walls_after_.assign(of_step.begin(), of_step.end());
    end_wrench_.assign(loads.begin(), loads.end());
    if (ranks_.is_root()) add_work_of_walls(bodies, instants[k + 1] - instants[k], end_wrench_);
  }
  motion_ = walls_after_;
  take_wrench(bodies);
}

void BodyCoupling::check_reactions() {
  if (has_bodies()) ranks_.on_root([&] { multibody_->check_reactions(); });
}

std::string BodyCoupling::trouble() {
  return of_root([&] { return multibody_->trouble(); });
}

std::string BodyCoupling::dead_point() {
  return of_root([&] { return multibody_->dead_point(); });
}

std::string BodyCoupling::of_root(const std::function<std::string()>& tell) {
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
// set_bodies: sets the motion of the bodies, on rank 0; values: broadcast with the motion.
template <class Action, class... Values>
void BodyCoupling::broadcast(RankList& list, Real t, const Action& set_bodies, Values... values) {
  const std::span<BodyMotion> motion(motion_);
  const auto set = [&] {
    throw_of_root();
    if (multibody_) set_bodies();
    if (walls_.move()) walls_.at(t, motion.subspan(bodies_));
  };
  if (parents_move()) ranks_.on_root(set, walls_.move() ? motion : motion.first(bodies_), values...);
  list.set_body_motion(motion_);
}

void BodyCoupling::set_poses(const std::vector<BodyMotion>& bodies) {
  std::copy(bodies.begin(), bodies.end(), motion_.begin());
}

void BodyCoupling::broadcast_motion(RankList& list) {
  if (has_parents()) broadcast(list, end_, [&] { set_poses(multibody_->motion()); });
}

void BodyCoupling::broadcast_motion(RankList& list, BodyIterations& iterations) {
  broadcast(
      list, end_, [&] { set_poses(multibody_->motion()); }, std::span(&iterations, 1));
}

void BodyCoupling::broadcast_motion(RankList& list, const MultibodyState& state, Real tau, Real t) {
  if (!has_parents()) return;
  broadcast(list, t, [&] {
    multibody_->motion(state, tau, of_bodies_);
    set_poses(of_bodies_);
  });
}

void BodyCoupling::reduce_wrench(ImplicitStep& step) {
  if (has_parents()) step.reduce_wrench(step_wrench_, end_wrench_);
}

void BodyCoupling::reduce_end_wrench(ExplicitRun& run) {
  if (has_parents()) run.reduce_wrench(end_wrench_, contacts_);
}

void BodyCoupling::reduce_end_wrench(RankParticles& particles) {
  if (has_parents()) particles.reduce_wrench(end_wrench_);
}

bool BodyCoupling::is_loaded(Real h) {
  if (!has_bodies() || !loaded_.can_be()) return false;
  bool loaded = is_loaded_on_root(h);
  ranks_.broadcast(loaded);
  return loaded;
}

bool BodyCoupling::is_loaded_on_root(Real h) const {
  return ranks_.is_root() && has_bodies() && loaded_.can_be() && loaded_.are_loaded(contacts_, h);
}

void BodyCoupling::open_loaded(Real h) {
  if (!multibody_) return;
  loaded_.open(contacts_, h, multibody_->motion(), step_wrench_.wrench, end_wrench_);
  loaded_.give(step_wrench_);
}

void BodyCoupling::follow_load(bool found) {
  if (!multibody_) return;
  if (found)
    loaded_.follow(multibody_->motion(), end_wrench_);
  else
    loaded_.extrapolate(multibody_->motion());
  loaded_.give(step_wrench_);
}

void BodyCoupling::average_accelerations(MultibodyState& bodies) {
  if (multibody_) multibody_->average_accelerations(bodies, loaded_.averaging_weight());
}

void BodyCoupling::set_mean_wrench(const std::vector<BodyWrench>& start, const std::vector<BodyWrench>& sum,
                                   int substeps) {
  step_wrench_.stiffness.clear();
  for (std::size_t b = 0; b < start.size(); ++b) {
    step_wrench_.wrench[b].force = (Real(2) / substeps) * sum[b].force - start[b].force;
    step_wrench_.wrench[b].torque = (Real(2) / substeps) * sum[b].torque - start[b].torque;
  }
}

}  // namespace scree
