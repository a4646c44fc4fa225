// A model built by several ranks is that of a single rank, in parts.
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "partition/shared_model.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/petsc_run.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

namespace {

Ranks world() {
  petsc();
  return Ranks::world();
}

Model built(const std::string& text, const std::vector<std::string>& overrides, const Share& share,
            std::vector<std::string>& warnings) {
  Log log(true);
  Model model = build_model(parse_deck(text, "deck.toml", overrides), log, share);
  warnings = log.warnings();
  return model;
}

std::string failure(const std::string& text, const std::vector<std::string>& overrides, const Share& share) {
  return input_error([&] {
    std::vector<std::string> unused;
    built(text, overrides, share, unused);
  });
}

// Every kind of group, with every random quantity.
const std::string kGroups = R"(
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [4.0, 3.0, 3.0]
x_min = "periodic"
x_max = "periodic"
z_min = "wall"
[time]
end = 1.0
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
[[bodies]]
name = "pad"
position = [2.0, 2.6, 1.0]
mass = 1.0
inertia = 1.0
shapes = [{ radius = 0.1 }]
[[particles]]
name = "lattice"
kind = "lattice"
origin = [0.1, 0.1, 0.1]
spacing = [0.15, 0.15, 0.15]
size = [5, 4, 3]
count = 53
radius = { kind = "uniform", min = 0.04, max = 0.06 }
density = { kind = "normal", mean = 1000.0, sd = 100.0, min = 500.0, max = 1500.0 }
random_velocity = 0.5
[[particles]]
kind = "list"
positions = [[0.1, 2.0, 1.0], [3.97, 2.5, 0.5], [1.0, 2.5, 1.0], [2.0, 2.5, 2.0]]
radius = 0.05
mass = { kind = "table", values = [1.0, 2.0, 3.0] }
[[particles]]
name = "packing"
kind = "random"
count = 40
min = [1.0, 0.0, 0.0]
max = [3.0, 1.0, 1.0]
radius = { kind = "table", values = [0.05, 0.1] }
mass = 1.0
random_velocity = 1.0
[[particles]]
kind = "row"
count = 7
origin = [0.1, 1.5, 2.5]
spacing = [0.2, 0.0, 0.0]
radius = 0.05
mass = 2.0
[[particles]]
name = "csv"
kind = "file"
file = "FOLDER/p.csv"
mass = 3.0
)";

class GroupsDeck {
 public:
  explicit GroupsDeck(const Ranks& ranks) : text_(kGroups) {
    const std::string csv = folder_ / "p.csv";  // each rank has its own file
    std::ofstream(csv) << "x,y,z,radius\n3.5,2.0,1.0,0.1\n3.5,2.3,1.0,0.1\n# none\n3.5,2.6,1.0,0.2\n";
    text_.replace(text_.find("FOLDER"), 6, folder_.path());
    ranks.any(false);
  }
  const std::string& text() const { return text_; }

 private:
  ScratchDirectory folder_;
  std::string text_;
};

}  // namespace

TEST_CASE("the ranks' parts of a model are the whole model") {
  const Ranks ranks = world();
  const RankShare share(ranks);
  const GroupsDeck deck(ranks);
  std::vector<std::string> alone_warnings, warnings;
  const Model alone = built(deck.text(), {}, Share(), alone_warnings);
  const Model model = built(deck.text(), {}, share, warnings);
  const ParticleSet &whole = alone.particles, &part = model.particles;
  REQUIRE(whole.size() == 107);
  const IdRange own = id_range(107, ranks.rank(), ranks.size());
  CHECK((part.first_id == own.first && std::ssize(part.position) == own.size()));
  std::size_t same = 0;
  for (std::size_t k = 0; k < part.size(); ++k) {
    const auto i = static_cast<std::size_t>(own.first) + k;
    same += part.position[k] == whole.position[i] && part.velocity[k] == whole.velocity[i] &&
            part.radius[k] == whole.radius[i] && part.mass[k] == whole.mass[i] &&
            part.material[k] == whole.material[i];
  }
  CHECK(same == part.size());
  const ParticleTotals &a = whole.totals, &b = part.totals;
  CHECK((b.count == 107 && b.smallest_radius == a.smallest_radius && b.largest_radius == a.largest_radius));
  CHECK((b.smallest_mass == a.smallest_mass && b.largest_mass == a.largest_mass && b.largest_radius == 0.2));
  REQUIRE(b.materials.size() == 1);
  CHECK((b.materials[0].count == 107 && b.materials[0].smallest_mass == a.smallest_mass));
  CHECK(b.materials[0].smallest_inertia_factor == a.materials[0].smallest_inertia_factor);
  CHECK(model.contact.skin == alone.contact.skin);
  CHECK(warnings == alone_warnings);
}

