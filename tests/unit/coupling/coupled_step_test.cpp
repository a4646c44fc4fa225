// Steps of bodies and particles together: rejected ones leave no trace, and the extent of the neighbour list
// changes nothing.
#include "coupling/coupled_step.hpp"

#include <fmt/format.h>

#include <memory>

#include "dem/particles/particle_store.hpp"
#include "run/state/state.hpp"
#include "support/backends.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/petsc_run.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"

namespace scree {

namespace {

// Two discs that fall on a disc on a spring, in a box that is periodic in x; contacts from the start on.
const std::string kDeck = kSmallDeck + R"(
[[contact.pairs]]
stiffness = 1e5
damping = 5.0
[[bodies]]
name = "pad"
position = [0.0, -0.2]
mass = 1.0
inertia = 0.005
shapes = [{ radius = 0.1, offset = [0.02, 0.0] }]
[[spring_dampers]]
name = "spring"
bodies = ["ground", "pad"]
points = [[0.0, -0.9], [0.0, 0.0]]
stiffness = 1e3
damping = 1.0
free_length = 0.7
[[particles]]
name = "falling"
kind = "lattice"
origin = [-0.03, -0.02]
spacing = [0.12, 0.2]
size = [1, 3]
radius = 0.085
mass = 1.0
velocity = [0.0, -1.0]
)";

const std::string kTouching = R"(
gravity = [0.0, -9.81, 0.0]
[space]
dimension = 3
min = [-2.0, -1.0, -2.0]
max = [2.0, 8.0, 2.0]
y_min = "wall"
[time]
end = 0.06
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
damping = 30.0
)";

// A skewed stack of balls.
const std::string kStack = R"(
[[bodies]]
name = "ball"
kind = "spatial"
count = 12
position = [0.0, -0.9, 0.0]
spacing = [0.02, 0.1985, 0.005]
mass = 1.0
inertia_tensor = [4e-3, 4e-3, 4e-3, 0.0, 0.0, 0.0]
shapes = [{ radius = 0.1, offset = [0.01, 0.0, -0.02] }]
)";

// A plate of triangles on three legs, with balls on it.
const std::string kPlate = R"(
[[meshes]]
name = "plate"
kind = "box"
size = [0.6, 0.1, 0.6]
[[bodies]]
name = "plate"
kind = "spatial"
position = [0.0, -0.8501, 0.0]
mass = 0.5
inertia_tensor = [0.02, 0.03, 0.02, 0.0, 0.0, 0.0]
meshes = [{ mesh = "plate" }]
shapes = [{ radius = 0.05, offset = [0.2, -0.1, 0.2] }, { radius = 0.05, offset = [-0.2, -0.1, 0.2] },
          { radius = 0.05, offset = [0.0, -0.1, -0.2] }]
[[bodies]]
name = "ball"
kind = "spatial"
count = 3
position = [-0.21, -0.7006, 0.05]
spacing = [0.21, 0.0, -0.03]
mass = 1.0
inertia_tensor = [4e-3, 4e-3, 4e-3, 0.0, 0.0, 0.0]
shapes = [{ radius = 0.1 }]
)";

// A board of triangles alone on three balls, with particles on it.
const std::string kBoard = R"(
[[meshes]]
name = "board"
kind = "box"
size = [0.6, 0.1, 0.6]
[[bodies]]
name = "ball"
kind = "spatial"
count = 3
position = [-0.21, -0.901, 0.05]
spacing = [0.21, 0.0, -0.03]
mass = 1.0
inertia_tensor = [4e-3, 4e-3, 4e-3, 0.0, 0.0, 0.0]
shapes = [{ radius = 0.1 }]
[[bodies]]
name = "board"
kind = "spatial"
position = [0.0, -0.752, 0.0]
mass = 0.5
inertia_tensor = [0.02, 0.03, 0.02, 0.0, 0.0, 0.0]
meshes = [{ mesh = "board" }]
[[particles]]
kind = "lattice"
origin = [-0.24, -0.653, -0.24]
spacing = [0.12, 0.0, 0.12]
size = [5, 1, 5]
radius = 0.05
mass = 0.02
)";

