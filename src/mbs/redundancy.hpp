// Redundant rows of the constraints: detected at the start, refused or reported.
#pragma once

#include <string>
#include <vector>

#include "mbs/rank_check.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// Rows of Phi_q that are combinations of others to within `distance` (column_dependencies).
std::vector<Dependency> redundant_rows(const RigidBodySystem& system, const SparseTerm& jacobian,
                                       Real distance = kDependent);
// Distances of these rows from combinations of all others, in the order of `of`.
std::vector<NearDependency> near_combinations(const RigidBodySystem& system, const SparseTerm& jacobian,
                                              const std::vector<int>& of);

// Where the model permits redundant rows, returns the note on them, "20 rows of rank 17: joint 'a', joint
// 'b'"; empty where there are none. Throws InputError, with the names of the joints and a remedy, where the
// model does not permit them, or where a row depends on no coordinate. At the start, with Phi_q there.
std::string check_redundancy(const Model& model, const RigidBodySystem& system, const SparseTerm& jacobian,
                             const std::vector<Dependency>& repeated);

// The level at which rows of Phi are compared at an instant.
enum class ConstraintLevel { positions, velocities, accelerations };

// Redundant rows must be consistent: throws InputError, with the names of those that differ most and their
// difference, where no motion satisfies them all. wanted: per row, Phi itself or the right-hand sides of the
// rates, at time t [s]; a difference of `limit` times the scale of its row counts as round-off.
void check_contradictions(const RigidBodySystem& system, const std::vector<Dependency>& repeated,
                          const std::vector<Real>& wanted, Real limit, ConstraintLevel asked, Real t = 0);

// A text on all rows where steps find no motion: those whose gap is at least half of the largest, over their
// scales, and its size: "driver 'a', driver 'b', by 0.01 rad".
std::string largest_gaps(const RigidBodySystem& system, const std::vector<Real>& gap);
// The joints, drivers and couplers whose rows take part in the dependencies.
std::string names_of(const RigidBodySystem& system, const std::vector<Dependency>& repeated);

// For messages: names without repetition, shortened to the first few.
std::string list_names(const std::vector<std::string>& names);

}  // namespace scree
