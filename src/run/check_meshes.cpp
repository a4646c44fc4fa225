#include "run/check_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_shells.hpp"
#include "model/memory.hpp"
#include "model/mesh_plausibility.hpp"

namespace scree {

namespace {

constexpr std::size_t kMeshesShown = 20;

TriangleMesh triangles_of(const SurfaceMesh& surface) {
  TriangleMesh mesh{surface.vertices, {}};
  for (const MeshTriangle& t : surface.triangles)
    mesh.triangles.push_back({t.vertex[0], t.vertex[1], t.vertex[2]});
  return mesh;
}

std::string size_text(const SurfaceMesh& surface) {
  const TriangleMesh mesh = triangles_of(surface);
  const Vec3 low = surface.box.min, high = surface.box.max;
  const std::vector<Index> shells = shells_of(mesh);
  const std::string area = fmt::format("area {:.6g} m^2", mesh_area(mesh));
  return fmt::format("{}, {}, {}, {}; ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) m, {}{}",
                     counted(std::ssize(mesh.triangles), "triangle", "triangles"),
                     counted(std::ssize(mesh.vertices), "vertex", "vertices"),
                     counted(*std::ranges::max_element(shells) + 1, "shell", "shells"),
                     surface.sheet ? "a sheet" : "closed", low.x, low.y, low.z, high.x, high.y, high.z, area,
                     surface.sheet ? "" : fmt::format(", volume {:.6g} m^3", mesh_volume(mesh)));
}

// A segment is drawn along z as two triangles, of which nobody need know.
std::string line_text(const SurfaceMesh& surface) {
  const Vec3 low = surface.box.min, high = surface.box.max;
  const Real depth = high.z - low.z;
  return fmt::format("{}, {}; ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m, length {:.6g} m",
                     counted(std::ssize(surface.triangles) / 2, "segment", "segments"),
                     surface.sheet ? "two sides" : "closed", low.x, low.y, high.x, high.y,
                     mesh_area(triangles_of(surface)) / depth);
}

std::string mass_text(const ModelMesh& mesh) {
  std::string text;
  for (const Real mass : mesh.solid_masses)
    text += fmt::format("{}{:.6g} kg", text.empty() ? ", as a solid " : " or ", mass);
  return text;
}

std::string coarser_line(const ModelMesh& mesh) {
  if (mesh.triangles_before == 0) return "";
  return fmt::format("               made coarser, from {} triangles, which are up to {:.3g} m beside it\n",
                     mesh.triangles_before, mesh.moved);
}

std::string curvature_line(const Model& model, const ModelMesh& mesh) {
  const MeshCurvature& curvature = mesh.surface->curvature;
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (curvature.concave_radius < kInfinity)
    add(fmt::format("least concave radius about {:.3g} m", curvature.concave_radius));
  if (curvature.sag > 0) add(fmt::format("facets up to {:.3g} m beside their curve", curvature.sag));
  const Real radius = model.particles.totals.largest_radius;
  if (radius > 0)
    add(fmt::format("a particle of {:.4g} m that touches it is near about {:.2g} {}", radius,
                    triangles_near(model, *mesh.surface, radius),
                    model.space.dimension == 2 ? "segments" : "triangles"));
  return text.empty() ? "" : fmt::format("               {}\n", text);
}

}  // namespace

std::string mesh_lines(const Model& model) {
  std::string lines;
  const bool planar = model.space.dimension == 2;
  for (std::size_t m = 0; m < std::min(model.meshes.size(), kMeshesShown); ++m) {
    const ModelMesh& mesh = model.meshes[m];
    lines += fmt::format("mesh           \"{}\": {}{}\n", mesh.name,
                         planar ? line_text(*mesh.surface) : size_text(*mesh.surface), mass_text(mesh)) +
             coarser_line(mesh) + curvature_line(model, mesh);
  }
  if (model.meshes.size() > kMeshesShown)
    lines += fmt::format("               and {} more\n", model.meshes.size() - kMeshesShown);
  return lines;
}

}  // namespace scree
