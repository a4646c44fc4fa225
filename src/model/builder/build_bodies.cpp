// Bodies and rows of bodies.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "base/rotation.hpp"
#include "mesh/convex_hull.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/primitives.hpp"
#include "model/builder/build_parts.hpp"
#include "model/builder/make_mesh.hpp"
#include "model/checks/plausibility.hpp"
#include "model/data/body_exchange.hpp"
#include "model/derived/frames.hpp"
#include "model/derived/shape_positions.hpp"
#include "model/derived/touching.hpp"
#include "physics/solid_body.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 1e-9;  // tolerance of the triangle inequality

// Throws InputError where keys that solids determine are given beside solids.
void check_mass_keys(const DeckTable& table, bool spatial) {
  const bool solid = !table.tables("solids").empty();
  const std::string moment = spatial ? "inertia_tensor" : "inertia";
  for (const std::string& key : {std::string("mass"), moment}) {
    if (solid && table.has(key)) table.fail(key, "follows from solids; leave it out");
    if (!solid && !table.has(key)) table.fail(key, "missing; without solids it must be given");
  }
  for (const char* key : {"center_of_mass", "inertia_quaternion", "inertia_rotation_axis",
                          "inertia_rotation_angle", "inertia_x_axis", "inertia_z_axis"})
    if (solid && table.has(key)) table.fail(key, "follows from solids; leave it out");
}

MassProperties hull_mass(const DeckTable& table, const TriangleMesh& mesh, Real density) {
  try {
    return solid_mesh_mass(convex_hull(mesh.vertices), density);
  } catch (const InputError& error) {
    table.fail("inertia", error.what());
  }
}

const NamedMesh& mesh_of(const DeckTable& solid, const ModelNames& names) {
  return names.triangles[static_cast<std::size_t>(find_name(names.meshes, solid, "mesh", "mesh"))];
}

MassProperties mesh_mass(const DeckTable& table, const ModelNames& names, Real density) {
  const auto& [mesh, sheet, line, crossing] = mesh_of(table, names);
  const MeshInertia kind = table.choice<MeshInertia>("inertia");
  if (sheet && kind == MeshInertia::exact)
    table.fail("mesh",
               "is an open surface, which encloses no volume; inertia = \"convex\" or \"shell\", or give the "
               "body's mass and inertia instead");
  if (!crossing.empty() && kind == MeshInertia::exact)
    table.fail(
        "mesh",
        fmt::format("{}, and the volume that two of them share would count twice: unite the shells in the "
                    "program that wrote the file, or leave solids out and give the body's mass and inertia",
                    crossing));
  if ((kind == MeshInertia::shell) != table.has("thickness"))
    table.fail("thickness", kind == MeshInertia::shell ? "missing; inertia is \"shell\""
                                                       : "not used without inertia = \"shell\"");
  if (!line && table.has("depth")) table.fail("depth", "is for lines, in 2D; this mesh has its own");
  const auto mass_of = [&](const TriangleMesh& whole) {
    switch (kind) {
      case MeshInertia::shell:
        return shell_mesh_mass(line ? without_ends(whole) : whole, density * table.real("thickness"));
      case MeshInertia::convex:
        return hull_mass(table, whole, density);
      case MeshInertia::exact:
        break;
    }
    return solid_mesh_mass(whole, density);
  };
  if (!line) return mass_of(mesh);
  MassProperties mass = mass_of(line_of_depth(mesh, table.has("depth") ? table.real("depth") : 1));
  mass.center.z = 0;  // by symmetry; round-off would lift the body off the plane
  return mass;
}

Real density_of(const DeckTable& table, const ModelNames& names) {
  const int material = table.has("density") ? 0 : find_material(names, table, "material");
  const Real density =
      table.has("density") ? table.real("density") : names.densities[static_cast<std::size_t>(material)];
  if (density == 0) table.fail("density", "missing; the material has none, either");
  return density;
}

