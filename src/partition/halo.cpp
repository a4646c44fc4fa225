#include "partition/halo.hpp"

#include <algorithm>

#include "base/for_each.hpp"
#include "base/index.hpp"
#include "partition/level_grids.hpp"

namespace scree {

namespace {

std::size_t list_of(const HaloTarget& target) { return as_size(target.neighbor + 1); }
static_assert(HaloTarget::kItself == -1);

Ghost ghost_in(const HaloTarget& target, Index source) { return {source, target.image, {}, target.shift}; }

// Number of the shift by the same periods in the other direction.
std::int8_t opposite_image(std::int8_t image) { return static_cast<std::int8_t>(2 * kZeroShift - image); }

// The second round of the halo of particles of many sizes. An item of this rank that is near a ghost of a
// higher level is a partner of the original and becomes a ghost on the rank that owns the original.
class SmallPartners {
 public:
  // ghosts: positions of those of the first round; images: theirs.
  SmallPartners(const HaloPlan& plan, const SizeLevels& levels, const LevelSpace& space,
                std::span<const Vec4> ghosts, std::span<const std::int8_t> images)
      : plan_(plan), levels_(levels), space_(space), ghosts_(ghosts), last_(plan.targets().size(), -1) {
    space_.extent = finite_part(plan.box(), space.extent);
    sort_ghosts();
    find_targets(images);
  }

  // Calls add(target) for each target of item i at p that is not among those of the first round.
  template <class Add>
  void visit(Index i, Vec4 p, const Add& add) {
    const Real past_touch = space_.past_touch;
    if (plan_.box().inside(xyz(p), (p.w + levels_.largest() + past_touch) * (1 + kBoxRoundOff))) return;
    const Real reach = reach_in_level(levels_, p.w, past_touch);
    for (int k = levels_.of(p.w) + 1; k < levels_.count; ++k) {
      const LevelGrid& level = cells_.levels[as_size(k)];
      if (level.items == 0) continue;
      cells_.for_each_run(level, level.near(p, past_touch), [&](Index first, Index last) {
        for (Index n = first; n < last; ++n) {
          const Index ghost = cells_.items[as_size(n)];
          const Index target = target_of_[as_size(ghost)];
          if (last_[as_size(target)] == i || !near(p, ghosts_[as_size(ghost)])) continue;
          last_[as_size(target)] = i;
          const HaloTarget& at = plan_.targets()[as_size(target)];
          if (!at.box.is_within(xyz(p) + at.shift, reach)) add(at);
        }
      });
    }
  }

 private:
  bool near(Vec4 p, Vec4 q) const {
    const Vec3 d = xyz(p) - xyz(q);
    const Real distance = p.w + q.w + space_.past_touch;
    return dot(d, d) < distance * distance * (1 + kBoxRoundOff);
  }
  void sort_ghosts() {
    std::vector<Index> in_level(as_size(levels_.count)), cell_of;
    for (const Vec4& p : ghosts_) ++in_level[as_size(levels_.of(p.w))];
    in_level[0] = 0;  // partners of no smaller items
    cells_.levels = make_level_grids(levels_, space_, in_level);
    for (const Vec4& p : ghosts_) {
      const int level = levels_.of(p.w);
      cell_of.push_back(level == 0 ? -1 : cells_.levels[as_size(level)].nearest(xyz(p)));
    }
    cells_.sort(cell_of);
  }
  // An original's rank has this rank's items by the opposite shift.
  void find_targets(std::span<const std::int8_t> images) {
    std::vector<Index> number(27 * (plan_.neighbors().size() + 1), 0);
    const auto place = [](std::size_t list, std::int8_t image) { return 27 * list + as_size(image); };
    for (std::size_t t = 0; t < plan_.targets().size(); ++t)
      number[place(list_of(plan_.targets()[t]), plan_.targets()[t].image)] = as_index(t);
    const auto add = [&](std::size_t list, Index first, Index count) {
      for (Index g = first; g < first + count; ++g)
        target_of_.push_back(number[place(list, opposite_image(images[as_size(g)]))]);
    };
    add(0, 0, plan_.own());
    for (std::size_t k = 0; k < plan_.neighbors().size(); ++k)
      add(k + 1, plan_.neighbors()[k].first_received, plan_.neighbors()[k].received);
  }

