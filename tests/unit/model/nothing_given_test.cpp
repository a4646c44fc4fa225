// Keys of 0 that mean nothing are equivalent to absent keys, in implicit steps, too; velocities across
// planes.
#include <fmt/format.h>

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

std::string deck_of(const std::string& pair, const std::string& more = "", bool hertz = false,
                    bool implicit = true) {
  return std::string(
             "[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = 1.0\nstep = "
             "1e-6\n") +
         fmt::format("[integrator]\nparticles = \"{}\"\n", implicit ? "hht" : "velocity-verlet") +
         "[[particles]]\nkind = \"row\"\ncount = 2\norigin = [0, 0, 0]\nspacing = [0.5, 0, 0]\nradius = "
         "0.02\nmass = "
         "0.1\n" +
         (hertz ? "[[materials]]\nname = \"soft\"\nyoung_modulus = 1e7\npoisson_ratio = 0.3\n" : "") +
         "[[contact.pairs]]\n" + (hertz ? "" : "stiffness = 1e5\n") + pair + more;
}

bool is_plain(const Model& model) {
  const NormalLawParameters& law = model.contact.law(0, 0);
  return !model.rolls() && !model.is_cohesive() && !law.jkr && law.adhesion_work == 0 &&
         law.attraction == 0 && law.range == 0 && model.contact.interaction_range == 0;
}

}  // namespace

TEST_CASE("keys of 0 are as if they were left out") {
  for (const bool implicit : {true, false})
    for (const bool hertz : {true, false})
      for (const char* key :
           {"rolling_friction = 0.0", "rolling_friction = 0.0\nrolling_damping_ratio = 0.3",
            "rolling_friction = 0.0\nrolling_stiffness = 2.0", "rolling_damping = 0.0",
            "twisting_friction = 0.0", "attraction = 0.0", "attraction = 0.0\nattraction_range = 0.1",
            "work_of_adhesion = 0.0", "work_of_adhesion = 0.0\nadhesion = \"jkr\"", "surface_energy = 0.0",
            "rolling_friction = 0.0\nrolling_damping = 0.0\ntwisting_friction = 0.0\nattraction = "
            "0.0\nsurface_energy = 0.0\nadhesion = \"dmt\""}) {
        CAPTURE(implicit, hertz, key);
        for (const char* friction : {"", "friction = 0.5\n"}) {
          const Model model = model_of(deck_of(fmt::format("{}\n{}", key, friction), "", hertz, implicit));
          CHECK(is_plain(model));
          CHECK(model.rotates() == (std::string(friction) != ""));
        }
      }
}

TEST_CASE("unsupported laws are refused in implicit steps whatever keys beside them are 0") {
  const auto refused = [](const std::string& pair, bool hertz = false) {
    return model_error(deck_of(pair, "", hertz));
  };
  const std::string needs = "needs integrator.particles = \"velocity-verlet\"";
  CHECK(contains(refused("attraction = 0.0\nwork_of_adhesion = 0.5\n", true), needs));
  CHECK(contains(refused("attraction = 0.5\nwork_of_adhesion = 0.0\nattraction_range = 0.1\n", true), needs));
  CHECK(contains(refused("rolling_friction = 0.1\n"), "needs friction"));
}

TEST_CASE("of a plane the surface runs along itself") {
  const auto wall = [](const char* normal, const char* velocity) {
    return model_error(
        deck_of("friction = 0.5\n", fmt::format("[[walls]]\nname = \"w\"\npoint = [0, 0, -0.5]\n"
                                                "normal = {}\nsurface_velocity = {}\n",
                                                normal, velocity)));
  };
  CHECK(wall("[0, 0, 1]", "[0.5, 0.1, 0]").empty());
  CHECK(wall("[1, 2, 2]", "[0.4, 0.1, -0.3]").empty());
  CHECK(wall("[0, 0, 1]", "[0, 0, 0]").empty());
  CHECK(contains(wall("[0, 0, 2]", "[0.5, 0, 0.3]"),
                 "walls.w.surface_velocity = [0.5, 0, 0.3]: has a part of 0.3 m/s along the plane's normal"));
  CHECK(contains(wall("[0, 0, 1]", "[0, 0, -1]"), "has a part of -1 m/s along the plane's normal"));
}

}  // namespace scree
