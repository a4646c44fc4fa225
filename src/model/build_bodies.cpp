// Bodies and rows of bodies.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "base/rotation.hpp"
#include "model/build_parts.hpp"
#include "model/plausibility.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 1e-9;    // of the triangle rule
constexpr Real kUnitLength = 1e-6;  // of a quaternion

void read_planar(const DeckTable& table, Body& body) {
  body.inertia = table.real("inertia");
  check_normal(table, "inertia", body.inertia);
  body.angle = table.real("angle");
  body.angular_velocity = table.real("angular_velocity");
  if (body.velocity.z != 0)
    table.fail("velocity", "planar bodies move in the x-y plane; the z component must be 0");
}

// Positive definite, and no principal moment above the sum of the other two: as of any body with mass.
void read_inertia(const DeckTable& table, Body& body) {
  const std::vector<Real>& j = table.reals("inertia_tensor");
  body.inertia_tensor = {j[0], j[3], j[4], j[1], j[5], j[2]};
  const std::array<Real, 3> principal = principal_values(body.inertia_tensor);
  const std::string found = fmt::format("the principal moments are {:.6g}, {:.6g} and {:.6g} kg m^2",
                                        principal[0], principal[1], principal[2]);
  if (!(principal[0] > 0)) table.fail("inertia_tensor", found + "; all must be positive");
  if (principal[2] > (principal[0] + principal[1]) * (1 + kRoundOff))
    table.fail("inertia_tensor",
               found + "; none may be larger than the sum of the other two, which holds for any body");
  body.inertia = principal[0];
}

Quaternion read_orientation(const DeckTable& table) {
  const bool axis = table.has("rotation_axis");
  if (axis != table.has("rotation_angle"))
    table.fail(axis ? "rotation_axis" : "rotation_angle", "rotation_axis and rotation_angle go together");
  if (axis && table.has("quaternion"))
    table.fail("quaternion", "not used together with rotation_axis and rotation_angle");
  if (axis) {
    const Vec3 along = table.vector("rotation_axis");
    if (norm(along) == 0) table.fail("rotation_axis", "must not be 0");
    return exponential((table.real("rotation_angle") / norm(along)) * along);
  }
  if (!table.has("quaternion")) return {};
  const std::vector<Real>& e = table.reals("quaternion");
  const Quaternion given{e[0], e[1], e[2], e[3]};
  if (!(std::abs(norm(given) - 1) < kUnitLength))
    table.fail("quaternion",
               fmt::format("must be of length 1, to {:g}; it is {:.9g}", kUnitLength, norm(given)));
  return normalized(given);
}

void read_spatial(const DeckTable& table, Body& body) {
  read_inertia(table, body);
  body.orientation = read_orientation(table);
  if (table.has("body_angular_velocity") && table.has("global_angular_velocity"))
    table.fail("global_angular_velocity", "not used together with body_angular_velocity");
  if (table.has("body_angular_velocity")) body.spin = table.vector("body_angular_velocity");
  if (table.has("global_angular_velocity"))
    body.spin = transposed_times(rotation_matrix(body.orientation), table.vector("global_angular_velocity"));
}

Body body_of(const DeckTable& table, const ModelNames& names, int dimension) {
  Body body;
  body.kind = table.choice<BodyKind>("kind");
  body.mass = table.real("mass");
  check_normal(table, "mass", body.mass);
  body.position = table.vector("position");
  body.velocity = table.vector("velocity");
  const bool spatial = body.kind == BodyKind::spatial;
  if (spatial && dimension != 3) table.fail("kind", "\"spatial\" needs space.dimension = 3");
  spatial ? read_spatial(table, body) : read_planar(table, body);
  std::set<std::tuple<Real, Real, Real, Real>> circles;
  for (const DeckTable& shape : table.tables("shapes")) {
    const Vec3 offset = shape.vector("offset");
    const Real radius = shape.real("radius");
    check_normal(shape, "radius", radius);
    if (!circles.insert({offset.x, offset.y, offset.z, radius}).second)
      shape.fail("radius",
                 "the body has a shape of this offset and radius already; each must be another one");
    body.shapes.push_back({offset, radius, find_material(names, shape, "material")});
  }
  return body;
}

}  // namespace

Vec3 turned_at_start(const DeckTable& body, Vec3 local) {
  if (body.choice<BodyKind>("kind") == BodyKind::planar) return Rotation(body.real("angle")).turn(local);
  return rotation_matrix(read_orientation(body)) * local;
}

void build_bodies(const DeckTable& deck, Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("bodies")) {
    const std::string& name = table.text("name");
    if (name == "ground") table.fail("name", "\"ground\" is the fixed frame; choose another name");
    const Body first = body_of(table, names, model.space.dimension);
    const bool row = table.has("count");
    const Vec3 spacing = table.vector("spacing");
    const std::int64_t count = row ? table.integer("count") : 1;
    if (!row && norm(spacing) > 0)
      table.fail("spacing", "a single body has no spacing; give count for a row");
    for (std::int64_t i = 0; i < count; ++i) {
      Body body = first;
      body.in_row = row;
      body.name = row ? fmt::format("{}.{}", name, i) : name;
      body.position += static_cast<Real>(i) * spacing;
      const int index = static_cast<int>(model.bodies.size());
      add_name(names.bodies, body.name, index, table);
      names.rows[name].push_back(index);
      model.bodies.push_back(std::move(body));
    }
  }
}

}  // namespace scree