TEST_CASE("ranks fill a region with the same positions, and refuse it with the same message") {
  const Ranks ranks = world();
  const RankShare share(ranks);
  const GroupsDeck deck(ranks);
  const std::vector<std::string> region{"particles.packing.cylinder_radius=0.5",
                                        "particles.packing.ends=[[1.2, 0.5, 0.5], [2.8, 0.5, 0.5]]"};
  std::vector<std::string> warnings;
  const ParticleSet whole = built(deck.text(), region, Share(), warnings).particles,
                    part = built(deck.text(), region, share, warnings).particles;
  for (std::size_t k = 0; k < part.size(); ++k)
    CHECK(part.position[k] == whole.position[static_cast<std::size_t>(part.first_id) + k]);
  const std::vector<std::string> full{region[0], region[1], "particles.packing.count=400"};
  CHECK(failure(deck.text(), full, share) == failure(deck.text(), full, Share()));
  CHECK(failure(deck.text(), full, share).find("region (min, max, cylinder_radius)") != std::string::npos);
}

TEST_CASE("overlaps at the start are found whichever ranks have the two, and named the same") {
  const Ranks ranks = world();
  const RankShare share(ranks);
  const GroupsDeck deck(ranks);
  struct Wrong {
    std::string override, message;
  };
  const std::vector<Wrong> wrong = {
      {"particles.lattice.spacing=[0.08, 0.15, 0.15]", "and particle"},  // neighbours, on the first ranks
      {"particles.lattice.origin=[0.03, 2.5, 0.5]",
       "and particle"},  // with a partner across the periodic sides
      {"particles.lattice.origin=[8.03, 2.5, 0.5]", "and particle"},  // two periods away
      {"particles.lattice.origin=[-16.0, 2.5, 0.5]", "and particle"},
      {"particles.lattice.origin=[0.1, 0.1, 0.02]", "wall \"z_min\" overlap"},
      {"particles.lattice.origin=[0.1, 0.1, -0.02]", "particle 0 starts at"},
      {"particles.csv.velocity=[0, 0]", "must be 3 numbers"},
      {"bodies.pad.position=[3.5, 2.1, 1.0]", "and body \"pad\" overlap"},
      {"particles.packing.count=4000", "of the volume of their box"},
      {"particles.csv.radius=0.1", "the file has a column radius"},
  };
  for (const Wrong& one : wrong) {
    CAPTURE(one.override);
    const std::string alone = failure(deck.text(), {one.override}, Share());
    CAPTURE(alone);
    CHECK(contains(alone, one.message));
    CHECK(failure(deck.text(), {one.override}, share) == alone);
  }
}

TEST_CASE("a value in a file that only one rank reads ends all with its message") {
  const Ranks ranks = world();
  const ScratchDirectory folder;
  {
    std::ofstream file(folder / "p.csv");
    file << "x,y,radius\n";
    for (int i = 0; i < 40; ++i) file << 0.02 * i << ",0.5," << (i == 37 ? "-1" : "0.005") << '\n';
  }
  const std::string text = kSmallDeck +
                           "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nkind = \"file\"\n" +
                           "mass = 1.0\nfile = \"" + (folder / "p.csv") + "\"\n";
  CHECK(contains(failure(text, {}, RankShare(ranks)), "p.csv:39: column radius = -1: must be a positive"));
}

}  // namespace scree
