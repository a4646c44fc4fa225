// Rank 0's multibody subsystem as every rank sees it: motion comes down, wrenches go up.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/loaded_bodies.hpp"
#include "coupling/wall_motion.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

class BodyLink {
 public:
  // The Multibody object is made on rank 0 alone, and only if the model has bodies. What rank 0 throws, here
  // and below, every rank throws.
  explicit BodyLink(const Model& model, const Ranks& ranks = {});

  bool has_bodies() const { return bodies_ > 0; }
  // Whether there are surfaces that are placed: on bodies, or walls that are no planes at rest.
  bool has_carriers() const { return !motion_.empty(); }
  // Whether they move, or do work.
  bool has_driven_walls() const { return walls_.move() || walls_.run(); }
  bool carriers_move() const { return has_bodies() || walls_.move(); }
  Multibody* multibody() { return multibody_.get(); }  // null on ranks other than 0
  const Multibody* multibody() const { return multibody_.get(); }
  const Ranks& ranks() const { return ranks_; }

  // The functions of Multibody on rank 0; collective, and nothing without bodies.
  void set_initial_state(MultibodyState& bodies, const std::vector<BodyWrench>& wrench);
  std::vector<std::string> start_warnings();                // on rank 0 alone
  void solve_acceleration(MultibodyState& bodies, Real t);  // with end_wrench()
  // end: of the step, t + h but for round-off [s].
  void predict(const MultibodyState& bodies, Real t, Real h, Real end);
  IterationNorms correct();             // with the step's wrench; the norms on every rank
  Real error() const;                   // on every rank
  void accept(MultibodyState& bodies);  // with end_wrench()
  // Books what walls do to particles over a step, or a substep, from t to `end`. wrench: of the contacts, as
  // the step was solved with; at its start that of `bodies`, which gets end_wrench() of the walls.
  void book_walls(MultibodyState& bodies, Real t, Real end, const std::vector<BodyWrench>& wrench);
  const std::vector<BodyWrench>& step_wrench() const { return step_wrench_.wrench; }
  void check_reactions();
  // On every rank.
  std::string trouble();
  std::string dead_point();

  // Rank 0 -> all: motion at the current iterate of the open step, handed to the placed surfaces on the list.
  void broadcast_motion(RankList& list);
  // The same for an instant tau [s] after `state`, along rank 0's prediction; of walls at the instant t [s].
  void broadcast_motion(RankList& list, const MultibodyState& state, Real tau, Real t);
  // All -> rank 0: contact wrench and contact stiffness per body. The wrenches are rank 0's; zero elsewhere.
  void reduce_wrench(ImplicitStep& step);
  void reduce_end_wrench(ExplicitRun& run);          // end_wrench() alone
  void reduce_end_wrench(RankParticles& particles);  // the same at the start
  // Replaces the step's wrench by the one whose trapezoidal impulse over `substeps` equal parts is their sum:
  // twice the mean force less the force at the start. sum: of the forces at the parts' ends, the outer two
  // halved.
  void set_mean_wrench(const std::vector<BodyWrench>& start, const std::vector<BodyWrench>& sum,
                       int substeps);
  // Whether the contacts of the last reduce_end_wrench(run) are stiff for a step of length h [s] of the
  // bodies (LoadedBodies). Collective.
  bool is_loaded(Real h);
  // The calls of a step of loaded bodies, in this order. open_loaded() follows predict(). follow_load()
  // follows each correct(): with `found` reduce_end_wrench(run) has the contacts at the corrected position,
  // else their slopes predict the wrenches. average_accelerations() follows accept().
  void open_loaded(Real h);
  void follow_load(bool found);
  void average_accelerations(MultibodyState& bodies);
  std::string load_warning() const { return loaded_.warning(); }  // of rank 0

  // Of the bodies, then of the placed walls.
  void take_wrench(MultibodyState& state) const;  // end_wrench()
  const std::vector<BodyWrench>& end_wrench() const { return end_wrench_; }
  std::vector<BodyWrench> wrench_of_bodies() const;
  const std::vector<BodyMotion>& motion() const { return motion_; }

 private:
  std::string of_root(const std::function<std::string()>& tell);
  void broadcast(RankList& list, Real t);
  void place(const std::vector<BodyMotion>& bodies);

  Ranks ranks_;
  std::size_t bodies_;
  WallMotions walls_;
  Real end_ = 0;  // of the open step [s]
  std::unique_ptr<Multibody> multibody_;
  std::vector<BodyMotion> motion_;                                  // of the bodies, then of the placed walls
  std::vector<BodyMotion> of_bodies_, walls_before_, walls_after_;  // scratch
  ContactWrenches step_wrench_;
  std::vector<BodyWrench> end_wrench_;
  std::vector<std::int64_t> contacts_;  // of particles, in end_wrench_; of an explicit step
  LoadedBodies loaded_;
};

}  // namespace scree
