#include "mbs/redundancy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "model/derived/connections.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr std::size_t kNamesShown = 8;
constexpr Real kParallel = 1e-9;  // sine between axes
constexpr int kRowsPerLoop = 3;   // redundant rows of a planar loop of revolute joints

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Joints, drivers and couplers that take part, by their numbers among the system's groups.
std::set<int> groups_of(const RigidBodySystem& system, const std::vector<Dependency>& repeated) {
  std::set<int> groups;
  for (const Dependency& dependency : repeated)
    for (const int row : dependency.columns) groups.insert(system.group_of(row));
  return groups;
}

std::string names_of(const RigidBodySystem& system, const std::set<int>& groups) {
  std::vector<std::string> names;
  for (const int group : groups) names.push_back(system.groups()[at(group)].title);
  return list_names(names);
}

// Remedy for spatial revolute joints with parallel axes: a loop of them has three redundant rows; a
// spherical joint has two rows less than a revolute joint, a cylindrical one has one less. The first groups
// are those of the joints.
std::string remedy_of_loops(const Model& model, const std::set<int>& groups, std::size_t repeated) {
  Vec3 axis;
  for (const int group : groups) {
    if (at(group) >= model.joints.size()) return "";
    const Joint& joint = model.joints[at(group)];
    if (joint.kind != JointKind::revolute || between(model, joint.body) != BodyKind::spatial) return "";
    const Vec3 own =
        to_global_direction(model, joint.body[0], rotation_matrix(joint.marker[0]) * Vec3{0, 0, 1});
    if (group == *groups.begin()) axis = own;
    if (norm(cross(axis, own)) > kParallel) return "";
  }
  if (repeated % kRowsPerLoop != 0) return "";
  if (repeated > kRowsPerLoop)
    return "; or, for the same motion without any, make one of these revolute joints spherical and "
           "another one cylindrical in each loop";
  return fmt::format(
      "; or, for the same motion without any, make joint '{}' spherical and joint '{}' cylindrical",
      model.joints[at(*groups.begin())].name, model.joints[at(*groups.rbegin())].name);
}

// Remedy for dependent rows whose bodies have at least as many coordinates as there are rows: they may be
// independent in other positions. Two rows alone are one condition twice, in every position.
std::string remedy_of_position(const RigidBodySystem& system, const SparseTerm& jacobian,
                               const std::vector<Dependency>& repeated) {
  if (std::ranges::all_of(repeated, [](const Dependency& d) { return d.columns.size() <= 2; })) return "";
  std::set<int> rows, bodies, outside;
  for (const Dependency& dependency : repeated)
    rows.insert(dependency.columns.begin(), dependency.columns.end());
  const auto body = [&](std::size_t i) { return system.layout().body_of_column(jacobian.column(i)); };
  for (std::size_t i = 0; i < jacobian.size(); ++i)
    if (rows.contains(jacobian.row(i))) bodies.insert(body(i));
  for (std::size_t i = 0; i < jacobian.size(); ++i)
    if (!bodies.contains(body(i))) outside.insert(jacobian.row(i));
  int coordinates = 0;
  for (int column = 0; column < system.coordinates(); ++column)
    coordinates += bodies.contains(system.layout().body_of_column(column));
  if (system.constraints() - static_cast<int>(outside.size()) > coordinates) return "";
  return "; where they do so in this position alone, as in a flat linkage, the position is singular: permit "
         "it, "
         "or start elsewhere";
}

// The only driver among redundant rows, where it moves: the other rows block its motion, and minimum-norm
// reactions do not change that.
const Driver* stuck_driver(const Model& model, const RigidBodySystem& system,
                           const std::vector<Dependency>& repeated) {
  for (const Dependency& dependency : repeated) {
    const std::set<int> groups = groups_of(system, {dependency});
    const auto drives = [&](int group) { return system.groups()[at(group)].drives; };
    if (std::ranges::count_if(groups, drives) != 1) continue;
    const int group = *std::ranges::find_if(groups, drives);
    const Driver& driver = model.drivers[at(group) - model.joints.size()];  // drivers follow the joints
    if (driver.motion.kind != TimeFunctionKind::constant) return &driver;
  }
  return nullptr;
}

constexpr const char* word_of(ConstraintLevel level) {
  return level == ConstraintLevel::positions    ? "positions"
         : level == ConstraintLevel::velocities ? "velocities"
                                                : "accelerations";
}

constexpr const char* per_of(ConstraintLevel level) {
  return level == ConstraintLevel::positions ? "" : level == ConstraintLevel::velocities ? "/s" : "/s^2";
}

// Columns of Phi_q^T, whose rows are multiplied by the scales of their coordinates.
std::vector<MatrixEntry> scaled_columns(const RigidBodySystem& system, const SparseTerm& jacobian) {
  std::vector<MatrixEntry> transposed;
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    const Real scale = system.coordinate_scale()[at(jacobian.column(i))];
    transposed.push_back({jacobian.column(i), jacobian.row(i), jacobian.value(i) * scale});
  }
  return transposed;
}

// The difference between the row that is easiest to change, a driver's where there is one, and the value
// that the other rows imply for it.
struct Difference {
  int row = 0;
  Real size = 0;  // [m, rad and their rates]
};

