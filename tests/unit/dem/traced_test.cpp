// Traced particles against the output of all particles.
#include <algorithm>
#include <map>

#include "random_box.hpp"

namespace scree {

TEST_CASE("traced particles are where the output of all particles has them") {
  for (const BoxCase& c : {kBoxes[0], kBoxes[4]}) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, 200, 5));
    for (Particle& record : box.records) record.position.x += 0.7;  // some move out of the periodic box
    box.backend->particles().load(box.records, {});
    const std::vector<GlobalId> wanted{199, 0, 7, 5000, 198, 3};  // one id does not exist
    std::map<GlobalId, TracedParticle> found;
    for (const TracedParticle& t : box.backend->reports().traced(wanted))
      CHECK(found.emplace(t.global_id, t).second);
    CHECK(found.size() == wanted.size() - 1);
    CHECK(!found.contains(5000));

    box.backend->list().build(0.02, box.timers);
    box.backend->particles().initial_forces();
    const BoxOutput output(*box.backend);
    for (std::size_t i = 0; i < output.all.global_id.size(); ++i) {
      const auto traced = found.find(output.all.global_id[i]);
      if (traced == found.end()) continue;
      CHECK(traced->second.position == output.all.position[i]);
      CHECK(traced->second.velocity == output.of<Vec3>("velocity")[i]);
    }
    CHECK(box.backend->reports().traced({}).empty());
  }
}

}  // namespace scree