// Bodies and particles at the start of a run.
struct Coupled {
  explicit Coupled(const std::vector<std::string>& overrides = {}) {
    petsc();
    std::vector<std::string> all{"contact.max_start_overlap=1.0"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    model = model_of(kDeck, all);
    backend = make_test_backend(model);
    link = std::make_unique<BodyCoupling>(model);
    step = std::make_unique<CoupledStep>(model, *backend, *link, timers);
    backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
    step->start(bodies);
  }

  Model model;
  StageTimers timers;
  std::unique_ptr<Backend> backend;
  std::unique_ptr<BodyCoupling> link;
  std::unique_ptr<CoupledStep> step;
  MultibodyState bodies;
};

// Names of the values that differ in a bit; "" if there are none.
std::string differing(const Coupled& a, const Coupled& b) {
  const auto packed = [](const Coupled& side) {
    State state;
    state.bodies = side.bodies;
    state.particles = side.backend->particles().records(),
    state.shapes = side.backend->particles().shape_losses();
    return with_rows_as_arrays(pack(state));  // pack() refers to the state
  };
  return differing_arrays(packed(a), packed(b));
}

constexpr Real kStep = 1e-3;

void take_steps(Coupled& coupled, int count) {
  for (int n = 0; n < count; ++n) {
    const StepOutcome outcome = coupled.step->implicit_step(coupled.bodies, n * kStep, kStep);
    INFO(outcome.trouble);
    REQUIRE(outcome.verdict == Verdict::accepted);
  }
}

}  // namespace

TEST_CASE("a step that does not converge leaves both sides unchanged and names the reason") {
  Coupled tight({"integrator.max_iterations=1"}), same_start({"integrator.max_iterations=1"});
  const StepOutcome outcome = tight.step->implicit_step(tight.bodies, 0, kStep);
  CHECK(outcome.verdict == Verdict::not_converged);
  CHECK(contains(outcome.trouble, "no convergence in 1 iterations"));
  CHECK(differing(tight, same_start) == "");
  CHECK(tight.step->counts().steps == 0);
  CHECK(tight.step->counts().rejected_newton == 1);
}

TEST_CASE("a step that does not converge names the side that is at fault") {
  const auto trouble = [](std::vector<std::string> overrides) {
    overrides.push_back("integrator.max_iterations=1");
    Coupled tight(overrides);
    return tight.step->implicit_step(tight.bodies, 0, kStep).trouble;
  };
  const std::string touching = trouble({"particles.falling.origin=[-0.03, -0.04]"});
  CAPTURE(touching);
  CHECK(contains(touching, "stage particle_correct: no convergence in 1 iterations; the largest residual, "));
  CHECK(contains(touching, "occurs at particle 0"));
  // The particles move along their prediction, far from everything.
  const std::string bodies =
      trouble({"gravity=[0, 0]", "particles.falling.origin=[0.5, 0.5]", "particles.falling.radius=0.01"});
  CAPTURE(bodies);
  CHECK(
      contains(bodies, "stage mbs_correct: no convergence in 1 iterations; the bodies' scaled residual is "));
}

