// Births of inserters: how many are due at which instants, and the totals that inserters declare.
#include "run/population/births.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "dem/cpu/cpu_backend.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kDeck = R"(
gravity = [0, 0, -10]
[space]
dimension = 3
min = [0, 0, 0]
max = [1, 1, 1]
[time]
end = 1.0
step = 1e-4
[[contact.pairs]]
stiffness = 1e4
[[particles]]
name = "old"
kind = "list"
positions = [[0.1, 0.1, 0.1], [0.9, 0.9, 0.1]]
radius = 0.05
density = 1000
[[inserters]]
name = "rain"
kind = "box"
min = [0, 0, 0.5]
max = [1, 1, 1]
number_rate = 100
interval = 0.1
start = 0.05
radius = { kind = "uniform", min = 0.01, max = 0.02 }
density = 2000
velocity = [0, 0, -3]
[[inserters]]
name = "ball"
kind = "sphere"
center = [0.5, 0.5, 0.3]
region_radius = 0.1
number = 7
radius = 0.005
mass = 0.001
)";

struct Case {
  explicit Case(const std::vector<std::string>& overrides = {}) : model(model_of(kDeck, overrides)) {}
  // In the order of the ids.
  std::vector<Particle> at(Real t) {
    std::vector<Particle> born = births.births_at(t, {}, backend.particles(), state);
    std::ranges::sort(born, {}, &Particle::global_id);
    return born;
  }

  Model model;
  CpuBackend backend{model};
  Births births{model};
  PopulationState state = births.start();
};

}  // namespace

TEST_CASE("births come at the instants of their inserters") {
  Case run;
  CHECK(run.births.next(run.state) <= 0);
  const std::vector<Particle> first = run.at(0);
  REQUIRE(first.size() == 7);
  for (std::size_t n = 0; n < first.size(); ++n) {
    CHECK(first[n].global_id == static_cast<GlobalId>(2 + 2 * n + 1));
    CHECK(norm(first[n].position - Vec3{0.5, 0.5, 0.3}) <= 0.095);
  }
  CHECK(run.at(0).empty());
  CHECK(near(run.births.next(run.state), 0.15, {.relative = 1e-8}));
  CHECK(run.at(0.1499).empty());
  CHECK(run.at(0.15).size() == 10);
  CHECK(run.at(0.16).empty());
  CHECK(run.at(0.36).size() == 20);  // those due at 0.35
  CHECK(run.state.due == std::vector<std::int64_t>{30, 7});
  CHECK((run.state.born_of(0) == 30 && run.state.born_of(1) == 7 && run.state.born() == 37));
}

TEST_CASE("a born particle has the properties of its inserter, wherever steps ended before") {
  Case one, other;
  one.at(0), other.at(0);
  std::vector<Particle> of_one = one.at(0.15);
  const std::vector<Particle> more = one.at(0.25), of_other = other.at(0.251);
  of_one.insert(of_one.end(), more.begin(), more.end());
  REQUIRE((of_one.size() == 20 && of_other.size() == 20));
  for (std::size_t n = 0; n < of_one.size(); ++n) {
    const Particle &p = of_one[n], &q = of_other[n];
    CHECK((p.global_id == q.global_id && p.radius == q.radius && p.mass == q.mass));
    CHECK((p.radius >= 0.01 && p.radius <= 0.02));
    CHECK(near(p.mass, sphere_mass(p.radius, 2000), {.relative = 1e-14}));
    CHECK((p.velocity == Vec3{0, 0, -3} && p.position.z >= 0.5 + p.radius));
  }
}

TEST_CASE("an error in the births leaves the state as it was") {
  Case run({"inserters.ball.region_radius=0.011", "inserters.ball.number=2", "inserters.ball.most_waiting=0",
            "inserters.ball.start=0.15"});
  const PopulationState before = run.state;
  CHECK_THROWS_AS(run.at(0.15), SimulationError);
  CHECK(
      (run.state.due == before.due && run.state.waiting == before.waiting && run.state.mass == before.mass));
}

TEST_CASE("a particle that waits is born before the later ones, as the same particle") {
  Case run({"inserters.ball.region_radius=0.011", "inserters.ball.number=2"});
  const std::size_t first = run.at(0).size();
  REQUIRE(first == 1);
  CHECK(run.state.waiting == std::vector<std::int64_t>{1, 1, 0});
  CHECK(run.births.next(run.state) > 0);
  const std::vector<Particle> later = run.at(run.births.next(run.state));  // the first one has left
  REQUIRE(later.size() == 1);
  CHECK(later.front().global_id == run.model.particles.id_of_birth(1, 1));
  CHECK(run.state.waiting.empty());
}

TEST_CASE("inserters widen the totals of the model") {
  const ParticleTotals totals = model_of(kDeck).particles.totals;
  CHECK((totals.at_start == 2 && totals.count == 2 + 95 + 7));
  CHECK((totals.smallest_radius == 0.005 && totals.largest_radius == 0.05));
  CHECK(totals.smallest_mass == 0.001);
  CHECK(near(totals.largest_density, 2000, {.relative = 1e-14}));
  CHECK(near(totals.most_radii_per_second, 3 / 0.01, {.relative = 1e-14}));
  CHECK((totals.lowest == Vec3{0, 0, 0.1} && totals.highest == Vec3{1, 1, 1}));
  CHECK((totals.materials.front().count == 104 && totals.materials.front().smallest_mass == 0.001));
}

TEST_CASE("inserters are groups, and their ids alternate") {
  const ParticleSet particles = model_of(kDeck).particles;
  REQUIRE(particles.groups.size() == 3);
  CHECK((particles.groups[1].name == "rain" && particles.groups[2].name == "ball"));
  const std::vector<GlobalId> ids = {0, 1, 2, 3, 4, 5, 102, 103};
  CHECK(groups_of(particles, ids) == std::vector<int>{0, 0, 1, 2, 1, 2, 1, 2});
  CHECK((particles.id_of_birth(0, 0) == 2 && particles.id_of_birth(1, 50) == 103));
}

}  // namespace scree
