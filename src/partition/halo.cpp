#include "partition/halo.hpp"

#include <algorithm>

#include "base/for_each.hpp"
#include "base/index.hpp"

namespace scree {

void Halo::exchange(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                    std::span<const Vec4> position, Real width) {
  plan_ = HaloPlan(ranks, decomposition, subdomain, width);
  collect_ghosts(position);
  images_.clear();
  for (const Ghost& ghost : own_) images_.push_back(ghost.image);
  images_.resize(as_size(plan_.ghosts()));
  for (std::vector<Vec4>& buffer : buffer_) buffer.resize(sent_.size());
  std::vector<std::int8_t> sent(sent_.size());
  std::transform(sent_.begin(), sent_.end(), sent.begin(), [](const Ghost& g) { return g.image; });
  const HaloMessage message{sent.data(), images_.data(), sizeof(std::int8_t)};
  plan_.transfer({&message, 1});
}

void Halo::collect_ghosts(std::span<const Vec4> position) {
  own_.clear(), sent_.clear();
  std::vector<std::vector<Ghost>> ghosts(plan_.neighbors().size());
  for (Index i = 0; i < as_index(position.size()); ++i)
    plan_.for_each_target(xyz(position[as_size(i)]), [&](const HaloTarget& t) {
      (t.neighbor == HaloTarget::kItself ? own_ : ghosts[as_size(t.neighbor)])
          .push_back({i, t.image, {}, t.shift});
    });
  std::vector<std::size_t> counts;
  for (const std::vector<Ghost>& list : ghosts) {
    counts.push_back(list.size());
    sent_.insert(sent_.end(), list.begin(), list.end());
  }
  plan_.set_counts(own_.size(), counts);
}

void Halo::update_motion(std::span<Vec4> position, std::span<Vec4> velocity,
                         std::optional<std::span<Vec4>> spin, Index first_ghost) const {
  const auto n = as_index(own_.size());
  for_each(Serial{}, n, HaloPositionItem{own_.data(), position.data(), first_ghost});
  for_each(Serial{}, n, HaloItem<Vec4>{own_.data(), velocity.data(), first_ghost});
  if (spin) for_each(Serial{}, n, HaloItem<Vec4>{own_.data(), spin->data(), first_ghost});
  for (std::size_t k = 0; k < sent_.size(); ++k) {
    const auto source = as_size(sent_[k].source);
    buffer_[0][k] = moved(sent_[k], position[source]), buffer_[1][k] = velocity[source];
    if (spin) buffer_[2][k] = (*spin)[source];
  }
  const auto message = [&](int buffer, std::span<Vec4> field) {
    return HaloMessage{buffer_[buffer].data(), field.data() + first_ghost, sizeof(Vec4)};
  };
  std::vector<HaloMessage> messages{message(0, position), message(1, velocity)};
  if (spin) messages.push_back(message(2, *spin));
  plan_.transfer(messages);
}

}  // namespace scree
