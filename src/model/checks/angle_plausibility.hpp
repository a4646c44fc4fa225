// Finds angles of a deck that look like degrees.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"

namespace scree {

// One text for each of the first few suspicious keys. Angles of bodies, meshes, markers, springs and phases
// are suspicious above one revolution [rad]. Joint limits and free coordinates may be many revolutions and
// are suspicious where they are whole numbers, as degrees usually are. Values of functions of time are not
// checked.
std::vector<std::string> angles_in_degrees(const DeckTable& deck);

}  // namespace scree
