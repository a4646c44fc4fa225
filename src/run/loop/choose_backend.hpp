// Choice of the backend of a run.
#pragma once

#include <memory>
#include <string>

#include "base/log.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The backend named by --backend; for "auto" the one that is likely to be faster. The log states the reason.
// If the deck prescribes a transport between GPUs, the CPU does not replace a GPU that is missing. Throws
// InputError if the named backend is missing or has too little memory. Collective.
std::unique_ptr<Backend> choose_backend(const Model& model, const Ranks& ranks, const std::string& name,
                                        Log& log);

}  // namespace scree
