#include "partition/halo.hpp"

namespace scree {
namespace {

// Shifts by -1, 0, +1 periods along one axis that bring x to within width of [min, max].
int axis_shifts(Real x, Real min, Real max, Real period, Real width, int (&out)[3]) {
  int n = 0;
  out[n++] = 0;
  if (period == 0) return n;
  if (x + period <= max + width) out[n++] = 1;
  if (x - period >= min - width) out[n++] = -1;
  return n;
}

}  // namespace

std::vector<Ghost> exchange_halo(const Subdomain& subdomain, const Space& space,
                                 std::span<const Vec4> position, Real width) {
  std::vector<Ghost> ghosts;
  const Vec3 period = subdomain.period();
  if (period == Vec3{}) return ghosts;
  for (Index i = 0; i < static_cast<Index>(position.size()); ++i) {
    const Vec4 p = position[static_cast<std::size_t>(i)];
    int sx[3], sy[3], sz[3];
    const int nx = axis_shifts(p.x, space.min.x, space.max.x, period.x, width, sx);
    const int ny = axis_shifts(p.y, space.min.y, space.max.y, period.y, width, sy);
    const int nz = axis_shifts(p.z, space.min.z, space.max.z, period.z, width, sz);
    for (int a = 0; a < nz; ++a)
      for (int b = 0; b < ny; ++b)
        for (int c = 0; c < nx; ++c) {
          const int image = (sz[a] + 1) * 9 + (sy[b] + 1) * 3 + sx[c] + 1;
          if (image == kNoShift) continue;
          ghosts.push_back(
              {i, {sx[c] * period.x, sy[b] * period.y, sz[a] * period.z}, static_cast<std::int8_t>(image)});
        }
  }
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
