// The meshes of walls and bodies as snapshots show them.
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

// One after the other in the order of SurfaceSet, then those that touch nothing; triangles in the order of
// the file or the shape.
class MeshSurfaces {
 public:
  // Where they are at one instant, and what acts on them.
  struct Look {
    std::vector<Vec3> position;  // of the corners [m]
    // Per triangle, those that the output shows.
    std::vector<Real> pressure;                   // [Pa], in 2D [N/m]
    std::vector<Vec3> shear;                      // likewise
    std::vector<Real> impact_work, sliding_work;  // [J]
    std::vector<Real> wear_depth;                 // [m]
  };

  // The model is kept.
  explicit MeshSurfaces(const Model& model);
  SeriesTriangles triangles() const;
  // motion: of the carriers (bodies, then placed walls); works: of all ranks, none where none is shown.
  Look look(std::span<const BodyMotion> motion, std::span<const TriangleLoad> loads,
            const std::vector<std::int64_t>& works) const;

 private:
  struct Part {
    Index surface;      // of the placed ones, or -1: it touches nothing
    int carrier, wall;  // wall: index into Model::walls, or -1 where the carrier is a body
    int material;
    Vec3 point;                               // its origin in the carrier's frame [m]
    std::size_t first_point, first_triangle;  // rows
    const SurfaceMesh* mesh;
  };
  void add(Part part, int mesh);
  template <class T>
  void spread(std::vector<T>& values) const;
  void take_works(const std::vector<std::int64_t>& works, Look& look) const;
  void place(const Part& part, const BodyMotion& carrier, Vec3* position) const;

  const Model& model_;
  std::vector<Part> parts_;
  std::size_t points_ = 0, triangles_ = 0;
};

}  // namespace scree
