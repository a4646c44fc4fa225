#include "mbs/rank_check.hpp"

#include <algorithm>
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
  // Column 3 = 2 column 0 - column 2; columns 1 and 4 do not take part.
  const std::vector<MatrixEntry> entries = {{0, 0, 1}, {1, 0, 3}, {2, 1, 1}, {1, 2, 5},
                                            {0, 3, 2}, {1, 3, 1}, {3, 4, 1}, {2, 4, 1}};
  CHECK(dependent_columns(4, 5, entries) == std::vector<int>{0, 2, 3});
  CHECK(dependent_columns(2, 2, {{0, 0, 1}}) == std::vector<int>{1});
  CHECK(dependent_columns(2, 2, {{0, 0, 1e9}, {0, 1, 1e-9}}) == std::vector<int>{0, 1});
}

TEST_CASE("all dependencies are found, as many as columns less the rank") {
  // Columns 0 and 1; 2 = 3 + 4; 5 is zero; 6 = 2 - 3 = 4 again.
  const std::vector<MatrixEntry> entries = {{0, 0, 1}, {0, 1, 2}, {1, 2, 1}, {2, 2, 1},
                                            {1, 3, 1}, {2, 4, 1}, {2, 6, 3}, {3, 7, 1}};
  const std::vector<Dependency> found = column_dependencies(4, 8, entries);
  REQUIRE(found.size() == 4);
  std::vector<bool> takes_part(8, false);
  std::vector<std::vector<int>> parts;
  for (const Dependency& dependency : found) {
    CHECK(std::is_sorted(dependency.columns.begin(), dependency.columns.end()));
    for (const int column : dependency.columns) takes_part[static_cast<std::size_t>(column)] = true;
    parts.push_back(dependency.columns);
    std::vector<Real> sum(4, 0);
    for (const auto& [column, weight] : dependency.weight)
      for (const MatrixEntry& entry : entries)
        if (entry.column == column) sum[static_cast<std::size_t>(entry.row)] += weight * entry.value;
    for (const Real value : sum) CHECK(std::abs(value) < 1e-14);
  }
  CHECK(takes_part == std::vector<bool>{true, true, true, true, true, true, true, false});
  CHECK(std::count(parts.begin(), parts.end(), std::vector<int>{5}) == 1);
  CHECK(std::count(parts.begin(), parts.end(), std::vector<int>{0, 1}) == 1);
}

TEST_CASE("a column near others hides no dependency, nor counts as one") {
  // Column 2 is nearly 0 + 1, 3 is nearly 2 + 0, and 5 is nearly 4 + 3.
  for (const Real little : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    const std::vector<MatrixEntry> entries = {{0, 0, 1}, {1, 1, 1}, {0, 2, 1},      {1, 2, 1}, {2, 2, little},
                                              {0, 3, 2}, {1, 3, 1}, {2, 3, little}, {3, 4, 1}, {3, 5, 1},
                                              {0, 5, 2}, {1, 5, 1}, {2, 5, little}};
    CAPTURE(little);
    CHECK(column_dependencies(4, 6, entries).size() == 2);
  }
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

TEST_CASE("how near a column is to the others does not depend on their order") {
  // Column d is a unit vector e of the others' combination (1, 1, 0.05) / sqrt(...) but for 0.01 across it.
  const Real weight[] = {1, 1, 0.05}, across = 0.01;
  const Real length = std::sqrt(1 + 1 + 0.05 * 0.05);
  int order[] = {0, 1, 2, 3};
  do {
    std::vector<MatrixEntry> entries;
    for (int k = 0; k < 3; ++k) {
      entries.push_back({k, order[k], 7});
      entries.push_back({k, order[3], weight[k] / length});
    }
    entries.push_back({3, order[3], across});
    const std::vector<NearDependency> near = nearest_combinations(4, 4, entries, {order[3], order[2]});
    REQUIRE(near.size() == 2);
    CHECK(std::abs(near[0].distance - across / std::sqrt(1 + across * across)) < 1e-6 * across);
    CHECK(near[0].combination.columns == std::vector<int>{0, 1, 2, 3});
    CHECK(near[1].distance > 0.2);  // a column that hardly takes part is far from all others
  } while (std::next_permutation(order, order + 4));
  CHECK(nearest_combinations(1, 1, {{0, 0, NAN}}, {0}).empty());
  CHECK(nearest_combinations(2, 2, {{0, 0, 1}, {0, 1, 2}}, {1}).front().distance < 1e-6);
}
