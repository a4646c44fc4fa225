#include "partition/halo.hpp"

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
  for (std::size_t g = 0; g < ghosts.size(); ++g)
    field[static_cast<std::size_t>(first_ghost) + g] = field[static_cast<std::size_t>(ghosts[g].source)];
}

void update_halo_positions(std::span<const Ghost> ghosts, std::span<Vec4> position, Index first_ghost) {
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const Vec4 p = position[static_cast<std::size_t>(ghosts[g].source)];
    position[static_cast<std::size_t>(first_ghost) + g] = vec4(xyz(p) + ghosts[g].shift, p.w);
  }
}

}  // namespace scree
