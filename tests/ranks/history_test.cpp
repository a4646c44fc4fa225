// What contacts remember, on all ranks against one rank alone: with particles that change their rank, and
// from a checkpoint of any number of ranks to any other. (One rank against brute force: unit/dem.)
#include <filesystem>

#include "output/checkpoint.hpp"
#include "run/restart.hpp"
#include "support/catch.hpp"
#include "support/contact_book.hpp"
#include "support/particle_bits.hpp"
#include "support/petsc_run.hpp"
#include "support/remembering_backend.hpp"
#include "support/shared_folder.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

namespace {

constexpr int kNumbers = 7;
constexpr Real kStep = 5e-4, kSkin = 0.05;

struct RememberingBox {
  RememberingBox(const Model& of, const Ranks& on)
      : ranks(on),
        model(of),
        motion(motion_of(of.bodies)),
        backend(make_remembering_backend<kNumbers>(model, on)) {}

  // state: of this rank's share of the ids.
  void start(const State& state) {
    backend->particles().load(state.particles, {});
    backend->particles().load_contacts(state.contacts);
    backend->list().place_bodies(motion);
    backend->list().build(kSkin, timers);
  }
  void start() {
    const std::vector<Particle> all = initial_records(model.particles, Subdomain(model.space));
    const IdRange own = id_range(std::ssize(all), ranks.rank(), ranks.size());
    State state;
    state.particles = {all.begin() + own.first, all.begin() + own.last};
    start(state);
    backend->particles().initial_forces();
  }
  // A run of so many steps; then the particles outside leave.
  void take_steps(Index steps) {
    const std::unique_ptr<ExplicitRun> run = backend->start_run(kStep);
    while (steps > 0) {
      backend->list().place_bodies(motion);
      const Index most = motion.empty() ? steps : 1;
      const StepsTaken taken = run->take_steps(most, most < steps, timers);
      steps -= taken.closed;
      for (BodyMotion& body : motion) body.position += kStep * body.velocity;
      if (!taken.open) break;
    }
    const std::vector<Leaver> leavers = backend->particles().outside();
    if (!leavers.empty()) backend->particles().take_out(leavers), backend->list().build(kSkin, timers);
  }
  // Of this rank, and in the order of the ids.
  State state() const {
    State state;
    state.particles = backend->particles().records();
    state.contacts = backend->particles().contacts();
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

Model moving_box(const BoxCase& c, Leaving leaving) {
  Model model = random_box(c, 150, 21);
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.contact.skin = kSkin;
  model.parallel.imbalance = 0;  // boxes are cut anew with every list
  model.space.leaving = leaving;
  for (KelvinVoigt& law : model.contact.laws) law.exponent = 1;
  return model;
}

// The state of all ranks, on each.
State of_all(const RememberingBox& box) {
  const State own = box.in_id_order();
  State all;
  all.particles = box.ranks.gather_everywhere(own.particles);
  all.contacts.numbers = own.contacts.numbers;
  all.contacts.set_counts(box.ranks.gather_everywhere(own.contacts.counts()));
  all.contacts.keys = box.ranks.gather_everywhere(own.contacts.keys);
  all.contacts.values = box.ranks.gather_everywhere(own.contacts.values);
  return all;
}

void check_equal(const RememberingBox& one, const RememberingBox& many) {
  const State a = of_all(one), b = of_all(many);
  CHECK(differing_fields(a.particles, b.particles) == "");
  CHECK(difference(a.contacts, b.contacts) == "");
  CHECK(a.contacts.keys.size() > 5);
  CHECK(one.hash() == many.hash());
}

}  // namespace

TEST_CASE("contacts remember over ranks, lists and cuts what they do on one rank") {
  petsc();
  for (const BoxCase& c : kBoxes)
    for (const Leaving leaving : {Leaving::drift, Leaving::remove}) {
      CAPTURE(c.name, static_cast<int>(leaving));
      const Model model = moving_box(c, leaving);
      RememberingBox many(model, Ranks::world()), one(model, Ranks());
      for (RememberingBox* box : {&many, &one}) box->start();
      const auto migrated = [&] { return many.ranks.sum(many.backend->list().balance().migrated); };
      const std::int64_t at_start = migrated();
      for (int part = 0; part < 20; ++part) {
        for (RememberingBox* box : {&many, &one}) box->take_steps(1 + 2 * part);
        check_equal(one, many);
      }
      CHECK((migrated() > at_start + 5) == !many.ranks.alone());
      CHECK(many.backend->list().builds() > 5);
    }
}

TEST_CASE("what contacts remember goes through a checkpoint to any number of ranks") {
  petsc();
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    const Model model = moving_box(c, Leaving::remove);
    const Ranks world = Ranks::world();
    RememberingBox many(model, world), one(model, Ranks());
    for (RememberingBox* box : {&many, &one}) box->start(), box->take_steps(100), box->take_steps(77);
    const SharedFolder folder(world);
    const State of_many = many.in_id_order(), of_one = one.in_id_order();
    write_checkpoint(folder / "many.h5", pack(of_many), world);
    world.on_root([&] { write_checkpoint(folder / "one.h5", pack(of_one)); });
    for (const char* name : {"many.h5", "one.h5"}) {
      CAPTURE(name);
      RememberingBox again(model, world), again_alone(model, Ranks());
      again.motion = again_alone.motion = many.motion;
      again.start(unpack(read_checkpoint(folder / name, world), world));
      again_alone.start(unpack(read_checkpoint(folder / name)));
      check_equal(one, again), check_equal(one, again_alone);
      RememberingBox onward(model, Ranks());
      onward.motion = one.motion, onward.start(of_one);
      for (RememberingBox* box : {&again, &again_alone, &onward}) box->take_steps(60);
      check_equal(onward, again), check_equal(onward, again_alone);
    }
  }
}

}  // namespace scree
