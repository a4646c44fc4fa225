// The energy balance: errors of steps of any length at contacts, and the energy of particles that escape in
// contact, are accounted for without remainder.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/impacts.hpp"
#include "support/measured.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

using Overrides = std::vector<std::string>;

constexpr Real kRoundOff = 1e-12;  // relative to the energy exchanged

std::string contact_deck(const std::string& space, const std::string& time, const std::string& particles) {
  return "[space]\ndimension = 2\n" + space + "[time]\ncontrol = \"fixed\"\n" + time +
         "[contact]\nmax_start_overlap = 0.2\n[[contact.pairs]]\nstiffness = 1e6\ndamping = 0.0\n" +
         particles;
}

std::string disc(const std::string& name, const std::string& position, const std::string& velocity) {
  return fmt::format("[[particles]]\nname = \"{}\"\nkind = \"list\"\npositions = [{}]\nvelocity = {}\n", name,
                     position, velocity) +
         "radius = 0.05\nmass = 1.0\n";
}

// Three discs in a row, pressed together. They separate, and the last crosses the side in contact with the
// second.
const std::string kCrossing =
    contact_deck("min = [-1.0, -1.0]\nmax = [1.0, 1.0]\n", "end = 8e-4\nstep = 2e-5\n",
                 disc("first", "[0.809, 0.0]", "[0.0, 0.0]") + disc("second", "[0.904, 0.0]", "[0.0, 0.0]") +
                     disc("third", "[0.999, 0.0]", "[0.0, 0.0]"));

// An oblique impact in some ten steps.
const std::string kOblique = contact_deck(
    "min = [-1.0, -1.0]\nmax = [1.0, 1.0]\n", "end = 6e-3\nstep = 3e-4\n",
    disc("left", "[-0.0507, 0.02]", "[3.0, 0.4]") + disc("right", "[0.0501, -0.03]", "[-2.0, -0.7]"));

// Discs in a box at a third of the time that an impact takes.
const std::string kGas = contact_deck(
    "min = [0.0, 0.0]\nmax = [1.0, 1.0]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = "
    "\"wall\"\n",
    "end = 0.6\nstep = 3e-3\n", R"(
[integrator]
particles = "hht"
[[particles]]
name = "gas"
kind = "random"
count = 80
min = [0.0, 0.0]
max = [1.0, 1.0]
radius = 0.03
mass = 1.0
random_velocity = 1.0
seed = 3
)");

// Discs between two slopes, which fall out through the gap while they press against each other.
const std::string kHopper = R"(
gravity = [0.0, -9.8066]
[integrator]
particles = "hht"
max_iterations = 60
[[walls]]
name = "left"
point = [0.38, 0.0]
normal = [0.8, 0.6]
[[walls]]
name = "right"
point = [0.62, 0.0]
normal = [-0.8, 0.6]
)" + contact_deck("min = [0.0, 0.0]\nmax = [1.0, 1.2]\n", "end = 0.7\nstep = 5e-4\n", R"(
[[particles]]
name = "grains"
kind = "random"
count = 60
min = [0.25, 0.18]
max = [0.75, 1.1]
radius = 0.03
mass = 1.0
random_velocity = 0.1
seed = 7
[output]
history_interval = 0.01
)");

struct Outcome {
  Ledger end;
  Real balance = 0, exchanged = 0, largest_balance = 0;
  bool loses = true;  // dissipation never decreases
  std::int64_t left = 0;

  Real largest_share() const { return largest_balance / exchanged; }
};

Outcome outcome_of(const std::string& deck, const Overrides& overrides) {
  SimulationRun run(model_of(deck, overrides));
  Outcome out;
  Real lost = 0;
  run.run([&] {
    const Real now = run.ledger().dissipated_contacts;
    out.loses = out.loses && now >= lost;
    lost = now;
    out.largest_balance = std::max(out.largest_balance, std::abs(run.balance_error()));
  });
  out.end = run.ledger(), out.balance = run.balance_error(), out.exchanged = run.exchanged();
  out.left = run.complete_state().carried_out.left;
  return out;
}

