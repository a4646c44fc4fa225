// Every field of the table moves with its particle on one rank.
#include <algorithm>
#include <set>

#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/particle_bits.hpp"

namespace scree {

namespace {

std::vector<Particle> filled_particles(GlobalId count) {
  std::vector<Particle> particles(static_cast<std::size_t>(count));
  for (GlobalId id = 0; id < count; ++id) {
    particles[static_cast<std::size_t>(id)].global_id = id;
    fill_fields(particles[static_cast<std::size_t>(id)], id);
  }
  return particles;
}

}  // namespace

TEST_CASE("the comparer of particles sees a change of any number of any field, the sign of a zero, too") {
  const Particle before = filled_particles(3)[2];
  std::size_t fields = 0;
  std::set<std::string> names;
  for_each_field([&](const ParticleField& field, auto member) {
    CAPTURE(field.name);
    for (std::size_t k = 0; k < numbers_of(before.*member).size(); ++k) {
      Particle after = before;
      auto numbers = numbers_of(before.*member);
      numbers[k] += 1;
      set_value(after.*member, numbers.data());
      CHECK(differing_fields(before, after) == std::string(field.name) + " ");
    }
    ++fields, names.insert(field.name);
    CHECK(std::string(field.unit) != "");
    CHECK(std::string(field.description) != "");
  });
  CHECK(fields >= 12);
  CHECK(names.size() == fields);
  Particle positive, negative;
  positive.velocity.y = 0.0, negative.velocity.y = -0.0;
  CHECK(differing_fields(positive, negative) == "velocity ");
  CHECK(differing_fields({before}, {before, before}) == "1 and 2 particles");
}

TEST_CASE("every field goes into the store, through its order, and out") {
  const std::vector<Particle> all = filled_particles(9);
  ParticleStore store;
  store.rotates = store.rolls = true;
  store.load(std::span(all).first(6));
  CHECK(differing_fields(store.records(), {all.begin(), all.begin() + 6}) == "");
  store.resize_items(11);  // ghosts and shapes are dropped by the next sort
  store.reorder({5, 0, 4, 2});
  CHECK(store.owned == 4);
  for (const std::size_t id : {7, 3}) store.add(all[id]);
  CHECK(differing_fields(store.records(), {all[0], all[2], all[3], all[4], all[5], all[7]}) == "");
  const Index order[] = {5, 0, 4, 2, 7, 3};
  for (Index i = 0; i < store.owned; ++i)
    CHECK(differing_fields(particle_at(store, i), all[static_cast<std::size_t>(order[i])]) == "");
  for_each_array<kAllArrays | kOptionalArrays>([](const auto& array) { CHECK(array.size() == 6); }, store);
}

TEST_CASE("every field goes into the backend, through its cells, and out") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    Model model = random_box(c, 60, 21);
    model.integrator.particles = ParticleIntegrator::velocity_verlet;
    const std::vector<Particle> records = filled_records(model);
    const std::unique_ptr<Backend> backend = make_test_backend(model, {});
    backend->particles().load(records, {});
    CHECK(differing_fields(backend->particles().records(), records) == "");
    StageTimers timers;
    backend->list().set_body_motion(motion_of(model.bodies));
    for (const Real skin : {0.1, 0.3}) backend->list().build(skin, timers);
    CHECK(differing_fields(backend->particles().records(), records) == "");
  }
}

}  // namespace scree
