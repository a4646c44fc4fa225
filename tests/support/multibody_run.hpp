// Models of multibody systems and a plain step loop without contact, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "mbs/multibody.hpp"
#include "model/data/model.hpp"
#include "support/petsc_run.hpp"

namespace scree {

inline constexpr Real kGravity = 9.8066;  // [m/s^2], the paper's

// The paper's disc: radius 0.05 m, mass 1 kg, inertia 0.005 kg m^2.
inline Body paper_disc(const std::string& name, Real x, Real y) {
  Body body;
  body.name = name;
  body.mass = 1;
  body.inertia = 0.005;
  body.position = {x, y, 0};
  body.shapes.push_back({{0, 0, 0}, 0.05, 0});
  return body;
}

inline Model empty_model() {
  Model model;
  model.gravity = {0, -kGravity, 0};
  model.time.end = 1;
  return model;
}

inline Joint ground_pin(const std::string& name, int body, Vec3 on_ground, Vec3 on_body) {
  Joint joint;
  joint.name = name;
  joint.body[1] = body;
  joint.point[0] = on_ground;
  joint.point[1] = on_body;
  return joint;
}

// Case 5.1: 20 discs in a row, joined by spring-dampers, the first and the last on revolute joints.
inline Model paper_net(Real damping = 100) {
  Model model = empty_model();
  for (int i = 0; i < 20; ++i) {
    model.bodies.push_back(paper_disc("net." + std::to_string(i), -0.95 + 0.1 * i, -0.6));
  }
  for (int i = 0; i < 19; ++i) {
    SpringDamper spring;
    spring.name = "spring." + std::to_string(i);
    spring.body[0] = i;
    spring.body[1] = i + 1;
    spring.stiffness = 1e5;
    spring.damping = damping;
    spring.free_length = 0.1;
    model.spring_dampers.push_back(spring);
  }
  for (const int i : {0, 19}) {
    const Vec3 centre = model.bodies[static_cast<std::size_t>(i)].position;
    model.joints.push_back(ground_pin("pin." + std::to_string(i), i, centre, {0, 0, 0}));
  }
  return model;
}

// A multibody system that steps without contact.
class MultibodyRun {
 public:
  explicit MultibodyRun(const Model& model, Real tolerance = 1e-10)
      : multibody((petsc(), model)),
        tolerance_(tolerance),
        contacts_{std::vector<BodyWrench>(model.bodies.size()), {}} {
    state = multibody.initial_state(contacts_.wrench);
  }

  // One step of length h; throws if Newton needs more than 20 iterations.
  void step(Real h) {
    multibody.predict(state, time, h);
    IterationNorms norms;
    int iteration = 0;
    do {
      if (++iteration > 20) {
        throw std::runtime_error("Newton did not converge at t = " + std::to_string(time));
      }
      norms = multibody.correct(contacts_);
    } while (norms.residual > tolerance_ || norms.correction > tolerance_);
    most_iterations = std::max(most_iterations, iteration);
    iterations += iteration;
    multibody.accept(state, contacts_.wrench);
    ++steps_;
    time = start_time_ + steps_ * h;
  }
  // n steps of length h from now on.
  void steps(int n, Real h) {
    start_time_ = time;
    steps_ = 0;
    for (int i = 0; i < n; ++i) step(h);
  }

  Real x(int body) const { return state.position[static_cast<std::size_t>(3 * body)]; }
  Real y(int body) const { return state.position[static_cast<std::size_t>(3 * body + 1)]; }
  Real angle(int body) const { return state.position[static_cast<std::size_t>(3 * body + 2)]; }

  Multibody multibody;
  MultibodyState state;
  Real time = 0;
  int iterations = 0, most_iterations = 0;

 private:
  Real tolerance_;
  ContactWrenches contacts_;
  Real start_time_ = 0;
  int steps_ = 0;
};

}  // namespace scree
