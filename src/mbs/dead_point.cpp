#include "mbs/dead_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mbs/redundancy.hpp"

namespace scree {

namespace {

// Rows of length 1 that are as near to a combination of others: so near that nothing else explains a failure;
// and where it does if the velocities have grown.
constexpr Real kAtIt = 1e-3, kNear = 0.03;
// Rates of coordinates over those that drivers ask for, both over their scales, that have grown.
constexpr Real kGrown = 10;
// A driver takes part in a combination from this share of the largest weight on, for rows of length 1. Where
// joints repeat each other by themselves, as in a linkage that lies flat, a driver's weight is nothing.
constexpr Real kTakesPart = 0.1;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Real largest(const std::vector<Real>& values, const std::vector<Real>& scale) {
  Real most = 0;
  for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(values[i]) / scale[i]);
  return most;
}

// Lengths of the rows of Phi_q, its columns times the scales of their coordinates.
std::vector<Real> row_lengths(const RigidBodySystem& system, const SparseTerm& jacobian) {
  std::vector<Real> square(at(system.constraints()), 0);
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    const Real value = jacobian.value(i) * system.coordinate_scale()[at(jacobian.column(i))];
    square[at(jacobian.row(i))] += value * value;
  }
  for (Real& length : square) length = std::sqrt(length);
  return square;
}

// A driver's row in a combination.
struct DrivenRow {
  int row = -1;
  Real asked = 0, weight = 0;  // weight times its rate; weight, for a row of length 1
};

// Whether it is in one of the combinations.
bool is_in(const std::vector<Dependency>& combinations, int row) {
  return std::ranges::any_of(combinations, [&](const Dependency& one) {
    return std::ranges::find(one.columns, row) != one.columns.end();
  });
}

// The one of those that take part which asks for most, or, where all rest, weighs most.
DrivenRow driven_row(const RigidBodySystem& system, const SparseTerm& jacobian,
                     const std::vector<Dependency>& combinations, const std::vector<Dependency>& repeated,
                     const std::vector<Real>& rate) {
  const std::vector<Real> length = row_lengths(system, jacobian);
  DrivenRow most;
  for (const Dependency& dependency : combinations) {
    Real heaviest = 0;
    for (const auto& [row, weight] : dependency.weight)
      heaviest = std::max(heaviest, std::abs(weight) * length[at(row)]);
    for (const auto& [row, w] : dependency.weight) {
      const DrivenRow one{row, std::abs(w * rate[at(row)]), std::abs(w) * length[at(row)]};
      if (!system.groups()[at(system.group_of(row))].drives || one.weight < kTakesPart * heaviest ||
          is_in(repeated, row))
        continue;
      if (most.row < 0 || std::pair(one.asked, one.weight) > std::pair(most.asked, most.weight)) most = one;
    }
  }
  return most;
}

}  // namespace

std::string dead_point(RigidBodySystem& system, const std::vector<Real>& position,
                       const std::vector<Real>& velocity, Real t, const std::vector<Dependency>& repeated) {
  SystemTerms terms;
  terms.applied_force.assign(at(system.coordinates()), 0);
  terms.constraint.assign(at(system.constraints()), 0);
  const SystemInstant instant{t, position, velocity};
  system.evaluate(instant, terms);
  const SparseTerm& jacobian = terms.constraint_jacobian;
  std::vector<Real> rate(at(system.constraints()), 0);
  system.velocity_rhs(instant, rate);
  const Real asked = largest(rate, system.constraint_scale()),
             reached = largest(velocity, system.coordinate_scale());
  std::vector<Dependency> combinations = repeated_rows(system, jacobian, kAtIt);
  int row = driven_row(system, jacobian, combinations, repeated, rate).row;
  if (row < 0 && reached > kGrown * asked) {
    combinations = repeated_rows(system, jacobian, kNear);
    row = driven_row(system, jacobian, combinations, repeated, rate).row;
  }
  if (row < 0) return "";
  return fmt::format(
      "{} asks for a motion that the mechanism cannot follow: it leads to a dead point, where {} become "
      "dependent and velocities and reactions grow without bound{}. Change its motion so that it stays clear "
      "of this position, or drive another joint: neither shorter steps nor integrator.redundant = \"share\" "
      "pass it",
      system.constraint_name(row), names_of(system, combinations),
      reached > asked && asked > 0
          ? fmt::format(" (velocities here are {:.3g} times what drivers ask for)", reached / asked)
          : "");
}

}  // namespace scree
