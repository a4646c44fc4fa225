// Positions and sizes of groups of particles.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/share.hpp"
#include "model/derived/distribution.hpp"
#include "model/derived/random.hpp"

namespace scree {

// Position of lattice site i, filled along x, then y, then z. size: number of sites per axis.
Vec3 lattice_position(Vec3 origin, Vec3 spacing, const std::array<std::int64_t, 3>& size, std::int64_t i);

// Region from which random positions are drawn, in place of the bounding box: an oblique region fills little
// of it.
struct DrawnRegion {
  std::function<Vec3(RandomNumbers& random, Real radius)> draw;
  Real volume = 0;  // [m^3]
};

struct PackingBox {
  Vec3 min, max;  // contains the particles entirely [m]
  int dimension = 3;
  Real gap = 0;            // smallest distance between surfaces [m]
  std::int64_t tries = 0;  // random positions per particle
  Real share = 1;          // fraction of the box or drawing region that belongs to the region
  std::optional<DrawnRegion> drawn{};
};

// Whether a sphere at this point is allowed [m].
using IsFree = std::function<bool(Vec3 point, Real radius)>;

// Random sequential insertion, largest particles first: each particle takes the first of its random positions
// that is allowed and does not overlap spheres inserted before. Returns one position per radius, in the order
// of the radii; fewer, the number inserted, where a particle found no position.
std::vector<Vec3> random_packing(const PackingBox& box, const std::vector<Real>& radius,
                                 const std::vector<StartItem>& obstacles, const IsFree& is_free,
                                 RandomNumbers& random);

// The reason why the particles cannot fit, found before any insertion; empty where they may fit. Large groups
// are judged by the probability that a random position is free, small ones by volume. region: its name.
std::string packing_trouble(const PackingBox& box, std::vector<Real> radius,
                            const std::string& region = "box (min, max)");

// Entries [part.first, part.last) of `count` values of a distribution. All values are drawn in sequence.
std::vector<Real> draw(const Distribution& distribution, std::int64_t count, IdRange part,
                       RandomNumbers& random);

}  // namespace scree
