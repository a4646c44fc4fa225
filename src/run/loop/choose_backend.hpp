// Where the particles of a run are computed.
#pragma once

#include <memory>
#include <string>

#include "base/log.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The backend that `name` (--backend) says, or for "auto" the one that is likely to be faster; the log says
// why. Where the deck forces a transport between GPUs, the CPU does not stand in for one that cannot be had.
// Throws InputError where the one that is named cannot be had or has too little memory. Collective.
std::unique_ptr<Backend> choose_backend(const Model& model, const Ranks& ranks, const std::string& name,
                                        Log& log);

}  // namespace scree
