// Groups of particles: positions, sizes, masses, velocities.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "model/derived/generators.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = kUlp;  // of positions up to 1 m [m]

std::string deck_3d(const std::string& particles) {
  return "[space]\ndimension = 3\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[time]\nend = 1.0\nstep = 1e-4\n"
         "control = \"fixed\"\n"
         "[[contact.pairs]]\nstiffness = 1e4\n" +
         particles;
}

std::string deck_2d(const std::string& particles) {
  return kSmallDeck + "[[contact.pairs]]\nstiffness = 1e4\n" + particles;
}

const std::string kRandom3d = R"([[particles]]
name = "spheres"
kind = "random"
count = 800
min = [0, 0, 0]
max = [1, 1, 1]
radius = { kind = "uniform", min = 0.02, max = 0.05 }
density = 1000.0
random_velocity = 0.5
seed = 5
)";

// Smallest distance between two surfaces [m].
Real smallest_gap(const ParticleSet& p) {
  Real gap = 1e30;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      gap = std::min(gap, norm(p.position[i] - p.position[j]) - p.radius[i] - p.radius[j]);
    }
  }
  return gap;
}

}  // namespace

TEST_CASE("a lattice fills row by row") {
  const ParticleSet p =
      model_of(deck_2d("[[particles]]\nkind = \"lattice\"\norigin = [-0.5, -0.5]\nspacing = [0.2, 0.3]\n"
                       "size = [4, 3]\ncount = 6\nradius = 0.05\nmass = 1.0\n"))
          .particles;
  REQUIRE(p.size() == 6);
  CHECK(near(p.position[3].x, 0.1, {.absolute = kRoundOff}));
  CHECK(p.position[3].y == -0.5);
  CHECK(near(p.position[5].x, -0.3, {.absolute = kRoundOff}));
  CHECK(near(p.position[5].y, -0.2, {.absolute = kRoundOff}));
  CHECK(p.position[5].z == 0);
}

TEST_CASE("a lattice in 3D, by its centre") {
  const ParticleSet p =
      model_of(deck_3d("[[particles]]\nkind = \"lattice\"\ncenter = [0.5, 0.5, 0.5]\n"
                       "spacing = [0.1, 0.2, 0.3]\nsize = [3, 2, 2]\nradius = 0.05\nmass = 1.0\n"))
          .particles;
  REQUIRE(p.size() == 12);
  Vec3 sum;
  for (const Vec3 x : p.position) sum += x;
  CHECK(norm((1.0 / 12) * sum - Vec3{0.5, 0.5, 0.5}) < 1e-14);
  CHECK(near(p.position[11].z, 0.65, {.absolute = kRoundOff}));
  CHECK(near(p.position[5].z, 0.35, {.absolute = kRoundOff}));
}

TEST_CASE("wrong lattices") {
  const std::string start =
      "[[particles]]\nname = \"l\"\nkind = \"lattice\"\nspacing = [0.1, 0.1]\nradius = 0.05\nmass = 1\n";
  CHECK(
      contains(model_error(deck_2d(start + "size = [2, 2]\n")), "exactly one of the keys origin and center"));
  CHECK(contains(model_error(deck_2d(start + "size = [2]\norigin = [0, 0]\n")),
                 "particles.l.size = [2]: must have 2 entries"));
  CHECK(contains(model_error(deck_2d(start + "size = [2, 2]\norigin = [0, 0]\ncount = 5\n")),
                 "particles.l.count = 5: must be at most 4, the number of lattice sites"));
}

TEST_CASE("a random packing keeps clear of everything and stays in its box") {
  const Model model = model_of(deck_3d(kRandom3d));
  const ParticleSet& p = model.particles;
  REQUIRE(p.size() == 800);
  CHECK(smallest_gap(p) >= 0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3 x = p.position[i];
    const Real r = p.radius[i];
    CHECK((r >= 0.02 && r <= 0.05));
    CHECK((x.x >= r && x.x <= 1 - r && x.y >= r && x.y <= 1 - r && x.z >= r && x.z <= 1 - r));
    CHECK(near(p.mass[i], 1000 * 4.0 / 3 * std::numbers::pi * r * r * r, {.relative = 4 * kUlp}));
    CHECK(std::abs(p.velocity[i].z) <= 0.5);
  }
}

