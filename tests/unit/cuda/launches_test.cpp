// No result depends on how kernels are launched: with blocks of other sizes, and with either form of the
// explicit step's kernel, bits are the same.
#include "launches.hpp"

#include "dem/backend/device.hpp"
#include "output/checkpoint.hpp"
#include "run/state/state.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/state_bits.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {
namespace {

constexpr int kParticles = 3000;

// Sets the launch configuration for as long as this object exists.
class Launched {
 public:
  explicit Launched(const Launches& choice) : before_(launches()) { launches() = choice; }
  ~Launched() { launches() = before_; }
  Launched(const Launched&) = delete;
  Launched& operator=(const Launched&) = delete;

 private:
  Launches before_;
};

struct Outcome {
  Checkpoint state;
  std::vector<Real> sums;
};

Outcome outcome_of(LoadedBox& box, Real verlet_step) {
  State state;
  state.particles = box.backend->particles().records();
  const ParticleLedger l = box.backend->reports().ledger(verlet_step);
  std::vector<Real> sums{l.kinetic,      l.gravitational,   l.contact_elastic,
                         l.contact_loss, l.integrator_loss, static_cast<Real>(l.contacts)};
  for (const Vec3& v : {l.momentum, l.angular_momentum}) sums.insert(sums.end(), {v.x, v.y, v.z});
  CHECK(l.contacts > 0);
  return {with_rows_as_arrays(pack(state)), sums};
}

Outcome implicit_steps(const BoxCase& c, const Launches& choice) {
  const Launched launched(choice);
  LoadedBox box(dense_box(c, ParticleIntegrator::hht, kParticles), 0.1, make_cuda_backend);
  for (int k = 0; k < 2; ++k) hht_step(*box.backend, box.motion, 1e-4);
  return outcome_of(box, 0);
}

// Steps over several lists, with rows pruned several times for each.
Outcome explicit_steps(const Model& model, Real step, const Launches& choice) {
  const Launched launched(choice);
  LoadedBox box(model, model.contact.skin, make_cuda_backend);
  const Index steps = 300, at_once = model.bodies.empty() ? steps : 1;
  const std::unique_ptr<ExplicitRun> run = box.backend->start_run(step);
  for (Index left = steps; left > 0; left -= at_once) {
    box.backend->list().set_body_motion(box.motion);
    REQUIRE(run->take_steps(at_once, left > at_once, box.timers).closed == at_once);
  }
  CHECK(box.backend->list().builds() > 1);
  return outcome_of(box, step);
}

Outcome explicit_steps(const BoxCase& c, Precision precision, const Launches& choice) {
  Model model = dense_box(c, ParticleIntegrator::velocity_verlet, kParticles);
  model.integrator.precision = precision;
  model.contact.skin = 0.02;
  return explicit_steps(model, 1e-5, choice);
}

// Layers of agitated particles over a floor of triangles, which only the lowest of them touch.
Model particles_over_mesh() {
  return model_of(R"(
[space]
dimension = 3
min = [0.0, 0.0, -0.1]
max = [0.231, 0.231, 1.0]
x_min = "periodic"
x_max = "periodic"
y_min = "periodic"
y_max = "periodic"
[time]
end = 1.0
step = 1e-4
[integrator]
particles = "velocity-verlet"
[contact]
skin = 2e-3
[[materials]]
name = "grain"
density = 2500.0
[[contact.pairs]]
stiffness = 1e4
damping = 1.0
friction = 0.4
tangential_damping_ratio = 0.1
[[meshes]]
name = "floor"
kind = "rectangle"
size = [0.6, 0.6]
refine = 0.05
[[walls]]
name = "floor"
mesh = "floor"
[[particles]]
name = "grains"
kind = "lattice"
origin = [0.01, 0.01, 0.01]
spacing = [0.021, 0.021, 0.021]
size = [11, 11, 25]
radius = 0.01
random_velocity = 0.5
material = "grain"
)");
}

void check_same(const Outcome& a, const Outcome& b) {
  CHECK(differing_arrays(a.state, b.state) == "");
  CHECK(same_bits(a.sums, b.sums));
}

struct ExplicitCase {
  const BoxCase& box;
  Precision precision;
};

// Periodic on all sides; exponents 1, 1.5 and, beside bodies, 1.
const ExplicitCase kExplicit[] = {{kBoxes[1], Precision::full},
                                  {kBoxes[4], Precision::full},
                                  {kBoxes[5], Precision::full},
                                  {kBoxes[1], Precision::mixed},
                                  {kBoxes[4], Precision::mixed}};

}  // namespace

TEST_CASE("blocks of any size give the same bits") {
  for (const BoxCase& c : kBoxes) {
    const Outcome usual = implicit_steps(c, {});
    for (const int block : {32, 64, 256}) {
      CAPTURE(c.name, block);
      check_same(usual, implicit_steps(c, {block, {}, {}}));
    }
  }
  for (const ExplicitCase& c : kExplicit) {
    const Outcome usual = explicit_steps(c.box, c.precision, {});
    for (const int block : {32, 64, 256}) {
      CAPTURE(c.box.name, static_cast<int>(c.precision), block);
      check_same(usual, explicit_steps(c.box, c.precision, {block, {}, {}}));
    }
  }
}

TEST_CASE("both forms of the explicit step's kernel give the same bits") {
  for (const ExplicitCase& c : kExplicit) {
    CAPTURE(c.box.name, static_cast<int>(c.precision));
    Launches several, one_by_one;
    several.several_at_once = true, one_by_one.several_at_once = false;
    const Outcome outcome = explicit_steps(c.box, c.precision, several);
    check_same(outcome, explicit_steps(c.box, c.precision, one_by_one));
    // Mixed precision has kernels of its own.
    if (c.precision == Precision::mixed)
      CHECK(differing_arrays(outcome.state, explicit_steps(c.box, Precision::full, several).state) != "");
  }
}

TEST_CASE("particles away from surfaces that go ahead of the others give the same bits") {
  Launches apart, together;
  apart.in_parts = true, together.in_parts = false;
  const auto compare = [&](const Model& model, Real step) {
    check_same(explicit_steps(model, step, apart), explicit_steps(model, step, together));
  };
  compare(particles_over_mesh(), 1e-4);
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Model model = dense_box(kBoxes[5], ParticleIntegrator::velocity_verlet, kParticles);
    model.integrator.precision = precision, model.contact.skin = 0.02;
    compare(model, 1e-5);
  }
}

}  // namespace scree
