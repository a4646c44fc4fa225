// Motors, springs, limits and friction on joints, and couplers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/builder/build_parts.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/time_functions.hpp"

namespace scree {

namespace {

const Joint& joint_at(const Model& model, int joint) { return model.joints[static_cast<std::size_t>(joint)]; }

// "revolute, translational, cylindrical or screw": the kinds of joints between these bodies with this
// coordinate, or with any.
std::string kinds_with(const Model& model, int joint, std::optional<JointCoordinate> coordinate) {
  const bool spatial = between(model, joint_at(model, joint).body) == BodyKind::spatial;
  const std::string both = spatial ? ", cylindrical or screw" : "";
  if (coordinate == JointCoordinate::angle) return "revolute" + both;
  if (coordinate == JointCoordinate::displacement) return "translational" + both;
  return spatial ? "revolute, translational, cylindrical, screw or universal" : "revolute or translational";
}

int moving_joint(const DeckTable& table, const Model& model, const ModelNames& names, const std::string& name,
                 const std::string& key) {
  const int joint = find_name(names.joints, name, table, key, "joint");
  const JointKind kind = joint_at(model, joint).kind;
  const bool keeps_distance = kind == JointKind::distance && !joint_at(model, joint).telescopes;
  if (coordinates_of(kind).empty() || keeps_distance)
    table.fail(key, fmt::format("joint \"{}\" is a {} joint; it must be {}, or a cylinder", name,
                                word_of(kind), kinds_with(model, joint, {})));
  return joint;
}

// The joint that the table names, or all joints of the row that it names.
std::vector<int> moving_joints(const DeckTable& table, const Model& model, const ModelNames& names) {
  const std::string& name = table.text("joint");
  const auto of_row = [&](std::size_t i) { return fmt::format("{}.{}", name, i); };
  std::vector<int> joints;
  if (names.joints.count(name) == 0)
    while (names.joints.count(of_row(joints.size())) > 0)
      joints.push_back(moving_joint(table, model, names, of_row(joints.size()), "joint"));
  if (joints.empty()) joints.push_back(moving_joint(table, model, names, name, "joint"));
  return joints;
}

// Adds element(joint) for every joint of the table; for a row of joints they are named NAME.0, NAME.1, ...
template <class Element, class Build>
void add_elements(const DeckTable& table, const Model& model, const ModelNames& names, NameMap& taken,
                  std::vector<Element>& out, const Build& build) {
  const std::vector<int> joints = moving_joints(table, model, names);
  const bool row = names.joints.count(table.text("joint")) == 0;
  const Element element = build(table);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    out.push_back(element);
    out.back().name = row ? fmt::format("{}.{}", table.text("name"), i) : table.text("name");
    out.back().joint = joints[i];
    out.back().coordinate = read_coordinate(table, joint_at(model, joints[i]));
    add_name(taken, out.back().name, 0, table);
  }
}

Motor build_motor(const DeckTable& table) {
  Motor motor;
  motor.kind = table.choice<MotorKind>("type");
  if (table.has("limit")) motor.limit = table.real("limit");
  switch (motor.kind) {
    case MotorKind::effort:
      motor.effort = build_force(table.table("effort"));
      break;
    case MotorKind::line:
      motor.stall_effort = table.real("stall_effort");
      motor.free_rate = table.real("free_rate");
      motor.command = build_force(table.table("command"));
      break;
    case MotorKind::speed:
      motor.rate = build_force(table.table("rate"));
      motor.gain = table.real("gain");
      motor.integral_gain = table.real("integral_gain");
      break;
    case MotorKind::position:
      motor.position = build_motion(table.table("position"));
      motor.position_gain = table.real("position_gain");
      motor.rate_gain = table.real("rate_gain");
      break;
  }
  return motor;
}

Curve build_curve(const DeckTable& table, const std::string& at, const std::string& values) {
  Curve curve;
  if (!table.has(at) && !table.has(values)) return curve;
  for (const std::string& key : {at, values})
    if (!table.has(key))
      table.fail(key, fmt::format("{} and {} belong together: one is missing", at, values));
  curve.at = table.reals(at), curve.values = table.reals(values);
  curve.interpolation = table.choice<Interpolation>("interpolation");
  if (curve.interpolation == Interpolation::clamped)
    table.fail("interpolation", "allowed for a spring on a joint: linear, natural, monotone");
  if (curve.at.size() < 2) table.fail(at, "must have two entries at least");
  if (curve.at.size() != curve.values.size())
    table.fail(values, fmt::format("must have {} entries, as {}", curve.at.size(), at));
  for (std::size_t i = 1; i < curve.at.size(); ++i)
    if (!(curve.at[i] > curve.at[i - 1]))
      table.fail(at, fmt::format("must increase; entry {} is {} after {}", i, curve.at[i], curve.at[i - 1]));
  return curve;
}

JointSpring build_spring(const DeckTable& table) {
  JointSpring spring;
  spring.stiffness = table.real("stiffness");
  spring.damping = table.real("damping");
  if (table.has("free_coordinate")) spring.free = table.real("free_coordinate");
  spring.elastic = build_curve(table, "coordinates", "elastic_efforts");
  spring.dissipative = build_curve(table, "rates", "damping_efforts");
  return spring;
}

JointLimit build_limit(const DeckTable& table) {
  JointLimit limit;
  if (!table.has("lower") && !table.has("upper")) table.fail("name", "a limit needs lower, upper or both");
  if (table.has("lower")) limit.lower = table.real("lower");
  if (table.has("upper")) limit.upper = table.real("upper");
  if (!(limit.lower < limit.upper)) table.fail("upper", fmt::format("must be above lower = {}", limit.lower));
  limit.stiffness = table.real("stiffness");
  limit.damping = table.real("damping");
  limit.exponent = table.real("exponent");
  return limit;
}

JointFriction build_friction(const DeckTable& table) {
  JointFriction friction;
  friction.effort = table.real("effort");
  friction.lever = table.real("friction_coefficient") * (table.has("radius") ? table.real("radius") : 1);
  if (friction.effort == 0 && friction.lever == 0)
    table.fail("name", "friction needs effort or friction_coefficient, above 0");
  friction.stiffness = table.real("stiffness");
  friction.damping = table.real("damping");
  friction.static_ratio = table.real("static_ratio");
  if ((friction.static_ratio > 1) != table.has("stribeck_rate"))
    table.fail("stribeck_rate", "static_ratio above 1 and stribeck_rate belong together");
  if (table.has("stribeck_rate")) friction.stribeck_rate = table.real("stribeck_rate");
  return friction;
}

// Checks the radius: an angle needs one, a displacement has none.
void check_radius(const DeckTable& table, const Joint& joint) {
  const bool turns = is_angle(read_coordinate(table, joint)),
             has_friction = table.real("friction_coefficient") > 0;
  if (joint.telescopes && has_friction)
    table.fail(
        "friction_coefficient",
        fmt::format("not used; cylinder \"{}\" carries no force across its line: give effort", joint.name));
  if (turns && has_friction && !table.has("radius"))
    table.fail(
        "radius",
        fmt::format("missing; the coordinate of joint \"{}\" is an angle, and friction_coefficient acts "
                    "at the radius of its pin",
                    joint.name));
  if (table.has("radius") && !(turns && has_friction))
    table.fail("radius", turns ? "not used without friction_coefficient"
                               : fmt::format("not used; joint \"{}\" slides", joint.name));
}

void take_coordinates(const DeckTable& table, const Model& model, Coupler& coupler,
                      const std::vector<JointCoordinate>& wanted) {
  if (coupler.joints.size() != wanted.size())
    table.fail("joints", fmt::format("must have {} entries for this type", wanted.size()));
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if (const int joint = coupler.joints[k]; !has_coordinate(joint_at(model, joint).kind, wanted[k]))
      table.fail("joints", fmt::format("joint \"{}\" must be {} here", joint_at(model, joint).name,
                                       kinds_with(model, joint, wanted[k])));
  coupler.coordinates = wanted;
}

// Reads the coordinates of a sum, which may be any.
void read_coordinates(const DeckTable& table, const Model& model, Coupler& coupler) {
  if (coupler.joints.size() < 2 || coupler.joints.size() > 3)
    table.fail("joints", "must have 2 or 3 entries");
  const auto fail = [&](const std::string& problem) { table.fail("coordinates", problem); };
  if (!table.has("coordinates")) {
    for (const int joint : coupler.joints) {
      const Joint& one = joint_at(model, joint);
      if (needs_choice(one.kind))
        fail(
            fmt::format("missing; joint \"{}\" is a {} joint and has {}: give a list with one of them, and "
                        "one for each of the others",
                        one.name, word_of(one.kind), listed(coordinates_of(one.kind))));
      coupler.coordinates.push_back(coordinates_of(one.kind).front());
    }
    return;
  }
  const std::vector<std::string>& words = table.texts("coordinates");
  if (words.size() != coupler.joints.size())
    fail(fmt::format("must have {} entries, as joints", coupler.joints.size()));
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (const auto known = words_of<JointCoordinate>(); !std::ranges::count(known, words[k]))
      fail(fmt::format("\"{}\" must be one of \"{}\"", words[k], fmt::join(known, "\", \"")));
    const Joint& joint = joint_at(model, coupler.joints[k]);
    coupler.coordinates.push_back(value_of<JointCoordinate>(words[k]));
    if (!has_coordinate(joint.kind, coupler.coordinates.back()))
      fail(
          fmt::format("joint \"{}\" is a {} joint and has no {}", joint.name, word_of(joint.kind), words[k]));
  }
}

