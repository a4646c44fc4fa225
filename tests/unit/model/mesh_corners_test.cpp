// Meshes of bodies on planes: their contacts, stiffness, and refusals.
#include "model/derived/mesh_corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kExplicit = "integrator.particles=velocity-verlet", kFixed = "time.control=fixed";

std::string deck(const std::string& mesh, const std::string& more = "") {
  return "[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = 1.0\nstep = "
         "1e-4\n[[contact.pairs]]\nstiffness = 1e5\n[[meshes]]\nname = \"m\"\n" +
         mesh +
         "[[walls]]\nname = \"floor\"\npoint = [0, 0, -0.5]\nnormal = [0, 0, 2]\n[[bodies]]\nname = "
         "\"b\"\nkind = \"spatial\"\nposition = [0, 0, 0]\nsolids = [{ kind = \"mesh\", mesh = \"m\", "
         "density = "
         "500.0 }]\nmeshes = [{ mesh = \"m\" }]\n" +
         more;
}
const std::string kCube = "kind = \"box\"\nsize = [0.2, 0.2, 0.2]\n";

// A box of wood and a floor of stone, each with a law for itself.
std::string two_materials(const std::string& contact) {
  std::string text = deck(kCube);
  text.replace(
      text.find("[[contact.pairs]]"), std::string("[[contact.pairs]]\nstiffness = 1e5\n").size(),
      contact +
          "[[materials]]\nname = \"wood\"\n[[materials]]\nname = \"stone\"\n[[contact.pairs]]\nmaterials "
          "= [\"wood\", \"wood\"]\nstiffness = 1e5\n[[contact.pairs]]\nmaterials = [\"stone\", "
          "\"stone\"]\nstiffness = 3e5\n");
  return text;
}
const std::vector<std::string> kTwoMaterials = {"bodies.b.meshes.0.material=wood",
                                                "walls.floor.material=stone"};

}  // namespace

TEST_CASE("a body oscillates on all corners of a face at once") {
  constexpr Real kStiffness = 1e5;
  // Rotated about an edge of its face: 4 K (a/2)^2 over m a^2 / 6.
  const Model cube = model_of(deck(kCube + "refine = 0.05\n"));
  CHECK(near(fastest_on_corners(cube, false).frequency, std::sqrt(6 * kStiffness / 4), {.relative = 1e-6}));
  CHECK(fastest_on_corners(cube, false).is_exact);
  CHECK(near(largest_corner_radius(cube), std::sqrt(6 * 0.04 / (4 * std::numbers::pi_v<Real>)),
             {.relative = 1e-9}));
  // The frequency grows with the number of corners as sqrt(N).
  for (const int corners : {24, 96}) {
    const Model disc = model_of(
        deck(fmt::format("kind = \"cylinder\"\nradius = 0.1\nlength = 0.1\nsegments = {}\n", corners)));
    const Body& body = disc.bodies[0];
    const Real turning = corners * 0.005 / body.inertia;
    CHECK(near(fastest_on_corners(disc, false).frequency,
               std::sqrt(kStiffness * std::max(corners / body.mass, turning)), {.relative = 1e-3}));
  }
  // Friction has k_t = 2/7 K; along the normal the contact is stiffer.
  const Model frictional = model_of(deck(kCube), {"contact.pairs.0.friction=0.3"});
  CHECK(near(fastest_on_corners(frictional, false).frequency, std::sqrt(6 * kStiffness / 4),
             {.relative = 1e-6}));
  for (const std::string override : {"walls=[]", "bodies.b.meshes.0.collides=false"})
    CHECK(fastest_on_corners(model_of(deck(kCube), {override}), false).frequency == 0);
}

TEST_CASE(
    "explicit steps that are long for a body on its corners are refused, or warned of if a joint holds it") {
  const std::string disc = deck("kind = \"cylinder\"\nradius = 0.1\nlength = 0.1\nsegments = 200\n");
  const std::string hinge =
      "[[joints]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"ground\", \"b\"]\npoint = [0, 0, "
      "0.1]\naxis = "
      "[0, 1, 0]\n";
  const auto overrides = [](const std::string& step) {
    return std::vector<std::string>{kExplicit, kFixed, "time.step=" + step, "contact.pairs.0.friction=0.3"};
  };
  const std::string finding = "a body on a plane, with all vertices of a face of its mesh, oscillates with";
  const auto warnings = [&](const std::string& text, const std::string& step) {
    return std::ranges::count_if(model_warnings(text, overrides(step)),
                                 [&](const std::string& warning) { return contains(warning, finding); });
  };
  CHECK(contains(model_error(disc, overrides("5e-4")), finding));
  CHECK(warnings(disc, "1.5e-4") == 1);
  CHECK(warnings(disc, "5e-5") == 0);
  CHECK(warnings(disc + hinge, "5e-4") == 1);
  CHECK(warnings(disc + hinge, "1.5e-4") == 0);
}

TEST_CASE("corners beyond a plane at t = 0 count by the mesh's radius on planes") {
  const std::string error = model_error(deck(kCube), {"bodies.b.position=[0, 0, -0.45]"});
  CHECK(error.find("body \"b\" and wall \"floor\" overlap at t = 0 by 0.36") != std::string::npos);
  CHECK(error.find("of the radius that the mesh counts with on planes") != std::string::npos);
  CHECK(model_error(deck(kCube), {"bodies.b.position=[0, 0, -0.4]"}).empty());
}

TEST_CASE("a mesh that lies across a plane at t = 0 touches none where a joint holds its body") {
  const std::string hinge =
      "[[joints]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"ground\", \"b\"]\npoint = [0, 0, "
      "0]\naxis = [0, "
      "0, 1]\n";
  const std::string across = "bodies.b.position=[0, 0, -0.45]",
                    warning = "lies across wall \"floor\" at t = 0";
  const auto warned = [&](const std::string& position) {
    return std::ranges::any_of(model_warnings(deck(kCube, hinge), {position}),
                               [&](const std::string& text) { return contains(text, warning); });
  };
  CHECK(largest_corner_radius(model_of(deck(kCube, hinge), {across})) == 0);
  CHECK(warned(across));
  CHECK(largest_corner_radius(model_of(deck(kCube, hinge), {"bodies.b.position=[0, 0, -0.4]"})) > 0);
  CHECK(!warned("bodies.b.position=[0, 0, -0.4]"));
  CHECK(contains(model_error(deck(kCube), {across}), "overlap at t = 0"));
}

TEST_CASE("a law for meshes and planes alone is not asked for, but made where the deck mixes") {
  const Model without = model_of(two_materials(""), kTwoMaterials);
  CHECK(largest_corner_radius(without) == 0);
  const Model mixed = model_of(two_materials("[contact]\nmixing = \"geometric\"\n"), kTwoMaterials);
  CHECK(largest_corner_radius(mixed) > 0);
  CHECK(near(mixed.contact.law(0, 1).normal_stiffness, 1.5e5, {.relative = 1e-12}));
}

}  // namespace scree
