// The energy balance closes in smooth motion.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kTruncation = 1e-6;  // the promise at h = 1e-5, relative to the energy exchanged

void check_balance(const std::string& what, const Model& model, Real least_exchanged) {
  SimulationRun run(model);
  run.run();
  std::cout << fmt::format("{}: balance error {:.1e} J of {:.4g} J exchanged\n", what, run.balance_error(),
                           run.exchanged());
  CAPTURE(what);
  CHECK(run.exchanged() > least_exchanged);
  CHECK(measured("ledger/smooth", "",
                 keeps(run.balance_error() / run.exchanged(), {.promise = kTruncation, .measured = 5.1e-9})));
}

// A disc of 1 kg that the floor y = 0 already carries at half of its weight: it oscillates in contact with
// the floor.
const std::string kOnFloor = R"(
gravity = [0.0, -9.8066]
[space]
dimension = 2
min = [-1.0, 0.0]
max = [1.0, 1.0]
y_min = "wall"
[time]
end = 0.05
step = 1e-5
control = "fixed"
[[contact.pairs]]
stiffness = 1e4
damping = 2.0
[[particles]]
name = "disc"
kind = "list"
positions = [[0.0, 0.0495]]
radius = 0.05
mass = 1.0
[output]
history_interval = 1e-3
)";

}  // namespace

TEST_CASE("the ledger closes for particles in free fall") {
  for (const std::string integrator : {"hht", "velocity-verlet"}) {
    const Model model = input_model("paper/net_9.toml",
                                    {"time.end=0.1", "time.step=1e-5", "integrator.particles=" + integrator});
    check_balance("free fall over the net, " + integrator, model, 1);
  }
}

TEST_CASE("the ledger closes for the net of case 5.1") {
  for (const std::string hht_alpha : {"0.0", "-0.3"})
    check_balance("net, alpha = " + hht_alpha,
                  input_model("paper/net.toml",
                              {"time.end=0.2", "time.step=1e-5", "integrator.hht_alpha=" + hht_alpha}),
                  1);
}

TEST_CASE("the ledger closes for a disc that swings on a floor") {
  for (const std::string integrator : {"hht", "velocity-verlet"})
    check_balance("disc on a floor, " + integrator,
                  model_of(kOnFloor, {"integrator.particles=" + integrator}), 1e-2);
}
