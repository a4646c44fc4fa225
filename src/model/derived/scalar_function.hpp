// Evaluation of a TimeFunction of the model.
#pragma once

#include <string>
#include <vector>

#include "model/data/joint_forces.hpp"
#include "physics/time_function.hpp"

namespace scree {

// Largest overshoot of a spline beyond its points.
struct Overshoot {
  std::size_t segment = 0;  // between points `segment` and the next
  Real t = 0, value = 0;    // where the overshoot is largest
  Real beyond = 0;          // overshoot of the range of the two points: above it > 0, below it < 0
};

class ScalarFunction {
 public:
  // owner: the owner of the function, e.g. "driver 'crank'"; end: of the simulated time [s]. Throws
  // InputError with the owner where a table has fewer than two points, columns of unequal length or times
  // that do not increase, or does not cover [0, end].
  ScalarFunction(const TimeFunction& function, const std::string& owner, Real end);
  // A curve over a variable other than time. Throws InputError on invalid points; it need not cover a range.
  ScalarFunction(const Curve& curve, const std::string& owner);
  // The constant `value`.
  explicit ScalarFunction(Real value) { function_.value = value; }

  // Whether the other function has the same values, bit for bit, at all times from 0 to `t` [s]; later values
  // may differ.
  bool same_until(const ScalarFunction& other, Real t) const;

  // The largest overshoot of a spline through a table's points beyond the values at the ends of a segment;
  // zero for other functions.
  Overshoot overshoot() const;

  // t [s]. Beyond the ends of a table, which round-off may reach, the end tangent continues it, so both
  // derivatives are continuous.
  TimeValue operator()(Real t) const {
    if (function_.kind == TimeFunction::Kind::constant)
      return {function_.value, 0, 0};  // the most frequent kind
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
  // At the table's times: rates (monotone), or second derivatives (0 for linear interpolation).
  std::vector<Real> rates_, second_derivatives_;
};

}  // namespace scree
