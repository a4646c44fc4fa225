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
#include "deck/deck.hpp"
#include "model/data/share.hpp"
#include "model/derived/random.hpp"

namespace scree {

// Place i of a lattice that is filled along x, then y, then z. size: places per axis.
Vec3 lattice_position(Vec3 origin, Vec3 spacing, const std::array<std::int64_t, 3>& size, std::int64_t i);

// Where random positions are drawn from instead of the box around them, which an oblique region hardly fills.
struct DrawnRegion {
  std::function<Vec3(RandomNumbers& random, Real radius)> draw;
  Real volume = 0;  // [m^3]
};

struct PackingBox {
  Vec3 min, max;  // holds the particles entirely [m]
  int dimension = 3;
  Real gap = 0;            // smallest distance between surfaces [m]
  std::int64_t tries = 0;  // random places per particle
  Real share = 1;          // of the box, or of what is drawn from: the region that they stand in
  std::optional<DrawnRegion> drawn{};
};

// Whether a sphere may stand at a point [m].
using IsFree = std::function<bool(Vec3 point, Real radius)>;

// Random sequential insertion: each particle, the largest first, goes to the first of its random places that
// is free and keeps clear of all spheres there already. Result: one position per radius, in the order of the
// radii; fewer, the number placed, where a particle found no place.
std::vector<Vec3> random_packing(const PackingBox& box, const std::vector<Real>& radius,
                                 const std::vector<StartItem>& obstacles, const IsFree& is_free,
                                 RandomNumbers& random);

// Why there cannot be room for all of them, before any place is tried; empty where there may be. Judges large
// groups by the chance of a random place, small ones by their volume alone. region: what it is called.
std::string packing_trouble(const PackingBox& box, std::vector<Real> radius,
                            const std::string& region = "box (min, max)");

// Entries [part.first, part.last) of `count` values of a distribution (a quantity of the deck): all of them
// are drawn one after the other, as many as there are. Throws InputError on bounds or weights that make none.
std::vector<Real> draw(const DeckTable& distribution, std::int64_t count, IdRange part,
                       RandomNumbers& random);

// Values that a distribution may take, the least among them.
std::vector<Real> distribution_values(const DeckTable& distribution);

}  // namespace scree
