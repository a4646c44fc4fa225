// Building blocks of primitives: rings of vertices, strips between them and fans.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Numbers of vertices, in order around the ring.
using Ring = std::vector<Index>;

class MeshBuilder {
 public:
  Index vertex(Vec3 v);
  Vec3 position(Index vertex) const { return mesh_.vertices[vertex]; }
  // Adds several vertices, at height z.
  Ring ring(const std::vector<Vec3>& points, Real z);
  void triangle(Index a, Index b, Index c) { mesh_.triangles.push_back({a, b, c}); }
  // Adds a quadrilateral with corners in order, split from a to c.
  void quad(Index a, Index b, Index c, Index d);
  // Adds the strip between two rings or lines of equal length, seen with `low` below and both running to the
  // right. A ring of one vertex is a tip. closed: also between the last and the first vertices.
  void strip(const Ring& low, const Ring& high, bool closed);
  // Adds a fan over the ring about a vertex in its middle; seen from outside the ring runs counterclockwise.
  void fan(Index middle, const Ring& ring);
  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

Ring reversed(const Ring& ring);

}  // namespace scree
