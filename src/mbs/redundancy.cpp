#include "mbs/redundancy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "mbs/rank_check.hpp"
#include "model/connections.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr std::size_t kNamesShown = 8;
constexpr Real kParallel = 1e-9;  // sine between axes
constexpr int kRowsPerLoop = 3;   // that repeat others in a planar loop of hinges

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<std::vector<int>> dependent_rows(const RigidBodySystem& system, const SparseTerm& jacobian) {
  std::vector<MatrixEntry> transposed;
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    const Real scale = system.coordinate_scale()[at(jacobian.column(i))];
    transposed.push_back({jacobian.column(i), jacobian.row(i), jacobian.value(i) * scale});
  }
  return column_dependencies(system.coordinates(), system.constraints(), transposed);
}

// Joints, drivers and couplers that take part, by their numbers among the system's groups.
std::set<int> groups_of(const RigidBodySystem& system, const std::vector<std::vector<int>>& dependencies) {
  std::set<int> groups;
  for (const std::vector<int>& rows : dependencies)
    for (const int row : rows) groups.insert(system.group_of(row));
  return groups;
}

std::string names_of(const RigidBodySystem& system, const std::set<int>& groups) {
  std::vector<std::string> names;
  for (const int group : groups) names.push_back(system.groups()[at(group)].title);
  return list_names(names);
}

// Hinges in space with parallel axes: a loop of them has three rows too many, and a spherical joint has two
// rows less than a hinge, a cylindrical one another one. The first groups are the joints'.
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
    return "; or, for the same motion without any, make in each loop one of these hinges spherical and "
           "another "
           "one cylindrical";
  return fmt::format(
      "; or, for the same motion without any, make joint '{}' spherical and joint '{}' cylindrical",
      model.joints[at(*groups.begin())].name, model.joints[at(*groups.rbegin())].name);
}

}  // namespace

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

std::string check_redundancy(const Model& model, const RigidBodySystem& system, const SparseTerm& jacobian) {
  const std::vector<std::vector<int>> dependencies = dependent_rows(system, jacobian);
  for (const std::vector<int>& rows : dependencies)
    if (rows.size() == 1)
      throw InputError(fmt::format("{} has a condition that no motion of its bodies changes; remove it",
                                   system.constraint_name(rows.front())));
  if (dependencies.empty()) return "";
  const std::set<int> groups = groups_of(system, dependencies);
  const int rows = system.constraints(), rank = rows - static_cast<int>(dependencies.size());
  if (model.integrator.redundant == RedundantRows::share)
    return fmt::format("{} rows of rank {}: {}", rows, rank, names_of(system, groups));
  throw InputError(fmt::format(
      "redundant constraints: {} fix the same motion more than once, {} rows have rank {}; the motion is "
      "unique, "
      "the reactions of these are not. Remove or change one; or set integrator.redundant = \"share\" for the "
      "least reactions{}",
      names_of(system, groups), rows, rank, remedy_of_loops(model, groups, dependencies.size())));
}

}  // namespace scree
