// The energy balance closes: kinetic + gravitational + elastic + dissipated + integrator's loss - work fed
// in is constant.
#include <cmath>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

struct Balance {
  Real error = 0;      // largest departure of the sum from its start [J]
  Real exchanged = 0;  // sum of the largest changes of the ledger's entries [J]
};

Balance balance_of(const Model& model, Real h, int steps) {
  MultibodyRun run(model);
  const auto entries = [&] {
    const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
    return std::vector<Real>{e.kinetic,
                             e.gravitational,
                             e.elastic,
                             run.state.dissipated,
                             run.state.integrator_loss,
                             -run.state.driver_work};
  };
  const std::vector<Real> start = entries();
  std::vector<Real> largest(start.size(), 0);
  Balance balance;
  for (int i = 1; i <= steps; ++i) {
    run.steps(1, h);
    run.time = i * h;
    const std::vector<Real> now = entries();
    Real sum = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      sum += now[k] - start[k];
      largest[k] = std::max(largest[k], std::abs(now[k] - start[k]));
    }
    balance.error = std::max(balance.error, std::abs(sum));
  }
  for (const Real change : largest) balance.exchanged += change;
  return balance;
}

// Every joint but the fixed one, every force element, a driver, and prescribed actuator, force and torque.
Model busy_mechanism() {
  Model model = empty_model();
  model.integrator.hht_alpha = -0.1;
  for (int i = 0; i < 4; ++i) model.bodies.push_back(paper_disc("body." + std::to_string(i), 0.5 * i, 0));
  model.joints.push_back(ground_pin("pivot", 0, {-0.2, 0, 0}, {-0.2, 0, 0}));
  model.joints.push_back(ground_pin("guide", 2, {1, 0, 0}, {0, 0, 0}));
  model.joints[1].kind = JointKind::translational;
  model.joints.push_back(ground_pin("link", 3, {0, 0, 0}, {0, 0.1, 0}));
  model.joints[2].kind = JointKind::distance;
  model.joints[2].body[0] = 2;
  model.joints[2].distance = std::hypot(0.5, 0.1);
  TimeFunction shake;
  shake.kind = TimeFunction::Kind::sine;
  shake.amplitude = 0.05;
  shake.frequency = 3;
  shake.phase = -M_PI / 2;  // from rest
  shake.value = 0.05;
  model.drivers.push_back({"shaker", 1, shake});
  TimeFunction pull = shake;
  pull.amplitude = 20;
  pull.value = 5;
  model.spring_dampers.push_back({"spring", {0, 1}, {{0.05, 0.02, 0}, {-0.05, 0, 0}}, 400, 6, 0.3, pull});
  model.spring_dampers.push_back({"stay", {kGround, 1}, {{0.5, 1, 0}, {0, 0.05, 0}}, 900, 2, 0.9, {}});
  model.torsional_spring_dampers.push_back({"twist", {0, 1}, 3, 0.2, 0.1});
  model.applied_forces.push_back({"push", 3, {0, 0.05, 0}, pull, {}, shake, true});
  model.applied_forces.push_back({"wind", 1, {0.02, 0.03, 0}, {}, pull, {}, false});
  return model;
}

}  // namespace

TEST_CASE("the ledger closes at resolved steps") {
  Model net = paper_net();
  net.integrator.hht_alpha = -0.1;
  for (const Model& model : {net, busy_mechanism()}) {
    const Balance balance = balance_of(model, 1e-5, 10000);
    CAPTURE(model.bodies.size(), balance.error, balance.exchanged);
    CHECK(balance.exchanged > 1e-2);
    CHECK(keeps(balance.error / balance.exchanged, {.promise = 1e-6, .measured = 9.6e-10}));
  }
}

TEST_CASE("the ledger's error is of second order") {
  const Real coarse = balance_of(busy_mechanism(), 1e-3, 200).error;
  const Real fine = balance_of(busy_mechanism(), 5e-4, 400).error;
  CAPTURE(coarse, fine);
  CHECK(std::log2(coarse / fine) > 1.8);
}

TEST_CASE("without alpha the integrator takes nothing out of a linear oscillator") {
  Model model = empty_model();
  model.bodies.push_back(paper_disc("mass", 0, 0));
  model.joints.push_back(ground_pin("guide", 0, {0, 0, 0}, {0, 0, 0}));
  model.joints[0].kind = JointKind::translational;
  model.spring_dampers.push_back({"spring", {kGround, 0}, {{-1, 0, 0}, {0, 0, 0}}, 1000, 0, 0.9, {}});
  MultibodyRun plain(model);
  plain.steps(1000, 2e-3);
  CHECK(keeps(plain.state.integrator_loss, {.promise = 1e-10, .measured = 6e-14}));
  model.integrator.hht_alpha = -0.3;
  MultibodyRun damped(model);
  damped.steps(1000, 2e-3);
  const Real total = 0.5 * 1000 * 0.1 * 0.1;
  CHECK(damped.state.integrator_loss > 1e-4 * total);
  CHECK(damped.state.integrator_loss < total);
}
