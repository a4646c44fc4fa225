// A TimeFunction of the model, ready to be evaluated.
#pragma once

#include <string>
#include <vector>

#include "model/data/joint_forces.hpp"
#include "physics/time_function.hpp"

namespace scree {

// How far a function leaves what its points say.
struct Overshoot {
  std::size_t segment = 0;  // between points `segment` and the next
  Real t = 0, value = 0;    // where it is farthest out
  Real beyond = 0;          // of the range between the two points: above it > 0, below it < 0
};

class ScalarFunction {
 public:
  // owner: what the function belongs to, e.g. "driver 'crank'"; end: of the simulated time [s]. Throws
  // InputError naming the owner where a table has fewer than two points, unequal columns, times that do not
  // increase, or does not cover [0, end].
  ScalarFunction(const TimeFunction& function, const std::string& owner, Real end);
  // A curve over something else than time. Throws InputError on its points as above; it need not cover
  // anything.
  ScalarFunction(const Curve& curve, const std::string& owner);
  // The constant `value`.
  explicit ScalarFunction(Real value) { function_.value = value; }

  // Whether the other has the same values, bit for bit, at all instants from 0 to `t` [s], though not after.
  bool same_until(const ScalarFunction& other, Real t) const;

  // The farthest that a spline through a table's points leaves the values at the ends of one of its pieces;
  // nothing of what is not such a spline.
  Overshoot overshoot() const;

  // t [s]; round-off past a table's ends follows the end tangent, which keeps both derivatives continuous.
  TimeValue operator()(Real t) const {
    if (function_.kind == TimeFunction::Kind::constant) return {function_.value, 0, 0};  // most of them
    return moving_value(t);
  }

 private:
  void check_points(const std::string& owner) const;
  void check_cover(const std::string& owner, Real end) const;
  void find_rates();
  void find_spline();
  void find_monotone();
  Real slope(std::size_t segment) const;
  Real monotone_rate(std::size_t point, Real parabola) const;
  Real monotone_bend(std::size_t point, Real parabola) const;
  TimeValue moving_value(Real t) const;
  TimeValue table_value(Real t) const;
  TimeValue segment_value(std::size_t segment, Real t) const;

  TimeFunction function_;
  // At the table's times: rates (monotone), second derivatives (0 where it is read linearly).
  std::vector<Real> rates_, second_derivatives_;
};

}  // namespace scree
