#include "mbs/start_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/error.hpp"
#include "mbs/rank_check.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr Real kPositionGap = 1e-10;   // of the constraint's scale
constexpr Real kRunningGap = 1e-6;     // of the scale, during a run, where steps keep Phi to their tolerance
constexpr Real kContradiction = 1e-6;  // of the scale, between redundant rows: the digits of a deck
constexpr Real kVelocityGap = 1e-8;    // of the largest velocity plus the constraint's scale per second
// Of the largest acceleration plus the constraint's scale per second squared.
constexpr Real kAccelerationGap = 1e-3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Additional text on a driver; per: as below.
std::string driver_text(const ConstraintGroup& group, std::string_view per) {
  if (!group.drives) return "";
  return per == "/s"   ? group.remedy
         : per.empty() ? fmt::format("; the motion begins at {:.6g}", group.start)
                       : "";
}

// Text on the group whose gap [m, rad], or its rate with per = "/s", exceeds the limit most, in its length
// rows or its angle rows; empty where none does. driven: additional text on a driver.
std::string group_violation(const RigidBodySystem& system, const std::vector<Real>& gap, Real limit,
                            const std::string& description, const std::string& driven, const char* per) {
  std::string trouble;
  Real worst = limit;
  for (const ConstraintGroup& group : system.groups())
    for (const bool angle : {false, true}) {
      Real square = 0, scale = 1;
      for (int row = group.first_row; row < group.end_row; ++row) {
        if (system.is_angle(row) != angle) continue;
        square += gap[at(row)] * gap[at(row)];
        scale = system.constraint_scale()[at(row)];
      }
      const Real size = std::sqrt(square);
      if (size <= worst * scale) continue;
      worst = size / scale;
      trouble = with_label(group.deck_label,
                           fmt::format("{0}: {1} {2:.6g} {3}{4}, allowed is {5:.3g} {3}{4}{6}", group.title,
                                       group.drives ? driven : description, size, angle ? "rad" : "m", per,
                                       limit * scale, driver_text(group, per)));
    }
  return trouble;
}

// 1 and the largest rate of a coordinate over its scale.
Real rate_scale(const RigidBodySystem& system, const std::vector<Real>& rate) {
  Real fastest = 0;
  for (std::size_t i = 0; i < rate.size(); ++i)
    fastest = std::max(fastest, std::abs(rate[i]) / system.coordinate_scale()[i]);
  return 1 + fastest;
}

// 1 and the largest right-hand side of a row over its scale.
Real rhs_scale(const RigidBodySystem& system, const std::vector<Real>& wanted) {
  Real fastest = 0;
  for (std::size_t j = 0; j < wanted.size(); ++j)
    fastest = std::max(fastest, std::abs(wanted[j]) / system.constraint_scale()[j]);
  return 1 + fastest;
}

SystemTerms terms_at(RigidBodySystem& system, const std::vector<Real>& position,
                     const std::vector<Real>& velocity, Real t) {
  SystemTerms terms;
  terms.applied_force.assign(at(system.coordinates()), 0);
  terms.constraint.assign(at(system.constraints()), 0);
  system.evaluate({t, position, velocity}, terms);
  return terms;
}

// gap: per row of Phi [m, rad].
void check_gaps(const RigidBodySystem& system, const std::vector<Real>& gap, Real limit, Real t) {
  const std::string when = fmt::format("t = {:.9g}{}", t, t > 0 ? " s" : "");
  const std::string trouble =
      group_violation(system, gap, limit, "its two sides do not meet at " + when + ", their distance is",
                      "its motion and the joint's coordinate at " + when + " differ by", "");
  if (!trouble.empty()) throw InputError(trouble);
}

void check_joints_closed(const Model& model) {
  for (const Joint& joint : model.joints)
    if (const JointGap ends = joint_gap(model, joint); !ends.meets())
      throw InputError(
          with_label(joint.deck_label, fmt::format("joint '{}': its two sides do not meet at t = 0, their "
                                                   "distance is {:.6g} m, allowed is {:.3g} m",
                                                   joint.name, ends.size, ends.allowed)));
}

