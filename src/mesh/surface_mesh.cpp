#include "mesh/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/mesh_features.hpp"
#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"

namespace scree {

namespace {

constexpr Real kFlatness = 1e-12;  // of a part, relative to the extent of the mesh
constexpr Real kUnits = 8;  // units in the last place of the largest coordinate that count as round-off

const MeshBox kNoBox{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

void extend(MeshBox& box, const MeshBox& other) {
  box.min = {std::min(box.min.x, other.min.x), std::min(box.min.y, other.min.y),
             std::min(box.min.z, other.min.z)};
  box.max = {std::max(box.max.x, other.max.x), std::max(box.max.y, other.max.y),
             std::max(box.max.z, other.max.z)};
}

// Boxes of groups of kTreeWidth consecutive boxes.
std::vector<MeshBox> grouped(const std::vector<MeshBox>& boxes) {
  std::vector<MeshBox> groups;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i % kTreeWidth == 0) groups.push_back(kNoBox);
    extend(groups.back(), boxes[i]);
  }
  return groups;
}

void build_tree(SurfaceMesh& mesh) {
  std::vector<MeshBox> level;
  for (const MeshTriangle& triangle : mesh.triangles) {
    level.push_back(kNoBox);
    for (const Index v : triangle.vertex) extend(level.back(), {mesh.vertices[v], mesh.vertices[v]});
  }
  mesh.level_start = {0};
  do {
    level = grouped(level);
    mesh.boxes.insert(mesh.boxes.end(), level.begin(), level.end());
    mesh.level_start.push_back(static_cast<Index>(mesh.boxes.size()));
  } while (level.size() > 1);
  mesh.box = mesh.boxes.back();
}

Real largest(Vec3 a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

// Largest distance of a vertex from the plane of its part [m]. The plane of a single triangle is only as
// good as its normal; with a sliver it may be off by more than the tolerance of parts.
Real farthest_from_plane(const TriangleMesh& mesh, const MeshParts& parts) {
  Real farthest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const MeshPart& part = parts.parts[static_cast<std::size_t>(parts.part_of[t])];
    for (const Index v : mesh.triangles[t])
      farthest = std::max(
          farthest, std::abs(dot(mesh.vertices[static_cast<std::size_t>(v)] - part.point, part.normal)));
  }
  return farthest;
}

}  // namespace

MeshView SurfaceMesh::view() const {
  MeshView view{};
  view.vertices = vertices.data();
  view.triangles = triangles.data();
  view.parts = parts.data();
  view.features = features.data();
  view.tests = tests.data();
  view.patches = patches.data();
  view.first_neighbour = first_neighbour.data();
  view.neighbours = neighbours.data();
  view.boxes = boxes.data();
  view.triangle_count = static_cast<Index>(triangles.size());
  view.part_count = static_cast<Index>(parts.size());
  std::copy(level_start.begin(), level_start.end(), view.level_start);
  view.levels = static_cast<int>(level_start.size()) - 1;
  view.sheet = sheet;
  view.cosine = cosine;
  view.round_off = round_off;
  view.flatness = flatness;
  return view;
}

SurfaceMesh build_surface_mesh(const TriangleMesh& mesh, Real feature_angle, bool sheet) {
  MeshTopology topology = mesh_topology(mesh);
  MeshBox box = kNoBox;
  for (const Vec3 v : topology.mesh.vertices) extend(box, {v, v});
  SurfaceMesh result;
  result.sheet = sheet;
  result.cosine = std::cos(feature_angle);
  result.round_off =
      kUnits * std::numeric_limits<Real>::epsilon() * std::max(largest(box.min), largest(box.max));
  result.flatness = kFlatness * largest(box.max - box.min) + result.round_off;
  MeshParts parts = mesh_parts(topology, result.flatness, result.cosine);
  result.flatness = std::max(result.flatness, farthest_from_plane(topology.mesh, parts));
  result.curvature = mesh_curvature(topology, parts, result.cosine, sheet);
  result.fold = least_fold(topology, parts, result.cosine, sheet);
  MeshFeatures features = mesh_features(topology, parts, sheet);
  result.triangles = std::move(features.triangles);
  result.features = std::move(features.features);
  result.tests = std::move(features.tests);
  result.patches = std::move(features.patches);
  result.parts = std::move(parts.parts);
  result.first_neighbour = std::move(parts.neighbours.first);
  result.neighbours = std::move(parts.neighbours.items);
  result.vertices = std::move(topology.mesh.vertices);
  result.original = std::move(topology.original);
  build_tree(result);
  return result;
}

}  // namespace scree
