// The picture of `scree check --picture`: the model as it starts.
#pragma once

#include <string>

#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Writes the snapshot of t = 0 into a folder beside the picture, which ends with the call, and lets
// scree-post draw it. program: its path, on rank 0; resolved_deck: the deck's text, which tells it of walls
// and joints; file: of the picture, its suffix says of which kind. Throws IoError. There is no picture where
// a signal has come (run/report/signals.hpp). Collective; bodies need a PetscSession on rank 0.
void draw_start(Model model, const std::string& resolved_deck, const std::string& program,
                const std::string& file, const Ranks& ranks);

}  // namespace scree
