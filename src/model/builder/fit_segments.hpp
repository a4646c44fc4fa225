// How finely round shapes of the deck's meshes are cut where the deck leaves that out.
#pragma once

#include "deck/deck.hpp"

namespace scree {

// The smallest radius that a particle of the deck can have [m]; infinite without particles. Files are read.
// Throws InputError and IoError on these.
Real smallest_grain(const DeckTable& deck);

// The key that says how finely a mesh is cut, and its value that fits particles of radius `grain` [m]; no
// key: the mesh has none, as boxes and files.
struct FittingSegments {
  std::string key;
  std::int64_t value = 0;
};
FittingSegments fitting_segments_of(const DeckTable& mesh, Real grain);

// Whether a mesh of the deck has such a key.
bool any_round(const DeckTable& deck);

// The deck with segments and levels where it leaves them out.
Deck with_fitting_segments(Deck deck);

}  // namespace scree
