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
// Of the largest weight in the combination, for rows of length 1. Where joints repeat each other by
// themselves, as in a linkage that lies flat, a driver's is nothing.
constexpr Real kTakesPart = 0.1;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Real largest(const std::vector<Real>& values, const std::vector<Real>& scale) {
  Real most = 0;
  for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(values[i]) / scale[i]);
  return most;
}

// Of the rows of Phi_q, its columns times the scales of their coordinates.
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

// The one of those that take part which asks for most, or, where all rest, weighs most.
DrivenRow driven_row(const RigidBodySystem& system, const SparseTerm& jacobian,
                     const std::vector<Dependency>& repeated, const std::vector<Real>& rate) {
  const std::vector<Real> length = row_lengths(system, jacobian);
  DrivenRow most;
  for (const Dependency& dependency : repeated) {
    Real heaviest = 0;
    for (const auto& [row, weight] : dependency.weight)
      heaviest = std::max(heaviest, std::abs(weight) * length[at(row)]);
    for (const auto& [row, w] : dependency.weight) {
      const DrivenRow one{row, std::abs(w * rate[at(row)]), std::abs(w) * length[at(row)]};
      if (!system.groups()[at(system.group_of(row))].drives || one.weight < kTakesPart * heaviest) continue;
      if (most.row < 0 || std::pair(one.asked, one.weight) > std::pair(most.asked, most.weight)) most = one;
    }
  }
  return most;
}

}  // namespace

std::string dead_point(RigidBodySystem& system, const std::vector<Real>& position,
                       const std::vector<Real>& velocity, const std::vector<Real>& multipliers, Real t) {
  SystemTerms terms;
  terms.applied_force.assign(at(system.coordinates()), 0);
  terms.constraint.assign(at(system.constraints()), 0);
  const SystemInstant instant{t, position, velocity, &multipliers};
  system.evaluate(instant, terms);
  std::vector<Real> rate(at(system.constraints()), 0);
  system.velocity_rhs(instant, rate);
  std::vector<Dependency> repeated = repeated_rows(system, terms.constraint_jacobian, kAtIt);
  int row = driven_row(system, terms.constraint_jacobian, repeated, rate).row;
  if (row < 0) {
    const Real asked = largest(rate, system.constraint_scale());
    if (!(largest(velocity, system.coordinate_scale()) > kGrown * asked)) return "";
    repeated = repeated_rows(system, terms.constraint_jacobian, kNear);
    row = driven_row(system, terms.constraint_jacobian, repeated, rate).row;
  }
  if (row < 0) return "";
  const ConstraintGroup& driver = system.groups()[at(system.group_of(row))];
  return fmt::format(
      "{} asks for a motion that the mechanism cannot follow: it leads to a dead point, where {} become "
      "dependent "
      "and velocities and reactions grow without bound; the driver's is {:.3g} {} here. Change its motion so "
      "that "
      "it stays clear of this position, or drive another joint: neither shorter steps nor "
      "integrator.redundant = "
      "\"share\" pass it",
      driver.title, names_of(system, repeated), std::abs(multipliers[at(row)]),
      system.is_angle(row) ? "N m" : "N");
}

}  // namespace scree
