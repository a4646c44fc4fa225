#include "mbs/dead_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mbs/redundancy.hpp"

namespace scree {

namespace {

// Distances of a driver's row, of length 1, from the combinations of all other rows. kAtIt: so small that a
// dead point alone explains the failure. kNear: a dead point explains it where velocities have grown.
// kInRange: a dead point may explain it where the next steps lead to it.
constexpr Real kAtIt = 1e-3, kNear = 0.03, kInRange = 0.3;
// Ratio of the rates of coordinates to the rates that drivers prescribe, both over their scales, from which
// velocities count as grown.
constexpr Real kGrown = 10;
// A step that fails before a dead point is at most so many times as long as the remaining time to it.
constexpr Real kStepsLeft = 4;
// Fraction of a step over which the change of the distance is measured.
constexpr Real kProbe = 0.01;
// Fraction of the largest weight, for rows of length 1, from which a driver takes part in a combination.
// Where joints are redundant without the driver, as in a flat linkage, the driver's weight is round-off.
constexpr Real kTakesPart = 0.1;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Real largest(const std::vector<Real>& values, const std::vector<Real>& scale) {
  Real most = 0;
  for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(values[i]) / scale[i]);
  return most;
}

// Lengths of the rows of Phi_q after its columns are multiplied by the scales of their coordinates.
std::vector<Real> row_lengths(const RigidBodySystem& system, const SparseTerm& jacobian) {
  std::vector<Real> square(at(system.constraints()), 0);
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    const Real value = jacobian.value(i) * system.coordinate_scale()[at(jacobian.column(i))];
    square[at(jacobian.row(i))] += value * value;
  }
  for (Real& length : square) length = std::sqrt(length);
  return square;
}

// Whether a driver's row may lead to a dead point. A row that is redundant from the start does so where it
// belongs to the only driver of its dependency and this driver moves: several drivers contradict each other
// instead, and a driver that rests moves nothing.
bool may_lead(const RigidBodySystem& system, int row, const std::vector<Dependency>& repeated, Real rate) {
  const auto drives = [&](int one) { return system.groups()[at(system.group_of(one))].drives; };
  for (const Dependency& one : repeated)
    if (std::ranges::find(one.columns, row) != one.columns.end() &&
        (rate == 0 || std::ranges::count_if(one.columns, drives) > 1))
      return false;
  return drives(row);
}

std::vector<int> driven_rows(const RigidBodySystem& system, const std::vector<Dependency>& repeated,
                             const std::vector<Real>& rate) {
  std::vector<int> rows;
  for (int row = 0; row < system.constraints(); ++row)
    if (may_lead(system, row, repeated, rate[at(row)])) rows.push_back(row);
  return rows;
}

// A driver's row, its distance from the other rows, and the nearest combination of these.
struct Nearest {
  int row = -1;
  Real distance = 1;
  Dependency combination;
};

// The row among `rows` that is nearest to a combination.
Nearest nearest(const RigidBodySystem& system, const SparseTerm& jacobian, const std::vector<int>& rows) {
  Nearest found;
  std::vector<NearDependency> all = near_combinations(system, jacobian, rows);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (found.row < 0 || all[i].distance < found.distance)
      found = {rows[i], all[i].distance, std::move(all[i].combination)};
  return found;
}

// The driver of a combination with the largest prescribed rate or, where all drivers rest, with the largest
// weight.
int prescribing_row(const RigidBodySystem& system, const SparseTerm& jacobian, const Nearest& near,
                    const std::vector<int>& rows, const std::vector<Real>& rate) {
  const std::vector<Real> length = row_lengths(system, jacobian);
  Real heaviest = 0;
  for (const auto& [row, weight] : near.combination.weight)
    heaviest = std::max(heaviest, std::abs(weight) * length[at(row)]);
  int most = near.row;
  std::pair<Real, Real> most_prescribed{-1, 0};
  for (const auto& [row, weight] : near.combination.weight) {
    const std::pair<Real, Real> prescribed{std::abs(weight * rate[at(row)]),
                                           std::abs(weight) * length[at(row)]};
    if (prescribed.second < kTakesPart * heaviest || !std::ranges::binary_search(rows, row)) continue;
    if (prescribed > most_prescribed) most = row, most_prescribed = prescribed;
  }
  return most;
}

const SparseTerm& jacobian_at(RigidBodySystem& system, const SystemInstant& at_instant, SystemTerms& terms) {
  terms.applied_force.assign(at(system.coordinates()), 0);
  terms.constraint.assign(at(system.constraints()), 0);
  system.evaluate(at_instant, terms);
  return terms.constraint_jacobian;
}

// Time until the velocities reach the dead point [s]. The square of the distance falls in proportion to
// time, as a driver of constant rate accelerates the joints without bound. Infinite where the velocities
// lead away from the dead point.
Real time_left(RigidBodySystem& system, const SystemInstant& now, const Nearest& near, Real step) {
  const Real tau = kProbe * step;
  std::vector<Real> displacement = now.velocity, position(now.position.size());
  for (Real& part : displacement) part *= tau;
  system.displace(now.position, displacement, position);
  SystemTerms terms;
  const Nearest then =
      nearest(system, jacobian_at(system, {now.time + tau, position, now.velocity}, terms), {near.row});
  const Real square = near.distance * near.distance, fall = square - then.distance * then.distance;
  return fall > 0 ? tau * square / fall : std::numeric_limits<Real>::infinity();
}

}  // namespace

std::string dead_point(RigidBodySystem& system, const SystemInstant& now, Real step,
                       const std::vector<Dependency>& repeated) {
  std::vector<Real> rate(at(system.constraints()), 0);
  system.velocity_rhs(now, rate);
  const std::vector<int> rows = driven_rows(system, repeated, rate);
  if (rows.empty()) return "";
  SystemTerms terms;
  const SparseTerm& jacobian = jacobian_at(system, now, terms);
  const Real prescribed = largest(rate, system.constraint_scale()),
             reached = largest(now.velocity, system.coordinate_scale());
  const Nearest near = nearest(system, jacobian, rows);
  if (near.row < 0 || near.distance > kInRange) return "";
  const bool explains = near.distance <= kAtIt || (near.distance <= kNear && reached > kGrown * prescribed) ||
                        time_left(system, now, near, step) <= kStepsLeft * step;
  if (!explains) return "";
  return fmt::format(
      "{} asks for a motion that the mechanism cannot follow: it leads to a dead point, where {} become "
      "dependent and velocities and reactions grow without bound{}. Change its motion so that it stays clear "
      "of this position, or drive another joint: neither shorter steps nor "
      "integrator.redundant = \"minimum-norm\" pass it",
      system.constraint_name(prescribing_row(system, jacobian, near, rows, rate)),
      names_of(system, {near.combination}),
      reached > prescribed && prescribed > 0
          ? fmt::format(" (velocities here are {:.3g} times those that drivers prescribe)",
                        reached / prescribed)
          : "");
}

}  // namespace scree
