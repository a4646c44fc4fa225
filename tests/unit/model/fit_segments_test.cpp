// Default segments of round meshes where the deck does not give them.
#include "model/builder/fit_segments.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "mesh/surface_mesh.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kSpace = R"([space]
dimension = 3
min = [-2, -2, -2]
max = [2, 2, 2]
[time]
end = 1.0
step = 1e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
[[walls]]
name = "w"
mesh = "m"
)";

std::string mesh(const std::string& keys) { return "[[meshes]]\nname = \"m\"\n" + keys + "\n"; }

std::string grains(const std::string& radius) {
  return "[[particles]]\nname = \"g\"\nkind = \"list\"\npositions = [[0, 0, 1.5]]\nmass = 0.1\nradius = " +
         radius + "\n";
}

const std::string kRod = mesh("kind = \"cylinder\"\nradius = 1.0\nlength = 0.5");

std::int64_t segments(const std::string& deck, const std::string& key = "segments") {
  return with_fitting_segments(parse_deck(deck, "deck.toml", {})).root.tables("meshes")[0].integer(key);
}

}  // namespace

TEST_CASE("segments that are left out follow the smallest particle") {
  CHECK(segments(kSpace + kRod) == 48);
  CHECK(segments(kSpace + kRod + grains("0.1")) == 32);
  CHECK(segments(kSpace + kRod + grains("0.02")) == 72);
  CHECK(segments(kSpace + kRod + grains("0.5")) == 16);
  // The smallest radius that may be drawn, of any group.
  CHECK(segments(kSpace + kRod + grains("{ kind = \"uniform\", min = 0.02, max = 0.3 }")) == 72);
  CHECK(segments(kSpace + kRod + grains("0.3") +
                 "[[particles]]\nkind = \"list\"\npositions = [[1, 0, 1.5]]\nmass = 0.1\nradius = 0.02\n") ==
        72);
  // Segments given in the deck are used.
  CHECK(segments(kSpace + mesh("kind = \"cylinder\"\nradius = 1.0\nlength = 0.5\nsegments = 7") +
                 grains("0.02")) == 7);
  CHECK(segments(kSpace + mesh("kind = \"sphere\"\nradius = 1.0"), "levels") == 3);
  CHECK(segments(kSpace + mesh("kind = \"sphere\"\nradius = 1.0") + grains("0.4"), "levels") == 2);
  CHECK(segments(kSpace + mesh("kind = \"sphere\"\nradius = 1.0") + grains("0.02"), "levels") == 5);
}

TEST_CASE("the mesh has the segments of the resolved deck, and reports its facets' deviation") {
  const std::string deck = kSpace + kRod + grains("0.02");
  const ModelMesh made = model_of(deck).meshes.front();
  CHECK(made.is_fitted);
  CHECK(made.fitting == "segments = 72");
  CHECK(made.surface->triangles.size() == 4 * 72);
  CHECK(made.deviation_is_exact);
  CHECK(made.deviation == Approx(1 - std::cos(std::numbers::pi / 72)).epsilon(kAccumulatedRoundOff));
  const Deck whole = with_fitting_segments(parse_deck(deck, "deck.toml", {}));
  CHECK(contains(whole.resolved_text(), "segments = 72\n"));
  const Deck again = parse_deck(whole.resolved_text(), "again.toml", {});
  CHECK(again.fingerprint() == whole.fingerprint());
  CHECK(with_fitting_segments(again).fingerprint() == whole.fingerprint());
  CHECK_FALSE(model_of(whole.resolved_text()).meshes.front().is_fitted);
  // Nothing is fitted without particles, or where the deck gives the number.
  CHECK(model_of(kSpace + kRod).meshes.front().fitting.empty());
  CHECK(model_of(kSpace + kRod).meshes.front().surface->triangles.size() == 4 * 48);
  CHECK(model_of(deck, {"meshes.m.segments=8"}).meshes.front().deviation ==
        Approx(1 - std::cos(std::numbers::pi / 8)).epsilon(kAccumulatedRoundOff));
}

}  // namespace scree