// Mass properties about the solid's own centre, along the axes of the body's frame.
MassProperties solid_of(const DeckTable& table, const ModelNames& names) {
  const Real density = density_of(table, names);
  const auto own = [&]() -> MassProperties {
    switch (table.choice<SolidKind>("kind")) {
      case SolidKind::sphere:
        return solid_sphere(density, table.real("radius"));
      case SolidKind::cylinder:
        return solid_cylinder(density, table.real("radius"), table.real("length"));
      case SolidKind::capsule:
        return solid_capsule(density, table.real("radius"), table.real("length"));
      case SolidKind::mesh:
        return mesh_mass(table, names, density);
      case SolidKind::box:
        break;
    }
    const std::vector<Real>& size = table.reals("size");
    return solid_box(density, {size[0], size[1], size[2]});
  }();
  if (!std::isnormal(own.mass) || !std::isnormal(own.inertia.zz) || !std::isnormal(own.inertia.xx))
    table.fail(table.has("depth") ? "depth" : "kind",
               "its mass or its inertia is beyond what a number holds");
  const Mat3 axes = rotation_matrix(read_orientation(table));
  if (table.choice<SolidKind>("kind") == SolidKind::mesh && mesh_of(table, names).line)
    check_rotated_about_z(table, axes);
  return {own.mass, table.vector("offset") + axes * own.center, rotated_tensor(axes, own.inertia)};
}

// Throws InputError unless the tensor is positive definite and no principal moment exceeds the sum of the
// other two.
Real check_inertia(const DeckTable& table, const std::string& key, const Sym3& tensor) {
  const std::array<Real, 3> principal = principal_values(tensor);
  const std::string found = fmt::format("the principal moments are {:.6g}, {:.6g} and {:.6g} kg m^2",
                                        principal[0], principal[1], principal[2]);
  if (!(principal[0] > 0)) table.fail(key, found + "; all must be positive");
  if (principal[2] > (principal[0] + principal[1]) * (1 + kRoundOff))
    table.fail(key, found + "; none may be larger than the sum of the other two, which holds for any body");
  return principal[0];
}

Sym3 read_inertia(const DeckTable& table) {
  const std::vector<Real>& j = table.reals("inertia_tensor");
  const Sym3 given{j[0], j[3], j[4], j[1], j[5], j[2]};
  const Quaternion axes = read_orientation(table, "inertia_");
  return axes.w == 1 ? given : rotated_tensor(rotation_matrix(axes), given);
}

// Reads mass, centre of mass and inertia.
void read_mass(const DeckTable& table, const ModelNames& names, Body& body) {
  const bool spatial = body.kind == BodyKind::spatial;
  check_mass_keys(table, spatial);
  if (!table.tables("solids").empty()) {
    std::vector<MassProperties> parts;
    for (const DeckTable& solid : table.tables("solids")) parts.push_back(solid_of(solid, names));
    const MassProperties whole = composed(parts);
    body.of_solids = true;
    body.mass = whole.mass, body.center_of_mass = whole.center, body.inertia_tensor = whole.inertia;
    body.inertia = spatial ? check_inertia(table, "solids", whole.inertia) : whole.inertia.zz;
    if (!std::isnormal(body.inertia))
      table.fail("solids", "the moment of inertia is beyond what a number holds");
    return;
  }
  body.mass = table.real("mass");
  check_normal(table, "mass", body.mass);
  if (table.has("center_of_mass")) body.center_of_mass = table.vector("center_of_mass");
  if (!spatial) {
    body.inertia = table.real("inertia");
    check_normal(table, "inertia", body.inertia);
    return;
  }
  body.inertia_tensor = read_inertia(table);
  body.inertia = check_inertia(table, "inertia_tensor", body.inertia_tensor);
}

void read_planar(const DeckTable& table, Body& body) {
  body.angle = table.real("angle");
  body.angular_velocity = table.real("angular_velocity");
  if (body.velocity.z != 0)
    table.fail("velocity", "planar bodies move in the x-y plane; the z component must be 0");
}

