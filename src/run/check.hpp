// The report of `scree check`.
#pragma once

#include <string>

#include "model/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Sizes, materials, contact times and step limits, degrees of freedom, and an estimate of the memory on the
// host and on a GPU; several lines. ranks: that the model was built by; this one has its part of the
// particles. Collective.
std::string check_report(const Model& model, const Ranks& ranks);

}  // namespace scree
