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
  // Of an element between two bodies: tension [N], or torque on the second one [N m].
  virtual Real effort(const BodyPoses&, Real) const { return 0; }
  // Elastic energy of a displacement by `length`, or by 1 rad, times two [J].
  virtual Real elastic_scale(Real) const { return 0; }
};

// Throw InputError naming the element: a table of its time functions is refused (see ScalarFunction; end: of
// the simulated time [s]). Evaluating a spring-damper whose points coincide throws SimulationError naming it.
std::unique_ptr<ForceElement> make_force_element(const SpringDamper& element, const BodyLayout& layout,
                                                 Real end);
std::unique_ptr<ForceElement> make_force_element(const TorsionalSpringDamper& element,
                                                 const BodyLayout& layout);
std::unique_ptr<ForceElement> make_force_element(const AppliedForce& element, const BodyLayout& layout,
                                                 Real end);

// The same between spatial bodies, or such a body and the ground.
std::unique_ptr<ForceElement> make_spatial_element(const SpringDamper& element, const BodyLayout& layout,
                                                   Real end);
std::unique_ptr<ForceElement> make_spatial_element(const AppliedForce& element, const BodyLayout& layout,
                                                   Real end);

}  // namespace scree
