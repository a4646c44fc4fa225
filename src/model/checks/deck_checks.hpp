// Checks of a built model against its deck, at the end of build_model(). Each throws InputError that names
// file, line, key, value and what is allowed, or writes a warning with its remedy to the log.
#pragma once

#include "base/log.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Refuses tables over time, anywhere below `table`, that end before the run does at `end` [s]; warns of
// splines that overshoot their tabulated values noticeably.
void check_time_tables(const DeckTable& table, Real end, Log& log);

// Refuses shapes of bodies whose centres lie outside the domain. It reads the deck alone, before any body is
// built.
void check_bodies_inside(const DeckTable& deck, const Space& space);
// Refuses particles outside the domain and overlaps above the deck's limit; warns of smaller overlaps.
void check_start_positions(const DeckTable& deck, const Model& model, const Share& share, Log& log);
// Refuses explicit steps beyond the stability limit; warns of steps in which a particle's displacement
// exceeds its radius.
void check_steps(const DeckTable& deck, const Model& model, Log& log);
// Warns of drivers, and of cylinders of type length, that prescribe a distance of 0 or less between two
// points.
void check_driven_lengths(const Model& model, Log& log);

}  // namespace scree
