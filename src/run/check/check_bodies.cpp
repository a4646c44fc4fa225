#include "run/check/check_bodies.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "base/index.hpp"
#include "base/mat3.hpp"
#include "mesh/hull_corners.hpp"
#include "model/checks/memory.hpp"
#include "model/data/body_layout.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/mesh_corners.hpp"

namespace scree {

namespace {

constexpr std::int64_t kBodiesShown = 20;

// Mass, centre of mass and inertia of a body made of solids, in the body's frame.
std::string solid_line(const Model& model, const Body& body) {
  const Vec3 c = body.center_of_mass;
  const std::string name = body.in_row
                               ? fmt::format("row \"{}\", each", body.name.substr(0, body.name.rfind('.')))
                               : fmt::format("body \"{}\"", body.name);
  const std::string centre = model.space.dimension == 2
                                 ? fmt::format("({:.6g}, {:.6g})", c.x, c.y)
                                 : fmt::format("({:.6g}, {:.6g}, {:.6g})", c.x, c.y, c.z);
  std::string inertia = fmt::format("{:.6g} kg m^2 about z", body.inertia);
  if (body.kind == BodyKind::spatial) {
    const std::array<Real, 3> principal = principal_values(body.inertia_tensor);
    inertia =
        fmt::format("principal {:.6g}, {:.6g}, {:.6g} kg m^2", principal[0], principal[1], principal[2]);
  }
  return fmt::format("solids         {}: {:.6g} kg, centre of mass {} m, inertia there {}\n", name, body.mass,
                     centre, inertia);
}

// Which surfaces the bodies' meshes have contacts with.
std::string mesh_partners_line(const Model& model) {
  std::int64_t corners = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes)
      if (touches_planes(model, b, shape))
        corners += std::ssize(model.meshes[as_size(shape.mesh)].corners->corners);
  const std::string planes =
      corners == 0 ? "" : fmt::format(", with planes at {}", counted(corners, "corner", "corners"));
  return fmt::format(
      "               their meshes have contacts with particles and with the discs and spheres of other "
      "bodies{}, not with {} and not with each other\n",
      planes, corners == 0 ? "walls" : "triangle walls");
}

std::string solid_lines(const Model& model) {
  std::string lines;
  std::int64_t shown = 0, more = 0;
  const Body* before = nullptr;
  const auto row = [](const Body& body) { return body.name.substr(0, body.name.rfind('.')); };
  for (const Body& body : model.bodies) {
    const bool again = before != nullptr && before->in_row && body.in_row && row(*before) == row(body);
    before = &body;
    if (!body.of_solids || again) continue;
    if (++shown <= kBodiesShown)
      lines += solid_line(model, body);
    else
      ++more;
  }
  return more == 0 ? lines : lines + fmt::format("               and {} more\n", more);
}

}  // namespace

std::string multibody_lines(const Model& model) {
  if (model.bodies.empty()) return "bodies         none\n";
  std::int64_t shapes = 0, meshes = 0, drawn_shapes = 0, drawn_meshes = 0, bare = 0;
  for (const Body& body : model.bodies) {
    shapes += std::ssize(body.shapes), meshes += std::ssize(body.meshes);
    drawn_shapes += std::ssize(body.drawn_shapes), drawn_meshes += std::ssize(body.drawn_meshes);
    bare +=
        body.shapes.empty() && body.meshes.empty() && body.drawn_shapes.empty() && body.drawn_meshes.empty();
  }
  const int coordinates = BodyLayout(model.bodies).columns(), constraints = constraint_count(model);
  const std::int64_t cylinders = std::ranges::count(model.joints, true, &Joint::telescopes);
  const std::int64_t elements =
      std::ssize(model.spring_dampers) + std::ssize(model.torsional_spring_dampers) +
      std::ssize(model.bushings) + std::ssize(model.applied_forces) + std::ssize(model.motors) +
      std::ssize(model.joint_springs) + std::ssize(model.joint_limits) + std::ssize(model.joint_frictions);
  std::string lines =
      fmt::format("bodies         {} with {}{}, {}, {}, {}\n", model.bodies.size(),
                  counted(shapes + drawn_shapes, "shape", "shapes"),
                  meshes + drawn_meshes == 0 ? "" : ", " + counted(meshes + drawn_meshes, "mesh", "meshes"),
                  counted(std::ssize(model.joints) - cylinders, "joint", "joints"),
                  counted(std::ssize(model.drivers), "driver", "drivers"),
                  counted(elements, "force element", "force elements"));
  if (drawn_shapes + drawn_meshes > 0)
    lines += fmt::format("               {}{}{} of these take{} no part in contact detection\n",
                         drawn_shapes == 0 ? "" : counted(drawn_shapes, "shape", "shapes"),
                         drawn_shapes == 0 || drawn_meshes == 0 ? "" : " and ",
                         drawn_meshes == 0 ? "" : counted(drawn_meshes, "mesh", "meshes"),
                         drawn_shapes + drawn_meshes == 1 ? "s" : "");
  if (bare > 0 && !model.walls.empty())
    lines += fmt::format("               {} no shapes{}: {} through walls and ha{} no contacts\n",
                         counted(bare, "body has", "bodies have"), model.meshes.empty() ? "" : " or meshes",
                         bare == 1 ? "it passes" : "they pass", bare == 1 ? "s" : "ve");
  if (meshes > 0) lines += mesh_partners_line(model);
  lines += solid_lines(model);
  lines += fmt::format("unknowns       {} coordinates, {} constraints: ", coordinates, constraints);
  // The number of independent rows needs the rank of the constraint matrix, which the bodies' solver reports.
  if (model.integrator.redundant == RedundantRows::share) return lines + "some may be redundant\n";
  return lines + counted(coordinates - constraints, "degree of freedom", "degrees of freedom") + "\n";
}

std::string history_limit_lines(const Model& model) {
  const Output& output = model.output;
  std::string lines;
  const auto add = [&](std::int64_t recorded, std::int64_t all, const char* what, const char* key) {
    if (recorded == 0 || recorded >= all) return;
    lines += fmt::format("history        without {} of the {} {}: output.{} = {}\n", all - recorded, all,
                         what, key, recorded);
  };
  add(output.history_reactions,
      std::ssize(model.joints) + std::ssize(model.drivers) + std::ssize(model.couplers),
      "joints, drivers and couplers", "history_reactions");
  add(output.history_efforts,
      std::ssize(model.motors) + std::ssize(model.joint_springs) + std::ssize(model.joint_limits) +
          std::ssize(model.joint_frictions),
      "motors, springs, limits and frictions on joints", "history_efforts");
  std::int64_t moving = 0;
  for (const Joint& joint : model.joints) moving += !coordinates_of(joint.kind).empty();
  add(output.history_coordinates, moving, "joints with coordinates", "history_coordinates");
  add(output.history_bushings, std::ssize(model.bushings), "bushings", "history_bushings");
  return lines;
}

}  // namespace scree