Overrides with(Overrides a, const Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const std::vector<Overrides> kImplicitVariants = {
    {"integrator.hht_alpha=0.0"},
    {"integrator.hht_alpha=-0.3"},
    {"integrator.contact_events=end-of-step"},
    {"contact.pairs.0.damping=50.0"},
    {"contact.pairs.0.damping=50.0", "contact.pairs.0.limit_damping=false"},
    {"contact.pairs.0.exponent=1.5", "contact.pairs.0.stiffness=1e7"}};

std::string text(const Overrides& overrides) {
  std::string all;
  for (const std::string& one : overrides) all += one + " ";
  return all;
}

// Dissipation of contacts without damping: zero.
Bounded undamped_loss(const Outcome& run) {
  return measured("ledger/undamped loss", "J", in_range(run.end.dissipated_contacts, 0, 0));
}

}  // namespace

TEST_CASE("a particle that leaves while it touches another takes the contact's energy along") {
  for (const std::string policy : {"remove", "ballistic"}) {
    std::vector<Overrides> ways = kImplicitVariants;
    ways.push_back({"integrator.particles=velocity-verlet"});
    for (const Overrides& way : ways) {
      CAPTURE(policy, text(way));
      const Outcome run = outcome_of(kCrossing, with(way, {"space.leaving=" + policy}));
      CHECK(run.left == 1);
      CHECK(measured("ledger/leaving", "",
                     keeps(run.largest_share(), {.promise = kRoundOff, .measured = 2e-13})));
      // The contact has a good part of the energy.
      CHECK(run.end.carried_out > 0.1 * run.exchanged);
    }
  }
}

TEST_CASE("two particles that leave together take their contact along once, and that with a wall as well") {
  const std::string deck = contact_deck(
      "min = [-1.0, -1.0]\nmax = [1.0, 1.0]\ny_min = \"wall\"\n", "end = 4e-4\nstep = 2e-5\n",
      disc("low", "[0.9999, -0.955]", "[2.0, 0.0]") + disc("high", "[0.9999, -0.86]", "[2.0, 0.0]"));
  for (const std::string policy : {"remove", "ballistic"})
    for (const std::string particles : {"hht", "velocity-verlet"}) {
      CAPTURE(policy, particles);
      const Outcome run = outcome_of(deck, {"space.leaving=" + policy, "integrator.particles=" + particles});
      CHECK(run.left == 2);
      CHECK(measured("ledger/leaving", "",
                     keeps(run.largest_share(), {.promise = kRoundOff, .measured = 5e-14})));
    }
}

TEST_CASE("what leaves a hopper leaves the books balanced") {
  for (const std::string policy : {"remove", "ballistic"}) {
    const Outcome hht = outcome_of(kHopper, {"space.leaving=" + policy, "contact.pairs.0.damping=20.0"});
    CAPTURE(policy, hht.balance, hht.exchanged);
    CHECK(hht.left > 10);
    CHECK((hht.loses && hht.end.dissipated_contacts > 0));
    CHECK(measured("ledger/implicit", "",
                   keeps(hht.largest_share(), {.promise = kRoundOff, .measured = 1e-15})));
    const Outcome verlet =
        outcome_of(kHopper, {"space.leaving=" + policy, "integrator.particles=velocity-verlet",
                             "time.step=5e-5", "contact.pairs.0.damping=20.0"});
    CAPTURE(verlet.balance, verlet.exchanged);
    CHECK(verlet.left > 10);
    // Errors of the steps at impacts.
    CHECK(measured("ledger/explicit hopper", "", at_most(verlet.largest_share(), 1e-3)));
  }
}

TEST_CASE("the energy error of oblique impacts in implicit steps is accounted to the integrator") {
  for (const Overrides& settings : kImplicitVariants)
    for (const std::string step : {"3e-4", "1e-3"}) {
      CAPTURE(text(settings), step);
      const Outcome run = outcome_of(kOblique, with(settings, {"time.step=" + step}));
      CHECK(run.exchanged > 1);
      CHECK(measured("ledger/implicit", "",
                     keeps(run.largest_share(), {.promise = kRoundOff, .measured = 2e-14})));
      const bool damped = settings.front().find("damping") != std::string::npos;
      if (!damped) CHECK(undamped_loss(run));
      if (damped) CHECK((run.loses && run.end.dissipated_contacts > 0));
    }
}

