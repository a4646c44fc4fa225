#include "mbs/dead_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mbs/redundancy.hpp"

namespace scree {

namespace {

// Rows of length 1 that are as near to a combination of others: so near that nothing else explains a failure;
// and where it does if the velocities have grown.
constexpr Real kAtIt = 1e-3, kNear = 0.05;
// Rates of coordinates over those that drivers ask for, both over their scales, that have grown.
constexpr Real kGrown = 10;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Real largest(const std::vector<Real>& values, const std::vector<Real>& scale) {
  Real most = 0;
  for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(values[i]) / scale[i]);
  return most;
}

// Of the drivers' rows in the dependencies the one that asks for most, or, where all drivers rest, the one
// that weighs most; -1 where there is none.
int driven_row(const RigidBodySystem& system, const std::vector<Dependency>& repeated,
               const std::vector<Real>& rate) {
  int row = -1;
  Real most[2] = {-1, -1};
  for (const Dependency& dependency : repeated)
    for (const auto& [candidate, weight] : dependency.weight) {
      if (!system.groups()[at(system.group_of(candidate))].drives) continue;
      const Real size = std::abs(weight) * system.constraint_scale()[at(candidate)],
                 asked = std::abs(weight * rate[at(candidate)]);
      if (asked > most[0] || (asked == most[0] && size > most[1]))
        row = candidate, most[0] = asked, most[1] = size;
    }
  return row;
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
  int row = driven_row(system, repeated, rate);
  if (row < 0) {
    const Real asked = largest(rate, system.constraint_scale());
    if (!(largest(velocity, system.coordinate_scale()) > kGrown * asked)) return "";
    repeated = repeated_rows(system, terms.constraint_jacobian, kNear);
    row = driven_row(system, repeated, rate);
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
