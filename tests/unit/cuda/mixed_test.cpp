// Explicit runs in mixed precision: restitution, settled heaps, momentum, and the same bits on a rerun.
#include <cmath>
#include <cstdio>

#include "model/derived/random.hpp"
#include "output/checkpoint.hpp"
#include "run/loop/simulation.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/petsc_run.hpp"
#include "support/reference.hpp"
#include "support/state_bits.hpp"
#include "unit/cuda/mixed_run.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

TEST_CASE("mixed precision: rebound velocities are within 1e-4 of those in double") {
  for (const Real damping : {0.0, 25.0, 200.0}) {
    CAPTURE(damping);
    Model model = box_model(1000, Precision::mixed);
    model.contact.laws[0].normal_damping = damping;
    for (int k = 0; k < 64; ++k) {  // far from the origin, at many phases of the impact within a step
      const Vec3 at{900 + 1e-5 * k, 3.0 + 4 * k, 990};
      add_sphere(model, at, {1, 0.1, 0}), add_sphere(model, at + Vec3{1.01, 0.2, 0.1}, {-1, 0, 0.3});
    }
    MixedTestRun mixed(model, true), exact(model, false);
    mixed.advance(1e-4, 400), exact.advance(1e-4, 400);
    const std::vector<Particle> a = mixed.backend->particles().records(),
                                b = exact.backend->particles().records();
    Real largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      largest = std::max(largest, norm(a[i].velocity - b[i].velocity));
    CHECK(norm(b[0].velocity - Vec3{1, 0.1, 0}) > 0.3);  // they did collide
    CHECK(measured("mixed/rebound", "m/s", at_most(largest, 1e-4)));
    const Real lost = mixed.backend->reports().ledger(1e-4).contact_loss,
               exactly = exact.backend->reports().ledger(1e-4).contact_loss;
    if (damping == 0) CHECK(near(lost, exactly, {.absolute = 1e-9}));
    if (damping > 0) CHECK(measured("mixed/dissipation", "", near(lost, exactly, {.relative = 1e-3})));
    std::printf("rebound, damping %g: velocities within %.1e m/s of double's, dissipation %.9g of %.9g J\n",
                damping, largest, lost, exactly);
  }
}

TEST_CASE("mixed precision: a settled heap stays settled for a million steps", "[long]") {
  Model model = box_model(8, Precision::mixed);
  model.gravity = {0, 0, -1};
  model.walls = {{"floor", {0, 0, 0}, {0, 0, 1}, 0},
                 {"x0", {0, 0, 0}, {1, 0, 0}, 0},
                 {"x1", {8, 0, 0}, {-1, 0, 0}, 0},
                 {"y0", {0, 0, 0}, {0, 1, 0}, 0},
                 {"y1", {0, 8, 0}, {0, -1, 0}, 0}};
  // A pyramid: every layer sits in the hollows of the one below, the lowest between the walls.
  for (int layer = 0; layer < 8; ++layer)
    for (int k = 0; k < (8 - layer) * (8 - layer); ++k) {
      const Real start = 0.5 + 0.5 * layer;
      add_sphere(model, {start + k % (8 - layer), start + k / (8 - layer), 0.5 + layer * std::sqrt(0.5)}, {});
    }
  MixedTestRun run(model, true);
  run.advance(1e-4, 200000);
  const std::vector<Particle> settled = run.backend->particles().records();
  run.advance(1e-4, 1000000);
  const std::vector<Particle> after = run.backend->particles().records();
  Real moved = 0, fastest = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    moved = std::max(moved, norm(after[i].position - settled[i].position));
    fastest = std::max(fastest, norm(after[i].velocity));
  }
  std::printf("settled heap after 1e6 steps: moved by %.1e diameters, fastest %.1e\n", moved, fastest);
  CHECK(measured("mixed/moved", "diameters", at_most(moved, 1e-4)));
  // The bound corresponds to a fall by 5e-9 diameters.
  CHECK(measured("mixed/fastest", "m/s", at_most(fastest, 1e-4)));
}

