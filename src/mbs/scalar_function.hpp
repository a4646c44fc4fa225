// A TimeFunction of the model, ready to be evaluated.
#pragma once

#include <string>
#include <vector>

#include "model/bodies.hpp"
#include "physics/time_function.hpp"

namespace scree {

// Tables are interpolated by the natural cubic spline, for drivers and forces alike: twice continuously
// differentiable, second derivative zero at both ends. It passes through every point and may overshoot
// between points where the slope jumps.
class ScalarFunction {
 public:
  // owner: what the function belongs to, e.g. "driver 'crank'"; end: of the simulated time [s]. Throws
  // InputError naming the owner where a table has fewer than two points, unequal columns, times that do not
  // increase, or does not cover [0, end].
  ScalarFunction(const TimeFunction& function, const std::string& owner, Real end);
  // The constant `value`.
  explicit ScalarFunction(Real value) { function_.value = value; }

  // t [s]; round-off past a table's ends follows the end tangent, which keeps both derivatives continuous.
  TimeValue operator()(Real t) const;

 private:
  void check_table(const std::string& owner, Real end) const;
  void find_second_derivatives();
  TimeValue table_value(Real t) const;

  TimeFunction function_;
  std::vector<Real> second_derivatives_;  // of the spline at the table's times
};

}  // namespace scree
