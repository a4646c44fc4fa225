#include "mesh/mesh_mass.hpp"

#include <algorithm>
#include <array>

#include "base/exact_sum.hpp"

namespace scree {

namespace {

// The centre of the box around the mesh.
Vec3 middle(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3 v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return Real(0.5) * low + Real(0.5) * high;
}

// Integrals of 1 (content), x and x x^T over the triangles, or over the tetrahedra that they span with the
// origin.
struct Moments {
  Real content = 0;
  Vec3 first;
  Sym3 second;
};

// s s^T + a a^T + b b^T + c c^T with s = a + b + c. Multiplied by area / 12 it is the integral of x x^T over
// a triangle, by volume / 20 that over the tetrahedron of it and the origin.
Sym3 corner_squares(const std::array<Vec3, 3>& corner, Real weight) {
  Sym3 sum = outer(weight, corner[0] + corner[1] + corner[2]);
  for (const Vec3 c : corner) sum += outer(weight, c);
  return sum;
}

Moments of_tetrahedron(const std::array<Vec3, 3>& corner) {
  const Real volume6 = dot(corner[0], cross(corner[1], corner[2]));
  return {volume6 / 6, volume6 / 24 * (corner[0] + corner[1] + corner[2]),
          corner_squares(corner, volume6 / 120)};
}

Moments of_triangle(const std::array<Vec3, 3>& corner) {
  const Real area2 = norm(cross(corner[1] - corner[0], corner[2] - corner[0]));
  return {area2 / 2, area2 / 6 * (corner[0] + corner[1] + corner[2]), corner_squares(corner, area2 / 24)};
}

// Sums of millions of triangles that lose no more digits than those of a few.
class ExactMoments {
 public:
  void add(const Moments& m) {
    const Sym3& s = m.second;
    const Real terms[] = {m.content, m.first.x, m.first.y, m.first.z, s.xx, s.xy, s.xz, s.yy, s.yz, s.zz};
    for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k].add(terms[k]);
  }
  Moments value() const {
    const auto sum = [&](int k) { return sums_[k].value(); };
    return {sum(0), {sum(1), sum(2), sum(3)}, {sum(4), sum(5), sum(6), sum(7), sum(8), sum(9)}};
  }

 private:
  std::array<ExactSum, 10> sums_;
};

// Moments about the given origin; of(corners): those of one triangle.
template <class Of>
Moments moments_about(const TriangleMesh& mesh, Vec3 origin, Of of) {
  ExactMoments moments;
  for (const std::array<Index, 3>& triangle : mesh.triangles) {
    std::array<Vec3, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = mesh.vertices[triangle[k]] - origin;
    moments.add(of(corner));
  }
  return moments.value();
}

// Inertia tr(S) 1 - S of a mass whose integral of x x^T is density S.
Sym3 inertia_of(const Sym3& s, Real density) {
  return {density * (s.yy + s.zz), -density * s.xy, -density * s.xz,
          density * (s.xx + s.zz), -density * s.yz, density * (s.xx + s.yy)};
}

// Two passes: the first finds the centre, the second takes the squares about it, without a large term to
// subtract.
template <class Of>
MassProperties mass_of(const TriangleMesh& mesh, Real density, Of of) {
  const Vec3 origin = middle(mesh);
  const Moments coarse = moments_about(mesh, origin, of);
  const Vec3 center = origin + 1 / coarse.content * coarse.first;
  const Moments fine = moments_about(mesh, center, of);
  const Vec3 shift = 1 / fine.content * fine.first;  // rounding error of the centre
  MassProperties whole{density * fine.content, center + shift, inertia_of(fine.second, density)};
  whole.inertia += point_inertia(-whole.mass, shift);
  return whole;
}

}  // namespace

Real mesh_area(const TriangleMesh& mesh) { return moments_about(mesh, middle(mesh), of_triangle).content; }

Real mesh_volume(const TriangleMesh& mesh) {
  return moments_about(mesh, middle(mesh), of_tetrahedron).content;
}

MassProperties solid_mesh_mass(const TriangleMesh& mesh, Real density) {
  return mass_of(mesh, density, of_tetrahedron);
}

MassProperties shell_mesh_mass(const TriangleMesh& mesh, Real mass_per_area) {
  return mass_of(mesh, mass_per_area, of_triangle);
}

}  // namespace scree
