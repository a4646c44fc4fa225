// What inserters and outlets have in common: the bodies and walls that carry them, and their intervals.
#pragma once

#include "deck/deck.hpp"
#include "model/data/model.hpp"
#include "model/data/names.hpp"

namespace scree {

// The body or wall of the key `on`: an index of the bodies, then of the walls with a pose; kGround without
// the key. Throws InputError for a plane at rest and for unknown names.
int carrier_of(const DeckTable& table, const Model& model, const ModelNames& names);

// The time in which a particle at rest falls by its diameter [s], as default of the key `interval`. radius:
// [m]. Throws InputError without gravity.
Real fall_interval(const DeckTable& table, const Model& model, Real radius);

// The interval [s]. Throws InputError where its instants until time.end are too many to count.
Real checked_interval(const DeckTable& table, const Model& model, Real interval);

}  // namespace scree
