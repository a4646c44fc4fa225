// The memory needed by a model is compared with the free memory before it is built.
#include "model/checks/memory.hpp"

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

// Every rank of the host needs as much.
class SixteenRanks : public Share {
 public:
  int size() const override { return 16; }
  Real sum_on_host(Real value) const override { return 16 * value; }
};

}  // namespace

TEST_CASE("bodies and links are counted before they are built") {
  const std::string deck = kSmallDeck + R"([[bodies]]
name = "net"
count = 7
mass = 1.0
inertia = 1.0
position = [0.0, 0.0]
shapes = [{ radius = 0.1 }, { radius = 0.05, collides = false, count = 3, spacing = [0.1, 0.0] }, { radius = 0.1, offset = [0.1, 0.0], size = [5, 4], spacing = [0.1, 0.1], sides = ["y_min"] }]
[[bodies]]
name = "bob"
mass = 1.0
inertia = 1.0
position = [0.0, 0.5]
[[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "bob"]
[[spring_dampers]]
name = "cord"
chain = "net"
stiffness = 1.0
[[spring_dampers]]
name = "hanger"
each = "net"
local_points = [[0.0, 1.0], [0.0, 0.0]]
stiffness = 1.0
)";
  const ModelSize size = bodies_and_joints(parse_deck(deck, "deck.toml", {}).root);
  CHECK((size.bodies == 8 && size.shapes == 7 * (1 + 5) && size.drawn_shapes == 7 * 3));
  CHECK(size.links == 1 + 7 + 7);  // a chain of 7 counted as 7
}

TEST_CASE("snapshots take memory, and existing objects are not counted again") {
  const std::string deck = R"([space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
[time]
end = 1.0
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 1e4
[[meshes]]
name = "ball"
kind = "sphere"
radius = 0.1
[[bodies]]
name = "carrier"
kind = "spatial"
position = [0, 0, 0]
mass = 1.0
inertia_tensor = [1, 1, 1, 0, 0, 0]
meshes = [{ mesh = "ball" }]
[[walls]]
name = "fixed"
mesh = "ball"
)";
  const Model model = model_of(deck), with_lines = model_of(deck, {"output.contacts=true"});
  const Real triangles = 20 * 64;
  CHECK(shown_meshes(model).triangles == 2 * triangles);
  CHECK(shown_meshes(model).points == 2 * (triangles / 2 + 2));
  CHECK(bytes_of_meshes(model, false) == kBytesPerTriangle * triangles);
  CHECK(bytes_of_meshes(model, true) == (kBytesPerStoredTriangle + 2 * kBytesPerShownTriangle) * triangles);
  CHECK(bytes_of_model(model) == kBytesPerTriangle * triangles);
  CHECK(bytes_per_particle(with_lines) - bytes_per_particle(model) == kLinesPerParticle * kBytesPerLine);
}

TEST_CASE("a model that fits, and one that does not") {
  const ModelSize size{1000000, 0, 0};
  const auto error = [&](Real bytes, const Share& share) {
    return input_error([&] { check_memory(size, bytes, "building it", share); });
  };
  CHECK(error(1e6, Share()).empty());
  CHECK(contains(error(1e18, Share()), "not enough memory: building it takes about 1e+09 GB, "));
  CHECK(contains(error(1e18, Share()),
                 " GB are free (MemAvailable of /proc/meminfo); a run of 1000000 particles "
                 "takes at least 0.96 GB on one rank; start more ranks"));
  CHECK(
      contains(error(1e17, SixteenRanks()), "building it takes about 1.6e+09 GB for the ranks of a host, "));
}

TEST_CASE("a deck too large for any machine is refused at once") {
  CHECK(contains(model_error(kSmallDeck +
                             "[[contact.pairs]]\nstiffness = 1.0\n[[particles]]\nkind = \"lattice\"\n"
                             "origin = [0, 0]\nspacing = [1e-9, 1e-9]\nsize = [100000, 10000]\n"
                             "radius = 1e-10\nmass = 1.0\n" +
                             [] {
                               std::string groups;  // 10^9 each
                               for (int i = 0; i < 99; ++i)
                                 groups +=
                                     "[[particles]]\nkind = \"row\"\ncount = 1000000000\norigin = [0, 0]\n"
                                     "spacing = [1e-9, 0]\nradius = 1e-10\nmass = 1.0\n";
                               return groups;
                             }()),
                 "a run of 100000000000 particles takes at least 9.6e+04 GB on one rank"));
  CHECK(contains(model_error(kSmallDeck +
                             [] {
                               std::string rows;
                               for (int i = 0; i < 200; ++i)
                                 rows +=
                                     "[[bodies]]\nname = \"r" + std::to_string(i) +
                                     "\"\ncount = 10000000\nmass = 1.0\ninertia = 1.0\nposition = [0, 0]\n";
                               return rows;
                             }()),
                 "a run of 2000000000 bodies takes at least 6e+03 GB on one rank; take fewer bodies"));
}

TEST_CASE("a body outside the space is named before any is built") {
  CHECK(contains(model_error(kSmallDeck + "[[bodies]]\nname = \"r\"\ncount = 10000000\nspacing = [3e-7, 0]\n"
                                          "mass = 1.0\ninertia = 1.0\nposition = [-1, 0]\n"
                                          "shapes = [{ radius = 1e-8 }]\n"),
                 "body \"r.6666667\" starts at (1.00000"));
}

}  // namespace scree
