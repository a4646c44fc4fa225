#include "mesh/convex_hull.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "mesh/mesh_mass.hpp"

namespace scree {
namespace {

constexpr Real kCells = 1099511627776.0;  // 2^40: a volume on the grid has at most 123 binary places
constexpr Real kFlat = 1e-9;
constexpr Index kNone = -1;

struct GridPoint {
  std::int64_t x, y, z;
};
struct GridVector {
  __int128 x, y, z;
};
using GridVolume = __int128;

GridVector from(GridPoint a, GridPoint b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }
GridVector cross(const GridVector& a, const GridVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
GridVolume dot(const GridVector& a, const GridVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
// Zero for the zero vector alone; comparable among vectors of the same points.
GridVolume size(const GridVector& a) {
  const auto absolute = [](GridVolume x) { return x < 0 ? -x : x; };
  return absolute(a.x) + absolute(a.y) + absolute(a.z);
}

struct Extent {
  Vec3 min, max;
};

Extent extent_of(const std::vector<Vec3>& points) {
  Extent box{points.front(), points.front()};
  for (const Vec3 p : points) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  return box;
}

std::vector<GridPoint> on_grid(const std::vector<Vec3>& points, const Extent& box) {
  const auto cell = [](Real x, Real min, Real max) {  // half coordinates, whose differences are finite
    return max > min ? std::llround((x / 2 - min / 2) / (max / 2 - min / 2) * kCells) : 0;
  };
  std::vector<GridPoint> grid;
  grid.reserve(points.size());
  for (const Vec3 p : points)
    grid.push_back(
        {cell(p.x, box.min.x, box.max.x), cell(p.y, box.min.y, box.max.y), cell(p.z, box.min.z, box.max.z)});
  return grid;
}

[[noreturn]] void fail_flat() {
  throw InputError("its vertices lie in one plane: their convex hull has no volume");
}

// Starts from a tetrahedron and adds the farthest of the points outside a face: the faces visible from it
// are replaced by a cone from their border to it. From a point in the plane of a face that face is not
// visible, as if the point lay a little deeper. The visible faces are therefore always connected, and every
// point outside one of them that is still outside the hull is outside the cone.
class Hull {
 public:
  explicit Hull(const std::vector<GridPoint>& points)
      : points_(points), faces_(4), first_(points.size(), kNone) {
    start();
    while (!queued_.empty()) {
      const Index face = queued_.back();
      queued_.pop_back();
      if (faces_[face].alive && !faces_[face].outside.empty()) grow(face);
    }
  }

  std::vector<std::array<Index, 3>> triangles() const {
    std::vector<std::array<Index, 3>> result;
    for (const Face& face : faces_)
      if (face.alive) result.push_back(face.corner);
    return result;
  }

 private:
  struct Face {
    std::array<Index, 3> corner{};  // counterclockwise seen from outside
    std::array<Index, 3> across{};  // neighbouring faces, across the edge from corner k to the next
    std::vector<Index> outside;     // points from which the face is visible
    Index farthest = kNone;         // one of `outside`
    GridVolume height = 0;          // of `farthest`, times twice the area
    bool alive = true;
  };
  struct Border {
    Index from, to;  // vertices, in the direction of the removed side
    Index beyond;    // the face that remains
  };

  // Positive where the face is visible from p; six times the volume of the tetrahedron of face and p.
  GridVolume height(const std::array<Index, 3>& corner, Index p) const {
    const GridPoint a = points_[corner[0]];
    return dot(cross(from(a, points_[corner[1]]), from(a, points_[corner[2]])), from(a, points_[p]));
  }
  bool is_visible_from(Index p, const Face& face) const { return height(face.corner, p) > 0; }

  // The point with the largest height_of(point), the lowest of equals.
  template <class Height>
  Index farthest(const Height& height_of) const {
    Index best = 0;
    GridVolume most = 0;
    for (Index p = 0; p < static_cast<Index>(points_.size()); ++p)
      if (const GridVolume far = height_of(p); far > most) most = far, best = p;
    if (most == 0) fail_flat();
    return best;
  }

  void start() {
    const Index a = 0, b = farthest([&](Index p) { return size(from(points_[a], points_[p])); });
    const GridVector edge = from(points_[a], points_[b]);
    const Index c = farthest([&](Index p) { return size(cross(edge, from(points_[a], points_[p]))); });
    const auto over = [&](Index p) { return height({a, b, c}, p); };
    const Index d = farthest([&](Index p) { return std::max(over(p), -over(p)); });
    const bool seen = over(d) > 0;
    const Index left = seen ? c : b, right = seen ? b : c;  // triangle a, left, right is not visible from d
    put(0, {a, left, right}, {1, 2, 3});
    put(1, {left, a, d}, {0, 3, 2});
    put(2, {right, left, d}, {0, 1, 3});
    put(3, {a, right, d}, {0, 2, 1});
    std::vector<Index> all(points_.size());
    std::iota(all.begin(), all.end(), 0);
    assign(all, {0, 1, 2, 3});
  }

  void put(Index f, const std::array<Index, 3>& corner, const std::array<Index, 3>& across) {
    Face& face = faces_[f];
    face = {};
    face.corner = corner, face.across = across;
  }

  // Assigns each point to the first of the faces that are visible from it.
  void assign(const std::vector<Index>& points, const std::vector<Index>& faces) {
    for (const Index p : points)
      for (const Index f : faces) {
        Face& face = faces_[f];
        const GridVolume above = height(face.corner, p);
        if (above <= 0) continue;
        face.outside.push_back(p);
        if (above > face.height) face.height = above, face.farthest = p;
        break;
      }
    for (const Index f : faces)
      if (!faces_[f].outside.empty()) queued_.push_back(f);
  }

  void grow(Index face) {
    const Index p = faces_[face].farthest;
    std::vector<Index> points;
    const std::vector<Border> borders = remove_visible(face, p, points);
    assign(points, cone(borders, p));
  }

  // Removes the faces visible from p, starting at this one, and collects their points; returns their border.
  std::vector<Border> remove_visible(Index face, Index p, std::vector<Index>& points) {
    std::vector<Index> seen{face};
    std::vector<Border> borders;
    faces_[face].alive = false;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const Face gone = std::move(faces_[seen[k]]);
      for (int e = 0; e < 3; ++e) {
        const Index next = gone.across[e];
        if (!faces_[next].alive) continue;
        if (is_visible_from(p, faces_[next])) {
          faces_[next].alive = false;
          seen.push_back(next);
        } else {
          borders.push_back({gone.corner[e], gone.corner[(e + 1) % 3], next});
        }
      }
      for (const Index q : gone.outside)
        if (q != p) points.push_back(q);
    }
    free_.insert(free_.end(), seen.begin(), seen.end());
    return borders;
  }

  // Adds the faces from the border to p and returns them.
  std::vector<Index> cone(const std::vector<Border>& borders, Index p) {
    std::vector<Index> made;
    for (const Border& border : borders) {
      const Index f = take_slot();
      put(f, {border.from, border.to, p}, {border.beyond, kNone, kNone});
      Face& beyond = faces_[border.beyond];
      for (int e = 0; e < 3; ++e)
        if (beyond.corner[e] == border.to) beyond.across[e] = f;
      first_[border.from] = f;
      made.push_back(f);
    }
    for (const Index f : made) {
      const Index next = first_[faces_[f].corner[1]];
      faces_[f].across[1] = next, faces_[next].across[2] = f;
    }
    return made;
  }

  Index take_slot() {
    if (free_.empty()) {
      faces_.emplace_back();
      return static_cast<Index>(faces_.size()) - 1;
    }
    const Index f = free_.back();
    free_.pop_back();
    return f;
  }

  const std::vector<GridPoint>& points_;
  std::vector<Face> faces_;
  std::vector<Index> free_;    // positions of removed faces
  std::vector<Index> queued_;  // faces with points outside, some of them removed
  std::vector<Index> first_;   // for a vertex on the border of a cone, the new face whose edge begins there
};

TriangleMesh without_unused(const std::vector<Vec3>& points, std::vector<std::array<Index, 3>> triangles) {
  TriangleMesh mesh{{}, std::move(triangles)};
  std::vector<Index> number(points.size(), kNone);
  for (auto& triangle : mesh.triangles)
    for (Index& v : triangle) {
      if (number[v] == kNone) {
        number[v] = static_cast<Index>(mesh.vertices.size());
        mesh.vertices.push_back(points[v]);
      }
      v = number[v];
    }
  return mesh;
}

}  // namespace

TriangleMesh convex_hull(const std::vector<Vec3>& points) {
  if (points.empty()) fail_flat();
  const Extent box = extent_of(points);
  const std::vector<GridPoint> grid = on_grid(points, box);
  TriangleMesh mesh = without_unused(points, Hull(grid).triangles());
  const Vec3 size = box.max - box.min;
  if (!(mesh_volume(mesh) > kFlat * size.x * size.y * size.z)) fail_flat();
  return mesh;
}

}  // namespace scree