// Points of joints are checked by the model's rule (joint_gap); angles and drivers by the rows of Phi.
void check_start_gaps(const Model& model, const RigidBodySystem& system, std::vector<Real> gap) {
  for (std::size_t k = 0; k < model.joints.size(); ++k)  // the first groups are those of the joints
    for (int row = system.groups()[k].first_row; row < system.groups()[k].end_row; ++row)
      if (!system.is_angle(row)) gap[at(row)] = 0;
  check_gaps(system, gap, kPositionGap, 0);
}

// Rows that keep two axes parallel also hold for opposite axes; an angle between them does not.
void check_senses(const Model& model) {
  for (const Joint& joint : model.joints) {
    if (!has_coordinate(joint.kind, JointCoordinate::angle) ||
        between(model, joint.body) != BodyKind::spatial)
      continue;
    Vec3 axis[2];
    for (int i = 0; i < 2; ++i)
      axis[i] = to_global_direction(model, joint.body[i], rotation_matrix(joint.marker[i]) * Vec3{0, 0, 1});
    if (dot(axis[0], axis[1]) < 0)
      throw InputError(with_label(
          joint.deck_label,
          fmt::format("joint '{}': its axes on the two bodies are opposite at t = 0; they must have "
                      "the same direction",
                      joint.name)));
  }
}

// The direction of a spring-damper or a distance is not defined where its points coincide.
void check_directions(const Model& model, const RigidBodySystem& system, const BodyPoses& poses) {
  const auto check = [&](const int(&body)[2], const Vec3(&point)[2], const char* kind,
                         const std::string& name) {
    const Vec3 apart = to_global_point(model, body[1], point[1]) - to_global_point(model, body[0], point[0]);
    if (between(model, body) == BodyKind::spatial
            ? norm(apart) > 0
            : norm(pair_geometry(point_pair(system.layout(), body, point), poses).gap) > 0)
      return;
    throw InputError(
        fmt::format("{} '{}': its two points coincide at t = 0, so it has no direction", kind, name));
  };
  for (const SpringDamper& element : model.spring_dampers) {
    check(element.body, element.point, "spring-damper", element.name);
  }
  for (const Joint& joint : model.joints) {
    if (joint.kind == JointKind::distance) check(joint.body, joint.point, "joint", joint.name);
  }
}

// Two drivers of one coordinate are redundant in every position: they must agree for the whole run.
void check_driven_twice(const Model& model, const RigidBodySystem& system,
                        const std::vector<Dependency>& repeated) {
  constexpr int kInstants = 200;
  std::vector<Dependency> twice;
  const auto driven = [&](int row) {  // groups of drivers follow those of joints
    const std::size_t group = at(system.group_of(row));
    return system.groups()[group].drives ? model.drivers[group - model.joints.size()].joint : -1;
  };
  for (const Dependency& d : repeated)
    if (d.columns.size() == 2 && driven(d.columns[0]) >= 0 && driven(d.columns[0]) == driven(d.columns[1]))
      twice.push_back(d);
  std::vector<Real> rate(at(system.constraints()), 0);
  for (int k = 1; k <= kInstants && !twice.empty(); ++k) {
    const Real t = model.time.end * k / kInstants;
    system.velocity_rhs({t, {}, {}}, rate);
    check_contradictions(system, twice, rate, kContradiction * rhs_scale(system, rate),
                         ConstraintLevel::velocities, t);
  }
}

}  // namespace

