#include "model/derived/exact_shares.hpp"

#include <algorithm>
#include <numeric>

namespace scree {

int next_by_shares(std::span<const Real> shares, std::span<const std::int64_t> counts, Real u) {
  const auto kinds = static_cast<int>(shares.size());
  if (kinds == 1) return 0;
  const Real margin = Real(1) / (2 * kinds - 2);
  const auto n = static_cast<Real>(std::accumulate(counts.begin(), counts.end(), std::int64_t{1}));
  // Among the kinds that are behind their shares by the margin, those whose number would fall behind by more
  // than 1 - margin first. Round-off may leave no kind behind by the margin: then all kinds count.
  const auto behind = [&](std::size_t k) { return shares[k] * n - static_cast<Real>(counts[k]); };
  const auto deadline = [&](std::size_t k) {
    return (static_cast<Real>(counts[k]) + 1 - margin) / shares[k];
  };
  for (const Real least : {margin, -kInfinity}) {
    Real first = kInfinity;
    int equal = 0;  // kinds with the first deadline
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (behind(k) < least || deadline(k) > first) continue;
      equal = deadline(k) < first ? 1 : equal + 1;
      first = deadline(k);
    }
    int chosen = static_cast<int>(u * equal);
    for (std::size_t k = 0; k < shares.size() && equal > 0; ++k)
      if (behind(k) >= least && deadline(k) == first && chosen-- == 0) return static_cast<int>(k);
  }
  return 0;
}

}  // namespace scree
