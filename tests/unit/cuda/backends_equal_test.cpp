// The CUDA backend against the CPU's, on boxes of particles and bodies at random positions. Both are built
// without contraction, and roots and divisions are exact to the last bit on both: linear laws give the same
// bits. pow() does not: other exponents agree to round-off.
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "dem/backend/device.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "support/catch.hpp"
#include "support/contact_line_bits.hpp"
#include "support/near.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {
namespace {

constexpr int kParticles = 3000;
constexpr Real kRoundOff = 1e-11;  // of forces: sums of some ten terms after a pow()

struct Pair {
  explicit Pair(const Model& of, Real skin = 0.02)
      : model(of),
        motion(motion_of(model.bodies)),
        cpu(make_cpu_backend(model)),
        cuda(make_cuda_backend(model)) {
    motion.resize(SurfaceSet(model).parents());  // walls are where they start
    for (Backend* backend : {cpu.get(), cuda.get()}) {
      backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
      backend->list().set_body_motion(motion);
      backend->list().build(skin, timers);
      backend->particles().initial_forces();
    }
  }

  Model model;
  std::vector<BodyMotion> motion;
  std::unique_ptr<Backend> cpu, cuda;
  StageTimers timers;
};

Real difference(Vec3 a, Vec3 b) { return norm(a - b) / (1 + norm(a)); }

// Largest difference of two states, relative; 0 where all bits are the same.
Real difference(const std::vector<Particle>& a, const std::vector<Particle>& b) {
  if (a.size() != b.size()) return INFINITY;
  Real largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].global_id != b[i].global_id || a[i].drifting != b[i].drifting || a[i].image.x != b[i].image.x)
      return INFINITY;
    for (const Real d :
         {difference(a[i].position, b[i].position), difference(a[i].velocity, b[i].velocity),
          difference(a[i].acceleration, b[i].acceleration), difference(a[i].force, b[i].force),
          std::abs(a[i].contact_loss - b[i].contact_loss), std::abs(a[i].loss_power - b[i].loss_power),
          std::abs(a[i].integrator_loss - b[i].integrator_loss)})
      if (!(d <= largest)) largest = d;
  }
  return largest;
}

Real allowed(const BoxCase& box) { return box.exponent == 1 ? 0 : kRoundOff; }

// Compares the wrenches of both backends.
void check_wrenches(const std::vector<BodyWrench> (&wrench)[2], Real tolerance) {
  REQUIRE(wrench[0].size() == wrench[1].size());
  for (std::size_t b = 0; b < wrench[0].size(); ++b) {
    CHECK(difference(wrench[0][b].force, wrench[1][b].force) <= tolerance);
    CHECK(difference(wrench[0][b].torque, wrench[1][b].torque) <= tolerance);
  }
}

// Compares the contacts with walls and bodies at their present poses.
void check_contacts(Pair& pair, Real tolerance) {
  std::vector<int> all(pair.model.walls.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<ContactSum> sums[2];
  for (int k = 0; k < 2; ++k) {
    Backend& backend = k == 0 ? *pair.cpu : *pair.cuda;
    sums[k] = backend.reports().wall_contacts(all);
    for (const ContactSum& body : backend.reports().parent_contacts()) sums[k].push_back(body);
    for (const ContactSum& surface : backend.reports().surface_contacts()) sums[k].push_back(surface);
  }
  REQUIRE(sums[0].size() == sums[1].size());
  std::int64_t contacts = 0;
  for (std::size_t i = 0; i < sums[0].size(); ++i) {
    CHECK(difference(sums[0][i].force, sums[1][i].force) <= tolerance);
    CHECK(difference(sums[0][i].torque, sums[1][i].torque) <= tolerance);
    CHECK(sums[0][i].contacts == sums[1][i].contacts);
    contacts += sums[0][i].contacts;
  }
  CHECK((contacts > 0) == !sums[0].empty());
}

}  // namespace

TEST_CASE("forces, lists and sums at the start are the same on both backends") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    Pair pair(dense_box(c, ParticleIntegrator::hht, kParticles));
    CHECK(pair.cpu->list().entries() == pair.cuda->list().entries());
    CHECK(pair.cpu->list().entries() > kParticles);
    CHECK(difference(pair.cpu->particles().records(), pair.cuda->particles().records()) <= allowed(c));
    const ParticleLedger a = pair.cpu->reports().ledger(0), b = pair.cuda->reports().ledger(0);
    CHECK(a.contacts == b.contacts);
    CHECK(a.kinetic == b.kinetic);
    CHECK(a.gravitational == b.gravitational);
    CHECK(std::abs(a.contact_elastic - b.contact_elastic) <= allowed(c) * a.contact_elastic);
    CHECK(difference(a.angular_momentum, b.angular_momentum) == 0);
    std::vector<BodyWrench> wrench[2];
    for (int k = 0; k < 2; ++k) {
      wrench[k].resize(pair.model.bodies.size());
      (k == 0 ? pair.cpu : pair.cuda)->particles().reduce_wrench(wrench[k]);
    }
    check_wrenches(wrench, allowed(c));
    check_contacts(pair, allowed(c));
  }
}

