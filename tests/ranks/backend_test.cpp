// The particles' backend on all ranks of mpirun against one rank alone, bit for bit; failures reach every
// rank.
#include "dem/backend/backend.hpp"

#include <mpi.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "dem/particles/particle_store.hpp"
#include "support/catch.hpp"
#include "support/particle_bits.hpp"
#include "support/petsc_run.hpp"
#include "support/state_bits.hpp"
#include "unit/dem/random_box.hpp"

namespace {

// Entries sent by this rank with MPI_Send, which is how they are gathered on rank 0.
struct Sent {
  int messages = 0, entries = 0;
} sent;

}  // namespace

// MPI lets a program intercept its own calls in this way.
extern "C" int MPI_Send(const void* data, int count, MPI_Datatype type, int to, int tag,
                        MPI_Comm communicator) {
  ++sent.messages, sent.entries += count;
  return PMPI_Send(data, count, type, to, tag, communicator);
}

namespace scree {

namespace {

constexpr int kParticles = 150;
constexpr Real kSkin = 0.15;

struct RankedBox {
  RankedBox(const Model& of, const Ranks& on, Real list_skin = kSkin)
      : ranks(on),
        model(of),
        skin(list_skin),
        motion(motion_of(of.bodies)),
        backend(make_test_backend(model, on)) {
    start(initial_records(model.particles, Subdomain(model.space)));
  }
  // records: of all particles, the same on every rank.
  void start(const std::vector<Particle>& records) {
    const IdRange own = id_range(std::ssize(records), ranks.rank(), ranks.size());
    backend->particles().load({records.begin() + own.first, records.begin() + own.last}, {});
    backend->list().set_body_motion(motion);
    backend->list().build(skin, timers);
    backend->particles().initial_forces();
  }
  std::vector<Particle> records() const {
    std::vector<Particle> all = ranks.all_gather(backend->particles().records());
    std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.global_id < b.global_id; });
    return all;
  }
  void renew_list() {
    if (backend->list().displacement() > 0.5) backend->list().build(kSkin, timers);
  }

  Ranks ranks;
  Model model;
  Real skin;
  std::vector<BodyMotion> motion;
  std::unique_ptr<Backend> backend;
  StageTimers timers;
};

void step(RankedBox& box, Real h) {
  if (box.model.integrator.particles == ParticleIntegrator::hht) return hht_step(*box.backend, box.motion, h);
  const std::unique_ptr<ExplicitRun> run = box.backend->start_run(h);
  box.backend->list().set_body_motion(box.motion);
  run->take_steps(1, false, box.timers);
}

bool touched(const std::vector<ContactSum>& sums) {
  return std::any_of(sums.begin(), sums.end(), [](const ContactSum& s) { return s.contacts > 0; });
}

constexpr int kRow = 20, kFarBodies = 300;

// A row of separate particles, a body in contact beside each of the first ones, and many bodies without
// contacts.
Model row_beside_bodies(int touched, ParticleIntegrator integrator) {
  constexpr Real kRadius = 0.1, kSpacing = 1;
  Model model;
  model.integrator.particles = integrator;
  model.space.dimension = 2;
  model.space.min = {0, 0, 0}, model.space.max = {kSpacing * (kRow + 1), kSpacing * (kRow + 1), 0};
  model.contact.material_names = {"material"};
  model.contact.laws.push_back({1e3, 0, 1, false});
  const auto add_body = [&](Vec3 position) {
    Body body;
    body.mass = 1, body.inertia = 1, body.position = position;
    body.shapes.push_back({{}, kRadius, 0});
    model.bodies.push_back(body);
  };
  for (int i = 0; i < kRow; ++i) {
    const Vec3 p = kSpacing * Vec3{i + 1.0, 1, 0};
    model.particles.position.push_back(p), model.particles.velocity.emplace_back();
    model.particles.radius.push_back(kRadius), model.particles.mass.push_back(1);
    model.particles.material.push_back(0);
    if (i < touched) add_body(p + Vec3{1.5 * kRadius, 0, 0});
  }
  for (int k = 0; k < kFarBodies; ++k) add_body(kSpacing * Vec3{1.0 + k % kRow, 3.0 + k / kRow, 0});
  count_particles(model.particles, 1);
  return model;
}

