// Mass properties of meshes against closed forms.
#include "mesh/mesh_mass.hpp"

#include <cmath>
#include <numbers>

#include "base/rotation.hpp"
#include "mesh/primitives.hpp"
#include "mesh/refine.hpp"
#include "mesh/weld.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

Real largest(const Sym3& j) { return std::max({std::abs(j.xx), std::abs(j.yy), std::abs(j.zz)}); }

// `bound`: for mass and the largest moment; for the centre, times `size`.
void check_near(const MassProperties& a, const MassProperties& b, Real bound, Real size = 1) {
  CHECK(near(a.mass, b.mass, {.relative = bound}));
  CHECK(near(a.center, b.center, {.absolute = bound * size}));
  const Within within{.absolute = bound * largest(b.inertia)};
  CHECK(near(a.inertia.xx, b.inertia.xx, within));
  CHECK(near(a.inertia.xy, b.inertia.xy, within));
  CHECK(near(a.inertia.xz, b.inertia.xz, within));
  CHECK(near(a.inertia.yy, b.inertia.yy, within));
  CHECK(near(a.inertia.yz, b.inertia.yz, within));
  CHECK(near(a.inertia.zz, b.inertia.zz, within));
}

TriangleMesh moved(TriangleMesh mesh, const Mat3& turn, Vec3 shift) {
  for (Vec3& v : mesh.vertices) v = turn * v + shift;
  return mesh;
}

Mat3 some_turn() {
  const Real c = std::cos(0.7), s = std::sin(0.7), d = std::cos(1.9), t = std::sin(1.9);
  return Mat3{{c, -s, 0}, {s, c, 0}, {0, 0, 1}} * Mat3{{1, 0, 0}, {0, d, -t}, {0, t, d}};
}