TEST_CASE("a step too long for the pair search is refused, but only where contacts are possible") {
  const std::vector<std::string> fast{"gravity=[0, 0]", "particles.falling.velocity=[100.0, 0.0]",
                                      "particles.falling.origin=[-0.03, 0.4]",
                                      "particles.falling.size=[1, 1]"};
  Coupled step(fast);
  const StepOutcome outcome = step.step->implicit_step(step.bodies, 0, 0.02);
  CHECK(outcome.verdict == Verdict::not_converged);
  CHECK(contains(outcome.trouble,
                 "stage neighbors: the step displaces a particle or a shape of a body by 2 m"));
  // A body alone that turns by many of its radii per step: no list has to cover it.
  petsc();
  const Model model = model_of(kSmallDeck + R"(
[[contact.pairs]]
stiffness = 0.0
[[bodies]]
name = "arm"
position = [0.5, 0.0]
velocity = [0.0, 20.0]
angular_velocity = 40.0
mass = 1.0
inertia = 0.005
shapes = [{ radius = 0.01 }]
[[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "arm"]
point = [0.0, 0.0]
)");
  StageTimers timers;
  const std::unique_ptr<Backend> backend = make_test_backend(model);
  BodyCoupling link(model);
  CoupledStep alone(model, *backend, link, timers);
  MultibodyState bodies;
  backend->particles().load({}, {});
  alone.start(bodies);
  for (int n = 0; n < 5; ++n)
    REQUIRE(alone.implicit_step(bodies, n * 0.01, 0.01).verdict == Verdict::accepted);
  CHECK(backend->list().builds() == 1);
}

TEST_CASE("a step that is not accurate enough leaves both sides as they were") {
  const std::vector<std::string> adaptive{"time.control=adaptive", "time.tolerance=1e-12"};
  Coupled refused(adaptive), same_start(adaptive);
  const StepOutcome outcome = refused.step->implicit_step(refused.bodies, 0, kStep);
  CHECK(outcome.verdict == Verdict::inaccurate);
  CHECK(outcome.error > 1);
  CHECK(differing(refused, same_start) == "");
  CHECK(refused.step->counts().rejected_error == 1);
}

TEST_CASE("the step after a refused one is the step that would have come without it") {
  const std::vector<std::string> adaptive{"time.control=adaptive", "time.tolerance=1.0"};
  Coupled with(adaptive), without(adaptive);
  with.model.time.tolerance = 1e-12;
  CHECK(with.step->implicit_step(with.bodies, 0, 2 * kStep).verdict == Verdict::inaccurate);
  with.model.time.tolerance = 1;
  take_steps(with, 3), take_steps(without, 3);
  CHECK(differing(with, without) == "");
}

TEST_CASE("a list that is too short is built anew without changing the result") {
  Coupled shortest({"contact.skin=1e-9"}), longest({"contact.skin=0.2"});
  take_steps(shortest, 50), take_steps(longest, 50);
  CHECK(shortest.backend->list().builds() > longest.backend->list().builds());
  CHECK(shortest.step->counts().newton_iterations == longest.step->counts().newton_iterations);
  CHECK(differing(shortest, longest) == "");
}

TEST_CASE("explicit steps do not depend on how many are asked for at once, nor on what the list covers") {
  const auto run = [](const std::string& skin, int at_once) {
    auto coupled = std::make_unique<Coupled>(std::vector<std::string>{
        "integrator.particles=velocity-verlet", "integrator.substeps=20", "contact.skin=" + skin});
    for (int n = 0; n < 120; n += at_once) {
      std::vector<Real> times;
      for (int k = n; k < n + at_once; ++k) times.push_back(k * kStep);
      REQUIRE(coupled->step->explicit_steps(coupled->bodies, times, kStep, times.back() + kStep) ==
              times.size());
    }
    return coupled;
  };
  const auto narrow = run("0.002", 1), wide = run("0.2", 1), together = run("0.002", 40);
  CHECK(narrow->backend->list().builds() > 10 * wide->backend->list().builds());
  CHECK(narrow->backend->reports().ledger(kStep / 20).contact_loss > 0);
  CHECK(differing(*narrow, *wide) == "");
  CHECK(differing(*narrow, *together) == "");
}

TEST_CASE("Newton's matrix has the blocks of contacts between bodies") {
  for (const auto& [name, bodies] : {std::pair{"stack", kStack}, {"plate", kPlate}, {"board", kBoard}})
    for (const Real step : {1e-3, 3e-3})
      for (const std::string friction : {"0.0", "0.5"}) {
        CAPTURE(name, step, friction);
        petsc();
        SimulationRun run(model_of(
            kTouching + bodies, {fmt::format("time.step={}", step), "contact.pairs.0.friction=" + friction}));
        run.run();
        const StepCounts& n = run.counts();
        CAPTURE(n.newton_iterations, n.steps);
        CHECK((n.rejected_newton == 0 && n.newton_iterations < 6 * n.steps));
      }
}

TEST_CASE("a run resumed from its state continues with the same bits") {
  for (const std::string particles : {"hht", "velocity-verlet"}) {
    CAPTURE(particles);
    std::vector<std::string> choice{"integrator.particles=" + particles};
    if (particles == "velocity-verlet") choice.push_back("integrator.substeps=20");
    Coupled whole(choice), second(choice);
    const auto advance = [&](Coupled& coupled, int from, int to) {
      for (int n = from; n < to; ++n) {
        if (particles == "hht")
          REQUIRE(coupled.step->implicit_step(coupled.bodies, n * kStep, kStep).verdict == Verdict::accepted);
        else
          coupled.step->explicit_steps(coupled.bodies, {n * kStep}, kStep, (n + 1) * kStep);
      }
    };
    advance(whole, 0, 10);
    second.bodies = whole.bodies;
    second.backend->particles().load(whole.backend->particles().records(),
                                     whole.backend->particles().shape_losses());
    second.step->resume(second.bodies, 10 * kStep);
    advance(whole, 10, 30), advance(second, 10, 30);
    CHECK(differing(whole, second) == "");
    CHECK(whole.backend->particles().shape_losses().contact_loss ==
          second.backend->particles().shape_losses().contact_loss);
  }
}

}  // namespace scree
