// A system at one instant, for tests of derivatives.
#pragma once

#include <vector>

#include "mbs/rigid_body_system.hpp"

namespace scree {

constexpr Real kTime = 0.3;

// At the bodies' poses at t = 0, with arbitrary multipliers.
struct Probe {
  explicit Probe(const Model& sample) : model(sample), system(model) {
    terms.applied_force.assign(static_cast<std::size_t>(system.coordinates()), 0);
    terms.constraint.assign(static_cast<std::size_t>(system.constraints()), 0);
    multipliers.assign(terms.constraint.size(), 0);
    for (std::size_t j = 0; j < multipliers.size(); ++j) multipliers[j] = 3.1 - 1.7 * static_cast<Real>(j);
    position.resize(static_cast<std::size_t>(system.positions()));
    velocity.resize(terms.applied_force.size());
    still.assign(velocity.size(), 0);
    for (const auto& kind : system.kinds()) kind->start(position, velocity);
  }
  std::vector<Real> moved(const std::vector<Real>& displacement) const {
    std::vector<Real> to(position.size());
    system.displace(position, displacement, to);
    return to;
  }
  void evaluate(const std::vector<Real>& q, const std::vector<Real>& v, Real t = kTime) {
    system.evaluate({t, q, v}, terms);
  }
  // Phi_q^T lambda - Q
  std::vector<Real> force(const std::vector<Real>& q, const std::vector<Real>& v) {
    evaluate(q, v);
    std::vector<Real> force(terms.applied_force.size(), 0);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = -terms.applied_force[i];
    terms.constraint_jacobian.multiply_transposed(1, multipliers, force);
    return force;
  }

  Model model;
  RigidBodySystem system;
  SystemTerms terms;
  SystemDerivatives derivatives;
  std::vector<Real> multipliers, position, velocity;
  std::vector<Real> still;  // no displacement, no acceleration
};

}  // namespace scree
