// Rows of the constraints that repeat others: found at the start, refused or reported.
#pragma once

#include <string>
#include <vector>

#include "mbs/rigid_body_system.hpp"

namespace scree {

// Looks for rows of Phi_q, at the start, that are combinations of others. Where the model lets such rows
// share the load, returns what is to be said of them, "20 rows of rank 17: joint 'a', joint 'b'"; empty where
// there are none. Throws InputError, with the joints' names and what helps, where it does not, or where a row
// moves nothing at all.
std::string check_redundancy(const Model& model, const RigidBodySystem& system, const SparseTerm& jacobian);

// For messages: names without repetition, shortened to the first few.
std::string list_names(const std::vector<std::string>& names);

}  // namespace scree
