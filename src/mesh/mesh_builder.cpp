#include "mesh/mesh_builder.hpp"

namespace scree {

Index MeshBuilder::vertex(Vec3 v) {
  mesh_.vertices.push_back(v);
  return static_cast<Index>(mesh_.vertices.size()) - 1;
}

Ring MeshBuilder::ring(const std::vector<Vec3>& points, Real z) {
  Ring ring;
  for (const Vec3 p : points) ring.push_back(vertex({p.x, p.y, z}));
  return ring;
}

void MeshBuilder::quad(Index a, Index b, Index c, Index d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void MeshBuilder::strip(const Ring& low, const Ring& high, bool closed) {
  const std::size_t points = std::max(low.size(), high.size());
  const auto at = [](const Ring& ring, std::size_t k) {
    return ring.size() == 1 ? ring[0] : ring[k % ring.size()];
  };
  for (std::size_t k = 0; k + (closed ? 0 : 1) < points; ++k) {
    const Index a = at(low, k), b = at(low, k + 1), c = at(high, k + 1), d = at(high, k);
    if (a != b) triangle(a, b, c);
    if (c != d) triangle(a, c, d);
  }
}

void MeshBuilder::fan(Index middle, const Ring& ring) { strip(ring, {middle}, true); }

Ring reversed(const Ring& ring) { return {ring.rbegin(), ring.rend()}; }

}  // namespace scree
