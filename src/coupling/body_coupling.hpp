// Connects the ranks with rank 0's multibody subsystem: motion is broadcast, wrenches are reduced.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/loaded_bodies.hpp"
#include "coupling/wall_motion.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Newton iterations of the bodies in an explicit step, which rank 0 alone takes: what the other ranks know.
struct BodyIterations {
  bool loaded = false;  // the wrenches follow the correction (LoadedBodies)
  bool last = false;    // the contacts at the present motion end the step
  int count = 0;
};

class BodyCoupling {
 public:
  // Rank 0 creates the Multibody object, if the model has bodies. Exceptions of rank 0 are thrown on every
  // rank, here and below.
  explicit BodyCoupling(const Model& model, const Ranks& ranks = {});

  bool has_bodies() const { return bodies_ > 0; }
  // Whether there are surfaces with a pose of their own: on bodies, or walls other than static planes.
  bool has_parents() const { return !motion_.empty(); }
  // Whether walls move, or do work as conveyors.
  bool has_driven_walls() const { return walls_.move() || walls_.run(); }
  bool parents_move() const { return has_bodies() || walls_.move(); }
  Multibody* multibody() { return multibody_.get(); }  // null on ranks other than 0
  const Multibody* multibody() const { return multibody_.get(); }
  const Ranks& ranks() const { return ranks_; }

  // The functions of Multibody, executed on rank 0; collective, and without effect in a model without bodies.
  void set_initial_state(MultibodyState& bodies, const std::vector<BodyWrench>& wrench);
  std::vector<std::string> start_warnings();                // result on rank 0 alone
  void solve_acceleration(MultibodyState& bodies, Real t);  // uses end_wrench()
  // end: end of the step, t + h up to round-off [s].
  void predict(const MultibodyState& bodies, Real t, Real h, Real end);
  // On rank 0, in explicit steps: predict(), and Multibody::prepare(); Multibody::begin_accept(). They read
  // no wrenches, and their exceptions are thrown later, with one rank too, as by defer().
  void predict_ahead(const MultibodyState& bodies, Real t, Real h, Real end);
  void begin_accept(const MultibodyState& bodies);
  IterationNorms correct();          // uses the step's wrench; returns the norms on every rank
  IterationNorms correct_on_root();  // the same on rank 0 alone
  Real error() const;                // on every rank
  // Uses end_wrench(). deferred: in explicit steps, an exception is thrown later, as by defer().
  void accept(MultibodyState& bodies, bool deferred = false);
  // Adds the work of walls on particles over a step or substep from t to `end` [s]. wrench: the contact
  // wrenches that the step was solved with; those at its start are in `bodies`, where end_wrench() of the
  // walls replaces them.
  void account_walls(MultibodyState& bodies, Real t, Real end, const std::vector<BodyWrench>& wrench);
  const std::vector<BodyWrench>& step_wrench() const { return step_wrench_.wrench; }
  // In a model without bodies. Rank 0 -> all: motion of the walls at each of these instants [s],
  // [instant][wall].
  std::vector<BodyMotion> motion_of_walls(std::span<const Real> instants);
  // Adds their work over steps between successive instants [s]. motion, wrenches: at the end of each step,
  // [step][wall]; motion() and end_wrench() are then those of the last step.
  void account_driven_walls(MultibodyState& bodies, std::span<const Real> instants,
                            std::span<const BodyMotion> motion, std::span<const BodyWrench> wrenches);
  void check_reactions();
  std::string trouble_on_root() const { return multibody_->trouble(); }
  // On every rank.
  std::string trouble();
  std::string dead_point();

  // Explicit steps: runs an action on rank 0 without telling the others. Its exceptions are thrown on every
  // rank by the next broadcast_motion() or throw_deferred(), and actions before that are left out. In this
  // way an explicit step of several ranks needs one broadcast per evaluation of the contacts.
  template <class Action>
  void defer(const Action& action) {
    if (ranks_.alone()) return throw_of_root(), action();
    do_ahead(action);
  }
  void throw_deferred();  // collective

