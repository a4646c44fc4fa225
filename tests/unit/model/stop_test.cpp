// Keys of stop conditions and of regions whose particles the history counts: what they become, and refusals.
#include <string>

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {
namespace {

std::string deck(int dimension, const std::string& more) {
  const std::string zero = dimension == 3 ? ", 0.0]\n" : "]\n", one = dimension == 3 ? ", 1.0]\n" : "]\n";
  return "[space]\ndimension = " + std::to_string(dimension) + "\nmin = [0.0, 0.0" + zero +
         "max = [1.0, 1.0" + one +
         "[time]\nend = 1.0\nstep = 1e-3\n[integrator]\nparticles = \"velocity-verlet\"\n" + more;
}
std::string stop(const std::string& keys) {
  return deck(2, "[[stop]]\ncolumn = \"energy/kinetic\"\n" + keys);
}
std::string region(int dimension, const std::string& keys) {
  return deck(dimension, "[[output.history_regions]]\nname = \"r\"\n" + keys);
}

}  // namespace

TEST_CASE("stop conditions of a deck") {
  const Model model =
      model_of(stop("below = 1e-3\nover = 0.5\nafter = 0.25\n[[stop]]\nname = \"level\"\ncolumn = "
                    "\"step/contacts\"\nwithin = 3.0\nover = 0.1\n"));
  REQUIRE(model.stop_conditions.size() == 2);
  const StopCondition &first = model.stop_conditions[0], &second = model.stop_conditions[1];
  CHECK((first.name == "0" && first.column == "energy/kinetic" && first.kind == StopKind::below));
  CHECK((first.bound == 1e-3 && first.over == 0.5 && first.after == 0.25));
  CHECK(
      (second.name == "level" && second.kind == StopKind::steady && second.bound == 3 && second.after == 0));
}

TEST_CASE("stop conditions that mean nothing are refused") {
  CHECK(contains(model_error(stop("")), "a condition needs one of the keys above, below and within"));
  CHECK(contains(model_error(stop("above = 1.0\nbelow = 2.0\n")),
                 "stop.0.below = 2.0: a condition has one of "));
  CHECK(contains(model_error(stop("within = 1.0\n")), "stop.0.over = 0.0: must be above 0 with within"));
  CHECK(contains(model_error(stop("within = -1.0\nover = 1.0\n")), "stop.0.within = -1.0: must be"));
  CHECK(contains(model_error(stop("above = 1.0\nover = -1.0\n")), "stop.0.over = -1.0: must be"));
  CHECK(contains(model_error(stop("above = inf\n")), "stop.0.above = inf: must be"));
  CHECK(contains(
      model_error(stop("above = 1.0\nname = \"a\"\n[[stop]]\nname = \"a\"\nabove = 1.0\ncolumn = \"b\"\n")),
      "repeated; names must be different"));
  CHECK(contains(model_error(deck(2, "[[stop]]\nabove = 1.0\n")), "stop.0.column: missing"));
}

TEST_CASE("regions of a deck") {
  const auto bounds = [](int dimension, const std::string& keys) {
    return model_of(region(dimension, keys)).output.history_regions.at(0).bounds;
  };
  CHECK(bounds(2, "kind = \"box\"\nmin = [0.0, 0.1]\nmax = [1.0, 0.2]\n").holds({1, 0.1, 0}));
  CHECK(!bounds(2, "kind = \"box\"\nmin = [0.0, 0.1]\nmax = [1.0, 0.2]\n").holds({0.5, 0.25, 0}));
  const RegionBounds circle = bounds(2, "kind = \"sphere\"\ncenter = [0.5, 0.5]\nradius = 0.25\n");
  CHECK((circle.holds({0.5, 0.75, 0}) && !circle.holds({0.7, 0.7, 0})));
  const RegionBounds pipe =
      bounds(3, "kind = \"cylinder\"\nends = [[0.0, 0.0, 0.0], [0.0, 0.0, 2.0]]\nradius = 0.5\n");
  CHECK((pipe.holds({0.5, 0, 2}) && pipe.holds({0.3, 0.3, 0})));
  CHECK((!pipe.holds({0, 0, 2.001}) && !pipe.holds({0, 0, -0.001}) && !pipe.holds({0.4, 0.4, 1})));
}

TEST_CASE("regions that do not exist are refused") {
  CHECK(contains(model_error(region(2, "kind = \"box\"\nmin = [0.0, 0.1]\nmax = [1.0, 0.1]\n")),
                 "history_regions.r.max = [1.0, 0.1]: must be larger than min"));
  CHECK(contains(model_error(region(
                     3, "kind = \"cylinder\"\nends = [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]\nradius = 0.5\n")),
                 "the two ends must differ"));
  CHECK(
      contains(model_error(region(2, "kind = \"cylinder\"\nends = [[0.0, 0.0], [0.0, 1.0]]\nradius = 0.5\n")),
               "a cylinder needs a domain of dimension 3"));
  CHECK(contains(model_error(region(2, "kind = \"sphere\"\ncenter = [0.0, 0.0]\nradius = 0.0\n")),
                 "radius = 0.0: must be"));
  const std::string circle = "kind = \"sphere\"\ncenter = [0.0, 0.0]\nradius = 1.0\n";
  CHECK(contains(model_error(region(2, circle + "[[output.history_regions]]\nname = \"r\"\n" + circle)),
                 "repeated; names must be different"));
  CHECK(contains(model_error(region(2, circle + "min = [0.0, 0.0]\n")), "min"));
}

}  // namespace scree
