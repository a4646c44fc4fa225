// Primitive surfaces: sound, with the mass properties of the exact shapes.
#include "mesh/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_shells.hpp"
#include "mesh/weld.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

void check_sound(const TriangleMesh& mesh, bool sheet = false, Index shells = 1) {
  for (const std::string& trouble : mesh_defects(mesh, sheet)) FAIL_CHECK(trouble);
  const TriangleMesh again = welded(mesh);
  CHECK(again.vertices.size() == mesh.vertices.size());
  const std::vector<Index> shell = shells_of(mesh);
  CHECK(*std::max_element(shell.begin(), shell.end()) == shells - 1);
}

// A shape with n segments around, and the mass properties of its exact form about its centre, of density 1.
struct RoundShape {
  const char* name;
  std::function<TriangleMesh(Index)> mesh;
  Real volume, center_z, polar;
};

Real power(Real x, int n) { return n == 0 ? 1 : x * power(x, n - 1); }

// Integrals over the true sections.
RoundShape cone() {
  const Real big = 1, small = 0.4, length = 1.5;
  const Real squares = big * big + big * small + small * small;
  return {"cone",
          [=](Index n) {
            return cone_mesh({big, small, length, n});
          },
          kPi * length / 3 * squares,
          length * (big * big + 2 * big * small + 3 * small * small) / (4 * squares),
          kPi / 10 * length * (power(big, 5) - power(small, 5)) / (big - small)};
}
RoundShape drum(Real end_wall) {
  const Real r = 1, wall = 0.1, length = 2, height = 0.25;
  const Real width = 2 * std::sin(0.9999 * kPi / 32);  // width of three of 96 segments
  const int lifters = 6;
  // A lifter lies between x = r - height and the circle, for |y| <= width / 2: integrals of 1 and x^2 + y^2
  // by Simpson's rule over y, in which they are smooth.
  Real area = 0, squares = 0;
  for (int k = 0; k <= 200; ++k) {
    const Real y = width * (k / 200. - 0.5), far = std::sqrt(r * r - y * y), first = r - height;
    const Real weight = width / 600 * (k == 0 || k == 200 ? 1 : k % 2 == 1 ? 4 : 2);
    area += weight * (far - first);
    squares += weight * ((power(far, 3) - power(first, 3)) / 3 + y * y * (far - first));
  }
  const auto disc = [](Real radius) { return kPi * radius * radius; };
  const auto polar = [](Real radius) { return kPi / 2 * power(radius, 4); };
  const Real out = r + wall, ends = 2 * end_wall;
  return {end_wall > 0 ? "drum" : "open drum",
          [=](Index n) {
            return drum_mesh({r, wall, length, end_wall, lifters, height, width, n});
          },
          length * (disc(out) - disc(r) + lifters * area) + ends * disc(out), 0,
          length * (polar(out) - polar(r) + lifters * squares) + ends * polar(out)};
}
RoundShape screw() {
  const Real core = 1 - 0.9999 * kPi / 4;  // the flight has the height of the length of 12 of 96 segments
  const Real flight = 1, pitch = -0.5, thickness = 0.0625, length = 1.5, core_length = 2;
  const Real sector = 2 * kPi * thickness / -pitch;
  return {"screw",
          [=](Index n) {
            return screw_mesh({core, flight, pitch, thickness, length, core_length, n});
          },
          core_length * kPi * core * core + length * sector / 2 * (flight * flight - core * core), 0,
          core_length * kPi / 2 * power(core, 4) + length * sector / 4 * (power(flight, 4) - power(core, 4))};
}
std::vector<RoundShape> round_shapes() {
  const MassProperties cylinder = solid_cylinder(1, 0.5, 2), capsule = solid_capsule(1, 0.5, 2);
  const MassProperties pipe = solid_cylinder(1, 0.3, 2), plate = solid_box(1, {2, 1.5, 0.2});
  const MassProperties hole = solid_cylinder(1, 0.6, 0.2);
  return {{"cylinder",
           [](Index n) {
             return cylinder_mesh({0.5, 2, n});
           },
           cylinder.mass, 0, cylinder.inertia.zz},
          {"capsule",
           [](Index n) {
             return capsule_mesh({0.5, 2, n});
           },
           capsule.mass, 0, capsule.inertia.zz},
          {"pipe",
           [](Index n) {
             return pipe_mesh({0.3, 0.5, 2, n});
           },
           cylinder.mass - pipe.mass, 0, cylinder.inertia.zz - pipe.inertia.zz},
          {"plate",
           [](Index n) {
             return plate_mesh({{2, 1.5, 0.2}, 0.6, n});
           },
           plate.mass - hole.mass, 0, plate.inertia.zz - hole.inertia.zz},
          cone(),
          drum(0),
          drum(0.15),
          screw()};
}

}  // namespace

