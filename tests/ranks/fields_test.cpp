// Every field of the table migrates with its particle.
#include "support/catch.hpp"
#include "support/particle_bits.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

TEST_CASE("every field goes with a particle to another rank") {
  const Ranks ranks = Ranks::world();
  for (const bool rotates : {false, true})
    for (const BoxCase& c : kBoxes) {
      CAPTURE(c.name, rotates);
      Model model = random_box(c, 150, 21);
      if (rotates) model.contact.friction.assign(model.contact.laws.size(), {1e3, 0.5, 0});
      const std::vector<Particle> all = filled_records(model);
      const IdRange own = id_range(std::ssize(all), ranks.rank(), ranks.size());
      const std::unique_ptr<Backend> backend = make_test_backend(model, ranks);
      backend->particles().load({all.begin() + own.first, all.begin() + own.last}, {});
      StageTimers timers;
      backend->list().set_body_motion(motion_of(model.bodies));
      backend->list().build(0.15, timers);
      std::vector<Particle> found = ranks.all_gather(backend->particles().records());
      std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.global_id < b.global_id; });
      CHECK(differing_fields(found, all) == "");
      CHECK((ranks.sum(backend->list().balance().migrated) > 0) == !ranks.alone());
    }
}

}  // namespace scree
