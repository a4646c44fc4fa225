// Walls that are placed, as they are carried: where they are and how they move at any instant, whatever
// touches them, and what contacts do to them on the way.
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

  std::size_t size() const { return walls_.size(); }  // walls that are placed, in their order
  bool move() const { return move_; }                 // one of them at least
  bool run() const { return run_; }                   // a surface along itself
  // Of carriers whose frames are the global one at t = 0: spatial motions about their origins. out: size().
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

// Of wrenches that act at the start and the end of a step of length h [s], the latter as the step was solved
// with, on what is carried so, and on its surface [J].
Real work_between(const BodyMotion& start, const BodyWrench& start_wrench, const BodyMotion& end,
                  const BodyWrench& wrench, Real h);

}  // namespace scree