// Sizes on either side of the switch to another form of the step's kernel.
TEST_CASE("mixed precision: a gas of 1e5 spheres keeps its momentum", "[long]") {
  const int spheres = GENERATE(100000, 110000);
  Model model = box_model(62, Precision::mixed);
  model.space.boundary.fill(Boundary::periodic);
  RandomNumbers random(9);
  for (int k = 0; k < spheres; ++k) {
    const int x = k % 47, y = k / 47 % 47, z = k / 47 / 47;
    add_sphere(model, {1.3 * x + 0.1 * random.uniform(), 1.3 * y + 0.1 * random.uniform(), 1.25 * z},
               {random.normal(), random.normal(), random.normal()});
  }
  MixedTestRun run(model, true);
  const ParticleLedger before = run.backend->reports().ledger(0);
  run.advance(1e-4, 20000);
  const ParticleLedger after = run.backend->reports().ledger(0);
  CHECK(after.contact_loss > 0.01 * before.kinetic);  // there were collisions
  // Relative to the sum of the magnitudes of the momenta, some 1 each.
  const Real drift = norm(after.momentum - before.momentum) / spheres;
  CHECK(measured("mixed/momentum of " + std::to_string(spheres), "kg m/s", at_most(drift, 1e-9)));
  std::printf("momentum of the gas: changed by %.1e of the sum of sizes in 20000 steps\n", drift);
}

TEST_CASE(
    "mixed precision: spheres with friction rebound with the velocities and spins of double precision") {
  Model model = box_model(1000, Precision::mixed);
  const bool hertz = GENERATE(false, true);
  if (hertz) {
    NormalLawParameters& law = model.contact.laws[0];
    law = {}, law.effective_modulus = 5e6, law.damping_ratio = 0.1;
    model.contact.friction = {{0.3, 0, 2e6, 0.1}};
  } else {
    // Without a tangential dashpot: it is off while a contact slides, and a step in which sliding begins in
    // single but not in double precision would change the impulse by h c v, 2e-3 N s here.
    model.contact.friction = {{0.3, Real(2) / 7 * 2e5, 0, 0}};
  }
  model.walls = {{"floor", {0, 0, 980}, {0, 0, 1}, 0}};
  for (int k = 0; k < 64; ++k) {  // sticking, sliding, or both in turn; some against the floor
    const Vec3 at{900 + 1e-5 * k, 3.0 + 4 * k, 990};
    add_sphere(model, at, {1, 0.03 * k, 0}), add_sphere(model, at + Vec3{1.01, 0.2, 0.1}, {-1, 0, 0.3});
    add_sphere(model, {920, 3.0 + 4 * k, 980.50503}, {0.03 * k, 0, -1});
  }
  MixedTestRun mixed(model, true), exact(model, false);
  mixed.advance(1e-4, 400), exact.advance(1e-4, 400);
  const std::vector<Particle> a = mixed.backend->particles().records(),
                              b = exact.backend->particles().records();
  Real velocity = 0, spin = 0, fastest_spin = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    velocity = std::max(velocity, norm(a[i].velocity - b[i].velocity));
    spin = std::max(spin, norm(a[i].angular_velocity - b[i].angular_velocity));
    fastest_spin = std::max(fastest_spin, norm(b[i].angular_velocity));
  }
  CHECK(fastest_spin > 0.5);  // there was friction
  CHECK(velocity <= 1e-4);
  CHECK(spin <= 4e-4);
  const Real lost = mixed.backend->reports().ledger(1e-4).contact_loss,
             exactly = exact.backend->reports().ledger(1e-4).contact_loss;
  CHECK(near(lost, exactly, {.relative = 1e-3, .absolute = 1e-9}));
  const Real friction_loss = mixed.backend->reports().ledger(1e-4).rotation.losses.of[kFrictionLoss],
             exact_friction = exact.backend->reports().ledger(1e-4).rotation.losses.of[kFrictionLoss];
  CHECK(exact_friction > 0);
  CHECK(friction_loss <= lost);
  CHECK(near(friction_loss, exact_friction, {.relative = 1e-3, .absolute = 1e-9}));
  std::printf(
      "%s and friction: velocities within %.1e m/s, spins within %.1e rad/s, dissipation %.9g of %.9g J\n",
      hertz ? "Hertz" : "linear spring", velocity, spin, lost, exactly);
}