Real ratio_of(const DeckTable& table) {
  const std::vector<Real>& radii = table.reals("radii");
  for (const Real radius : radii)
    if (!(radius > 0)) table.fail("radii", "must be above 0");
  return radii[1] / radii[0];
}

// Coefficients of the coupler; also sets the coordinates.
std::vector<Real> coefficients_of(const DeckTable& table, const Model& model, Coupler& coupler) {
  constexpr JointCoordinate turns = JointCoordinate::angle, slides = JointCoordinate::displacement;
  switch (table.choice<CouplerKind>("type")) {
    case CouplerKind::gear:
      take_coordinates(table, model, coupler, {turns, turns});
      return {1, table.boolean("internal") ? -ratio_of(table) : ratio_of(table)};
    case CouplerKind::belt:
      take_coordinates(table, model, coupler, {turns, turns});
      return {1, -ratio_of(table)};
    case CouplerKind::rack_and_pinion:
      take_coordinates(table, model, coupler, {turns, slides});
      if (table.real("radius") == 0) table.fail("radius", "must not be 0");
      return {-table.real("radius"), 1};
    case CouplerKind::differential:
      take_coordinates(table, model, coupler, {turns, turns, turns});
      return {1, 1, -2};
    case CouplerKind::sum:
      break;
  }
  read_coordinates(table, model, coupler);
  const std::vector<Real>& coefficients = table.reals("coefficients");
  if (coefficients.size() != coupler.joints.size())
    table.fail("coefficients", fmt::format("must have {} entries, as joints", coupler.joints.size()));
  for (const Real coefficient : coefficients)
    if (coefficient == 0) table.fail("coefficients", "must not be 0");
  return coefficients;
}

