// Rows of the constraints that repeat others: found at the start, refused or reported.
#pragma once

#include <string>
#include <vector>

#include "mbs/rank_check.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// Rows of Phi_q that are combinations of others to within `distance` (column_dependencies).
std::vector<Dependency> repeated_rows(const RigidBodySystem& system, const SparseTerm& jacobian,
                                      Real distance = kDependent);
// How near these rows are to combinations of all others, in the order of `of`.
std::vector<NearDependency> near_combinations(const RigidBodySystem& system, const SparseTerm& jacobian,
                                              const std::vector<int>& of);

// Where the model lets such rows share the load, returns what is to be said of them, "20 rows of rank 17:
// joint 'a', joint 'b'"; empty where there are none. Throws InputError, with the joints' names and what
// helps, where it does not, or where a row moves nothing at all. At the start, with Phi_q there.
std::string check_redundancy(const Model& model, const RigidBodySystem& system, const SparseTerm& jacobian,
                             const std::vector<Dependency>& repeated);

// What rows of Phi ask for at an instant.
enum class Asked { positions, velocities, accelerations };

// Rows that repeat each other must ask for the same: throws InputError with the names of those that differ
// most and by how much, where no motion has what they ask for. wanted: per row, Phi itself or the right-hand
// sides of the rates, at time t [s]; a difference of `limit`, times the scale of its row, is taken as
// round-off.
void check_contradictions(const RigidBodySystem& system, const std::vector<Dependency>& repeated,
                          const std::vector<Real>& wanted, Real limit, Asked asked, Real t = 0);

// What is to be said of the rows as a whole, where steps find no motion: those whose gap is at least half of
// the largest, over their scales, and how large it is: "driver 'a', driver 'b', by 0.01 rad".
std::string largest_gaps(const RigidBodySystem& system, const std::vector<Real>& gap);
// The joints, drivers and couplers whose rows take part.
std::string names_of(const RigidBodySystem& system, const std::vector<Dependency>& repeated);

// For messages: names without repetition, shortened to the first few.
std::string list_names(const std::vector<std::string>& names);

}  // namespace scree
