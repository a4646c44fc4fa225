// Positions and sizes of groups of particles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/deck.hpp"
#include "model/random.hpp"

namespace scree {

// The first `count` places of a lattice, filled along x, then y, then z. size: places per axis.
std::vector<Vec3> lattice_positions(Vec3 origin, Vec3 spacing, const std::array<std::int64_t, 3>& size,
                                    std::int64_t count);

// Circles or spheres that were placed already.
struct Obstacles {
  std::vector<Vec3> position;  // [m]
  std::vector<Real> radius;    // [m]
};

struct PackingBox {
  Vec3 min, max;  // holds the particles entirely [m]
  int dimension = 3;
  Real gap = 0;            // smallest distance between surfaces [m]
  std::int64_t tries = 0;  // random places per particle
};

// Random sequential insertion: each particle, the largest first, goes to the first of its random places that
// keeps clear of everything there already. Result: one position per radius, in the order of the radii; fewer,
// the number placed, where a particle found no place.
std::vector<Vec3> random_packing(const PackingBox& box, const std::vector<Real>& radius,
                                 const Obstacles& obstacles, RandomNumbers& random);

// `count` values of a distribution (a quantity of the deck). Throws InputError on bounds or weights that make
// none.
std::vector<Real> draw(const DeckTable& distribution, std::size_t count, RandomNumbers& random);

}  // namespace scree
