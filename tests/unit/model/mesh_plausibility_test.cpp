// Warnings about meshes: too fine for the particles, folds too sharp for soft contacts, intersecting shells.
#include "model/checks/mesh_plausibility.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh/mesh_tree.hpp"
#include "mesh/surface_mesh.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kSpace = R"([space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
leaving = "ballistic"
[time]
end = 1.0
step = 1e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
friction = 0.3
[[walls]]
name = "w"
mesh = "m"
[[particles]]
name = "g"
kind = "list"
positions = [[0, 0, 0.9]]
velocity = [0, 0, -1]
radius = 0.02
mass = 0.02
)";

std::string mesh(const std::string& keys) { return "[[meshes]]\nname = \"m\"\n" + keys + "\n"; }

// The warnings that contain a text.
std::vector<std::string> of(const std::string& text, const std::string& deck,
                            const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> found = model_warnings(deck, overrides);
  std::erase_if(found, [&](const std::string& warning) { return !contains(warning, text); });
  return found;
}

// A line in the x-y plane that bends by the angle, with a disc.
std::string line(Real degrees) {
  const Real t = std::tan(degrees * M_PI / 360);
  return fmt::format(
      "[space]\ndimension = 2\nmin = [-1, -1]\nmax = [1, 1]\nleaving = \"ballistic\"\n[time]\nend = "
      "1.0\nstep = "
      "1e-5\n"
      "[integrator]\nparticles = \"velocity-verlet\"\n[[contact.pairs]]\nstiffness = 1e4\n[[meshes]]\nname = "
      "\"m\"\n"
      "kind = \"line\"\npoints = [[-0.5, {0}], [0, 0], [0.5, {0}]]\n[[walls]]\nname = \"w\"\nmesh = \"m\"\n"
      "[[particles]]\nname = \"g\"\nkind = \"list\"\npositions = [[0, 0.8]]\nvelocity = [0, -1]\nradius = "
      "0.05\n"
      "mass = 1.0\n",
      t / 2);
}

}  // namespace

TEST_CASE("the estimated number of nearby triangles is that counted at random positions") {
  for (const char* keys :
       {"kind = \"rectangle\"\nsize = [1.0, 1.0]\nrefine = 0.03",
        "kind = \"rectangle\"\nsize = [1.0, 1.0]\nrefine = 0.01",
        "kind = \"pipe\"\nradius = 0.9\ninner_radius = 0.8\nlength = 1.0\nsegments = 200"}) {
    const Model model = model_of(kSpace + mesh(keys));
    const SurfaceMesh& surface = *model.meshes.front().surface;
    const Real radius = 0.02, reach = radius + model.contact.skin;
    std::mt19937 random(3);
    const auto share = [&] { return random() / 4294967296.0; };
    Real counted = 0;
    constexpr int kPlaces = 2000;
    for (int k = 0; k < kPlaces; ++k) {
      // Near the middle of the mesh, away from its border.
      const Vec3 plane{0.6 * share() - 0.3, 0.6 * share() - 0.3, radius};
      const Real around = 2 * M_PI * share();
      const Vec3 p = surface.sheet ? plane
                                   : Vec3{(0.8 - radius) * std::cos(around),
                                          (0.8 - radius) * std::sin(around), 0.6 * share() - 0.3};
      for_each_triangle_near(surface.view(), p, reach, [&](Index) { ++counted; });
    }
    CAPTURE(keys, counted / kPlaces);
    CHECK(triangles_near(model, surface, radius) ==
          Approx(counted / kPlaces).epsilon(surface.sheet ? 0.05 : 0.5));
  }
}

TEST_CASE("triangles that are small beside the particles get a warning with what makes them larger") {
  const auto fine = [](const std::string& keys, const std::vector<std::string>& overrides = {}) {
    return of("small beside the particles", kSpace + mesh(keys), overrides);
  };
  const std::string screw =
      "kind = \"screw\"\nradius = 0.1\ncore_radius = 0.03\npitch = 0.1\nthickness = 0.01\nlength = 0.3\n";
  const std::vector<std::string> found = fine(screw + "segments = 96");
  REQUIRE(found.size() == 1);
  CHECK(found[0].ends_with("and each costs time: segments = 24"));
  CHECK(fine(screw).empty());
  CHECK(fine(screw + "segments = 24").empty());
  CHECK(fine("kind = \"rectangle\"\nsize = [1.0, 1.0]\nrefine = 0.005").at(0).ends_with("a larger refine"));
  CHECK(fine("kind = \"rectangle\"\nsize = [1.0, 1.0]").empty());
}

TEST_CASE("a fold beyond the feature angle requires overlaps below r (1 - cos of its angle)") {
  for (const Real degrees : {33.0, 45.0, 60.0}) {
    CAPTURE(degrees);
    // An impact of 1 kg at 1 m/s overlaps by sqrt(1 / K).
    const Real most = 0.05 * (1 - std::cos(degrees * M_PI / 180)), enough = 1 / (most * most);
    const auto warned = [&](Real stiffness) {
      return of("it has a concave edge", line(degrees),
                {fmt::format("contact.pairs.0.stiffness={}", stiffness)});
    };
    REQUIRE(warned(0.9 * enough).size() == 1);
    const std::string text = warned(0.9 * enough)[0];
    CHECK(contains(text,
                   fmt::format("mesh \"m\": it has a concave edge of {:.3g} degrees at (0, 0, 0)", degrees)));
    const std::string named = text.substr(text.find("a stiffness of ") + 15);
    CHECK(std::stod(named) == Approx(enough).epsilon(0.02));
    CHECK(warned(std::stod(named)).empty());
    CHECK(warned(1.01 * enough).empty());
  }
  CHECK(of("it has a concave edge", line(29), {"contact.pairs.0.stiffness=1e3"}).empty());
  // They fall no farther than from where the highest starts: from 0.8 m, from below.
  const auto falls = [](Real height) {
    return of("it has a concave edge", line(45),
              {"particles.g.velocity=[0, 0]", "gravity=[0, -9.81]", "contact.pairs.0.stiffness=3e4",
               fmt::format("particles.g.positions=[[0.3, {}]]", height)})
        .size();
  };
  CHECK(falls(0.8) == 1);
  CHECK(falls(-0.3) == 0);
  // Also by their weight at rest, and of bodies.
  CHECK(of("it has a concave edge", line(45),
           {"particles.g.velocity=[0, 0]", "gravity=[0, -1e-9]", "contact.pairs.0.stiffness=1e-6"})
            .size() == 1);
  CHECK(of("it has a concave edge", line(45),
           {"walls=[]", "bodies=[{name=\"b\",mass=1.0,inertia=1.0,position=[0,0],meshes=[{mesh=\"m\"}]}]",
            "contact.pairs.0.stiffness=1e3"})
            .size() == 1);
  // A mesh that nothing has.
  CHECK(of("it has a concave edge", line(45), {"walls=[]", "contact.pairs.0.stiffness=1e3"}).empty());
}

TEST_CASE("a surface that runs across every face takes nothing along") {
  const std::string sheet = kSpace + mesh("kind = \"rectangle\"\nsize = [1.0, 1.0]");
  const auto warned = [&](const char* velocity) {
    return of("is perpendicular to every face", sheet, {fmt::format("walls.w.surface_velocity={}", velocity)})
        .size();
  };
  CHECK(warned("[0, 0, 1]") == 1);
  CHECK(warned("[0.1, 0, 1]") == 0);
  CHECK(warned("[1, 0, 0]") == 0);
}

}  // namespace scree
