#include "dem/reports/triangle_works.hpp"
#include "support/catch.hpp"

namespace scree {

TEST_CASE("sums at triangles are normalized before their limbs are full") {
  TermCount count;
  const std::int64_t third = FixedSum::kMostTerms / 3;
  for (int round = 0; round < 4; ++round) {
    CHECK(count.take(third) == (round == 0));
    CHECK(count.take(third));
    CHECK(count.take(third));
  }
  TriangleWork work;
  for (FixedSum& sum : work.of) sum.word[0] = std::int64_t{5} << 40;
  const Real before = work.of[kImpactWork].value();
  NormalizeItem{&work}(0);
  for (const FixedSum& sum : work.of) {
    CHECK(sum.word[0] < std::int64_t{1} << 32);
    CHECK(sum.value() == before);
  }
}

}  // namespace scree