StartFindings check_start(const Model& model, RigidBodySystem& system, const std::vector<Real>& position,
                          const std::vector<Real>& velocity) {
  check_senses(model);
  check_directions(model, system, system.poses_at({0, position, velocity}));
  const SystemTerms terms = terms_at(system, position, velocity, 0);
  check_joints_closed(model);
  StartFindings findings{"", redundant_rows(system, terms.constraint_jacobian)};
  check_contradictions(system, findings.repeated, terms.constraint, kContradiction,
                       ConstraintLevel::positions);
  check_start_gaps(model, system, terms.constraint);
  std::vector<Real> rate(at(system.constraints()), 0);
  system.velocity_rhs({0, position, velocity}, rate);
  check_contradictions(system, findings.repeated, rate, kVelocityGap * rhs_scale(system, rate),
                       ConstraintLevel::velocities);
  for (Real& required : rate) required = -required;
  const SparseTerm& jacobian = terms.constraint_jacobian;
  for (std::size_t i = 0; i < jacobian.size(); ++i)
    rate[at(jacobian.row(i))] += jacobian.value(i) * velocity[at(jacobian.column(i))];
  if (velocity_trouble(system, rate, velocity).empty())
    check_redundant_accelerations(system, findings.repeated, position, velocity);
  check_driven_twice(model, system, findings.repeated);
  findings.redundancy = check_redundancy(model, system, jacobian, findings.repeated);
  return findings;
}

void check_redundant_accelerations(RigidBodySystem& system, const std::vector<Dependency>& repeated,
                                   const std::vector<Real>& position, const std::vector<Real>& velocity) {
  if (repeated.empty()) return;
  terms_at(system, position, velocity, 0);  // sets the poses of the system
  std::vector<Real> required(at(system.constraints()), 0);
  system.acceleration_rhs({0, position, velocity}, required);
  check_contradictions(system, repeated, required, kAccelerationGap * rhs_scale(system, required),
                       ConstraintLevel::accelerations);
}

std::string velocity_trouble(const RigidBodySystem& system, const std::vector<Real>& gap_rate,
                             const std::vector<Real>& velocity) {
  const std::string description = "the velocities at t = 0 contradict it by";
  return group_violation(system, gap_rate, kVelocityGap * rate_scale(system, velocity), description,
                         description, "/s");
}

void check_start_accelerations(const RigidBodySystem& system, const std::vector<Real>& misfit,
                               const std::vector<Real>& acceleration) {
  const std::string description =
      "no accelerations at t = 0 satisfy it and the other constraints, the residual is";
  const std::string trouble = group_violation(
      system, misfit, kAccelerationGap * rate_scale(system, acceleration), description, description, "/s^2");
  if (!trouble.empty()) throw InputError(trouble);
}

void check_joints_hold(RigidBodySystem& system, const std::vector<Real>& position,
                       const std::vector<Real>& velocity, Real t) {
  check_gaps(system, terms_at(system, position, velocity, t).constraint, kRunningGap, t);
}

std::string near_singular(RigidBodySystem& system, const std::vector<Real>& position, Real t) {
  constexpr Real kNear = 1e-3;  // of rows of length 1
  const std::vector<Real> zero_velocity(at(system.coordinates()), 0);
  const SystemTerms terms = terms_at(system, position, zero_velocity, t);
  const std::vector<Dependency> repeated = redundant_rows(system, terms.constraint_jacobian, kNear);
  return repeated.empty() ? "" : names_of(system, repeated);
}

std::string matrix_failure(const MechanicalSystem& system, const SparsePattern& pattern,
                           std::span<const Real> values) {
  const auto name = [&](int index) {
    const int constraint = index - system.coordinates();
    return constraint < 0 ? system.coordinate_name(index) : system.constraint_name(constraint);
  };
  std::vector<MatrixEntry> entries;
  for (int row = 0; row < pattern.rows(); ++row) {
    for (int k = pattern.row_start[at(row)]; k < pattern.row_start[at(row) + 1]; ++k) {
      if (!std::isfinite(values[at(k)])) return fmt::format("is not finite at {}", name(row));
      entries.push_back({row, pattern.column[at(k)], values[at(k)]});
    }
  }
  std::vector<std::string> names;
  bool bodies = false;
  for (const int column : dependent_columns(pattern.rows(), pattern.rows(), entries)) {
    names.push_back(name(column));
    bodies = bodies || column < system.coordinates();
  }
  if (names.empty()) return "could not be solved, though it is not singular";
  return fmt::format("is singular: {}{}", list_names(names), bodies ? "" : kSingularPosition);
}

}  // namespace scree
