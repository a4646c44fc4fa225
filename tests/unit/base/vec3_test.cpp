// Vector algebra and the inverse of symmetric positive definite matrices.
#include "base/vec3.hpp"

#include <limits>
#include <random>

#include "support/catch.hpp"

namespace scree {

namespace {

Real number(std::mt19937_64& random) {
  return std::ldexp(static_cast<Real>(static_cast<std::int64_t>(random())), -63);
}

Vec3 vector(std::mt19937_64& random) {
  const Real x = number(random), y = number(random), z = number(random);
  return {x, y, z};
}

}  // namespace

TEST_CASE("cross and dot products") {
  CHECK(cross({1, 0, 0}, {0, 1, 0}) == Vec3{0, 0, 1});
  CHECK(cross({0, 1, 0}, {0, 0, 1}) == Vec3{1, 0, 0});
  CHECK(cross({0, 0, 1}, {1, 0, 0}) == Vec3{0, 1, 0});
  CHECK(dot({1, 2, 3}, {4, -5, 6}) == 12);
  CHECK(norm({2, 3, 6}) == 7);
  Vec3 a{1, 2, 3};
  a += {1, 1, 1}, a -= {0, 1, 2};
  CHECK(a == Vec3{2, 2, 2});
  CHECK(-a == Vec3{-2, -2, -2});
  CHECK(xyz(vec4(a, 5)) == a);
  CHECK(vec4(a, 5).w == 5);
}

TEST_CASE("a vector is finite only if all its components are") {
  CHECK(is_finite({1, -2, 3}));
  for (const Real bad : {std::numeric_limits<Real>::infinity(), std::numeric_limits<Real>::quiet_NaN()}) {
    CHECK_FALSE(is_finite({bad, 0, 0}));
    CHECK_FALSE(is_finite({0, bad, 0}));
    CHECK_FALSE(is_finite({0, 0, bad}));
  }
}

TEST_CASE("an outer product projects on its vector") {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3 n = vector(random), v = vector(random);
    const Real round_off = 1e-15;
    CHECK(norm(outer(2.5, n) * v - (2.5 * dot(n, v)) * n) <= round_off);
  }
}

// A mass plus contacts of growing stiffness, the blocks that the particles' linear solve inverts.
TEST_CASE("the inverse of a positive definite matrix times the matrix is the unit matrix") {
  std::mt19937_64 random(2);
  for (const Real stiffness : {0.0, 1.0, 1e3, 1e6}) {
    CAPTURE(stiffness);
    Sym3 a{1, 0, 0, 1, 0, 1};
    for (int contact = 0; contact < 4; ++contact) a += outer(stiffness, vector(random));
    const Sym3 b = inverse(a);
    // A relative error of each entry of the inverse, times the condition number.
    const Real round_off = 1e-15 * (1 + 10 * stiffness);
    for (const Vec3 unit : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      CHECK(norm(b * (a * unit) - unit) <= round_off);
  }
}

TEST_CASE("the inverse of a diagonal matrix is exact for powers of two") {
  const Sym3 b = inverse({2, 0, 0, 4, 0, 8});
  CHECK(b.xx == 0.5);
  CHECK(b.yy == 0.25);
  CHECK(b.zz == 0.125);
  CHECK((b.xy == 0 && b.xz == 0 && b.yz == 0));
}

}  // namespace scree
