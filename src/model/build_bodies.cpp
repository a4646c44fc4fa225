// Bodies and rows of bodies.
#include <fmt/format.h>

#include <set>
#include <tuple>

#include "model/build_parts.hpp"
#include "model/plausibility.hpp"

namespace scree {

namespace {

Body body_of(const DeckTable& table, const ModelNames& names) {
  Body body;
  body.mass = table.real("mass");
  body.inertia = table.real("inertia");
  for (const char* key : {"mass", "inertia"}) check_normal(table, key, table.real(key));
  body.position = table.vector("position");
  body.angle = table.real("angle");
  body.velocity = table.vector("velocity");
  body.angular_velocity = table.real("angular_velocity");
  if (body.velocity.z != 0) table.fail("velocity", "bodies move in the x-y plane; the z component must be 0");
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

void build_bodies(const DeckTable& deck, Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("bodies")) {
    const std::string& name = table.text("name");
    if (name == "ground") table.fail("name", "\"ground\" is the fixed frame; choose another name");
    const Body first = body_of(table, names);
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
