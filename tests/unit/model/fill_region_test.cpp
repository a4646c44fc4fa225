// Random groups in regions: every particle lies inside, by formulas of the region's shape, and is free.
#include "model/builder/fill_region.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "model/derived/posed_meshes.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 1e-12;

const std::string kSpace = R"(
[space]
dimension = 3
min = [-2.0, -2.0, -2.0]
max = [2.0, 2.0, 2.0]
[time]
end = 1.0
step = 1e-3
[[contact.pairs]]
stiffness = 1e4
)";

std::string group(int count, const std::string& region, const std::string& radius = "0.03") {
  return "[[particles]]\nname = \"fill\"\nkind = \"random\"\ncount = " + std::to_string(count) +
         "\nradius = " + radius + "\nmass = 1.0\n" + region;
}

// The largest overlap of two particles over the smaller radius, and of particles and shapes of bodies.
Real largest_overlap(const Model& model) {
  std::vector<std::pair<Vec3, Real>> all;
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    all.emplace_back(model.particles.position[i], model.particles.radius[i]);
  for (const Body& body : model.bodies) {
    const Real c = std::cos(body.angle), s = std::sin(body.angle);
    for (const Shape& shape : body.shapes)
      all.emplace_back(body.position + Vec3{c * shape.offset.x - s * shape.offset.y,
                                            s * shape.offset.x + c * shape.offset.y, shape.offset.z},
                       shape.radius);
  }
  Real most = 0;
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    for (std::size_t j = 0; j < all.size(); ++j)
      if (j != i)
        most = std::max(most, (all[i].second + all[j].second - norm(all[i].first - all[j].first)) /
                                  std::min(all[i].second, all[j].second));
  return most;
}

void check_free(const Model& model) {
  const PosedMeshes meshes(model);
  CHECK(largest_overlap(model) <= kRoundOff);
  for (std::size_t i = 0; i < model.particles.size(); ++i) {
    REQUIRE(meshes.is_clear(model.particles.position[i], (1 - kRoundOff) * model.particles.radius[i], 0));
    REQUIRE(is_clear_of_planes(model, model.particles.position[i], model.particles.radius[i]));
  }
}

}  // namespace

TEST_CASE("a cylinder on an oblique axis, cut by a box") {
  const std::string region = "cylinder_radius = 0.4\nends = [[-0.5, -0.2, 0.1], [0.7, 0.6, 0.5]]\n";
  const Vec3 from{-0.5, -0.2, 0.1}, direction{1.2, 0.8, 0.4};
  for (const bool cut : {false, true}) {
    const Model model =
        model_of(kSpace + group(cut ? 300 : 900, region + (cut ? "max = [2.0, 0.1, 2.0]\n" : ""),
                                "{ kind = \"uniform\", min = 0.02, max = 0.04 }"));
    int far = 0;
    for (std::size_t i = 0; i < model.particles.size(); ++i) {
      const Vec3 p = model.particles.position[i] - from;
      const Real r = model.particles.radius[i], along = dot(p, direction) / norm(direction),
                 across = norm(cross(p, direction)) / norm(direction);
      REQUIRE(along >= r - kRoundOff);
      REQUIRE(along <= norm(direction) - r + kRoundOff);
      REQUIRE(across <= 0.4 - r + kRoundOff);
      if (cut) REQUIRE(model.particles.position[i].y <= 0.1 - r + kRoundOff);
      far += across > 0.3;
    }
    CHECK(far > static_cast<int>(model.particles.size()) / 5);  // up to the wall, not about the axis alone
    check_free(model);
  }
}

// The box around it is 2,000 times as large.
TEST_CASE("a thin cylinder on an oblique axis is filled as one along x is") {
  const auto filled = [&](const std::string& ends) {
    return model_of(kSpace + group(2500, "cylinder_radius = 0.02\nends = " + ends + "\n",
                                   "{ kind = \"constant\", value = 0.004 }"));
  };
  const Model oblique = filled("[[-0.9, -0.9, -0.9], [0.9, 0.9, 0.9]]");
  const Vec3 axis = (1 / std::sqrt(3.0)) * Vec3{1, 1, 1};
  for (const Vec3 p : oblique.particles.position) {
    REQUIRE(norm(cross(p, axis)) <= 0.02 - 0.004 + kRoundOff);
    REQUIRE(std::abs(dot(p, axis)) <= 0.9 * std::sqrt(3.0) - 0.004 + kRoundOff);
  }
  check_free(oblique);
  CHECK(filled("[[-1.5, 0.0, 0.0], [1.5, 0.0, 0.0]]").particles.size() == 2500);
}

