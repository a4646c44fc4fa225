// Force elements between planar bodies: generalized forces with analytic derivatives, energies and powers.
#pragma once

#include <memory>
#include <vector>

#include "mbs/body_poses.hpp"
#include "mbs/sparse_term.hpp"
#include "model/data/bodies.hpp"

namespace scree {

// Powers at one instant [W].
struct Powers {
  Real dissipated = 0;  // taken out by dampers
  Real applied = 0;     // fed in by actuators and applied forces
  Real drivers = 0;     // fed in by prescribed motions
};

class ForceElement {
 public:
  virtual ~ForceElement() = default;

  // Adds to Q [coordinates]. Returns the size of what it added [J]: a force times `length` [m], or a torque.
  virtual Real add_force(const BodyPoses& poses, Real t, Real length, std::vector<Real>& force) = 0;
  // Adds -Q_q and -Q_v [coordinates, coordinates]. poses and t: those of the last add_force().
  virtual void add_derivatives(const BodyPoses& poses, Real t, SparseTerm& stiffness,
                               SparseTerm& damping) const = 0;
  virtual void add_powers(const BodyPoses& poses, Real t, Powers& powers) const = 0;
  virtual Real elastic_energy(const BodyPoses&) const { return 0; }  // [J]
  // Effort of an element between two bodies: tension [N], or torque on the second body [N m].
  virtual Real effort(const BodyPoses&, Real) const { return 0; }
  // Twice the elastic energy of a displacement by `length`, or of a rotation by 1 rad [J].
  virtual Real elastic_scale(Real) const { return 0; }
};

// Throw InputError with the name of the element where a table of one of its time functions is refused (see
// ScalarFunction; end: of the simulated time [s]). Evaluation of a spring-damper with coincident points
// throws SimulationError with its name.
std::unique_ptr<ForceElement> make_force_element(const SpringDamper& element, const BodyLayout& layout,
                                                 Real end);
std::unique_ptr<ForceElement> make_force_element(const TorsionalSpringDamper& element,
                                                 const BodyLayout& layout);
std::unique_ptr<ForceElement> make_force_element(const AppliedForce& element, const BodyLayout& layout,
                                                 Real end);

// Force elements between spatial bodies, or between a spatial body and the ground; they throw as the planar
// ones do.
std::unique_ptr<ForceElement> make_spatial_element(const SpringDamper& element, const BodyLayout& layout,
                                                   Real end);
std::unique_ptr<ForceElement> make_spatial_element(const AppliedForce& element, const BodyLayout& layout,
                                                   Real end);

}  // namespace scree
