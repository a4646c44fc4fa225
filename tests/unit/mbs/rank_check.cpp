#include "mbs/rank_check.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace scree;

TEST_CASE("independent columns have no dependency") {
  CHECK(dependent_columns(3, 2, {{0, 0, 1}, {1, 0, 2}, {1, 1, 1}, {2, 1, 1e6}}).empty());
  // Nearly parallel, but not equal.
  CHECK(dependent_columns(2, 2, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1e-6}}).empty());
  CHECK(dependent_columns(2, 0, {}).empty());
  CHECK(dependent_columns(1, 1, {{0, 0, NAN}}).empty());
}

TEST_CASE("a dependency names exactly the columns that take part") {
  // Column 3 = 2 column 0 - column 2; columns 1 and 4 have nothing to do with it.
  const std::vector<MatrixEntry> entries = {{0, 0, 1}, {1, 0, 3}, {2, 1, 1}, {1, 2, 5},
                                            {0, 3, 2}, {1, 3, 1}, {3, 4, 1}, {2, 4, 1}};
  CHECK(dependent_columns(4, 5, entries) == std::vector<int>{0, 2, 3});
  CHECK(dependent_columns(2, 2, {{0, 0, 1}}) == std::vector<int>{1});
  CHECK(dependent_columns(2, 2, {{0, 0, 1e9}, {0, 1, 1e-9}}) == std::vector<int>{0, 1});
}

TEST_CASE("a long chain is checked in linear time") {
  // Differences of neighbours, and one more column from the first to the last.
  constexpr int kLinks = 20000;
  std::vector<MatrixEntry> entries;
  for (int i = 0; i < kLinks; ++i) {
    entries.push_back({i, i, -1});
    entries.push_back({i + 1, i, 1});
  }
  CHECK(dependent_columns(kLinks + 1, kLinks, entries).empty());
  entries.push_back({0, kLinks, -1});
  entries.push_back({kLinks, kLinks, 1});
  CHECK(dependent_columns(kLinks + 1, kLinks + 1, entries).size() == kLinks + 1);
}