TEST_CASE("filling: the inside of a mesh without a body or wall, up to a level") {
  const std::string ball = "[[meshes]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.5\nlevels = 3\n";
  const Model tank = model_of(kSpace + ball + group(600, "mesh = \"ball\"\nmax = [2.0, 2.0, 0.1]\n"));
  for (const Vec3 p : tank.particles.position) {
    REQUIRE(norm(p) <= 0.5 - 0.03);
    REQUIRE(p.z <= 0.1 - 0.03 + kRoundOff);
  }
  check_free(tank);
}

TEST_CASE("filling: the inside of a shell on a rotated body, and of a mesh without contacts") {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "scree_fill_region_test.obj";
  std::ofstream(file) << "v -0.4 -0.2 -0.3\nv 0.4 -0.2 -0.3\nv 0.4 0.2 -0.3\nv -0.4 0.2 -0.3\n"
                         "v -0.4 -0.2 0.3\nv 0.4 -0.2 0.3\nv 0.4 0.2 0.3\nv -0.4 0.2 0.3\n"
                         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::string shell = "[[meshes]]\nname = \"crate\"\nkind = \"file\"\nsheet = true\nfile = \"" +
                            file.string() + "\"\n",
                    solid = "[[meshes]]\nname = \"crate\"\nkind = \"box\"\nsize = [0.8, 0.4, 0.6]\n";
  for (const bool sheet : {true, false}) {
    const std::string body =
        "[[bodies]]\nname = \"crate\"\nkind = \"spatial\"\nposition = [0.3, 0.1, -0.2]\nmass = 1.0\n"
        "inertia_tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]\nrotation_axis = [0.0, 0.0, 1.0]\nrotation_angle = "
        "0.5\nmeshes = [{ mesh = \"crate\"" +
        std::string(sheet ? "" : ", collides = false") + " }]\n";
    const Model model = model_of(kSpace + (sheet ? shell : solid) + body + group(250, "mesh = \"crate\"\n"));
    const Real c = std::cos(0.5), s = std::sin(0.5);
    for (const Vec3 p : model.particles.position) {
      const Vec3 d = p - Vec3{0.3, 0.1, -0.2};
      REQUIRE(std::abs(c * d.x + s * d.y) <= 0.4 - 0.03 + kRoundOff);
      REQUIRE(std::abs(-s * d.x + c * d.y) <= 0.2 - 0.03 + kRoundOff);
      REQUIRE(std::abs(d.z) <= 0.3 - 0.03 + kRoundOff);
    }
    check_free(model);
  }
}

TEST_CASE("the inside of a body: of a drum of solid walls, of a tray of discs") {
  const std::string drum =
      "[[meshes]]\nname = \"drum\"\nkind = \"drum\"\nradius = 0.5\nlength = 0.6\nwall = 0.05\nend_wall = "
      "0.05\n"
      "segments = 32\n[[bodies]]\nname = \"drum\"\nkind = \"spatial\"\nposition = [0.2, 0.0, 0.1]\nmass = "
      "1.0\n"
      "inertia_tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]\nz_axis = [1.0, 0.0, 0.0]\nmeshes = [{ mesh = "
      "\"drum\" }]\n";
  const Model full = model_of(kSpace + drum + group(600, "body = \"drum\"\n"));
  for (const Vec3 p : full.particles.position) {
    REQUIRE(std::abs(p.x - 0.2) <= 0.3 - 0.03 + kRoundOff);
    REQUIRE(std::hypot(p.y, p.z - 0.1) <= 0.5 - 0.03);
  }
  check_free(full);
  const std::string tray =
      "[[bodies]]\nname = \"tray\"\nposition = [0.2, -0.1]\nangle = 0.3\nmass = 1.0\ninertia = 1.0\n"
      "shapes = [{ radius = 0.03, offset = [-0.5, -0.3], size = [21, 13], spacing = [0.05, 0.05], sides = "
      "[\"x_min\", \"x_max\", \"y_min\"] }]\n";
  const Model load =
      model_of(kSmallDeck + "[[contact.pairs]]\nstiffness = 1e4\n" + tray + group(60, "body = \"tray\"\n"));
  for (const Vec3 p : load.particles.position) {
    const Vec3 d = p - Vec3{0.2, -0.1, 0};
    const Real x = std::cos(0.3) * d.x + std::sin(0.3) * d.y, y = -std::sin(0.3) * d.x + std::cos(0.3) * d.y;
    REQUIRE(std::abs(x) <= 0.5 - 0.03 + kRoundOff);
    REQUIRE(std::abs(y) <= 0.3 - 0.03 + kRoundOff);
  }
  check_free(load);
}

