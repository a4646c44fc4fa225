// Angles of a deck that look like degrees.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"

namespace scree {

// One text for each of the first few keys whose value [rad] is more than a turn, where it says how something
// stands: such as are angles alone, of bodies, meshes, markers, springs and phases. Joint limits and free
// coordinates, which may be many turns, count where they are whole numbers, as degrees mostly are. What
// functions of time prescribe does not count.
std::vector<std::string> angles_in_degrees(const DeckTable& deck);

}  // namespace scree