TEST_CASE("random packing: same seed, same particles; other seed, others; a gap is kept") {
  const ParticleSet a = model_of(deck_3d(kRandom3d)).particles, b = model_of(deck_3d(kRandom3d)).particles;
  const ParticleSet c = model_of(deck_3d(kRandom3d), {"particles.spheres.seed=6"}).particles;
  CHECK(same_bits(a.position, b.position));
  CHECK(same_bits(a.velocity, b.velocity));
  CHECK(same_bits(a.radius, b.radius));
  CHECK_FALSE(same_bits(a.position, c.position));
  CHECK(smallest_gap(
            model_of(deck_3d(kRandom3d), {"particles.spheres.gap=0.004", "particles.spheres.count=300"})
                .particles) >= 0.004);
}

TEST_CASE("random packing keeps clear of bodies and of particles before it") {
  const std::string text = deck_2d(R"([[bodies]]
name = "b"
mass = 1.0
inertia = 1.0
position = [0.0, 0.0]
shapes = [{ radius = 0.4 }]
[[particles]]
kind = "list"
positions = [[0.7, 0.7]]
radius = 0.2
mass = 1.0
[[particles]]
name = "discs"
kind = "random"
count = 60
min = [-1, -1]
max = [1, 1]
radius = 0.05
mass = 1.0
)");
  const ParticleSet p = model_of(text).particles;
  CHECK(smallest_gap(p) >= 0);
  for (std::size_t i = 1; i < p.size(); ++i) CHECK(norm(p.position[i]) >= 0.45);
  const std::string message = model_error(text, {"particles.discs.count=260", "particles.discs.tries=100"});
  CHECK(contains(message, "--set particles.discs.count=260: only "));
  CHECK(contains(message, "particles found a position in 100 tries each"));
}

TEST_CASE("random groups without room are refused before a position is tried") {
  // Random tries would need 10^9 positions for the last of them.
  const auto error = [](const std::string& count, const std::string& radius) {
    return model_error(deck_3d(kRandom3d),
                       {"particles.spheres.count=" + count, "particles.spheres.radius=" + radius,
                        "particles.spheres.tries=1000000000"});
  };
  CHECK(contains(error("200000", "0.01"),
                 "--set particles.spheres.count=200000: the particles are 0.838 of the volume of their box "
                 "(min, max), and random insertion fills at most about 0.38 of it in 1000000000 tries each"));
  CHECK(contains(error("3000000", "{ kind = \"uniform\", min = 0.003, max = 0.006 }"),
                 "random insertion fills at most about 0."));
  CHECK(contains(error("2000000", "0.02"),
                 "the particles are 67 of the volume of their box (min, max), and random insertion fills at "
                 "most about 0.38 of it"));
  CHECK(contains(error("8", "0.3"),
                 "the particles are 0.905 of the volume of their box (min, max), and no packing "
                 "fills more than 0.74 of it; a larger box"));
}

TEST_CASE("random groups below the limit of random packing are placed") {
  // Reached with seed 1 to 3 and 10^4 tries each: 0.506 of the plane, 0.304 of space.
  const std::string discs =
      "[[particles]]\nname = \"d\"\nkind = \"random\"\ncount = 2400\nmin = [-1, -1]\nmax = [1, 1]\nradius = "
      "0.016\n"
      "mass = 1.0\n";
  CHECK(model_error(deck_2d(discs)).empty());  // 0.483
  CHECK(model_error(deck_3d(kRandom3d), {"particles.spheres.count=8000", "particles.spheres.radius=0.02"})
            .empty());
}