TEST_CASE("mixed precision: particles that attract each other run in double precision, with a message") {
  Model model = box_model(10, Precision::mixed);
  model.contact.laws[0].attraction = 5, model.contact.laws[0].range = 0.02,
  model.contact.interaction_range = 0.02;
  const bool rolls = GENERATE(false, true);
  if (rolls)
    model.contact.friction = {{0.3, Real(2) / 7 * 2e5, 0, 0.1}},
    model.contact.rolling = {{.friction = 0.2, .stiffness_factor = 2.25}};
  add_sphere(model, {4, 5, 5}, {1, 0.03, 0}), add_sphere(model, {5.005, 5.2, 5.1}, {-1, 0, 0.3});
  MixedTestRun mixed(model, true), exact(model, false);
  CHECK_FALSE(mixed.backend->is_mixed());
  const std::string told = mixed.backend->description();
  CAPTURE(told);
  CHECK(told.find("precision double, because particles attract each other") != std::string::npos);
  mixed.advance(1e-4, 400), exact.advance(1e-4, 400);
  const std::vector<Particle> a = mixed.backend->particles().records(),
                              b = exact.backend->particles().records();
  CHECK(norm(b[0].velocity - Vec3{1, 0.03, 0}) > 0.3);  // they did collide
  for (std::size_t i = 0; i < 2; ++i)
    CHECK((a[i].position == b[i].position && a[i].velocity == b[i].velocity));
}

// Histories in single precision would make the pile creep.
TEST_CASE("mixed precision: a pile that friction holds stays where it is", "[long]") {
  Model model = box_model(12, Precision::mixed);
  model.gravity = {0, 0, -1};
  model.walls = {{"floor", {0, 0, 0}, {0, 0, 1}, 0}};
  model.contact.friction = {{0.5, Real(2) / 7 * 2e5, 0, 0.2}};
  // Three spheres on the floor that do not touch, and one on top between them.
  const Real aside = 0.6;
  for (int k = 0; k < 3; ++k)
    add_sphere(model, {6 + aside * std::cos(2.0943951 * k), 6 + aside * std::sin(2.0943951 * k), 0.5}, {});
  add_sphere(model, {6, 6, 0.5 + std::sqrt(1 - aside * aside)}, {});
  MixedTestRun run(model, true);
  run.advance(1e-4, 300000);
  const std::vector<Particle> settled = run.backend->particles().records();
  run.advance(1e-4, 1000000);
  const std::vector<Particle> after = run.backend->particles().records();
  Real moved = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    moved = std::max(moved, norm(after[i].position - settled[i].position));
  CHECK(after[3].position.z > 1);  // it is stable
  CHECK(moved < 1e-5);             // diameters
  std::printf("pile held by friction after 1e6 steps: moved by %.1e diameters\n", moved);
}

TEST_CASE("mixed precision: ballistic particles keep their exact positions at any distance") {
  Model model = box_model(100, Precision::mixed);
  model.gravity = {0, -9.81, 0};
  model.space.leaving = OutsidePolicy::drift;
  add_sphere(model, {50, -3, 50}, {-900, -20, 35}), add_sphere(model, {50, 50, 50}, {});
  MixedTestRun mixed(model, true), exact(model, false);
  for (MixedTestRun* run : {&mixed, &exact}) {
    std::vector<Particle> records = run->backend->particles().records();
    records[0].drifting = true;
    run->backend->particles().load(records, {});
    run->backend->list().build(model.contact.skin, run->timers);
    run->backend->particles().initial_forces();
    for (int part = 0; part < 3; ++part) run->advance(1e-4, 4000);  // a kilometre
  }
  const std::vector<Particle> a = mixed.backend->particles().records(),
                              b = exact.backend->particles().records();
  CHECK(b[0].position.x < -1000);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(norm(a[i].position - b[i].position) <= 1e-8 * norm(b[i].position));
    CHECK(norm(a[i].velocity - b[i].velocity) <= 1e-6 * norm(b[i].velocity));
  }
}

// Several batches of steps between two rows of the history: their length must not depend on the clock.
TEST_CASE("mixed precision: a rerun has the same bits") {
  const Model model =
      input_model("examples/gas_periodic.toml",
                  {"integrator.precision=mixed", "contact.pairs.0.damping=1.0", "time.end=0.5",
                   "output.history_interval=0.25", "output.snapshot_interval=0.5"});
  petsc();
  measured_on_gpu(device_name());
  const ScratchDirectory folders[2];
  for (const ScratchDirectory& folder : folders) {
    RunOptions options;
    options.backend = "cuda", options.output_directory = folder.path();
    Log log(true);
    REQUIRE(run_simulation(model, options, log) == ExitCode::done);
  }
  CHECK(measured("mixed/rerun", "bits",
                 BitForBit{differing_arrays(read_checkpoint(folders[0] / "checkpoint_end.h5"),
                                            read_checkpoint(folders[1] / "checkpoint_end.h5"))}));
}

}  // namespace scree
