// A mesh with all data of the contact search, built once from its triangles.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "mesh/mesh_curvature.hpp"
#include "mesh/mesh_fold.hpp"
#include "mesh/mesh_view.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Holds the arrays of a MeshView.
struct SurfaceMesh {
  std::vector<Vec3> vertices;  // those that triangles use, in the order of first use [m]
  std::vector<MeshTriangle> triangles;
  std::vector<MeshPart> parts;
  std::vector<MeshFeature> features;
  std::vector<Index> tests, patches, first_neighbour, neighbours;
  std::vector<MeshBox> boxes;
  std::vector<Index> level_start;  // first box of each level, and the end
  std::vector<Index> original;     // number of each triangle in the original mesh
  MeshBox box;                     // of all vertices [m]
  MeshCurvature curvature;
  MeshFold fold;
  bool sheet = false;
  Real cosine = 1, round_off = 0, flatness = 0;

  // Valid as long as this object exists and is not moved.
  MeshView view() const;
};

// mesh: sound, that is with welded vertices, consistent winding, without degenerate triangles, and closed
// unless `sheet`. feature_angle [rad]: edges with a smaller angle are smooth. The result depends on the mesh
// alone, not on the number of threads of the machine.
SurfaceMesh build_surface_mesh(const TriangleMesh& mesh, Real feature_angle, bool sheet);

}  // namespace scree