TEST_CASE("distributions") {
  const std::string row =
      "[[particles]]\nname = \"r\"\nkind = \"random\"\ncount = 4000\nmin = [-1, -1]\nmax = [1, 1]\n"
      "mass = 1.0\nradius = ";
  const auto radii = [&](const std::string& distribution) {
    return model_of(deck_2d(row + distribution + "\n")).particles.radius;
  };
  const auto mean = [](const std::vector<Real>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / v.size();
  };
  // Standard errors of the means: 0.0003 / sqrt(12 x 4000), 0.0002 / sqrt(4000); five of them are allowed.
  CHECK(near(mean(radii("{ kind = \"uniform\", min = 0.001, max = 0.002 }")), 0.0015, {.absolute = 2.3e-5}));
  const std::vector<Real> normal =
      radii("{ kind = \"normal\", mean = 0.002, sd = 0.0002, min = 0.0015, max = 0.0025 }");
  CHECK(near(mean(normal), 0.002, {.absolute = 1.6e-5}));
  CHECK((*std::min_element(normal.begin(), normal.end()) >= 0.0015 &&
         *std::max_element(normal.begin(), normal.end()) <= 0.0025));
  const std::vector<Real> table =
      radii("{ kind = \"table\", values = [0.001, 0.003], weights = [3.0, 1.0] }");
  const auto small = static_cast<Real>(std::count(table.begin(), table.end(), 0.001));
  CHECK(near(small / 4000, 0.75, {.absolute = 5 * std::sqrt(0.75 * 0.25 / 4000)}));
  CHECK(contains(input_error([&] { radii("{ kind = \"uniform\", min = 0.002, max = 0.001 }"); }),
                 "must be at least min = 0.002"));
  CHECK(contains(input_error([&] { radii("{ kind = \"table\", values = [0.001], weights = [1.0, 2.0] }"); }),
                 "must have 1 entries, as values"));
  CHECK(contains(
      input_error([&] { radii("{ kind = \"normal\", mean = 1.0, sd = 1e-3, min = 0.001, max = 0.002 }"); }),
      "of the distribution is from min to max = 0.002"));
}

TEST_CASE("masses: given, from density, from the material") {
  const std::string list =
      "[[particles]]\nname = \"p\"\nkind = \"list\"\npositions = [[0, 0]]\nradius = 0.1\n";
  const auto mass = [](const std::string& text) { return model_of(text).particles.mass[0]; };
  CHECK(mass(deck_2d(list + "mass = 2.0\n")) == 2);
  CHECK(near(mass(deck_2d(list + "density = 100.0\nthickness = 0.5\n")), 100 * 0.5 * std::numbers::pi * 0.01,
             {.relative = 4 * kUlp}));
  CHECK(near(mass(deck_2d("[[materials]]\nname = \"m\"\ndensity = 10.0\n" + list)),
             10 * std::numbers::pi * 0.01, {.relative = 4 * kUlp}));
  CHECK(contains(model_error(deck_2d(list)), "particles.p.mass: missing; the group needs mass or density"));
  CHECK(contains(model_error(deck_2d(list + "mass = 1.0\ndensity = 1.0\n")), "not used together with mass"));
}

TEST_CASE("groups are identified by the ids of their particles") {
  const std::string keys = "radius = 0.01\nmass = 1.0\n";
  const ParticleSet p =
      model_of(deck_2d("[[particles]]\nname = \"pair\"\nkind = \"list\"\npositions = [[0, 0], [0.1, 0]]\n" +
                       keys + "[[particles]]\nkind = \"list\"\npositions = []\n" + keys +
                       "[[particles]]\nkind = \"row\"\norigin = [0, 0.5]\nspacing = [0.1, 0]\ncount = 3\n" +
                       keys))
          .particles;
  REQUIRE(p.groups.size() == 3);
  CHECK((p.groups[0].name == "pair" && p.groups[1].name == "1" && p.groups[2].name == "2"));
  CHECK(groups_of(p, std::vector<GlobalId>{0, 1, 2, 4}) == std::vector<int>{0, 0, 2, 2});
  CHECK(groups_of(p, std::vector<GlobalId>{3}) == std::vector<int>{2});
}

}  // namespace scree
