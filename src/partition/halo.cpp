#include "partition/halo.hpp"

#include "base/for_each.hpp"

namespace scree {
std::vector<Ghost> exchange_halo(const Subdomain& subdomain, const Space& space,
                                 std::span<const Vec4> position, Real width) {
  std::vector<Ghost> ghosts;
  const Vec3 period = subdomain.period();
  if (period == Vec3{}) return ghosts;
  const HaloBox box{space.min, space.max, period, width};
  for (Index i = 0; i < static_cast<Index>(position.size()); ++i)
    for_each_ghost(box, xyz(position[static_cast<std::size_t>(i)]), [&](Vec3 shift, std::int8_t image) {
      ghosts.push_back({i, shift, image});
    });
  return ghosts;
}

void update_halo(std::span<const Ghost> ghosts, std::span<Vec4> field, Index first_ghost) {
  for_each(Serial{}, static_cast<Index>(ghosts.size()),
           HaloItem<Vec4>{ghosts.data(), field.data(), first_ghost});
}

void update_halo_positions(std::span<const Ghost> ghosts, std::span<Vec4> position, Index first_ghost) {
  for_each(Serial{}, static_cast<Index>(ghosts.size()),
           HaloPositionItem{ghosts.data(), position.data(), first_ghost});
}

}  // namespace scree