std::string failure(const std::function<void()>& action) {
  try {
    action();
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("particles, wrenches and sums have the bits of one rank") {
  petsc();
  const Ranks world = Ranks::world();
  for (const BoxCase& c : kBoxes)
    for (const ParticleIntegrator integrator :
         {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet}) {
      CAPTURE(c.name, static_cast<int>(integrator));
      Model model = random_box(c, kParticles, 21);
      model.integrator.particles = integrator;
      model.parallel.imbalance = 0;                       // boxes are recomputed with every list
      RankedBox many(model, world), one(model, Ranks());  // in this order: the first takes the rank's GPU
      CHECK(differing_fields(one.records(), many.records()) == "");
      for (int k = 0; k < 25; ++k) {
        for (RankedBox* box : {&one, &many}) step(*box, 2e-4), box->renew_list();
        if (k == 12) many.backend->list().build(3 * kSkin, many.timers);  // wider than a cell of the boxes
      }
      CHECK(differing_fields(one.records(), many.records()) == "");
      std::vector<BodyWrench> end_a(model.bodies.size()), end_b = end_a;
      if (integrator == ParticleIntegrator::hht) {
        ContactWrenches step_a{end_a, {}}, step_b = step_a;
        const auto a = predicted_step(*one.backend, 2e-4), b = predicted_step(*many.backend, 2e-4);
        a->contact_force(), b->contact_force();
        a->reduce_wrench(step_a, end_a), b->reduce_wrench(step_b, end_b);
        a->undo(), b->undo();
        if (world.is_root()) CHECK((same_bits(step_a, step_b) && same_bits(end_a, end_b)));
      } else if (c.exponent == 1) {
        one.backend->particles().reduce_wrench(end_a), many.backend->particles().reduce_wrench(end_b);
        if (world.is_root()) CHECK(same_bits(end_a, end_b));
      }
      CHECK(world.sum(many.backend->list().balance().halo.owned) == kParticles);
      const std::vector<int> walls = c.walls ? std::vector{1, 0} : std::vector<int>{};
      const std::vector<ContactSum> walls_a = one.backend->reports().wall_contacts(walls),
                                    walls_b = many.backend->reports().wall_contacts(walls),
                                    bodies_a = one.backend->reports().parent_contacts(),
                                    bodies_b = many.backend->reports().parent_contacts(),
                                    shapes_a = one.backend->reports().surface_contacts(),
                                    shapes_b = many.backend->reports().surface_contacts();
      if (world.is_root()) CHECK((same_bits(walls_a, walls_b) && touched(walls_a) == c.walls));
      if (world.is_root()) CHECK((same_bits(bodies_a, bodies_b) && touched(bodies_a) == c.bodies));
      if (world.is_root()) CHECK((same_bits(shapes_a, shapes_b) && touched(shapes_a) == c.bodies));
      const ParticleLedger p = one.backend->reports().ledger(0), q = many.backend->reports().ledger(0);
      if (!world.is_root()) continue;
      CHECK((p.kinetic == q.kinetic && p.gravitational == q.gravitational));
      CHECK((p.contact_elastic == q.contact_elastic && p.contact_loss == q.contact_loss));
      CHECK((p.integrator_loss == q.integrator_loss && p.momentum == q.momentum));
      CHECK((p.angular_momentum == q.angular_momentum && p.contacts == q.contacts));
      CHECK(p.drifting == q.drifting);
    }
}

TEST_CASE("escaped particles in contact, and their former partners, have the bits of one rank") {
  petsc();
  const Ranks world = Ranks::world();
  for (const BoxCase& c : kBoxes)
    for (const ParticleIntegrator integrator : {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet})
      for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove}) {
        if (c.periodic_axes == c.dimension) continue;
        CAPTURE(c.name, static_cast<int>(integrator), static_cast<int>(leaving));
        Model model = random_box(c, kParticles, 21);
        model.integrator.particles = integrator;
        model.space.leaving = leaving;
        for (std::size_t id = 0; id < 15; ++id) {  // over a side that is open in all these cases
          model.particles.position[9 * id].y = model.space.max.y - 1e-6;
          model.particles.velocity[9 * id] = {0, 10, 0};
        }
        RankedBox many(model, world), one(model, Ranks());
        std::vector<EscapedParticle> escaped_particles[2];
        for (const bool alone : {false, true}) {
          RankedBox& box = alone ? one : many;
          step(box, 2e-4);
          escaped_particles[alone] = box.backend->particles().outside();
          box.backend->particles().remove_escaped(escaped_particles[alone]);
          box.backend->list().build(kSkin, box.timers);
          step(box, 2e-4);
        }
        REQUIRE(escaped_particles[0].size() == escaped_particles[1].size());
        CHECK(escaped_particles[0].size() >= 15);
        bool same_energies = true;
        Real elastic = 0;
        for (std::size_t k = 0; k < escaped_particles[0].size(); ++k) {
          const EscapedParticle &a = escaped_particles[0][k], &b = escaped_particles[1][k];
          same_energies = same_energies && a.energy == b.energy && a.elastic == b.elastic &&
                          a.contact_loss == b.contact_loss && a.integrator_loss == b.integrator_loss;
          elastic += a.elastic;
        }
        CHECK((same_energies && elastic > 0));
        CHECK(differing_fields(one.records(), many.records()) == "");
        const ShapeLosses p = one.backend->particles().shape_losses(),
                          q = many.backend->particles().shape_losses();
        if (world.is_root()) CHECK(same_bits(p, q));
      }
}

