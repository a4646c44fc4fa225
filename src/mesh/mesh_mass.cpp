#include "mesh/mesh_mass.hpp"

#include <algorithm>
#include <array>

namespace scree {

namespace {

// The middle of the box around the mesh.
Vec3 middle(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3 v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return Real(0.5) * low + Real(0.5) * high;
}

// Integrals of 1 (content), x and x x^T over what triangles span.
struct Moments {
  Real content = 0;
  Vec3 first;
  Sym3 second;
};

// The triangle a, b, c: twice its area times integral x x^T is (s s^T + a a^T + b b^T + c c^T) / 24 times
// that, with s = a + b + c; the tetrahedron of it and the origin has the same sum over 120, of six times its
// volume.
Sym3 corner_squares(const std::array<Vec3, 3>& corner, Real weight) {
  Sym3 sum = outer(weight, corner[0] + corner[1] + corner[2]);
  for (const Vec3 c : corner) sum += outer(weight, c);
  return sum;
}

void add_tetrahedron(Moments& moments, const std::array<Vec3, 3>& corner) {
  const Real volume6 = dot(corner[0], cross(corner[1], corner[2]));
  moments.content += volume6 / 6;
  moments.first += volume6 / 24 * (corner[0] + corner[1] + corner[2]);
  moments.second += corner_squares(corner, volume6 / 120);
}

void add_triangle(Moments& moments, const std::array<Vec3, 3>& corner) {
  const Real area2 = norm(cross(corner[1] - corner[0], corner[2] - corner[0]));
  moments.content += area2 / 2;
  moments.first += area2 / 6 * (corner[0] + corner[1] + corner[2]);
  moments.second += corner_squares(corner, area2 / 24);
}

// About the origin given.
template <class Add>
Moments moments_about(const TriangleMesh& mesh, Vec3 origin, Add add) {
  Moments moments;
  for (const std::array<Index, 3>& triangle : mesh.triangles) {
    std::array<Vec3, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = mesh.vertices[triangle[k]] - origin;
    add(moments, corner);
  }
  return moments;
}

// tr(S) 1 - S, of a mass with integral x x^T = density S.
Sym3 inertia_of(const Sym3& s, Real density) {
  return {density * (s.yy + s.zz), -density * s.xy, -density * s.xz,
          density * (s.xx + s.zz), -density * s.yz, density * (s.xx + s.yy)};
}

// Two passes: the first finds the centre, the second takes the squares about it, without a large term to
// subtract.
template <class Add>
MassProperties mass_of(const TriangleMesh& mesh, Real density, Add add) {
  const Vec3 origin = middle(mesh);
  const Moments coarse = moments_about(mesh, origin, add);
  const Vec3 center = origin + 1 / coarse.content * coarse.first;
  const Moments fine = moments_about(mesh, center, add);
  const Vec3 shift = 1 / fine.content * fine.first;  // what the centre was rounded by
  MassProperties whole{density * fine.content, center + shift, inertia_of(fine.second, density)};
  whole.inertia += point_inertia(-whole.mass, shift);
  return whole;
}

}  // namespace

Real mesh_area(const TriangleMesh& mesh) { return moments_about(mesh, middle(mesh), add_triangle).content; }

Real mesh_volume(const TriangleMesh& mesh) {
  return moments_about(mesh, middle(mesh), add_tetrahedron).content;
}

MassProperties solid_mesh_mass(const TriangleMesh& mesh, Real density) {
  return mass_of(mesh, density, add_tetrahedron);
}

MassProperties shell_mesh_mass(const TriangleMesh& mesh, Real mass_per_area) {
  return mass_of(mesh, mass_per_area, add_triangle);
}

}  // namespace scree
