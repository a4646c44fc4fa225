// Steps of the CPU backend: undone without a trace, the same bits for every list and for fused substeps;
// escaping particles.
#include <cmath>

#include "base/error.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/particle_bits.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 16 * kUlp;  // of displacements of some hundredths between positions of some 1 m

constexpr int kParticles = 60;

Model soft_box(const BoxCase& box, ParticleIntegrator integrator) {
  Model model = random_box(box, kParticles, 21);
  model.integrator.particles = integrator;
  return model;
}

}  // namespace

TEST_CASE("a rolled-back step leaves no trace") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    LoadedBox box(soft_box(c, ParticleIntegrator::hht), 0.2);
    hht_step(*box.backend, box.motion, 1e-4);
    const std::vector<Particle> before = box.backend->particles().records();
    const std::unique_ptr<ImplicitStep> step = predicted_step(*box.backend, 1e-3);
    step->contact_force();
    box.backend->list().set_body_motion(box.motion);
    step->particle_correct();
    CHECK_FALSE(same_bits(box.backend->particles().records(), before));
    step->undo();
    CHECK(same_bits(box.backend->particles().records(), before));
    // The step after the roll-back equals the step without it.
    hht_step(*box.backend, box.motion, 1e-4);
    const std::vector<Particle> after = box.backend->particles().records();
    LoadedBox other(soft_box(c, ParticleIntegrator::hht), 0.2);
    hht_step(*other.backend, other.motion, 1e-4), hht_step(*other.backend, other.motion, 1e-4);
    CHECK(same_bits(other.backend->particles().records(), after));
  }
}

TEST_CASE("the list's skin and age do not change a bit") {
  for (const BoxCase& c : kBoxes)
    for (const ParticleIntegrator integrator :
         {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet}) {
      CAPTURE(c.name, static_cast<int>(integrator));
      LoadedBox often(soft_box(c, integrator), 0.05), seldom(soft_box(c, integrator), 0.3);
      for (int step = 0; step < 10; ++step) {
        for (LoadedBox* box : {&often, &seldom}) {
          if (integrator == ParticleIntegrator::hht)
            hht_step(*box->backend, box->motion, 2e-4);
          else
            verlet_steps(*box, 2e-4, 1);
        }
        often.backend->list().build(0.02 + 0.01 * step, often.timers);
      }
      REQUIRE(seldom.backend->list().displacement() <= 1);
      CHECK(same_bits(often.backend->particles().records(), seldom.backend->particles().records()));
    }
}

TEST_CASE("fused explicit steps give the bits of single ones") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    const Model model = soft_box(c, ParticleIntegrator::velocity_verlet);
    LoadedBox fused(model, 0.3), single(model, 0.3);
    const Real h = 1e-4;
    CHECK(verlet_steps(fused, h, 9) == 9);
    for (int step = 0; step < 9; ++step) verlet_steps(single, h, 1);
    CHECK(same_bits(fused.backend->particles().records(), single.backend->particles().records()));
  }
}

TEST_CASE("steps without particles or shapes") {
  for (const auto integrator : {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet}) {
    Model model = random_box(kBoxes[0], 0, 1);
    model.integrator.particles = integrator;
    LoadedBox box(model);
    if (integrator == ParticleIntegrator::velocity_verlet) {
      CHECK(verlet_steps(box, 1e-4, 3) == 3);
    } else {
      const std::unique_ptr<ImplicitStep> step = predicted_step(*box.backend, 1e-4);
      CHECK(step->contact_force().residual == 0);
      CHECK(step->particle_correct().correction == 0);
      step->accept();
    }
    CHECK(box.backend->list().displacement() == 0);
    CHECK(box.backend->reports().ledger(0).kinetic == 0);
    CHECK(box.backend->particles().records().empty());
  }
}

TEST_CASE("steps conserve momentum without gravity, walls and bodies") {
  for (const BoxCase& c : kBoxes)
    for (const ParticleIntegrator integrator :
         {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet}) {
      if (c.bodies || c.walls) continue;
      CAPTURE(c.name, static_cast<int>(integrator));
      Model model = soft_box(c, integrator);
      model.gravity = {};
      LoadedBox box(model, 0.3);
      const ParticleLedger start = box.backend->reports().ledger(0);
      for (int step = 0; step < 10; ++step) {
        if (integrator == ParticleIntegrator::hht)
          hht_step(*box.backend, box.motion, 1e-4);
        else
          verlet_steps(box, 1e-4, 1);
      }
      // HHT's is exact to its residual, 1e-10 of the largest force, times 1 ms.
      CHECK(norm(box.backend->reports().ledger(0).momentum - start.momentum) <= 1e-11 * kParticles);
    }
}

TEST_CASE("the list expires when an item has moved by half the skin") {
  LoadedBox box(soft_box(kBoxes[2], ParticleIntegrator::hht), 0.1);
  CHECK(box.backend->list().displacement() == 0);
  box.motion[4].position.x += 0.04;
  const std::unique_ptr<ImplicitStep> step = predicted_step(*box.backend, 1e-9);
  box.backend->list().set_body_motion(box.motion);
  CHECK(near(box.backend->list().displacement(), 0.8, {.relative = kRoundOff}));
  box.motion[4].position.x += 0.02;
  box.backend->list().set_body_motion(box.motion);
  CHECK(near(box.backend->list().displacement(), 1.2, {.relative = kRoundOff}));
}