TEST_CASE("what implicit steps do to a gas of another exponent is the integrator's") {
  for (const std::string limit : {"true", "false"}) {
    const Outcome run =
        outcome_of(kGas, {"contact.pairs.0.exponent=1.5", "contact.pairs.0.stiffness=1e7",
                          "contact.pairs.0.limit_damping=" + limit, "integrator.hht_alpha=0.0"});
    std::cout << fmt::format(
        "gas, n = 1.5, limit_damping {}: the steps took {:.3g} J of {:.4g} J exchanged\n", limit,
        run.end.dissipated_integrator, run.exchanged);
    CAPTURE(limit, run.end.dissipated_integrator, run.exchanged);
    CHECK(undamped_loss(run));
    CHECK(std::abs(run.end.dissipated_integrator) > 0.01 * run.exchanged);
    CHECK(measured("ledger/implicit", "",
                   keeps(run.largest_share(), {.promise = kRoundOff, .measured = 1e-15})));
  }
}

// Explicit steps: the energy of the motion changes by the trapezoidal work of the forces, except for a
// function of state with its own entry. The difference between that work and the contacts' elastic energy is
// the balance error.
TEST_CASE("the balance error of explicit steps is what they do to contacts") {
  const std::string deck =
      contact_deck("min = [-1.0, -1.0]\nmax = [1.0, 1.0]\nx_min = \"wall\"\n", "end = 0.021\nstep = 3e-4\n",
                   disc("disc", "[-0.948, 0.0]", "[-3.0, 1.0]"));
  SimulationRun run(model_of(deck, {"integrator.particles=velocity-verlet", "contact.pairs.0.exponent=1.5"}));
  const auto overlap = [&] { return std::max(0.0, -0.95 - run.particles()[0].position.x); };
  const auto force = [](Real d) { return 1e6 * std::pow(d, 1.5); };
  const auto energy = [](Real d) { return 1e6 / 2.5 * std::pow(d, 2.5); };
  Real x = run.particles()[0].position.x, d = overlap(), missed = 0, largest = 0;
  run.run([&] {
    const Real x1 = run.particles()[0].position.x, d1 = overlap();
    missed += energy(d1) - energy(d) + (force(d) + force(d1)) / 2 * (x1 - x);
    x = x1, d = d1;
    largest = std::max(largest, std::abs(missed));
    CHECK(keeps(run.balance_error() - missed, {.promise = kRoundOff, .measured = 3e-13}));
  });
  CHECK(largest > 1e-3);
}

// The body's next step begins with the force of the contact that ended: exactly half a step's work is
// missing.
TEST_CASE("a particle that leaves while it touches a body takes the contact's energy along") {
  const std::string deck =
      contact_deck("min = [-1.0, -1.0]\nmax = [1.0, 1.0]\nleaving = \"remove\"\n",
                   "end = 8e-4\nstep = 2e-5\n", disc("disc", "[0.999, 0.0]", "[0.0, 0.0]") + R"([[bodies]]
name = "body"
mass = 1.0
inertia = 0.001
position = [0.904, 0.0]
shapes = [{ radius = 0.05 }]
)");
  for (const std::string step : {"2e-5", "4e-6"})
    for (const std::string particles : {"hht", "velocity-verlet"}) {
      CAPTURE(step, particles);
      const Outcome run = outcome_of(deck, {"time.step=" + step, "integrator.particles=" + particles});
      CHECK(run.left == 1);
      CHECK(run.end.carried_out > 0.5 * run.exchanged);
      CHECK(run.largest_share() < 500 * std::stod(step));
    }
}

// Contacts of bodies' shapes with each other and with a wall; their centres are the bodies', so that the
// bodies' energy accounting has the same work. The bodies' Newton loop ends at its tolerances, not at
// round-off.
TEST_CASE("the dissipation of bodies' shapes is accounted for like that of particles") {
  const std::string body = R"(
[[bodies]]
name = "{}"
mass = 1.0
inertia = 0.001
position = [{}, 0.0]
velocity = [{}, 0.0]
shapes = [{{ radius = 0.05 }}]
)";
  const std::string deck =
      contact_deck("min = [-1.0, -1.0]\nmax = [1.0, 1.0]\nx_min = \"wall\"\n", "end = 0.02\nstep = 5e-4\n",
                   fmt::format(fmt::runtime(body), "left", -0.92, -3) +
                       fmt::format(fmt::runtime(body), "right", -0.81, -7));
  for (const Overrides& settings : kImplicitVariants) {
    CAPTURE(text(settings));
    const Outcome run = outcome_of(deck, settings);
    const bool damped = settings.front().find("damping") != std::string::npos;
    CHECK((damped ? run.loses && run.end.dissipated_contacts > 0 : run.end.dissipated_contacts == 0));
    CHECK(keeps(run.largest_share(), {.promise = 1e-7, .measured = 5.9e-10}));
  }
}
