// Concave edges beyond the feature angle.
#include "mesh/mesh_fold.hpp"

#include <numbers>

#include "mesh/primitives.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kDegree = std::numbers::pi_v<Real> / 180;

MeshFold fold_of(const TriangleMesh& mesh, bool sheet, Real feature_angle = kFeatureAngle) {
  return build_surface_mesh(mesh, feature_angle, sheet).fold;
}

// A line through the points, extruded along z.
TriangleMesh bent(const std::vector<Vec3>& points, bool closed = false) {
  return extruded_line_mesh(points, closed, 1);
}

}  // namespace

TEST_CASE("the fold of the smallest angle is found, on open surfaces from either side") {
  for (const Real sign : {1.0, -1.0}) {
    const MeshFold fold =
        fold_of(bent({{-1, 0, 0}, {0, 0, 0}, {1, sign, 0}, {0.5, 5 * sign, 0}, {-3, 5 * sign, 0}}), true);
    CHECK(fold.angle == Approx(45 * kDegree).epsilon(kAccumulatedRoundOff));
    CHECK(norm(fold.position) < 1e-12);
  }
  // 31 and 29 degrees.
  const auto of_angle = [](Real degrees) {
    return fold_of(
        bent({{-1, 0, 0}, {0, 0, 0}, {std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0}}), true);
  };
  CHECK(of_angle(31).angle == Approx(31 * kDegree).epsilon(kAccumulatedRoundOff));
  CHECK(of_angle(29).angle == 0);
}

TEST_CASE("of closed meshes folds are concave from outside") {
  CHECK(fold_of(box_mesh({{1, 1, 1}}), false).angle == 0);
  CHECK(fold_of(cylinder_mesh({1, 1, 8}), false).angle == 0);
  CHECK(fold_of(pipe_mesh({1, 2, 1, 8}), false).angle == Approx(45 * kDegree).epsilon(kAccumulatedRoundOff));
  CHECK(fold_of(pipe_mesh({1, 2, 1, 16}), false).angle == 0);
  CHECK(fold_of(pipe_mesh({1, 2, 1, 16}), false, 0.2).angle == 0);
  CHECK(fold_of(pipe_mesh({1, 2, 1, 8}), false, 0.8).angle == 0);
  // The first of 16 folds with equal angles.
  CHECK(norm(fold_of(pipe_mesh({1, 2, 1, 8}), false).position) == Approx(1).epsilon(kAccumulatedRoundOff));
}

}  // namespace scree
