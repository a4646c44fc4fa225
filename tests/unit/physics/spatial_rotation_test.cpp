// The tangent of rotation vectors and its change, from tiny rotations to nearly whole revolutions.
#include "physics/spatial_rotation.hpp"

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

TEST_CASE("the inverse tangent is the change of the rotation vector per change of the orientation") {
  const Vec3 along{0.48, -0.6, 0.64}, change{0.3, 0.7, -0.2};
  for (const Real angle : {1e-9, 1e-3, 0.02, 0.04, 0.5, 2.0, 3.0}) {
    INFO(angle);
    const Vec3 u = angle * along;
    constexpr Real kStep = 1e-5;
    const auto moved = [&](Real s) { return rotation_vector(exponential(u) * exponential(s * change)); };
    const Vec3 numeric = (1 / (2 * kStep)) * (moved(kStep) - moved(-kStep));
    CHECK(near(inverse_tangent(u) * change, numeric, {.absolute = 1e-8}));
  }
}

TEST_CASE("how the inverse tangent changes is its derivative, by series and in closed form") {
  const Vec3 along{0.48, -0.6, 0.64}, on{-0.5, 0.9, 0.4}, change{0.3, 0.7, -0.2};
  for (const Real angle : {0.0, 1e-9, 1e-3, 0.1, 0.2499, 0.2501, 1.0, 3.0}) {
    INFO(angle);
    const Vec3 u = angle * along;
    constexpr Real kStep = 1e-4;
    const auto at = [&](Real s) { return inverse_tangent(u + s * change) * on; };
    const Vec3 numeric = (1 / (2 * kStep)) * (at(kStep) - at(-kStep));
    CHECK(near(inverse_tangent_change(u, on) * change, numeric, {.absolute = 1e-8}));
  }
  // Both forms agree at the end of the series' range.
  const Vec3 below = (0.25 - 1e-13) * along, above = (0.25 + 1e-13) * along;
  CHECK(near(inverse_tangent_change(below, on) * change, inverse_tangent_change(above, on) * change,
             {.absolute = 1e-12}));
}

}  // namespace scree