TEST_CASE("a box and a plate are exact") {
  const TriangleMesh box = box_mesh({{1, 2, 3}});
  check_sound(box);
  CHECK(box.triangles.size() == 12);
  CHECK(mesh_volume(box) == 6);
  CHECK(mesh_area(box) == 22);
}

TEST_CASE("a hopper has the area of its sides, a funnel in the limit, and both are seen from outside") {
  const auto check_outside = [](const TriangleMesh& mesh) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 p = mesh.vertices[a], normal = cross(mesh.vertices[b] - p, mesh.vertices[c] - p);
      CHECK(normal.x * p.x + normal.y * p.y > 0);
    }
  };
  // Sides inclined outwards by 3 over a height of 4, and by 0.9 over 4.
  const TriangleMesh hopper = hopper_mesh({{1, 2, 0}, {7, 3.8, 0}, 4, 0.5});
  CHECK(hopper.triangles.size() == 16);
  CHECK(near(mesh_area(hopper), (2 + 3.8) * 5 + (1 + 7) * 4.1 + 0.5 * 6, {.relative = 4 * kUlp}));
  check_outside(hopper);
  const TriangleMesh funnel = funnel_mesh({1, 4, 4, 0.5, 2000});
  CHECK(near(mesh_area(funnel), kPi * (1 + 4) * 5 + 0.5 * 2 * kPi, {.relative = 1e-6}));
  check_outside(funnel);
  const auto [low, high] = std::ranges::minmax(funnel.vertices, {}, &Vec3::z);
  CHECK(low.z == -0.5);
  CHECK(high.z == 4);
}

TEST_CASE("primitives are closed, and open ones sound") {
  check_sound(cylinder_mesh({0.5, 2, 3}));
  check_sound(cylinder_mesh({0.5, 2, 24}));
  check_sound(cone_mesh({1, 0, 2, 17}));
  check_sound(cone_mesh({1, 0.3, 2, 17}));
  check_sound(cone_mesh({0.2, 1, 2, 17}));
  for (int levels = 0; levels < 4; ++levels) check_sound(sphere_mesh({0.7, levels}));
  check_sound(capsule_mesh({0.3, 1, 4}));
  check_sound(capsule_mesh({0.3, 1, 16}));
  check_sound(plate_mesh({{2, 1, 0.1}, 0.3, 24}));
  check_sound(pipe_mesh({0.8, 1, 3, 12}));
  check_sound(rectangle_mesh(2, 3), true);
  for (const Real outlet_length : {0., 0.3}) {
    check_sound(funnel_mesh({0.2, 1, 1.5, outlet_length, 17}), true);
    check_sound(hopper_mesh({{0.2, 0.4, 0}, {1, 1, 0}, 1.5, outlet_length}), true);
  }
  for (const Index lifters : {0, 1, 2, 3, 8})
    for (const Real end_wall : {0., 0.1})  // a closed drum has a cavity
      check_sound(drum_mesh({1, 0.05, 2, end_wall, lifters, 0.2, 0.1, 36}), false, end_wall > 0 ? 2 : 1);
  for (const Real pitch : {0.5, -0.4})
    for (const Real core_length : {1.5, 2.})
      check_sound(screw_mesh({0.1, 0.4, pitch, 0.05, 1.5, core_length, 24}));
}

