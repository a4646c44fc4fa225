// Deviation of facets from the surfaces that they approximate, against points on all facets.
#include "mesh/facets.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// The distance of a point from one of the surfaces of a shape [m].
using Surface = std::function<Real(Vec3)>;

Surface cylinder(Real radius) {
  return [=](Vec3 p) { return std::abs(std::hypot(p.x, p.y) - radius); };
}
Surface disc(Real z) {
  return [=](Vec3 p) { return std::abs(p.z - z); };
}
Surface ball(Real radius, Real z = 0) {
  return [=](Vec3 p) { return std::abs(norm(p - Vec3{0, 0, z}) - radius); };
}
Surface cone(Real radius, Real top_radius, Real length) {
  return [=](Vec3 p) {
    const Real slant = std::hypot(length, top_radius - radius);
    const Real beside = std::hypot(p.x, p.y) - radius - p.z / length * (top_radius - radius);
    return std::abs(beside) * length / slant;
  };
}
// The face of a left-handed flight that is rotated by `angle` at z = 0, by brute force over the angle.
Surface helicoid(Real rise, Real angle) {
  return [=](Vec3 p) {
    const Real own = std::atan2(p.y, p.x);
    const Real turns = std::round((-p.z / rise + angle - own) / (2 * kPi));
    Real least = kInfinity, from = -0.3, to = 0.3, at = 0;
    for (int round = 0; round < 6; ++round) {
      for (int k = 0; k <= 40; ++k) {
        const Real turn = from + (to - from) * k / 40;
        const Real z = -rise * (own + 2 * kPi * turns + turn - angle);
        const Real distance = std::hypot(std::hypot(p.x, p.y) * std::sin(turn), p.z - z);
        if (distance < least) least = distance, at = turn;
      }
      const Real width = (to - from) / 20;
      from = at - width, to = at + width;
    }
    return least;
  };
}

// The largest distance of points of facets from the surface on which their corners lie, the nearest one of
// several.
Real measured(const TriangleMesh& mesh, const std::vector<Surface>& surfaces, int points = 12) {
  constexpr Real kOnIt = 1e-9;
  Real farthest = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    Real of_facet = kInfinity;
    for (const Surface& surface : surfaces) {
      if (surface(p) > kOnIt || surface(q) > kOnIt || surface(r) > kOnIt) continue;
      Real largest = 0;
      for (int i = 0; i <= points; ++i)
        for (int j = 0; i + j <= points; ++j)
          largest = std::max(largest, surface(p + Real(i) / points * (q - p) + Real(j) / points * (r - p)));
      of_facet = std::min(of_facet, largest);
    }
    REQUIRE(of_facet < kInfinity);
    farthest = std::max(farthest, of_facet);
  }
  return farthest;
}

}  // namespace

TEST_CASE("facets of shapes of revolution have the stated deviation from the true surface") {
  for (const Index n : {4, 8, 12, 16, 48}) {
    CAPTURE(n);
    const auto check = [](const auto& shape, const TriangleMesh& mesh, const std::vector<Surface>& surfaces) {
      CHECK(facet_deviation(shape) == Approx(measured(mesh, surfaces)).epsilon(0.01));
    };
    const CylinderShape rod{0.5, 2, n};
    check(rod, cylinder_mesh(rod), {cylinder(0.5), disc(-1), disc(1)});
    CHECK(facet_deviation(rod) == Approx(0.5 * (1 - std::cos(kPi / n))).epsilon(kAccumulatedRoundOff));
    const PipeShape pipe{0.3, 0.5, 2, n};
    check(pipe, pipe_mesh(pipe), {cylinder(0.3), cylinder(0.5), disc(-1), disc(1)});
    const PlateShape plate{{2, 1.5, 0.2}, 0.6, n};
    const auto sides = [](Vec3 p) {
      return std::min(std::abs(std::abs(p.x) - 1), std::abs(std::abs(p.y) - 0.75));
    };
    check(plate, plate_mesh(plate), {cylinder(0.6), disc(-0.1), disc(0.1), sides});
    const ConeShape tip{1, 0, 0.7, n}, stump{0.4, 1, 1.5, n};
    check(tip, cone_mesh(tip), {cone(1, 0, 0.7), disc(0)});
    check(stump, cone_mesh(stump), {cone(0.4, 1, 1.5), disc(0), disc(1.5)});
    const CapsuleShape capsule{0.5, 2, n};
    check(capsule, capsule_mesh(capsule), {cylinder(0.5), ball(0.5, -1), ball(0.5, 1)});
    for (const Real outlet : {0.0, 0.5}) {
      const FunnelShape funnel{0.4, 0.45, 0.1, outlet, n}, steep{0.1, 1, 0.5, outlet, n};
      check(funnel, funnel_mesh(funnel), {cone(0.4, 0.45, 0.1), cylinder(0.4)});
      check(steep, funnel_mesh(steep), {cone(0.1, 1, 0.5), cylinder(0.1)});
    }
  }
}

