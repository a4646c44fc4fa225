// Impacts under Hertz's law, of a sphere on a wall and of two free spheres, against closed forms: largest
// overlap, duration, and a restitution independent of speed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "physics/restitution.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kRadius = 0.05, kRatio = 0.3;  // [m], Poisson's [-]

// Normal impact without gravity. m reduced mass [kg], K [N/m^1.5], v approach speed [m/s]; z = damping ratio
// of e, the damper's c = 2 z sqrt(5/4 m K) times d^0.25; force_time [s]: from touch to the end of the force;
// d_max: largest overlap [m]. Closed form: in tau with dtau = d^0.25 dt the motion is a damped linear
// oscillator in y = 4/5 d^1.25, whose y' is the velocity; times by quadrature with 40 digits. Checked: DOP853
// on the law itself, 1e-12.
struct KnownImpact {
  Real mass, stiffness, restitution, speed;
  bool tension;
  Real duration, largest_overlap;
};
constexpr KnownImpact kKnown[] = {
    {2, 1e7, 0.9, 0.3, false, 0.00831078215781807, 0.000836700466297371},
    {2, 1e7, 0.9, 0.3, true, 0.0086569127551591, 0.000837453385915329},
    {1e-6, 5e7, 0.6, 1, false, 9.63235543957217e-6, 2.95417693906278e-6},
    {1e-6, 5e7, 0.6, 1, true, 1.13486901513012e-5, 3.01677326497323e-6},
    {1e-6, 5e7, 0.2, 0.01, false, 2.03351966580902e-5, 4.78176249895018e-8},
    {1e-6, 5e7, 0.2, 0.01, true, 3.47199135320436e-5, 5.80571914001047e-8},
    {0.001, 1e8, 1, 0.5, false, 0.000147163759216235, 2.5e-5},
};

enum class Partner { wall, sphere };

// The two start `gap` [m] apart and approach at this speed.
Model impact_model(const KnownImpact& known, Partner partner, const std::string& integrator, Real gap) {
  const bool wall = partner == Partner::wall;
  const Real effective_radius = wall ? kRadius : kRadius / 2;
  // 1/E* = 2 (1 - nu^2) / E, K = 4/3 E* sqrt(R*).
  const Real young = 2 * (1 - kRatio * kRatio) * known.stiffness * 0.75 / std::sqrt(effective_radius);
  Model model = model_of(fmt::format(
      R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
{}
[time]
end = 1.0
step = 1e-8
control = "fixed"
[integrator]
particles = "{}"
[[materials]]
name = "glass"
young_modulus = {}
poisson_ratio = {}
[[contact.pairs]]
materials = ["glass", "glass"]
restitution = {}
limit_damping = {}
[[particles]]
kind = "list"
positions = [{}]
radius = {}
mass = {}
)",
      wall ? "y_min = \"wall\"" : "", integrator, young, kRatio, known.restitution, !known.tension,
      wall ? "[0.0, 0.0, 0.0]" : "[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]", kRadius,
      wall ? known.mass : 2 * known.mass));
  if (wall) {
    model.particles.position[0] = {0, -1 + kRadius + gap, 0};
    model.particles.velocity[0] = {0, -known.speed, 0};
  } else {
    const Real y = kRadius + gap / 2;
    model.particles.position[0] = {0, -y, 0}, model.particles.position[1] = {0, y, 0};
    model.particles.velocity[0] = {0, known.speed / 2, 0},
    model.particles.velocity[1] = {0, -known.speed / 2, 0};
  }
  return model;
}

struct Measured {
  Real duration = 0, rebound = 0, largest_overlap = 0;  // [s], [m/s], [m]
};

struct Approach {
  Real overlap, rate;  // [m], [m/s]
};

Approach approach_of(const std::vector<Particle>& spheres) {
  if (spheres.size() == 1) return {kRadius - 1 - spheres[0].position.y, -spheres[0].velocity.y};
  return {2 * kRadius - (spheres[1].position.y - spheres[0].position.y),
          spheres[0].velocity.y - spheres[1].velocity.y};
}

// Fixed steps, so many in the contact. The impact ends with the overlap, or earlier with the force where
// that is clipped.
Measured measure(const KnownImpact& known, Partner partner, const std::string& integrator, int steps) {
  const Real h = known.duration / steps, gap = 3.3 * h * known.speed;
  Model model = impact_model(known, partner, integrator, gap);
  model.time.step = model.time.max_step = h;
  model.time.end = h * std::ceil(1.3 * steps + 6);
  const Real ratio = damping_ratio_of(known.restitution, known.tension);
  const Real damping = 2 * ratio * std::sqrt(1.25 * known.mass * known.stiffness);
  const auto acting = [&](const Approach& now) {
    if (known.tension || damping == 0 || now.overlap <= 0) return now.overlap;
    return known.stiffness * std::pow(now.overlap, 1.5) + damping * std::pow(now.overlap, 0.25) * now.rate;
  };
  SimulationRun run(model);
  Measured found;
  Real before = 0;
  while (run.time() < model.time.end) {
    const Real step = run.step();
    const Approach approach = approach_of(run.particles());
    const Real now = acting(approach);
    if (before > 0 && now <= 0 && found.duration == 0)
      found.duration = run.time() - step * now / (now - before) - gap / known.speed;
    found.largest_overlap = std::max(found.largest_overlap, approach.overlap);
    before = now;
  }
  found.rebound = -approach_of(run.particles()).rate;
  return found;
}

