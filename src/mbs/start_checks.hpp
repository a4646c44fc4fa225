// Refuses a start that violates the constraints, and redundant constraints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "mbs/kkt_matrix.hpp"
#include "mbs/redundancy.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// Text behind the names of constraints that are redundant in the current position.
inline constexpr const char* kSingularPosition =
    " are redundant in this position, or nearly so: it is singular; integrator.redundant = "
    "\"minimum-norm\" passes it";

struct StartFindings {
  std::string redundancy;            // the note on redundant constraints that are permitted
  std::vector<Dependency> repeated;  // their dependencies
};

// Joints are closed by the model's rule (joint_gap); gaps of drivers up to 1e-10 of the length scale and of
// angles up to 1e-10 rad count as round-off. position, velocity: [coordinates]. Throws InputError with the
// name of the joint or driver, its gap and the tolerance, or with the joints and drivers that contradict
// each other or are redundant, the element whose two points coincide, or the spatial joint whose axes are
// opposite.
StartFindings check_start(const Model& model, RigidBodySystem& system, const std::vector<Real>& position,
                          const std::vector<Real>& velocity);
// For redundant rows and consistent velocities: throws InputError where no accelerations satisfy them all.
void check_redundant_accelerations(RigidBodySystem& system, const std::vector<Dependency>& repeated,
                                   const std::vector<Real>& position, const std::vector<Real>& velocity);

// The joint or driver that the start velocities violate most, and by how much; empty where there is none.
// gap_rate: Phi_q q' + Phi_t at the start; up to 1e-8 of the largest velocity plus one length scale (1 rad)
// per second counts as round-off.
std::string velocity_trouble(const RigidBodySystem& system, const std::vector<Real>& gap_rate,
                             const std::vector<Real>& velocity);
// For redundant rows. misfit: residual of their right-hand sides after the accelerations are solved for; a
// thousandth of the largest acceleration plus one length scale (1 rad) per second squared is permitted, as
// rows near a singular position count as redundant. Throws InputError with the name of the joint or driver.
void check_start_accelerations(const RigidBodySystem& system, const std::vector<Real>& misfit,
                               const std::vector<Real>& acceleration);
// Checks the positions at a later time t [s], where they are as exact as steps keep them: gaps up to 1e-6 of
// the length scale (1e-6 rad). Throws as check_start.
void check_joints_hold(RigidBodySystem& system, const std::vector<Real>& position,
                       const std::vector<Real>& velocity, Real t);

// Names of joints and drivers whose rows are nearly redundant at a position, for messages; empty where there
// are none.
std::string near_singular(RigidBodySystem& system, const std::vector<Real>& position, Real t);

// For messages: why a saddle-point matrix could not be solved, with the joints, drivers and bodies that take
// part, e.g. "is singular: body 'link' (id 3)".
std::string matrix_failure(const MechanicalSystem& system, const SparsePattern& pattern,
                           std::span<const Real> values);

}  // namespace scree
