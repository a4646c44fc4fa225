// The picture of `scree check --picture`: the model at its start.
#pragma once

#include <string>

#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Writes the snapshot of t = 0 into a temporary folder beside the picture and lets scree-post draw it.
// program: path of scree-post, on rank 0; resolved_deck: text of the deck, with walls and joints for the
// picture; file: the picture, whose suffix gives the format. Throws IoError. After a signal
// (run/report/signals.hpp) no picture is drawn. Collective; bodies need a PetscSession on rank 0.
void draw_start(Model model, const std::string& resolved_deck, const std::string& program,
                const std::string& file, const Ranks& ranks);

}  // namespace scree
