// Prescribed motion of the placed walls: poses and velocities at any instant, and the work on the contacts of
// walls over a step.
#pragma once

#include <span>
#include <vector>

#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

class WallMotions {
 public:
  explicit WallMotions(const Model& model);

  std::size_t size() const { return walls_.size(); }  // number of placed walls, in the model's order
  bool move() const { return move_; }                 // at least one of them moves
  bool run() const { return run_; }                   // at least one surface is a conveyor
  // Motions of the walls' parents at time t [s]: spatial motions about their origins; the frames coincide
  // with the global one at t = 0. out: has size() entries.
  void at(Real t, std::span<BodyMotion> out) const;

 private:
  struct Part {
    WallMotion of;
    ScalarFunction coordinate;
  };
  static void add(const Part& part, Real t, BodyMotion& motion);

  std::vector<std::vector<Part>> walls_;
  bool move_ = false, run_ = false;
};

// Work of contact wrenches on a moving parent, and on the conveyor motion of its surface, over a step of
// length h [s], by the trapezoidal rule [J]. wrench: at the end, as the step was solved with.
Real work_between(const BodyMotion& start, const BodyWrench& start_wrench, const BodyMotion& end,
                  const BodyWrench& wrench, Real h);

}  // namespace scree
