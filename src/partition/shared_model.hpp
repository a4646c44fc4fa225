// The ranks of a run, sharing the construction of one model.
#pragma once

#include "model/data/share.hpp"
#include "partition/ranks.hpp"

namespace scree {

class RankShare : public Share {
 public:
  explicit RankShare(const Ranks& ranks) : ranks_(ranks) {}
  int rank() const override { return ranks_.rank(); }
  int size() const override { return ranks_.size(); }
  void collectively(const std::function<void()>& action) const override { ranks_.collectively(action); }
  std::int64_t sum(std::int64_t value) const override { return ranks_.sum(value); }
  std::int64_t min(std::int64_t value) const override { return ranks_.min(value); }
  Real max(Real value) const override { return ranks_.max(value); }
  Real sum_on_host(Real value) const override { return ranks_.sum_on_host(value); }
  std::vector<StartItem> all_gather(std::vector<StartItem> own) const override {
    return ranks_.all_gather(std::move(own));
  }
  // Distributes the items over boxes with nearly equal numbers of items, as in a run. Throws InputError if
  // the domain is too small for so many boxes.
  std::vector<StartItem> distribute_by_boxes(std::vector<StartItem> own, const Space& space,
                                             Real reach) const override;

 private:
  Ranks ranks_;
};

}  // namespace scree
