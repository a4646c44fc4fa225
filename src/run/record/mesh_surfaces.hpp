// The meshes of walls and bodies in snapshots.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dem/surfaces/surfaces.hpp"
#include "dem/surfaces/triangle_sums.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "output/series_triangles.hpp"

namespace scree {

// Meshes in the order of SurfaceSet, then those without contact detection; triangles in the order of the file
// or the shape.
class MeshSurfaces {
 public:
  // Positions and loads of the meshes at one instant.
  struct Sample {
    std::vector<Vec3> position;  // of the vertices [m]
    // Per triangle; only the fields that the output has.
    std::vector<Real> pressure;                   // [Pa], in 2D [N/m]
    std::vector<Vec3> shear;                      // [Pa], in 2D [N/m]
    std::vector<Real> impact_work, sliding_work;  // [J]
    std::vector<Real> wear_depth;                 // [m]
  };

  // Keeps a reference to the model.
  explicit MeshSurfaces(const Model& model);
  SeriesTriangles triangles() const;
  // motion: of the parents (bodies, then placed walls); works: of all ranks, empty if no field needs them.
  Sample sample(std::span<const BodyMotion> motion, std::span<const TriangleLoad> loads,
                const std::vector<std::int64_t>& works) const;

 private:
  struct Part {
    Index surface;     // index among the placed surfaces; -1: no contact detection
    int parent, wall;  // wall: index into Model::walls, or -1 where the parent is a body
    int material;
    Vec3 point;                               // origin of the mesh in the parent's frame [m]
    std::size_t first_point, first_triangle;  // rows
    const SurfaceMesh* mesh;
  };
  void add(Part part, int mesh);
  template <class T>
  void spread(std::vector<T>& values) const;
  void take_works(const std::vector<std::int64_t>& works, Sample& sample) const;
  void place(const Part& part, const BodyMotion& parent, Vec3* position) const;

  const Model& model_;
  std::vector<Part> parts_;
  std::size_t points_ = 0, triangles_ = 0;
};

}  // namespace scree