  // Rank 0 -> all: motion at the current iterate of the open step; sets the surface poses of the list.
  void broadcast_motion(RankList& list);
  // Also sets `iterations` to those of rank 0, in the same message.
  void broadcast_motion(RankList& list, BodyIterations& iterations);
  // Rank 0 -> all: motion tau [s] after `state` by rank 0's prediction, and that of walls at time t [s]; sets
  // the surface poses of the list.
  void broadcast_motion(RankList& list, const MultibodyState& state, Real tau, Real t);
  // All -> rank 0: contact wrench and contact stiffness per body. Zero on other ranks.
  void reduce_wrench(ImplicitStep& step);
  void reduce_end_wrench(ExplicitRun& run);          // All -> rank 0: end_wrench() alone
  void reduce_end_wrench(RankParticles& particles);  // All -> rank 0: end_wrench() at the start of a run
  // Replaces the step's wrench by the one whose trapezoidal impulse equals the sum of the impulses over
  // `substeps` equal substeps: twice the mean force less the force at the start. sum: of the forces at the
  // ends of the substeps, with half the weight for the first and the last.
  void set_mean_wrench(const std::vector<BodyWrench>& start, const std::vector<BodyWrench>& sum,
                       int substeps);
  // Whether the contacts found by the last reduce_end_wrench(run) are stiff for a step of the bodies of
  // length h [s] (LoadedBodies). Collective; the second one is false on ranks other than 0.
  bool is_loaded(Real h);
  bool is_loaded_on_root(Real h) const;
  // The calls of a step of loaded bodies, in this order. open_loaded() follows predict(). follow_load()
  // follows each correct(): with `found`, reduce_end_wrench(run) has evaluated the contacts at the corrected
  // position; otherwise the wrenches are extrapolated by their slopes. average_accelerations() follows
  // accept().
  void open_loaded(Real h);
  void follow_load(bool found);
  void average_accelerations(MultibodyState& bodies);
  std::string load_warning() const { return loaded_.warning(); }  // on rank 0

  // Entries for the bodies, then for the placed walls.
  void take_wrench(MultibodyState& state) const;  // takes over end_wrench()
  const std::vector<BodyWrench>& end_wrench() const { return end_wrench_; }
  std::vector<BodyWrench> wrench_of_bodies() const;
  const std::vector<BodyMotion>& motion() const { return motion_; }

 private:
  template <class Action>
  void do_ahead(const Action& action) {
    if (!ranks_.is_root() || deferred_) return;
    try {
      action();
    } catch (...) {
      deferred_ = std::current_exception();
    }
  }
  void throw_of_root() {
    if (deferred_) std::rethrow_exception(std::exchange(deferred_, nullptr));
  }
  std::string of_root(const std::function<std::string()>& tell);
  template <class Action, class... Values>
  void broadcast(RankList& list, Real t, const Action& set_bodies, Values... values);
  void add_work_of_walls(MultibodyState& bodies, Real h, const std::vector<BodyWrench>& wrench) const;
  void set_poses(const std::vector<BodyMotion>& bodies);

  Ranks ranks_;
  std::size_t bodies_;
  WallMotions walls_;
  Real end_ = 0;                 // end of the open step [s], on rank 0
  std::exception_ptr deferred_;  // exception of rank 0 that the other ranks do not know yet
  std::unique_ptr<Multibody> multibody_;
  std::vector<BodyMotion> motion_;                                  // of the bodies, then of the placed walls
  std::vector<BodyMotion> of_bodies_, walls_before_, walls_after_;  // scratch
  ContactWrenches step_wrench_;
  std::vector<BodyWrench> end_wrench_;
  std::vector<std::int64_t> contacts_;  // number of particle contacts in end_wrench(), of an explicit step
  LoadedBodies loaded_;
};

}  // namespace scree