TEST_CASE("round primitives converge at order 2") {
  for (const RoundShape& shape : round_shapes()) {
    CAPTURE(shape.name);
    const MassProperties coarse = solid_mesh_mass(shape.mesh(96), 1),
                         fine = solid_mesh_mass(shape.mesh(192), 1);
    const auto order = [](Real c, Real f, Real exact) { return std::log2((exact - c) / (exact - f)); };
    CHECK(near(order(coarse.mass, fine.mass, shape.volume), 2, {.absolute = 0.03}));
    CHECK(near(order(coarse.inertia.zz, fine.inertia.zz, shape.polar), 2, {.absolute = 0.03}));
    CHECK(near(fine.mass, shape.volume, {.relative = 2e-3}));
    CHECK(near(fine.center, {0, 0, shape.center_z}, {.absolute = 1e-3}));
  }
}

TEST_CASE("right-handed screws are as round as left-handed ones") {
  const Real core = 0.12, length = 2;
  for (const Real pitch : {0.7, -0.7}) {
    const TriangleMesh mesh = screw_mesh({core, 0.42, pitch, 0.05, length, length, 32});
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c], sum = p + q + r;
      const Real farthest = std::max({std::hypot(p.x, p.y), std::hypot(q.x, q.y), std::hypot(r.x, r.y)});
      if (farthest > core * 1.001 || std::abs(sum.z) > 2.7) continue;  // the ends
      const Vec3 normal = cross(q - p, r - p), radial{sum.x, sum.y, 0};
      CHECK(dot(normal, radial) > 0.99 * norm(normal) * norm(radial));
    }
  }
}

TEST_CASE("circles are as symmetric as numbers can be") {
  for (const Index n : {3, 4, 5, 8, 12, 100}) {
    for (Index k = 0; k < n; ++k) {
      const Vec3 p = circle_point(k, n), mirrored = circle_point((n - k) % n, n);
      CHECK(near(p, {std::cos(2 * kPi * k / n), std::sin(2 * kPi * k / n), 0}, {.absolute = 8 * kUlp}));
      CHECK((mirrored.x == p.x && mirrored.y == -p.y));
      if (n % 4 != 0) continue;
      const Vec3 quarter = circle_point((k + n / 4) % n, n);
      CHECK((quarter.x == -p.y && quarter.y == p.x));
    }
  }
  CHECK(circle_point(3, 12) == Vec3{0, 1, 0});
  CHECK(circle_point(1, 8).x == circle_point(1, 8).y);
  CHECK(segments_within(1, 1) == 4);
  for (const Real sag : {0.1, 1e-3, 1e-6}) {
    const Index n = segments_within(2, sag);
    CHECK(2 * (1 - std::cos(kPi / n)) <= sag);
    CHECK(2 * (1 - std::cos(kPi / (n - 4))) > sag);
  }
}

TEST_CASE("a planar line is drawn out to a power of two") {
  const TriangleMesh mesh = extruded_line_mesh({{0, 0, 5}, {3, 0, 5}, {3, 1, 5}}, false, 0.3);
  check_sound(mesh, true);
  CHECK(mesh.triangles.size() == 4);
  for (const Vec3 v : mesh.vertices) CHECK(std::abs(v.z) == 0.5);
  for (const Vec3 v : extruded_line_mesh({{0, 0, 0}, {1, 0, 0}}, false, 2).vertices)
    CHECK(std::abs(v.z) == 2);
  // Faces to the right of the path along +x: towards -y.
  const auto& [a, b, c] = mesh.triangles[0];
  const Vec3 normal = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
  CHECK((normal.x == 0 && normal.y < 0 && normal.z == 0));
}

