// A box of particles whose contacts have histories, and bodies that move and rotate at their velocities:
// lost histories change the forces.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "run/restart/restart.hpp"
#include "run/state/state.hpp"
#include "support/history_test_backend.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

inline constexpr int kHistoryNumbers = 8;  // numbers per contact
inline constexpr Real kMovingStep = 5e-4, kMovingSkin = 0.05;

inline Model moving_box(const BoxCase& c, OutsidePolicy leaving) {
  Model model = random_box(c, 150, 21);
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.contact.skin = kMovingSkin;
  model.parallel.imbalance = 0;  // boxes are recomputed with every list
  model.space.leaving = leaving;
  for (NormalLawParameters& law : model.contact.laws) law.exponent = 1;
  if (c.walls && c.periodic_axes > 0) {  // walls along the periodic axis alone do not repeat
    model.walls.resize(1);
    model.walls[0].normal = {0, 1, 0};
  }
  return model;
}

struct HistoryTestBox {
  using Make = std::unique_ptr<Backend> (*)(const Model&, const Ranks&);

  HistoryTestBox(const Model& of, const Ranks& on, Make make = make_history_test_backend<kHistoryNumbers>)
      : ranks(on), model(of), motion(motion_of(of.bodies)), backend(make(model, on)) {}

  // state: of this rank's part of the ids.
  void start(const State& state) {
    backend->particles().load(state.particles, state.shapes);
    backend->particles().load_contacts(state.contacts);
    backend->particles().load_shape_contacts(state.shape_contacts);
    backend->list().set_body_motion(motion);
    backend->list().build(model.contact.skin, timers);
  }
  void start() {
    const std::vector<Particle> all = initial_records(model.particles, Subdomain(model.space));
    const IdRange own = id_range(std::ssize(all), ranks.rank(), ranks.size());
    State state;
    state.particles = {all.begin() + own.first, all.begin() + own.last};
    start(state);
    backend->particles().initial_forces();
  }
  // Moves bodies by their velocities over h [s], rotations included.
  void move_bodies(Real h) {
    for (BodyMotion& body : motion)
      body.position += h * body.velocity, body.angle += h * body.angular_velocity;
    backend->list().set_body_motion(motion);
  }
  // Takes so many steps, each followed by so many queries of the bodies; then escaped particles are removed.
  void take_steps(Index steps, Real h = kMovingStep, int looks = 0) {
    const std::unique_ptr<ExplicitRun> run = backend->start_run(h);
    while (steps > 0) {
      move_bodies(h);
      const Index most = motion.empty() ? steps : 1;
      const StepsTaken taken = run->take_steps(most, most < steps, timers);
      steps -= taken.closed;
      for (int look = 0; look < looks; ++look) run->shape_contacts();
      if (!taken.open) break;
    }
    const std::vector<EscapedParticle> escaped_particles = backend->particles().outside();
    if (!escaped_particles.empty())
      backend->particles().remove_escaped(escaped_particles),
          backend->list().build(model.contact.skin, timers);
  }
  // State of this rank, in the order of the ids.
  State state() const {
    State state;
    state.particles = backend->particles().records();
    state.contacts = backend->particles().contacts();
    state.shapes = backend->particles().shape_losses();
    state.shape_contacts = backend->particles().shape_contacts();
    return state;
  }
  State in_id_order() const {
    State out = state();
    std::vector<GlobalId> ids;
    for (const Particle& p : out.particles) ids.push_back(p.global_id);
    const IdOrder order(ranks, model.particles.totals.count, ids);
    out.particles = order.apply(std::move(out.particles));
    out.contacts = in_order(order, std::move(out.contacts));
    return out;
  }
  std::string hash() const { return hash_of_all(state(), ranks); }

  Ranks ranks;
  Model model;
  std::vector<BodyMotion> motion;
  std::unique_ptr<Backend> backend;
  StageTimers timers;
};

}  // namespace scree
