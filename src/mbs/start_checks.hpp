// Refuses a start that contradicts the constraints, and constraints that repeat each other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "mbs/kkt_matrix.hpp"
#include "mbs/redundancy.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// For messages, behind the names of constraints that repeat each other where they stand.
inline constexpr const char* kSingularPosition =
    " repeat each other in this position, or nearly so: it is singular; integrator.redundant = \"share\" "
    "passes "
    "it";

struct StartFindings {
  std::string redundancy;            // what is to be said of constraints that share the load
  std::vector<Dependency> repeated;  // their rows
};

// Joints meet by the model's rule (joint_gap); gaps of drivers up to 1e-10 of the length scale and of angles
// up to 1e-10 rad are taken as round-off. position, velocity: [coordinates]. Throws InputError naming the
// joint or driver, its gap and what is allowed, or the joints and drivers that contradict each other or are
// redundant together, or the element whose two points coincide, or the joint in space whose axes point
// against each other.
StartFindings check_start(const Model& model, RigidBodySystem& system, const std::vector<Real>& position,
                          const std::vector<Real>& velocity);
// Of rows that repeat each other, with velocities that hold: throws InputError where no accelerations satisfy
// them all.
void check_repeated_accelerations(RigidBodySystem& system, const std::vector<Dependency>& repeated,
                                  const std::vector<Real>& position, const std::vector<Real>& velocity);

// The joint or driver that the start velocities contradict most, and by how much; empty where they contradict
// none. gap_rate: Phi_q q' + Phi_t at the start; up to 1e-8 of the largest velocity plus one length scale (1
// rad) per second is taken as round-off.
std::string velocity_trouble(const RigidBodySystem& system, const std::vector<Real>& gap_rate,
                             const std::vector<Real>& velocity);
// Of rows that share the load. misfit: what the accelerations leave of their right-hand sides; a thousandth
// of the largest acceleration plus one length scale (1 rad) per second squared is allowed, as near a singular
// position rows count as repeated that nearly are. Throws InputError naming the joint or driver.
void check_start_accelerations(const RigidBodySystem& system, const std::vector<Real>& misfit,
                               const std::vector<Real>& acceleration);
// The same of the positions alone at a later time t [s], where they are as exact as steps keep them: gaps up
// to 1e-6 of the length scale (1e-6 rad).
void check_joints_hold(RigidBodySystem& system, const std::vector<Real>& position,
                       const std::vector<Real>& velocity, Real t);

// For messages: joints and drivers whose rows nearly repeat each other at a position, or nothing.
std::string near_singular(RigidBodySystem& system, const std::vector<Real>& position, Real t);

// For messages: why a saddle-point matrix could not be solved, with the joints, drivers and bodies that take
// part, e.g. "is singular: body 'link' (id 3)".
std::string matrix_failure(const MechanicalSystem& system, const SparsePattern& pattern,
                           std::span<const Real> values);

}  // namespace scree
