#include "model/derived/joint_coordinates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "model/derived/connections.hpp"

namespace scree {

namespace {

std::string missing(const Joint& joint, JointCoordinate wanted) {
  const std::vector<JointCoordinate> own = coordinates_of(joint.kind);
  return fmt::format("joint \"{}\" is a {} joint and has no {}{}", joint.name, word_of(joint.kind),
                     word_of(wanted), own.empty() ? "" : ", but " + listed(own));
}

}  // namespace

std::vector<JointCoordinate> coordinates_of(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
      return {JointCoordinate::angle};
    case JointKind::translational:
      return {JointCoordinate::displacement};
    case JointKind::cylindrical:
    case JointKind::screw:
      return {JointCoordinate::angle, JointCoordinate::displacement};
    case JointKind::distance:
      return {JointCoordinate::length};
    case JointKind::universal:
      return {JointCoordinate::angle_1, JointCoordinate::angle_2};
    default:
      return {};
  }
}

bool has_coordinate(JointKind kind, JointCoordinate coordinate) {
  return std::ranges::count(coordinates_of(kind), coordinate) > 0;
}

bool is_angle(JointCoordinate coordinate) {
  return coordinate != JointCoordinate::displacement && coordinate != JointCoordinate::length;
}

std::string listed(const std::vector<JointCoordinate>& coordinates) {
  std::vector<std::string> words;
  for (const JointCoordinate c : coordinates) words.push_back((is_angle(c) ? "an " : "a ") + word_of(c));
  return fmt::format("{}", fmt::join(words, " and "));
}

bool needs_choice(JointKind kind) { return coordinates_of(kind).size() > 1 && kind != JointKind::screw; }

JointCoordinate coordinate_of(const std::string& title, const Joint& joint,
                              std::optional<JointCoordinate> wanted) {
  const std::vector<JointCoordinate> own = coordinates_of(joint.kind);
  if (own.empty())
    throw InputError(
        fmt::format("{}: joint '{}' is {} and has no coordinate; allowed are revolute, "
                    "translational, cylindrical, screw, universal and distance joints",
                    title, joint.name, word_of(joint.kind)));
  if (wanted && !has_coordinate(joint.kind, *wanted))
    throw InputError(fmt::format("{}: {}", title, missing(joint, *wanted)));
  return wanted.value_or(own.front());
}

JointCoordinate read_coordinate(const DeckTable& table, const Joint& joint) {
  const std::vector<JointCoordinate> own = coordinates_of(joint.kind);
  if (table.has("coordinate")) {
    const auto wanted = table.choice<JointCoordinate>("coordinate");
    if (!has_coordinate(joint.kind, wanted)) table.fail("coordinate", missing(joint, wanted));
    return wanted;
  }
  if (needs_choice(joint.kind))
    table.fail("coordinate", fmt::format("missing; joint \"{}\" is a {} joint and has {}: name one of them",
                                         joint.name, word_of(joint.kind), listed(own)));
  return own.front();
}

std::vector<JointCoordinate> rotational_coordinates(const Model& model, const Joint& joint) {
  if (between(model, joint.body) != BodyKind::spatial) return {};
  std::vector<JointCoordinate> angles = coordinates_of(joint.kind);
  std::erase_if(angles, [](JointCoordinate c) { return !is_angle(c); });
  return angles;
}

int counted_angles(const Model& model) {
  std::size_t count = 0;
  for (const Joint& joint : model.joints) count += rotational_coordinates(model, joint).size();
  return static_cast<int>(count);
}

}  // namespace scree