TEST_CASE("facets of spheres and drums have the stated deviation; flat shapes have none") {
  for (const int levels : {0, 1, 2, 3, 4}) {
    const SphereShape sphere{0.7, levels};
    CHECK(facet_deviation(sphere) == Approx(measured(sphere_mesh(sphere), {ball(0.7)}, 24)).epsilon(0.01));
  }
  for (const Index n : {8, 24, 96})
    for (const Index lifters : {0, 5})
      for (const Real end_wall : {0.0, 0.15}) {
        CAPTURE(n, lifters, end_wall);
        const DrumShape drum{1, 0.1, 2, end_wall, lifters, 0.25, 0.2, n};
        std::vector<Surface> surfaces{cylinder(1), cylinder(1.1), disc(-1), disc(1), disc(-1.15), disc(1.15)};
        for (Index k = 0; k < lifters; ++k) {
          const Vec3 out = circle_point(k, lifters), along{-out.y, out.x, 0};
          surfaces.push_back([=](Vec3 p) { return std::abs(dot(p, out) - 0.75); });
          for (const Real side : {-0.1, 0.1})
            surfaces.push_back([=](Vec3 p) { return std::abs(dot(p, along) - side); });
        }
        CHECK(facet_deviation(drum) == Approx(measured(drum_mesh(drum), surfaces)).epsilon(0.01));
      }
  CHECK(facet_deviation(BoxShape{{1, 2, 3}}) == 0);
  CHECK(facet_deviation(HopperShape{{1, 1, 0}, {2, 2, 0}, 1, 0}) == 0);
}

TEST_CASE("facets of screws have the stated deviation from core, rim and faces") {
  for (const ScrewShape& base :
       {ScrewShape{0.012, 0.045, -0.07, 0.005, 0.14, 0.14, 0},
        ScrewShape{0.044, 0.045, -0.5, 0.3, 0.5, 0.6, 0}, ScrewShape{0.01, 0.045, -0.4, 0.001, 0.2, 0.2, 0}})
    for (const Index n : {8, 16, 48}) {
      ScrewShape screw = base;
      screw.segments = n;
      CAPTURE(n, screw.pitch, facet_deviation(screw));
      const Real rise = -screw.pitch / (2 * kPi), half = kPi * screw.thickness / -screw.pitch;
      const std::vector<Surface> surfaces{cylinder(screw.core_radius), cylinder(screw.flight_radius),
                                          helicoid(rise, half),        helicoid(rise, -half),
                                          disc(screw.length / 2),      disc(-screw.length / 2),
                                          disc(screw.core_length / 2), disc(-screw.core_length / 2)};
      CHECK(facet_deviation(screw) == Approx(measured(screw_mesh(screw), surfaces, 8)).epsilon(0.02));
    }
  // The angles between its facets do not reveal this sag: eight chords around a rim of radius 0.045.
  CHECK(facet_deviation(ScrewShape{0.012, 0.045, 0.07, 0.005, 0.14, 0.14, 8}) ==
        Approx(0.045 * (1 - std::cos(kPi / 8))).epsilon(0.01));
}

TEST_CASE(
    "segments that fit the particles: facets within a twentieth of their radius, edges no shorter than "
    "they") {
  const Real angle = kPi / 6;
  for (const Real radius : {0.3, 0.05, 1.0, 7.0}) {
    const Real particle_radius = 0.01;
    const Index n = fitting_segments(radius, particle_radius, angle);
    CAPTURE(radius, n);
    CHECK(n % 4 == 0);
    CHECK(facet_deviation(CylinderShape{radius, 1, n}) <= 0.05 * particle_radius);
    if (n > 16) CHECK(facet_deviation(CylinderShape{radius, 1, n - 4}) > 0.05 * particle_radius);
    CHECK(2 * kPi * radius / n > 0.4 * 2 * particle_radius);
  }
  CHECK(fitting_segments(1, 100, angle) == 16);
  CHECK(fitting_segments(1, 1e-9, angle) == 360);
  CHECK(fitting_segments(1, 100, 0.1) == 64);  // of less than 0.1 rad each
  CHECK(fitting_segments(1, 100, 1e-9) == 360);
  CHECK(facet_deviation(SphereShape{1, fitting_levels(1, 0.1)}) <= 0.005);
  CHECK(facet_deviation(SphereShape{1, fitting_levels(1, 0.1) - 1}) > 0.005);
  CHECK(fitting_levels(1, 100) == 2);
  CHECK(fitting_levels(1, 1e-9) == 6);
}

}  // namespace scree