TEST_CASE("a closed planar line bounds a solid") {
  const std::vector<Vec3> l{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const TriangleMesh mesh = extruded_outline_mesh(l, 1);
  check_sound(mesh);
  CHECK(mesh_volume(mesh) == 6);
  CHECK(mesh.triangles.size() == 20);
  CHECK(without_ends(mesh).triangles == extruded_line_mesh(l, true, 1).triangles);
  CHECK(mesh_volume(line_of_depth(mesh, 0.5)) == 1.5);
  const TriangleMesh clockwise = extruded_outline_mesh({l.rbegin(), l.rend()}, 1);
  CHECK(mesh_defects(clockwise, false).at(0).starts_with("its volume is -6 m^3, below 0"));
  CHECK_THROWS_WITH(extruded_outline_mesh({l[0], l[2], l[1], l[5]}, 1),
                    "the closed line is no outline: it crosses itself or has no area");
}

TEST_CASE("shapes that cannot be") {
  CHECK(shape_defect(BoxShape{{1, 0, 1}}) == "size = [1, 0, 1]: must be positive");
  CHECK(shape_defect(CylinderShape{1, 2, 2}) == "segments = 2: must be 3 to 10000");
  CHECK(shape_defect(CylinderShape{-1, 2, 8}) == "radius = -1: must be positive");
  CHECK(shape_defect(ConeShape{1, -0.1, 2, 8}) == "top_radius = -0.1: must be at least 0");
  CHECK(shape_defect(SphereShape{1, 11}) == "levels = 11: must be 0 to 10");
  CHECK(shape_defect(CapsuleShape{1, 2, 6}) == "segments = 6: must be a multiple of 4, 4 to 10000");
  CHECK(shape_defect(PlateShape{{1, 2, 0.1}, 0.5, 8}) ==
        "hole_radius = 0.5: must be less than half of the plate, 0.5");
  CHECK(shape_defect(FunnelShape{0.1, 0, 1, 0, 8}) == "top_radius = 0: must be positive");
  CHECK(shape_defect(HopperShape{{1, 0, 0}, {1, 1, 0}, 1, 0}) == "size = [1, 0]: must be positive");
  CHECK(shape_defect(HopperShape{{1, 1, 0}, {1, 1, 0}, 1, -1}) == "outlet_length = -1: must be at least 0");
  CHECK(shape_defect(PipeShape{1, 1, 1, 8}) == "outer_radius = 1: must be above inner_radius = 1");
  DrumShape drum{1, 0.1, 2, 0, 6, 0.3, 0.1, 36};
  CHECK(shape_defect(drum) == "");
  drum.lifter_height = 1;
  CHECK(shape_defect(drum) == "6 lifters of height 1 and width 0.1 do not fit into radius = 1");
  drum.lifter_height = 0.95, drum.lifters = 8;
  CHECK(shape_defect(drum) == "8 lifters of height 0.95 and width 0.1 do not fit into radius = 1");
  drum.lifter_height = 1e-4, drum.lifter_width = 0.1;
  CHECK(shape_defect(drum).starts_with("lifter_height = 0.0001: must be above the sag of the wall"));
  ScrewShape screw{0.1, 0.5, 0.5, 0.05, 1, 1, 24};
  CHECK(shape_defect(screw) == "");
  screw.thickness = 0.5;
  CHECK(shape_defect(screw) == "thickness = 0.5: must be less than the pitch, 0.5");
  screw.thickness = 0.1, screw.core_length = 0.9;
  CHECK(shape_defect(screw) == "core_length = 0.9: must be at least length = 1");
  screw.core_length = 1, screw.pitch = 0;
  CHECK(shape_defect(screw) == "pitch = 0: must not be 0");
  screw.pitch = 1e-9, screw.thickness = 1e-10;
  CHECK(shape_defect(screw) == "segments = 24: would make more than 100000000 triangles");
}

}  // namespace scree
