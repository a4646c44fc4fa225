// The report of `scree check`.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Several lines on sizes, materials, contact times, step limits and degrees of freedom, with an estimate of
// the memory on the host and on a GPU. ranks: the ranks that built the model, of which each holds its part of
// the particles; chosen: values that the deck left to the program; files: lines on the files (disk_use.hpp).
// Collective.
std::string check_report(const Model& model, const std::vector<ChosenValue>& chosen, const Ranks& ranks,
                         const std::string& files);

}  // namespace scree