// More triangles in a row than a warp keeps, and more boxes of a level than it descends through at once.
TEST_CASE("contacts of particles near many triangles are the same on both backends") {
  for (const int squares : {40, 150, 400}) {
    CAPTURE(squares);
    Model model = dense_box(kBoxes[6], ParticleIntegrator::velocity_verlet, kParticles);
    const Pair bare(model);
    add_floor(model, squares);
    const Pair pair(model);
    CHECK(difference(pair.cpu->particles().records(), pair.cuda->particles().records()) <=
          allowed(kBoxes[6]));
    CHECK(difference(pair.cpu->particles().records(), bare.cpu->particles().records()) > 0);
  }
}

TEST_CASE("an implicit step is the same on both backends") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    Pair pair(dense_box(c, ParticleIntegrator::hht, kParticles), 0.1);
    std::vector<int> iterations[2];
    std::unique_ptr<ImplicitStep> steps[2];
    std::vector<BodyWrench> in_step[2], at_end[2];
    for (int k = 0; k < 2; ++k) {
      Backend& backend = k == 0 ? *pair.cpu : *pair.cuda;
      steps[k] = predicted_step(backend, 2e-4);
      solve_step(backend, *steps[k], pair.motion, [&](int linear) { iterations[k].push_back(linear); });
      CHECK(steps[k]->step_displacement() > 0);
      at_end[k].resize(pair.model.bodies.size());
      ContactWrenches contacts{at_end[k], {}};
      steps[k]->reduce_wrench(contacts, at_end[k]);
      in_step[k] = contacts.wrench;
    }
    // Other exponents: both iterates are within the residual's tolerance.
    const Real tolerance = c.exponent == 1 ? 0 : 1e-7;
    CHECK(near(steps[0]->step_displacement(), steps[1]->step_displacement(), {.relative = 1e-3 * tolerance}));
    CHECK(iterations[0] == iterations[1]);
    CHECK(iterations[0].size() > 1);
    CHECK(near(steps[0]->error(), steps[1]->error(), {.relative = tolerance}));
    for (const auto* wrench : {&in_step, &at_end}) check_wrenches(*wrench, tolerance);
    for (const auto& step : steps) step->accept();
    CHECK(difference(pair.cpu->particles().records(), pair.cuda->particles().records()) <= tolerance);
  }
}

// Removes the escaped particles; returns the energy that they take along [J]: all of it, and the contacts'
// part.
std::array<Real, 2> leave(Backend& backend) {
  const std::vector<EscapedParticle> escaped_particles = backend.particles().outside();
  std::array<Real, 2> taken{};
  for (const EscapedParticle& l : escaped_particles)
    taken[0] += l.energy + l.contact_loss + l.integrator_loss + l.elastic, taken[1] += l.elastic;
  backend.particles().remove_escaped(escaped_particles);
  return taken;
}

TEST_CASE(
    "particles that escape after an implicit step, and the remaining ones, are the same on both backends") {
  for (const BoxCase& c : kBoxes)
    for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove}) {
      if (c.periodic_axes == c.dimension) continue;
      CAPTURE(c.name, static_cast<int>(leaving));
      Model model = dense_box(c, ParticleIntegrator::hht, kParticles);
      model.space.leaving = leaving;
      for (std::size_t id = 0; id < 40; ++id) {  // over the upper side of an axis that is open in all cases
        model.particles.position[7 * id].y = model.space.max.y - 1e-6;
        model.particles.velocity[7 * id] = {0, 10, 0};
      }
      Pair pair(model, 0.1);
      std::array<Real, 2> taken[2];
      for (int k = 0; k < 2; ++k) {
        Backend& backend = k == 0 ? *pair.cpu : *pair.cuda;
        hht_step(backend, pair.motion, 2e-4);
        taken[k] = leave(backend);
        backend.list().build(0.1, pair.timers);
        hht_step(backend, pair.motion, 2e-4);
      }
      const Real tolerance = c.exponent == 1 ? 0 : 1e-7;
      CHECK(taken[0][1] > 0);
      for (int k = 0; k < 2; ++k)
        CHECK(std::abs(taken[0][k] - taken[1][k]) <= tolerance * std::abs(taken[0][k]));
      CHECK(difference(pair.cpu->particles().records(), pair.cuda->particles().records()) <= tolerance);
      CHECK(near(pair.cpu->particles().shape_losses().contact_loss,
                 pair.cuda->particles().shape_losses().contact_loss, {.relative = tolerance}));
      CHECK(near(pair.cpu->particles().shape_losses().integrator_loss,
                 pair.cuda->particles().shape_losses().integrator_loss, {.relative = tolerance}));
    }
}