void read_spatial(const DeckTable& table, Body& body) {
  body.orientation = read_orientation(table);
  if (table.has("body_angular_velocity") && table.has("global_angular_velocity"))
    table.fail("global_angular_velocity", "not used together with body_angular_velocity");
  if (table.has("body_angular_velocity")) body.spin = table.vector("body_angular_velocity");
  if (table.has("global_angular_velocity"))
    body.spin = transposed_times(rotation_matrix(body.orientation), table.vector("global_angular_velocity"));
}

// Moves the body's points from the origin of its frame to the centre of mass.
void move_to_center(Body& body) {
  if (body.center_of_mass == Vec3{}) return;
  const PointMotion center = point_motion(start_motion(body), body.center_of_mass);
  body.position = center.position, body.velocity = center.velocity;
}

// Material of a shape or mesh of a body; not needed where it takes no part in contact.
int surface_material(const ModelNames& names, const DeckTable& surface, bool collides) {
  const bool needed = collides || surface.has("material") || names.materials.size() == 1;
  return needed ? find_material(names, surface, "material") : kNoMaterial;
}

void add_shapes(const DeckTable& table, const ModelNames& names, int dimension, Body& body) {
  std::set<std::tuple<Real, Real, Real, Real>> circles;
  for (const DeckTable& shape : table.tables("shapes")) {
    const Real radius = shape.real("radius");
    check_normal(shape, "radius", radius);
    const bool touches = collides(table, shape);
    const int material = surface_material(names, shape, touches);
    std::vector<Shape>& shapes = touches ? body.shapes : body.drawn_shapes;
    ShapePositions(shape, dimension).for_each([&](Vec3 place) {
      if (!circles.insert({place.x, place.y, place.z, radius}).second)
        shape.fail("radius",
                   "the body has a shape of this offset and radius already; each must be another one");
      shapes.push_back({place - body.center_of_mass, radius, material});
    });
  }
}

void add_meshes(const DeckTable& table, const ModelNames& names, Body& body) {
  for (const DeckTable& mesh : table.tables("meshes")) {
    const int number = find_name(names.meshes, mesh, "mesh", "mesh");
    for (const std::vector<MeshShape>* known : {&body.meshes, &body.drawn_meshes})
      if (std::ranges::find(*known, number, &MeshShape::mesh) != known->end())
        mesh.fail("mesh", "the body has this mesh already; each must be another one");
    const bool touches = collides(table, mesh);
    std::vector<MeshShape>& meshes = touches ? body.meshes : body.drawn_meshes;
    meshes.push_back({-body.center_of_mass, number, surface_material(names, mesh, touches)});
  }
}

Body body_of(const DeckTable& table, const ModelNames& names, int dimension) {
  Body body;
  body.kind = table.choice<BodyKind>("kind");
  body.position = table.vector("position");
  body.velocity = table.vector("velocity");
  const bool spatial = body.kind == BodyKind::spatial;
  if (spatial && dimension != 3) table.fail("kind", "\"spatial\" needs space.dimension = 3");
  read_mass(table, names, body);
  spatial ? read_spatial(table, body) : read_planar(table, body);
  move_to_center(body);
  add_shapes(table, names, dimension, body);
  add_meshes(table, names, body);
  return body;
}

// Records the mass of solids that are meshes, for the report.
void note_mesh_solids(const DeckTable& body, const ModelNames& names, Model& model) {
  for (const DeckTable& solid : body.tables("solids")) {
    if (solid.choice<SolidKind>("kind") != SolidKind::mesh) continue;
    const auto mesh = static_cast<std::size_t>(find_name(names.meshes, solid, "mesh", "mesh"));
    const Real mass = mesh_mass(solid, names, density_of(solid, names)).mass;
    std::vector<Real>& masses = model.meshes[mesh].solid_masses;
    if (std::ranges::find(masses, mass) == masses.end()) masses.push_back(mass);
  }
}

}  // namespace

void build_bodies(const DeckTable& deck, Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("bodies")) {
    const std::string& name = table.text("name");
    if (name == kGroundName) table.fail("name", "\"ground\" is the fixed frame; choose another name");
    const Body first = body_of(table, names, model.space.dimension);
    note_mesh_solids(table, names, model);
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