TEST_CASE("in 2D a circle, and the inside of a closed line") {
  const std::string deck = kSmallDeck + "[[contact.pairs]]\nstiffness = 1e4\n";
  const Model round = model_of(deck + group(80, "cylinder_radius = 0.5\ncenter = [0.1, 0.2]\n"));
  for (const Vec3 p : round.particles.position) REQUIRE(norm(p - Vec3{0.1, 0.2, 0}) <= 0.47 + kRoundOff);
  check_free(round);
  const std::string line =
      "[[meshes]]\nname = \"wedge\"\nkind = \"line\"\nclosed = true\npoints = [[0.0, 0.0], [0.8, 0.0], [0.0, "
      "0.8]]\n";
  const Model wedge = model_of(deck + line + group(25, "mesh = \"wedge\"\n"));
  for (const Vec3 p : wedge.particles.position) {
    REQUIRE(std::min(p.x, p.y) >= 0.03 - kRoundOff);
    REQUIRE(p.x + p.y <= 0.8 - 0.03 * std::numbers::sqrt2_v<Real> + kRoundOff);
  }
}

TEST_CASE("random groups keep clear of planes, and a box alone has the positions that it had") {
  const std::string plane = "[[walls]]\nname = \"ramp\"\npoint = [0.0, 0.0, 0.0]\nnormal = [1.0, 0.0, 1.0]\n";
  const std::string box = "min = [-0.5, -0.5, -0.5]\nmax = [0.5, 0.5, 0.5]\n";
  check_free(model_of(kSpace + plane + group(300, box)));
  const Model bare = model_of(kSpace + group(300, box));
  // A region around the box cuts nothing off, but counts tries differently: the positions are the same.
  const Model within = model_of(
      kSpace + group(300, box + "cylinder_radius = 1.5\nends = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]\n"));
  for (std::size_t i = 0; i < bare.particles.size(); ++i)
    CHECK(same_bits(bare.particles.position[i], within.particles.position[i]));
}

TEST_CASE("regions with too little room, or none, are refused") {
  const auto error = [](const std::string& tables) { return model_error(kSpace + tables); };
  const std::string cylinder = "cylinder_radius = 0.2\nends = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.5]]\n";
  CHECK(contains(error(group(5000, cylinder)), "of the volume of their region (cylinder_radius)"));
  CHECK(contains(error(group(400, cylinder)),
                 "in 10000 tries each in the region (cylinder_radius); a larger region"));
  CHECK(contains(error(group(1, cylinder + "max = [1.0, 1.0, -0.1]\n")),
                 "the region (max, cylinder_radius) has no room in the space"));
  CHECK(contains(error(group(1, "")), "particles.fill.min: missing; a random group needs a region"));
  CHECK(contains(error(group(1, "cylinder_radius = 0.2\n")), "particles.fill.ends: missing"));
  CHECK(contains(error(group(1,
                             "ends = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.5]]\n"
                             "min = [0.0, 0.0, 0.0]\nmax = [1.0, 1.0, 1.0]\n")),
                 "not used without cylinder_radius"));
  const std::string floor = "[[meshes]]\nname = \"floor\"\nkind = \"rectangle\"\nsize = [1.0, 1.0]\n";
  CHECK(contains(error(floor + group(1, "mesh = \"floor\"\n")), "is open and has no inside"));
  const std::string block = "[[meshes]]\nname = \"block\"\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n";
  const std::string wall = "[[walls]]\nname = \"block\"\nmesh = \"block\"\n";
  CHECK(contains(error(block + wall + group(1, "mesh = \"block\"\n")), "its inside is matter"));
  CHECK(model_of(kSpace + block + group(100, "mesh = \"block\"\n")).particles.size() == 100);
  const std::string body =
      "[[bodies]]\nname = \"b\"\nkind = \"spatial\"\nposition = [0.0, 0.0, 0.0]\nmass = 1.0\n"
      "inertia_tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]\n";
  CHECK(contains(error(block + body + "meshes = [{ mesh = \"block\" }]\n" + group(1, "body = \"b\"\n")),
                 "the region (body) has no room in the space that is free of walls, meshes and bodies"));
  CHECK(contains(error(body + group(1, "body = \"b\"\n")), "has no shapes and meshes that collide"));
  CHECK(contains(error(floor + body + "meshes = [{ mesh = \"floor\" }]\n" + group(1, "body = \"b\"\n")),
                 "its shapes and meshes lie in a plane"));
}

}  // namespace scree