struct Outcome {
  std::array<Real, 2> taken{};         // energy of the escaped particles
  std::vector<BodyWrench> wrench;      // with the last step closed
  std::vector<std::int64_t> contacts;  // that these are of
};

// Takes steps on one backend and removes escaped particles on the way.
Outcome take_steps(Backend& backend, Pair& pair, Index steps, Index most, Real h = 1e-4) {
  Outcome out;
  out.wrench.resize(pair.model.bodies.size());
  std::unique_ptr<ExplicitRun> run = backend.start_run(h);
  for (Index left = steps; left > 0;) {
    backend.list().set_body_motion(pair.motion);
    const StepsTaken steps_taken = run->take_steps(std::min(left, most), left > most, pair.timers);
    left -= steps_taken.closed;
    if (steps_taken.open) continue;
    run->shape_contacts();
    run->reduce_wrench(out.wrench, out.contacts);
    const std::array<Real, 2> now = leave(backend);
    out.taken[0] += now[0], out.taken[1] += now[1];
    backend.list().build(pair.model.contact.skin, pair.timers);
    if (left > 0) run = backend.start_run(h);
  }
  return out;
}

TEST_CASE("explicit steps are the same on both backends") {
  for (const BoxCase& c : kBoxes)
    for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove}) {
      CAPTURE(c.name);
      Model model = dense_box(c, ParticleIntegrator::velocity_verlet, kParticles);
      model.contact.skin = 0.004;  // expires within the run
      model.space.leaving = leaving;
      Pair pair(model, model.contact.skin);
      const Outcome a = take_steps(*pair.cpu, pair, 100, 7), b = take_steps(*pair.cuda, pair, 100, 50);
      CHECK((a.taken[1] > 0) == (c.periodic_axes < c.dimension));
      for (int k = 0; k < 2; ++k)
        CHECK(std::abs(a.taken[k] - b.taken[k]) <= (c.exponent == 1 ? 0 : 1e-7) * std::abs(a.taken[k]));
      CHECK(pair.cuda->list().builds() > 2);
      CHECK(difference(pair.cpu->particles().records(), pair.cuda->particles().records()) <=
            (c.exponent == 1 ? 0 : 1e-7));
      check_wrenches({a.wrench, b.wrench}, c.exponent == 1 ? 0 : 1e-7);
      CHECK(a.contacts == b.contacts);
      if (c.exponent == 1) check_contacts(pair, 0);
    }
}

// Steps so short that rows are pruned several times between two lists; particles so few and so many that
// either form of the step's kernel is used.
TEST_CASE("many short explicit steps are the same on both backends") {
  for (const BoxCase& c : {kBoxes[1], kBoxes[5]})
    for (const int particles : {kParticles, 80000}) {
      CAPTURE(c.name, particles);
      Model model = dense_box(c, ParticleIntegrator::velocity_verlet, particles);
      model.contact.skin = 0.02;
      Pair pair(model, model.contact.skin);
      const Index at_once = model.bodies.empty() ? 300 : 1;
      for (Backend* backend : {pair.cpu.get(), pair.cuda.get()})
        take_steps(*backend, pair, 300, at_once, 1e-5);
      CHECK(pair.cuda->list().builds() > 1);
      CHECK(pair.cuda->list().builds() < 30);
      CHECK(difference(pair.cpu->particles().records(), pair.cuda->particles().records()) == 0);
    }
}

// Lines of the largest box leave the device in parts.
TEST_CASE("contacts are shown the same on both backends") {
  std::vector<std::pair<BoxCase, int>> cases{{kBoxes[1], 200000}};
  for (const BoxCase& c : kBoxes)
    if (allowed(c) == 0) cases.emplace_back(c, kParticles);
  for (const auto& [c, particles] : cases) {
    CAPTURE(c.name, particles);
    Pair pair(dense_box(c, ParticleIntegrator::velocity_verlet, particles));
    const auto lines = [&](Backend& backend) { return ordered_lines(backend.reports(), particles); };
    const std::vector<ContactLine> cpu = lines(*pair.cpu), cuda = lines(*pair.cuda);
    CHECK(cpu.size() > (particles > kParticles ? kLinesAtOnce : static_cast<std::size_t>(kParticles) / 4));
    CHECK(same_bits(cpu, cuda));
  }
}

TEST_CASE("the state moves between the backends without a trace") {
  const BoxCase& c = kBoxes[5];
  Pair pair(dense_box(c, ParticleIntegrator::velocity_verlet, kParticles));
  const std::vector<Particle> records = pair.cpu->particles().records();
  pair.cuda->particles().load(records, {});
  CHECK(difference(pair.cuda->particles().records(), records) == 0);
}

}  // namespace scree