constexpr const char* kIntegrators[] = {"hht", "velocity-verlet"};

}  // namespace

TEST_CASE("Hertz impacts follow the closed forms") {
  constexpr Real kTruncation = 1e-4;
  Real rebound = 0, duration = 0, overlap = 0;
  for (const KnownImpact& known : kKnown)
    for (const Partner partner : {Partner::wall, Partner::sphere})
      for (const char* integrator : kIntegrators) {
        CAPTURE(known.restitution, known.tension, static_cast<int>(partner), integrator);
        const Measured found = measure(known, partner, integrator, 4000);
        const Real errors[] = {found.rebound / (known.restitution * known.speed) - 1,
                               found.duration / known.duration - 1,
                               found.largest_overlap / known.largest_overlap - 1};
        CHECK(measured("hertz/rebound", "", keeps(errors[0], {.promise = kTruncation, .measured = 1.3e-5})));
        CHECK(measured("hertz/duration", "", keeps(errors[1], {.promise = kTruncation, .measured = 2.9e-6})));
        CHECK(measured("hertz/overlap", "", keeps(errors[2], {.promise = kTruncation, .measured = 1.2e-5})));
        rebound = std::max(rebound, std::abs(errors[0])), duration = std::max(duration, std::abs(errors[1]));
        overlap = std::max(overlap, std::abs(errors[2]));
      }
  std::cout << fmt::format("Hertz, T/4000: rebound {:.1e}, duration {:.1e}, largest overlap {:.1e}\n",
                           rebound, duration, overlap);
}

TEST_CASE("an undamped Hertz impact lasts 2.94328 d_max / v") {
  const KnownImpact& known = kKnown[6];
  const Real modulus = 0.75 * known.stiffness / std::sqrt(kRadius);
  const Real overlap =
      std::pow(15 * known.mass * known.speed * known.speed / (16 * modulus * std::sqrt(kRadius)), 0.4);
  CHECK(near(known.largest_overlap, overlap, {.relative = 1e-13}));
  CHECK(near(known.duration, 2.94328 * overlap / known.speed, {.relative = 2e-6}));  // digits given
}

TEST_CASE("adaptive steps keep the restitution of Hertz impacts, at any speed") {
  constexpr Real kPhysical = 1e-3;
  Real largest = 0;
  for (const Real restitution : {0.95, 0.6, 0.2})
    for (const Real speed : {1.0, 10.0})
      for (const Partner partner : {Partner::wall, Partner::sphere}) {
        CAPTURE(restitution, speed, static_cast<int>(partner));
        const KnownImpact impact{1, 1e7, restitution, speed, false, 0, 0};
        // For the impact without damping.
        const Real time = 2.94328 * std::pow(1.25 * speed * speed / 1e7, 0.4) / speed;
        Model model = impact_model(impact, partner, "hht", 0.2 * time * speed);
        model.time.control = StepControl::adaptive;
        model.time.step = time / 20, model.time.min_step = 1e-6 * time, model.time.max_step = time;
        model.time.end = 6 * time;
        SimulationRun run(model);
        run.run();
        const Real error = -approach_of(run.particles()).rate / (restitution * speed) - 1;
        CHECK(measured("hertz/adaptive", "", keeps(error, {.promise = kPhysical, .measured = 7.5e-4})));
        largest = std::max(largest, std::abs(error));
      }
  std::cout << fmt::format("Hertz, adaptive: rebound {:.1e}\n", largest);
}

// Spheres in a box, in steps of about a third of a contact.
TEST_CASE("the energy balance of a Hertz gas closes to round-off, and its dampers never give energy") {
  constexpr Real kRoundOff = 1e-12;  // relative to the energy exchanged
  const std::string deck = R"(
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [0.5, 0.5, 0.5]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[time]
end = 0.2
step = 1e-3
control = "fixed"
[integrator]
particles = "hht"
[[materials]]
name = "soft"
density = 1000.0
young_modulus = 1e6
poisson_ratio = 0.4
[[contact.pairs]]
materials = ["soft", "soft"]
restitution = 1.0
[[particles]]
kind = "random"
count = 80
min = [0.0, 0.0, 0.0]
max = [0.5, 0.5, 0.5]
radius = { kind = "uniform", min = 0.02, max = 0.04 }
random_velocity = 1.0
seed = 3
)";
  for (const std::string way : {"contact.pairs.0.restitution=1.0", "contact.pairs.0.restitution=0.5",
                                "contact.pairs.0.limit_damping=false"}) {
    CAPTURE(way);
    SimulationRun run(model_of(deck, {"contact.pairs.0.restitution=0.5", way}));
    Real lost = 0, balance = 0;
    bool loses = true;
    run.run([&] {
      const Real now = run.ledger().dissipated_contacts;
      loses = loses && now >= lost;
      lost = now, balance = std::max(balance, std::abs(run.balance_error()));
    });
    CHECK(loses);
    CHECK((way.ends_with("=1.0") ? lost == 0 : lost > 0.1 * run.exchanged()));
    CHECK(balance <= kRoundOff * run.exchanged());
  }
}
