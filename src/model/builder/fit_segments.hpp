// Number of facets of round meshes where the deck leaves it out.
#pragma once

#include "deck/deck.hpp"

namespace scree {

// The smallest radius that a particle of the deck can have [m]; infinite without particles. Reads particle
// files; throws InputError and IoError on them.
Real smallest_particle_radius(const DeckTable& deck);

// The key for the number of facets of a mesh and the value that fits particles of radius `grain` [m]. No key
// for meshes without facets of their own, such as boxes and files.
struct FittingSegments {
  std::string key;
  std::int64_t value = 0;
};
FittingSegments fitting_segments_of(const DeckTable& mesh, Real grain);

// Whether a mesh of the deck has such a key.
bool any_round(const DeckTable& deck);

// The deck with the fitting values of segments and levels where it leaves them out.
Deck with_fitting_segments(Deck deck);

}  // namespace scree
