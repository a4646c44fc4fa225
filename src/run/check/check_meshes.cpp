#include "run/check/check_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_shells.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/checks/memory.hpp"
#include "model/checks/mesh_plausibility.hpp"

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
                     surface.sheet ? "an open surface" : "closed", low.x, low.y, low.z, high.x, high.y,
                     high.z, area,
                     surface.sheet ? "" : fmt::format(", volume {:.6g} m^3", mesh_volume(mesh)));
}

// A line is stored as triangles: each segment is extruded along z into two of them, which the text does not
// mention.
std::string line_text(const SurfaceMesh& surface) {
  const Vec3 low = surface.box.min, high = surface.box.max;
  const Real depth = high.z - low.z;
  return fmt::format("{}, {}; ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m, length {:.6g} m",
                     counted(std::ssize(surface.triangles) / 2, "segment", "segments"),
                     surface.sheet ? "open" : "closed", low.x, low.y, high.x, high.y,
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
  return fmt::format("               simplified from {} triangles, which are at most {:.3g} m away\n",
                     mesh.triangles_before, mesh.moved);
}

// The deviation from the true surface; for files an estimate from the angles between facets.
std::string deviation_text(const ModelMesh& mesh) {
  const SurfaceMesh& surface = *mesh.surface;
  if (mesh.deviation_is_exact)
    return mesh.deviation > 0
               ? fmt::format("facets deviate by up to {:.3g} m from the true surface", mesh.deviation)
               : "";
  const std::string taken = fmt::format("edges of {:.3g} degrees or more count as sharp",
                                        std::acos(surface.cosine) * 180 / std::numbers::pi_v<Real>);
  return mesh.deviation > 0 ? fmt::format(
                                  "facets deviate by up to {:.3g} m from their curve, estimated from the "
                                  "angles between them; {}",
                                  mesh.deviation, taken)
                            : fmt::format("no curve found from the angles between facets; {}", taken);
}

// "segments = 32, from the size of the particles".
std::string fitted_text(const Model& model, const ModelMesh& mesh) {
  if (!mesh.is_fitted) return "";
  if (mesh.fitting.empty()) return "default refinement, as there are no particles";
  return fmt::format("{}, from the smallest particle's radius, {:.4g} m", mesh.fitting,
                     model.particles.totals.smallest_radius);
}

std::string cost_text(const Model& model, const ModelMesh& mesh) {
  const Real radius = model.particles.totals.largest_radius;
  if (!(radius > 0)) return "";
  const SurfaceMesh& surface = *mesh.surface;
  return fmt::format("a particle of {:.4g} m is {:.2g} {} wide; about {:.2g} are near a contact", radius,
                     triangles_wide(model, surface, radius),
                     model.space.dimension == 2 ? "segments" : "triangles",
                     triangles_near(model, surface, radius));
}

std::string facet_lines(const Model& model, const ModelMesh& mesh) {
  const MeshCurvature& curvature = mesh.surface->curvature;
  std::string shape;
  const auto add = [&](const std::string& part) {
    if (!part.empty()) shape += (shape.empty() ? "" : ", ") + part;
  };
  add(fitted_text(model, mesh));
  if (curvature.concave_radius < kInfinity)
    add(fmt::format("least concave radius about {:.3g} m", curvature.concave_radius));
  add(deviation_text(mesh));
  std::string lines;
  for (const std::string& line : {shape, cost_text(model, mesh)})
    if (!line.empty()) lines += fmt::format("               {}\n", line);
  return lines;
}

}  // namespace

std::string mesh_lines(const Model& model) {
  std::string lines;
  const bool planar = model.space.dimension == 2;
  for (std::size_t m = 0; m < std::min(model.meshes.size(), kMeshesShown); ++m) {
    const ModelMesh& mesh = model.meshes[m];
    lines += fmt::format("mesh           \"{}\": {}{}\n", mesh.name,
                         planar ? line_text(*mesh.surface) : size_text(*mesh.surface), mass_text(mesh)) +
             coarser_line(mesh) + facet_lines(model, mesh);
  }
  if (model.meshes.size() > kMeshesShown)
    lines += fmt::format("               and {} more\n", model.meshes.size() - kMeshesShown);
  return lines;
}

}  // namespace scree