// A prism over a right triangle, without symmetry.
TriangleMesh wedge() {
  return {{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 3}, {2, 0, 3}, {0, 1, 3}},
          {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
}

// The torus of radii 2 and 0.5 about z, of 2 n by n segments; n even.
TriangleMesh torus(Index n) {
  TriangleMesh mesh;
  for (Index i = 0; i < 2 * n; ++i) {
    const Vec3 around = circle_point(i, 2 * n);
    for (Index j = 0; j < n; ++j) {
      const Vec3 across = 0.5 * circle_point(j, n);
      mesh.vertices.push_back({(2 + across.x) * around.x, (2 + across.x) * around.y, across.y});
      const Index i1 = (i + 1) % (2 * n), j1 = (j + 1) % n;
      const Index a = i * n + j, b = i1 * n + j, c = i1 * n + j1, d = i * n + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("mass of a cube, a box, a tetrahedron and a prism") {
  check_near(solid_mesh_mass(box_mesh({{1, 1, 1}}), 6), solid_box(6, {1, 1, 1}), 4 * kUlp);
  check_near(solid_mesh_mass(box_mesh({{1, 2, 3}}), 2), solid_box(2, {1, 2, 3}), 4 * kUlp);
  // x, y, z >= 0 and x + y + z <= 1, of 1 kg: integral x^2 = 1/10, x y = 1/20, about the origin.
  const TriangleMesh corner{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                            {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const Real across = 2 * (0.1 - 0.0625), product = -(0.05 - 0.0625);
  check_near(solid_mesh_mass(corner, 6),
             {1, {0.25, 0.25, 0.25}, {across, product, product, across, product, across}}, 8 * kUlp);
  // A right triangle with legs 2 and 1, 3 high, of 9 kg: about its centre a triangle has m a^2 / 18 and
  // -m a b / 36 (of x y).
  const Real xx = 9 * 4 / 18., yy = 9 * 1 / 18., xy = -9 * 2 / 36., zz = 9 * 9 / 12.;
  check_near(solid_mesh_mass(wedge(), 3), {9, {2 / 3., 1 / 3., 1.5}, {yy + zz, -xy, 0, xx + zz, 0, xx + yy}},
             8 * kUlp, 3);
}

TEST_CASE("mass properties depend neither on a mesh's fineness nor on its orientation or distance") {
  const TriangleMesh mesh = wedge();
  const MassProperties mass = solid_mesh_mass(mesh, 3);
  check_near(solid_mesh_mass(refined(mesh, 0.05), 3), mass, 1e-14, 3);
  const Mat3 turn = some_turn();
  check_near(solid_mesh_mass(moved(mesh, turn, {}), 3),
             {mass.mass, turn * mass.center, rotated_tensor(turn, mass.inertia)}, 1e-14, 3);
  // So far away that no coordinate is rounded, and as far that all are, to 1.2e-10 m.
  const Vec3 exact{1 << 20, -(1 << 20), 1 << 19}, far{1e6, -1e6, 7e5};
  check_near(solid_mesh_mass(moved(mesh, identity3(), exact), 3),
             {mass.mass, mass.center + exact, mass.inertia}, 1e-14, 1e6);
  const TriangleMesh rounded = moved(moved(mesh, turn, far), identity3(), -far);
  check_near(solid_mesh_mass(moved(mesh, turn, far), 3),
             {mass.mass, turn * mass.center + far, rotated_tensor(turn, mass.inertia)}, 1e-9, 1e6);
  const MassProperties near_by = solid_mesh_mass(rounded, 3);
  check_near(solid_mesh_mass(moved(mesh, turn, far), 3),
             {near_by.mass, near_by.center + far, near_by.inertia}, 1e-14, 1e6);
}

TEST_CASE("a torus and a sphere at order 2") {
  const Real big = 2, small = 0.5, mass = 2 * kPi * kPi * big * small * small;
  const Real polar = mass * (big * big + 0.75 * small * small);
  const Real across = mass * (big * big / 2 + 0.625 * small * small);
  const MassProperties ring{mass, {}, {across, 0, 0, across, 0, polar}}, ball = solid_sphere(1, 0.7);
  const auto check_order = [](const MassProperties& coarse, const MassProperties& fine,
                              const MassProperties& exact) {
    const auto order = [](Real c, Real f, Real e) { return std::log2((e - c) / (e - f)); };
    CHECK(near(order(coarse.mass, fine.mass, exact.mass), 2, {.absolute = 0.02}));
    CHECK(near(order(coarse.inertia.xx, fine.inertia.xx, exact.inertia.xx), 2, {.absolute = 0.02}));
    CHECK(near(order(coarse.inertia.zz, fine.inertia.zz, exact.inertia.zz), 2, {.absolute = 0.02}));
    CHECK(near(fine.mass, exact.mass, {.relative = 0.005}));
    CHECK(norm(fine.center - exact.center) < 1e-14);
  };
  check_order(solid_mesh_mass(torus(32), 1), solid_mesh_mass(torus(64), 1), ring);
  check_order(solid_mesh_mass(sphere_mesh({0.7, 3}), 1), solid_mesh_mass(sphere_mesh({0.7, 4}), 1), ball);
}

TEST_CASE("a shell's mass lies on its area") {
  // A cube of six plates of 1 kg: each 1/12 (twice or once) and 1/4 where it is off the axis.
  check_near(shell_mesh_mass(box_mesh({{1, 1, 1}}), 1), {6, {}, {5 / 3., 0, 0, 5 / 3., 0, 5 / 3.}}, 4 * kUlp);
  const MassProperties plate = shell_mesh_mass(moved(rectangle_mesh(2, 3), identity3(), {1, 0, 0}), 0.5);
  check_near(plate, {3, {1, 0, 0}, {3 * 9 / 12., 0, 0, 1, 0, 3 * 13 / 12.}}, 4 * kUlp);
  const MassProperties ball = shell_mesh_mass(sphere_mesh({1, 5}), 1);
  CHECK(near(ball.inertia.xx, 2 / 3. * ball.mass, {.relative = 1e-3}));
}

TEST_CASE("a mesh inside out has a volume below 0") {
  TriangleMesh mesh = wedge();
  for (std::array<Index, 3>& t : mesh.triangles) std::swap(t[0], t[1]);
  CHECK(near(mesh_volume(mesh), -3, {.relative = 4 * kUlp}));
  CHECK(near(mesh_area(mesh), 2 + 6 + 3 + 3 * std::sqrt(5.), {.relative = 4 * kUlp}));
}

}  // namespace scree
