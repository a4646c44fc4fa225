#include "partition/shared_model.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "partition/decomposition.hpp"

namespace scree {
namespace {

// The ranks that receive an item: the owner of its position, and ranks whose boxes are near one of its
// images.
class Receivers {
 public:
  Receivers(const Decomposition& decomposition, const Space& space, Real reach)
      : decomposition_(decomposition), reach_(reach), period_(Subdomain(space).period()) {
    for (std::size_t r = 0; r < decomposition.boxes().size(); ++r)
      boxes_.push_back(decomposition.box(as_index(r), Subdomain(space)));
  }

  // Calls visit(rank) once per receiving rank, for the owner first.
  template <class Visit>
  void for_each_of(Vec3 p, const Visit& visit) const {
    const int owner = decomposition_.owner(p);
    visit(owner);
    // Far inside the owner's box; boxes end at the periodic sides of the domain.
    if (boxes_[as_size(owner)].inside(p, reach_)) return;
    for (int r = 0; r < as_index(boxes_.size()); ++r)
      if (r != owner && any_image_near(boxes_[as_size(r)], p)) visit(r);
  }

 private:
  bool any_image_near(const DomainBox& box, Vec3 p) const {
    for (int z = -steps(period_.z); z <= steps(period_.z); ++z)
      for (int y = -steps(period_.y); y <= steps(period_.y); ++y)
        for (int x = -steps(period_.x); x <= steps(period_.x); ++x)
          if (box.is_within(p + Vec3{x * period_.x, y * period_.y, z * period_.z}, reach_)) return true;
    return false;
  }
  static int steps(Real period) { return period > 0 ? 1 : 0; }

  const Decomposition& decomposition_;
  Real reach_;
  Vec3 period_;
  std::vector<DomainBox> boxes_;
};

}  // namespace

std::vector<StartItem> RankShare::distribute_by_boxes(std::vector<StartItem> own, const Space& space,
                                                      Real reach) const {
  if (ranks_.alone() || !(reach > 0)) return own;
  Decomposition decomposition;
  {
    std::vector<Vec4> position;
    for (const StartItem& item : own) position.push_back(vec4(item.position, item.radius));
    const std::vector<std::int64_t> weight(own.size(), 1);
    decomposition = Decomposition(ranks_, make_domain_grid(space, reach), position, weight);
  }
  const Receivers receivers(decomposition, space, reach);
  std::vector<std::int64_t> counts(as_size(ranks_.size()));
  for (const StartItem& item : own)
    receivers.for_each_of(item.position, [&](int r) { ++counts[as_size(r)]; });
  std::vector<std::size_t> next(counts.size());
  for (std::size_t r = 1; r < next.size(); ++r) next[r] = next[r - 1] + as_size(counts[r - 1]);
  std::vector<StartItem> sent(next.back() + as_size(counts.back()));
  for (StartItem item : own) {
    item.is_own = true;  // true for the first receiver
    receivers.for_each_of(item.position, [&](int r) {
      sent[next[as_size(r)]++] = item;
      item.is_own = false;
    });
  }
  own = {};
  return ranks_.all_to_all(std::span<const StartItem>(sent), counts);
}

}  // namespace scree