TEST_CASE("particles escape once, ordered by global id, and become ballistic or are removed") {
  for (const OutsidePolicy leaving : {OutsidePolicy::error, OutsidePolicy::remove, OutsidePolicy::drift}) {
    CAPTURE(static_cast<int>(leaving));
    Model model = soft_box(kBoxes[0], ParticleIntegrator::velocity_verlet);
    model.space.leaving = leaving;
    const Real h = 1e-3;
    for (const std::size_t id : {41, 7, 23}) {
      model.particles.position[id].x = model.space.max.x - 1e-6;
      model.particles.velocity[id] = {100, 0, 0};
    }
    LoadedBox box(model, 0.5);
    verlet_steps(box, h, 1);
    const ParticleLedger before = box.backend->reports().ledger(0);
    const std::vector<EscapedParticle> escaped_particles = box.backend->particles().outside();
    REQUIRE(escaped_particles.size() == 3);
    CHECK((escaped_particles[0].global_id == 7 && escaped_particles[1].global_id == 23 &&
           escaped_particles[2].global_id == 41));
    for (const EscapedParticle& l : escaped_particles) CHECK((l.position.x > model.space.max.x && !l.lost));
    if (leaving == OutsidePolicy::error) continue;
    box.backend->particles().remove_escaped(escaped_particles);
    CHECK(box.backend->list().displacement() > 1);
    box.backend->list().build(0.1, box.timers);
    CHECK(box.backend->particles().outside().empty());
    const ParticleLedger after = box.backend->reports().ledger(0);
    const bool removed = leaving == OutsidePolicy::remove;
    CHECK(box.backend->particles().records().size() ==
          static_cast<std::size_t>(removed ? kParticles - 3 : kParticles));
    CHECK(after.drifting == (removed ? 0 : 3));
    Real taken = 0;
    for (const EscapedParticle& l : escaped_particles) taken += l.energy;
    const Real energy = after.kinetic + after.gravitational + (removed ? taken : 0);
    CHECK(near(energy, before.kinetic + before.gravitational, {.relative = kRoundOff}));
  }
}

TEST_CASE("an explicit step across the whole periodic domain is refused, except for ballistic particles") {
  const auto failure = [](const BoxCase& c, Real speed, bool drifting) -> std::string {
    LoadedBox box(soft_box(c, ParticleIntegrator::velocity_verlet), 0.2);
    box.records[23].velocity = {0, speed, 0};
    box.records[23].drifting = drifting;
    try {
      box.backend->particles().load(box.records, {});
      box.backend->list().build(0.2, box.timers);
      verlet_steps(box, 1e-3, 1);
      box.backend->list().build(0.2, box.timers);
    } catch (const SimulationError& error) {
      return error.what();
    }
    return "";
  };
  const std::string refused = kUnsoundPosition[0] + std::string("23") + kUnsoundPosition[1];
  for (const BoxCase& c : {kBoxes[1], kBoxes[4]}) {
    CAPTURE(c.name);
    for (const Real speed : {1e5, 1e30, 1e308}) {
      CHECK(failure(c, speed, false) == refused);
      CHECK(failure(c, speed, true).empty());
    }
  }
}

TEST_CASE("gravity alone acts on a ballistic particle") {
  Model model = soft_box(kBoxes[0], ParticleIntegrator::velocity_verlet);
  LoadedBox box(model);
  // Three of each kind at one position outside.
  for (const std::size_t id : {3, 4, 5}) {
    box.records[id].position = {2 + 0.01 * static_cast<Real>(id), 0, 0};
    box.records[id].drifting = true;
  }
  box.backend->particles().load(box.records, {});
  box.backend->list().build(0.02, box.timers);
  box.backend->particles().initial_forces();
  const BoxOutput output(*box.backend);
  for (std::size_t i = 0; i < output.all.global_id.size(); ++i) {
    if (output.all.global_id[i] < 3 || output.all.global_id[i] > 5) continue;
    CHECK(norm(output.of<Vec3>("force")[i]) == 0);
    CHECK(output.of<int>("contacts")[i] == 0);
  }
}

TEST_CASE("a force that is not finite names the stage and the particle") {
  LoadedBox box(soft_box(kBoxes[0], ParticleIntegrator::hht));
  box.records[17].velocity.x = std::nan("");
  box.backend->particles().load(box.records, {});
  box.backend->list().build(0.02, box.timers);
  box.backend->particles().initial_forces();
  std::string message;
  try {
    predicted_step(*box.backend, 1e-4)->contact_force();
  } catch (const SimulationError& error) {
    message = error.what();
  }
  CHECK(message.find("contact_force") != std::string::npos);
  CHECK(message.find("particle") != std::string::npos);
}

}  // namespace scree
