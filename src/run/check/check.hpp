// The report of `scree check`.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Sizes, materials, contact times and step limits, degrees of freedom, and an estimate of the memory on the
// host and on a GPU; several lines. ranks: that the model was built by; this one has its part of the
// particles; chosen: what the deck left to the program; files: lines on these (disk_use.hpp). Collective.
std::string check_report(const Model& model, const std::vector<ChosenValue>& chosen, const Ranks& ranks,
                         const std::string& files);

}  // namespace scree
