#include "partition/id_order.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace scree {
namespace {

std::vector<std::size_t> sorting_order(std::span<const GlobalId> ids) {
  if (std::is_sorted(ids.begin(), ids.end())) return {};
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  return order;
}

}  // namespace

IdOrder::IdOrder(const Ranks& ranks, std::int64_t count, std::span<const GlobalId> ids)
    : ranks_(ranks), sent_(sorting_order(ids)), counts_(as_size(ranks.size())) {
  if (ranks.alone()) return;
  for (const GlobalId id : ids) ++counts_[as_size(id_owner(count, id, ranks.size()))];
  arrived_ = sorting_order(apply(std::vector<GlobalId>(ids.begin(), ids.end())));
}

}  // namespace scree
