// Orders data of particles on all ranks by global id.
#pragma once

#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "model/data/id_range.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Each rank gets its range of the ids (id_range) in increasing order: the ranks' parts, one after the other,
// are all particles in the order of their ids. No rank holds more than its range and its original data.
class IdOrder {
 public:
  // count: the end of the ranges, equal on every rank; ids above it go to the last rank. ids: of this rank's
  // particles in any order, each id once over all ranks. Collective.
  IdOrder(const Ranks& ranks, std::int64_t count, std::span<const GlobalId> ids);

  // values: one per particle, in the order of the constructor's ids. Returns those of this rank's range of
  // ids, in their order. Collective.
  template <class T>
  std::vector<T> apply(std::vector<T> values) const {
    values = permuted(std::move(values), sent_);
    if (!ranks_.alone()) values = ranks_.all_to_all(std::span<const T>(values), counts_);
    return permuted(std::move(values), arrived_);
  }
  // As above for rows of values: the i-th particle has lengths[i] of them. Collective.
  template <class T>
  std::vector<T> apply(std::vector<T> values, std::vector<std::int64_t> lengths) const {
    values = permuted_rows(std::move(values), lengths, sent_);
    if (!ranks_.alone()) {
      lengths = permuted(std::move(lengths), sent_);
      std::vector<std::int64_t> sums;  // per receiving rank
      auto length = lengths.begin();
      for (const std::int64_t rows : counts_) {
        sums.push_back(std::accumulate(length, length + rows, std::int64_t{0}));
        length += rows;
      }
      values = ranks_.all_to_all(std::span<const T>(values), sums);
      lengths = ranks_.all_to_all(std::span<const std::int64_t>(lengths), counts_);
    }
    return permuted_rows(std::move(values), lengths, arrived_);
  }

 private:
  // The values at the indices `order`; an empty order leaves them unchanged.
  template <class T>
  static std::vector<T> permuted(std::vector<T> values, const std::vector<std::size_t>& order) {
    if (order.empty()) return values;
    std::vector<T> out(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) out[i] = values[order[i]];
    return out;
  }
  template <class T>
  static std::vector<T> permuted_rows(std::vector<T> values, const std::vector<std::int64_t>& lengths,
                                      const std::vector<std::size_t>& order) {
    if (order.empty()) return values;
    std::vector<std::int64_t> first(lengths.size());
    std::exclusive_scan(lengths.begin(), lengths.end(), first.begin(), std::int64_t{0});
    std::vector<T> out;
    out.reserve(values.size());
    for (const std::size_t row : order)
      out.insert(out.end(), values.begin() + first[row], values.begin() + first[row] + lengths[row]);
    return out;
  }

  Ranks ranks_;
  std::vector<std::size_t> sent_, arrived_;  // orders that sort by id; empty if already sorted
  std::vector<std::int64_t> counts_;         // per receiving rank
};

}  // namespace scree