// So many that each rank has particles far from its sides, whose forces a GPU computes during the exchange
// of ghosts; and lists that expire within a batch of steps.
TEST_CASE("many explicit steps of many particles have the bits of one rank") {
  petsc();
  for (const BoxCase& c : {kBoxes[1], kBoxes[4]}) {
    CAPTURE(c.name);
    Model model = dense_box(c, ParticleIntegrator::velocity_verlet, 20000);
    model.contact.skin = 0.02;
    model.parallel.imbalance = 0;
    RankedBox many(model, Ranks::world(), 0.02), one(model, Ranks(), 0.02);
    for (RankedBox* box : {&one, &many}) {
      const Real h = 1e-4;
      box->backend->start_run(h)->take_steps(200, false, box->timers);
    }
    CHECK(many.backend->list().builds() > 2);
    CHECK(differing_fields(one.records(), many.records()) == "");
  }
}

TEST_CASE("a particle that is not finite ends all ranks with the same message") {
  petsc();
  for (const ParticleIntegrator integrator : {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet})
    for (const bool place : {false, true}) {
      CAPTURE(static_cast<int>(integrator), place);
      Model model = random_box(kBoxes[4], kParticles, 5);
      model.integrator.particles = integrator;
      RankedBox box(model, Ranks::world());
      std::vector<Particle> records = initial_records(model.particles, Subdomain(model.space));
      (place ? records[17].position : records[17].velocity).x = std::nan("");
      const std::string message = failure([&] {
        box.start(records);
        step(box, 1e-4);
      });
      CHECK(message.find("is not finite") != std::string::npos);
      if (place) CHECK(message == kUnsoundPosition[0] + std::string("17") + kUnsoundPosition[1]);
      std::string of_all;
      for (int rank = 0; rank < Ranks::world().size(); ++rank) of_all += message;
      const std::vector<char> own(message.begin(), message.end()), all = Ranks::world().all_gather(own);
      CHECK(std::string(all.begin(), all.end()) == of_all);
      // All ranks have reached the same point: the next collective is the same one everywhere.
      CHECK(Ranks::world().sum(std::int64_t{1}) == Ranks::world().size());
    }
}

TEST_CASE("of the bodies' shapes only those that a rank touches are sent, in one message") {
  petsc();
  const Ranks world = Ranks::world();
  for (const ParticleIntegrator integrator : {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet})
    for (const int touched : {0, 3, kRow}) {
      CAPTURE(static_cast<int>(integrator), touched);
      RankedBox box(row_beside_bodies(touched, integrator), world);
      std::vector<BodyWrench> end(box.model.bodies.size());
      ContactWrenches step{end, {}};
      std::unique_ptr<ImplicitStep> open;
      if (integrator == ParticleIntegrator::hht)
        open = predicted_step(*box.backend, 1e-6), open->contact_force();
      sent = {};
      if (open)
        open->reduce_wrench(step, end);
      else
        box.backend->particles().reduce_wrench(end);
      const Sent by_this_rank = sent;
      const std::vector<Particle> own = box.backend->particles().records();
      const auto in_touch =
          std::count_if(own.begin(), own.end(), [&](const auto& p) { return p.global_id < touched; });
      CHECK(by_this_rank.messages == (world.is_root() ? 0 : 1));
      CHECK(by_this_rank.entries == (world.is_root() ? 0 : in_touch));
      if (touched == kRow && !world.alone()) CHECK(world.sum(std::int64_t{by_this_rank.entries}) > 0);
      const auto moved =
          std::count_if(end.begin(), end.end(), [](const BodyWrench& w) { return w.force.x > 0; });
      CHECK(moved == (world.is_root() ? touched : 0));
    }
}

TEST_CASE("the particle with the largest residual is the same on any number of ranks") {
  petsc();
  const Model model = random_box(kBoxes[1], kParticles, 2);
  RankedBox many(model, Ranks::world()), one(model, Ranks());
  const auto a = predicted_step(*one.backend, 1e-3), b = predicted_step(*many.backend, 1e-3);
  a->contact_force(), b->contact_force();
  CHECK(a->worst_particle() == b->worst_particle());
}

}  // namespace scree