  const HaloPlan& plan_;
  const SizeLevels& levels_;
  LevelSpace space_;
  std::span<const Vec4> ghosts_;
  LevelCells cells_;              // of the ghosts
  std::vector<Index> target_of_;  // of each ghost's original
  std::vector<Index> last_;       // per target: the last item that it got
};

}  // namespace

void Halo::exchange(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                    std::span<const Vec4> position, Real width) {
  plan_ = HaloPlan(ranks, decomposition, subdomain, width);
  GhostLists ghosts(plan_.neighbors().size() + 1);
  for (Index i = 0; i < as_index(position.size()); ++i)
    plan_.for_each_target(xyz(position[as_size(i)]),
                          [&](const HaloTarget& t) { ghosts[list_of(t)].push_back(ghost_in(t, i)); });
  set_ghosts(ghosts);
}

void Halo::exchange(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                    std::span<const Vec4> position, const SizeLevels& levels, const LevelSpace& space) {
  const Real width = 2 * levels.largest() + space.past_touch;
  if (levels.count == 1) return exchange(ranks, decomposition, subdomain, position, width);
  plan_ = HaloPlan(ranks, decomposition, subdomain, width);
  GhostLists ghosts(plan_.neighbors().size() + 1);
  for (Index i = 0; i < as_index(position.size()); ++i) {
    const Vec4 p = position[as_size(i)];
    for_each_target(plan_.box(), reach_in_level(levels, p.w, space.past_touch), plan_.targets().data(),
                    as_index(plan_.targets().size()), xyz(p),
                    [&](const HaloTarget& t) { ghosts[list_of(t)].push_back(ghost_in(t, i)); });
  }
  set_ghosts(ghosts);
  const std::vector<Vec4> of_ghosts = ghost_positions(position);
  SmallPartners partners(plan_, levels, space, of_ghosts, images_);
  for (Index i = 0; i < as_index(position.size()); ++i)
    partners.visit(i, position[as_size(i)],
                   [&](const HaloTarget& t) { ghosts[list_of(t)].push_back(ghost_in(t, i)); });
  set_ghosts(ghosts);
}

// Tells the neighbours the numbers and images of the ghosts.
void Halo::set_ghosts(const GhostLists& ghosts) {
  own_ = ghosts[0], sent_.clear();
  std::vector<std::size_t> counts;
  for (std::size_t k = 1; k < ghosts.size(); ++k) {
    counts.push_back(ghosts[k].size());
    sent_.insert(sent_.end(), ghosts[k].begin(), ghosts[k].end());
  }
  plan_.set_counts(own_.size(), counts);
  images_.clear();
  for (const Ghost& ghost : own_) images_.push_back(ghost.image);
  images_.resize(as_size(plan_.ghosts()));
  for (std::vector<Vec4>& buffer : buffer_) buffer.resize(sent_.size());
  std::vector<std::int8_t> sent(sent_.size());
  std::transform(sent_.begin(), sent_.end(), sent.begin(), [](const Ghost& g) { return g.image; });
  const HaloMessage message{sent.data(), images_.data(), sizeof(std::int8_t)};
  plan_.transfer({&message, 1});
}

std::vector<Vec4> Halo::ghost_positions(std::span<const Vec4> position) const {
  std::vector<Vec4> ghosts(as_size(plan_.ghosts()));
  const auto place = [&](const Ghost& ghost) { return moved(ghost, position[as_size(ghost.source)]); };
  std::transform(own_.begin(), own_.end(), ghosts.begin(), place);
  std::transform(sent_.begin(), sent_.end(), buffer_[0].begin(), place);
  const HaloMessage message{buffer_[0].data(), ghosts.data(), sizeof(Vec4)};
  plan_.transfer({&message, 1});
  return ghosts;
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