Difference difference_of(const RigidBodySystem& system, const Dependency& dependency,
                         const std::vector<Real>& wanted) {
  const auto drives = [&](int row) { return system.groups()[at(system.group_of(row))].drives; };
  Real sum = 0, weight = 0;
  Difference out{dependency.columns.front(), 0};
  for (const int row : dependency.columns)
    if (drives(row) >= drives(out.row)) out.row = row;
  for (const auto& [row, w] : dependency.weight) {
    sum += w * wanted[at(row)];
    if (row == out.row) weight = w;
  }
  out.size = std::abs(sum / weight);
  return out;
}

}  // namespace

std::vector<Dependency> redundant_rows(const RigidBodySystem& system, const SparseTerm& jacobian,
                                       Real distance) {
  return column_dependencies(system.coordinates(), system.constraints(), scaled_columns(system, jacobian),
                             distance);
}

std::vector<NearDependency> near_combinations(const RigidBodySystem& system, const SparseTerm& jacobian,
                                              const std::vector<int>& of) {
  return nearest_combinations(system.coordinates(), system.constraints(), scaled_columns(system, jacobian),
                              of);
}

std::string names_of(const RigidBodySystem& system, const std::vector<Dependency>& repeated) {
  return names_of(system, groups_of(system, repeated));
}

std::string list_names(const std::vector<std::string>& names) {
  std::vector<std::string> once;
  for (const std::string& name : names) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  const std::size_t shown = std::min(once.size(), kNamesShown);
  std::string text =
      fmt::format("{}", fmt::join(once.begin(), once.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (once.size() > shown) text += fmt::format(" and {} more", once.size() - shown);
  return text;
}

std::string check_redundancy(const Model& model, const RigidBodySystem& system, const SparseTerm& jacobian,
                             const std::vector<Dependency>& repeated) {
  const auto label = [&](int group) { return system.groups()[at(group)].deck_label; };
  for (const Dependency& dependency : repeated)
    if (dependency.columns.size() == 1) {
      const int row = dependency.columns.front();
      throw InputError(with_label(
          label(system.group_of(row)),
          system.constraint_name(row) + " has a condition that no motion of its bodies changes; remove it"));
    }
  if (repeated.empty()) return "";
  const std::set<int> groups = groups_of(system, repeated);
  const int rows = system.constraints(), rank = rows - static_cast<int>(repeated.size());
  if (model.integrator.redundant == RedundantRows::share)
    return fmt::format("{} rows of rank {}: {}", rows, rank, names_of(system, groups));
  if (const Driver* const blocked = stuck_driver(model, system, repeated))
    throw InputError(with_label(
        blocked->deck_label,
        fmt::format(
            "driver '{}' asks for a motion that the mechanism cannot follow: its position at t = 0 is a "
            "dead point, where {} are dependent. Start elsewhere, or drive another joint: "
            "integrator.redundant = \"minimum-norm\" does not pass it",
            blocked->name, names_of(system, groups))));
  throw InputError(with_label(
      label(*groups.rbegin()),
      fmt::format("redundant constraints: {} fix the same motion more than once, {} rows have rank {}; the "
                  "motion is unique, the reactions of these are not. Remove or change one; or set "
                  "integrator.redundant = \"minimum-norm\" for minimum-norm reactions{}{}",
                  names_of(system, groups), rows, rank, remedy_of_loops(model, groups, repeated.size()),
                  remedy_of_position(system, jacobian, repeated))));
}

void check_contradictions(const RigidBodySystem& system, const std::vector<Dependency>& repeated,
                          const std::vector<Real>& wanted, Real limit, ConstraintLevel level, Real t) {
  const Dependency* worst = nullptr;
  Difference most;
  Real ratio = limit;
  for (const Dependency& dependency : repeated) {
    const Difference difference = difference_of(system, dependency, wanted);
    const Real scaled = difference.size / system.constraint_scale()[at(difference.row)];
    if (scaled > ratio) worst = &dependency, most = difference, ratio = scaled;
  }
  if (worst == nullptr) return;
  const ConstraintGroup& group = system.groups()[at(system.group_of(most.row))];
  const std::string difference_text =
      fmt::format("the {} that they require at t = {:.9g}{} differ by {:.6g} {}{}", word_of(level), t,
                  t > 0 ? " s" : "", most.size, system.is_angle(most.row) ? "rad" : "m", per_of(level));
  const std::string names = names_of(system, {*worst});
  if (level == ConstraintLevel::accelerations && !group.drives)
    throw InputError(with_label(
        group.deck_label,
        fmt::format("{} are redundant in the position at t = 0, which is singular, and no motion continues "
                    "the velocities there: {}. Give velocities of a possible motion, or start elsewhere",
                    names, difference_text)));
  throw InputError(with_label(
      group.deck_label,
      fmt::format("{} contradict each other: {}, and no motion satisfies them all. Change or "
                  "remove one{}",
                  names, difference_text,
                  worst->columns.size() > 2 ? "; or, where the position at t = 0 is singular, start elsewhere"
                                            : "")));
}

std::string largest_gaps(const RigidBodySystem& system, const std::vector<Real>& gap) {
  int largest = 0;
  const auto scaled = [&](int row) { return std::abs(gap[at(row)]) / system.constraint_scale()[at(row)]; };
  for (int row = 1; row < system.constraints(); ++row)
    if (scaled(row) > scaled(largest)) largest = row;
  std::vector<std::string> names;
  for (int row = 0; row < system.constraints(); ++row)
    if (scaled(row) >= scaled(largest) / 2) names.push_back(system.constraint_name(row));
  return fmt::format("{}, by {:.3g} {}", list_names(names), std::abs(gap[at(largest)]),
                     system.is_angle(largest) ? "rad" : "m");
}

}  // namespace scree
