// Checks of a built model against its deck, at the end of build_model(). Each throws InputError that names
// file, line, key, value and what is allowed, or writes a warning with its remedy to the log.
#pragma once

#include "base/log.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Checks all tables over time below `table`. Throws InputError where one does not cover the run up to `end`
// [s]; warns where a spline overshoots its points noticeably.
void check_time_tables(const DeckTable& table, Real end, Log& log);

// Throws InputError where the centre of a body's shape is outside the domain. Works from the deck, before any
// body is built.
void check_bodies_inside(const DeckTable& deck, const Space& space);
// Throws InputError where a particle is outside the domain or an overlap exceeds the deck's limit. Warns of
// smaller overlaps.
void check_start_positions(const DeckTable& deck, const Model& model, const Share& share, Log& log);
// Warns of steps in which particles move by more than their radius. Throws InputError for explicit steps
// beyond the stability limit.
void check_steps(const DeckTable& deck, const Model& model, Log& log);
// Warns of drivers, and of cylinders of type length, that prescribe a distance of two points of 0 or less.
void check_driven_lengths(const Model& model, Log& log);

}  // namespace scree
