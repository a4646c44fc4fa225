// All motors, springs, limits and friction on the joints of a model.
#pragma once

#include <vector>

#include "mbs/joint_force.hpp"
#include "model/data/model.hpp"

namespace scree {

// Laws in the model's order: motors, springs, limits, friction. `memory` has one number for each law with
// memory.
class JointForces {
 public:
  JointForces() = default;
  // start: the bodies at t = 0; load_rows: for each joint the rows of Phi of the force that it transmits.
  // Throws InputError with the name of an element that is refused.
  JointForces(const Model& model, const BodyLayout& layout, const BodyPoses& start,
              const std::vector<std::vector<int>>& load_rows);

  bool empty() const { return forces_.empty(); }
  // Whether an effort depends on the joints' reactions.
  bool are_loaded() const;
  // Opens a step of length h at this instant; with h = 0 efforts are those of instants until the next step.
  void open_step(const BodyPoses& poses, const SystemInstant& at, Real h, const std::vector<Real>& memory);
  // From here on efforts are those of instants. Returns whether an effort may differ from that of the step.
  bool end_step();

  // Sums over all laws, with the meaning of ForceElement's functions; add_force returns the largest
  // contribution [J].
  Real add_force(const BodyPoses& poses, const SystemInstant& at, Real length, std::vector<Real>& force);
  void add_derivatives(const BodyPoses& poses, const SystemInstant& at, SystemDerivatives& derivatives);
  Real elastic_energy(const BodyPoses& poses, Real t, const std::vector<Real>& memory) const;  // [J]
  Real elastic_scale(Real length) const;  // the largest one

  // Work from the opening of the step to the last add_force(), and the memory there.
  JointWork work() const;
  std::vector<Real> memory() const;
  // Samples of all laws at any instant.
  std::vector<JointForce::Sample> samples(const BodyPoses& poses, const SystemInstant& at,
                                          const std::vector<Real>& memory) const;
  const std::vector<JointForce>& all() const { return forces_; }

 private:
  std::vector<JointForce> forces_;
};

}  // namespace scree
