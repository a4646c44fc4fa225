// Random numbers by counters: the generator's published vectors, and sequences by seed, purpose and index.
#include "base/counter_random.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

std::vector<Real> numbers(std::uint64_t seed, RandomStream stream, std::int64_t index, int count) {
  CounterRandom random(seed, stream, index);
  std::vector<Real> drawn;
  for (int k = 0; k < count; ++k) drawn.push_back(random.uniform());
  return drawn;
}

bool equal(const PhiloxBlock& block, std::array<std::uint32_t, 4> expected) {
  return std::equal(expected.begin(), expected.end(), block.word);
}

}  // namespace

TEST_CASE("Philox4x32-10 gives the known answers of its authors' library, Random123") {
  constexpr std::uint32_t kOnes = 0xffffffff;
  CHECK(equal(philox4x32({{0, 0, 0, 0}}, {{0, 0}}), {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  CHECK(equal(philox4x32({{kOnes, kOnes, kOnes, kOnes}}, {{kOnes, kOnes}}),
              {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  // Digits of pi.
  CHECK(equal(philox4x32({{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, {{0xa4093822, 0x299f31d0}}),
              {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST_CASE("a random sequence depends on seed, purpose and index") {
  const std::vector<Real> one = numbers(5, RandomStream::radius, 7, 9);
  CHECK(one == numbers(5, RandomStream::radius, 7, 9));
  for (const std::vector<Real>& other :
       {numbers(6, RandomStream::radius, 7, 9), numbers(5, RandomStream::mass, 7, 9),
        numbers(5, RandomStream::radius, 8, 9), numbers(5, RandomStream::radius, 7 + (1ll << 32), 9)})
    for (std::size_t k = 0; k < one.size(); ++k) CHECK(one[k] != other[k]);
  // The first number of seed 0, index 0 follows from the block of the counter (0, 0, 0, stream).
  const PhiloxBlock block = philox4x32({{0, 0, 0, 1u << 16}}, {{0, 0}});
  const std::uint64_t bits = static_cast<std::uint64_t>(block.word[1]) << 32 | block.word[0];
  CHECK(numbers(0, RandomStream::radius, 0, 1)[0] == static_cast<Real>(bits >> 11) * 0x1p-53);
}

TEST_CASE("uniform and normal random numbers have their moments, over indices and within a sequence") {
  constexpr int kCount = 100000;
  const Real error = 1 / std::sqrt(Real(kCount));
  for (const bool over_indices : {true, false}) {
    Real sum = 0, squares = 0, products = 0, normals = 0, normal_squares = 0, before = 0.5;
    CounterRandom within(3, RandomStream::test, 0);
    for (int i = 0; i < kCount; ++i) {
      CounterRandom own(3, RandomStream::test, i);
      CounterRandom& random = over_indices ? own : within;
      const Real u = random.uniform(), z = random.normal();
      REQUIRE((u >= 0 && u < 1));
      sum += u, squares += u * u, products += (u - 0.5) * (before - 0.5), before = u;
      normals += z, normal_squares += z * z;
    }
    // Five standard errors.
    CHECK(near(sum / kCount, 0.5, {.absolute = 5 * error / std::sqrt(12.0)}));
    CHECK(near(squares / kCount, 1.0 / 3, {.absolute = 5 * error * std::sqrt(4.0 / 45)}));
    CHECK(near(products / kCount, 0, {.absolute = 5 * error / 12}));
    CHECK(near(normals / kCount, 0, {.absolute = 5 * error}));
    CHECK(near(normal_squares / kCount, 1, {.absolute = 5 * error * std::sqrt(2.0)}));
  }
}

}  // namespace scree