Coupler build_coupler(const DeckTable& table, const Model& model, const ModelNames& names) {
  Coupler coupler;
  coupler.name = table.text("name"), coupler.deck_label = table.label();
  for (const std::string& name : table.texts("joints"))
    add_once(coupler.joints, moving_joint(table, model, names, name, "joints"), table, "joints",
             fmt::format("\"{}\"", name));
  coupler.coefficients = coefficients_of(table, model, coupler);
  return coupler;
}

}  // namespace

void build_joint_forces(const DeckTable& deck, Model& model, const ModelNames& names) {
  NameMap efforts, reactions = names.joints;  // the history has them in one group of datasets
  for (const Motor& motor : model.motors) efforts.emplace(motor.name, 0);  // those of cylinders
  for (const JointLimit& limit : model.joint_limits) efforts.emplace(limit.name, 0);
  for (const DeckTable& table : deck.tables("motors"))
    add_elements(table, model, names, efforts, model.motors, build_motor);
  for (const DeckTable& table : deck.tables("joint_springs"))
    add_elements(table, model, names, efforts, model.joint_springs, build_spring);
  for (const DeckTable& table : deck.tables("joint_limits"))
    add_elements(table, model, names, efforts, model.joint_limits, build_limit);
  for (const DeckTable& table : deck.tables("joint_frictions")) {
    add_elements(table, model, names, efforts, model.joint_frictions, build_friction);
    check_radius(table, joint_at(model, model.joint_frictions.back().joint));
  }
  for (const Driver& driver : model.drivers) reactions.emplace(driver.name, 0);
  for (const DeckTable& table : deck.tables("couplers")) {
    add_name(reactions, table.text("name"), 0, table);
    model.couplers.push_back(build_coupler(table, model, names));
  }
}

}  // namespace scree
