// What primitives are put together from: rings of vertices, strips between them and fans.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Numbers of vertices in their order around.
using Ring = std::vector<Index>;

class MeshBuilder {
 public:
  Index vertex(Vec3 v);
  Vec3 place(Index vertex) const { return mesh_.vertices[vertex]; }
  // Several at once, moved to height z.
  Ring ring(const std::vector<Vec3>& points, Real z);
  void triangle(Index a, Index b, Index c) { mesh_.triangles.push_back({a, b, c}); }
  // a, b, c, d around, split from a to c.
  void quad(Index a, Index b, Index c, Index d);
  // Between rings or lines of equal length: seen with `low` below and both running to the right. A ring of
  // one vertex is a tip. closed: also from the last back to the first.
  void strip(const Ring& low, const Ring& high, bool closed);
  // The ring as seen from its outside, where it runs counterclockwise, about a vertex in its middle.
  void fan(Index middle, const Ring& ring);
  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

Ring reversed(const Ring& ring);

}  // namespace scree
