// Meshes from decks: position, refinement, mass, counts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "mesh/surface_mesh.hpp"
#include "model/checks/mesh_plausibility.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kSpace = R"([space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
[time]
end = 1.0
step = 1e-4
control = "fixed"
)";

// One body with these solids and the mesh "made", a table without its name.
std::string body_of(const std::string& made, const std::string& solids) {
  return kSpace + "[[meshes]]\nname = \"made\"\n" + made +
         "\n[[bodies]]\nname = \"b\"\nkind = \"spatial\"\nposition = [0.1, 0, 0]\nsolids = [" + solids +
         "]\n";
}

const std::string kOfMesh = R"({ kind = "mesh", mesh = "made", density = 800.0 })";

void check_equal(const Body& a, const Body& b) {
  CHECK(a.mass == Approx(b.mass).epsilon(1e-12));
  CHECK(norm(a.center_of_mass - b.center_of_mass) < 1e-13);
  CHECK(norm(a.position - b.position) < 1e-13);
  const Sym3 &i = a.inertia_tensor, &j = b.inertia_tensor;
  const Real scale = std::abs(j.xx) + std::abs(j.yy) + std::abs(j.zz);
  for (const Real apart : {i.xx - j.xx, i.yy - j.yy, i.zz - j.zz, i.xy - j.xy, i.xz - j.xz, i.yz - j.yz})
    CHECK(std::abs(apart) < 1e-12 * scale);
}

Body body(const std::string& deck, const std::vector<std::string>& overrides = {}) {
  return model_of(deck, overrides).bodies.front();
}

const std::string kSmallLine = kSmallDeck + R"([[meshes]]
name = "line"
kind = "line"
points = [[0.0, 0.0], [0.3, 0.0], [0.0, 0.4]]
[[walls]]
name = "line"
mesh = "line"
)";

}  // namespace

TEST_CASE("a body made of a box of triangles weighs what the box does") {
  const std::string turned = "offset = [0.1, 0.2, 0.3]\nrotation_axis = [1, 2, 3]\nrotation_angle = 0.7";
  const std::string box = body_of("kind = \"box\"\nsize = [0.1, 0.2, 0.3]\n" + turned, kOfMesh);
  const Body whole =
      body(body_of("kind = \"box\"\nsize = [1, 1, 1]",
                   "{ kind = \"box\", size = [0.1, 0.2, 0.3], density = 800.0, offset = [0.1, 0.2, 0.3], "
                   "rotation_axis = [1, 2, 3], rotation_angle = 0.7 }"));
  check_equal(body(box), whole);
  check_equal(body(box, {"meshes.made.refine=0.03"}), whole);
  // Positioned by the solid instead of by the mesh.
  check_equal(body(body_of("kind = \"box\"\nsize = [0.1, 0.2, 0.3]",
                           "{ kind = \"mesh\", mesh = \"made\", density = 800.0, offset = [0.1, 0.2, 0.3], "
                           "rotation_axis = [1, 2, 3], rotation_angle = 0.7 }")),
              whole);
}

TEST_CASE("a mesh of a file is stretched along each axis, and mirrored without turning it inside out") {
  // A tetrahedron of 1/6 m^3, with its centre at a quarter of each edge.
  const std::string path = std::filesystem::temp_directory_path() / "scree_stretched.obj";
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string file = "kind = \"file\"\nfile = \"" + path + "\"\nscale = 0.1\n";
  const auto made = [&](const std::string& more) { return body(body_of(file + more, kOfMesh)); };
  const Body plain = made("");
  CHECK(plain.mass == Approx(800.0 / 6000).epsilon(kAccumulatedRoundOff));
  for (const Vec3 s : {Vec3{1, -1, 1}, Vec3{-1, -1, 1}, Vec3{-1, -1, -1}, Vec3{2, 3, -0.5}}) {
    const Body other = made(fmt::format("stretch = [{}, {}, {}]", s.x, s.y, s.z));
    CHECK(other.mass == Approx(plain.mass * std::abs(s.x * s.y * s.z)).epsilon(1e-12));
    CHECK(norm(other.center_of_mass - Vec3{0.025 * s.x, 0.025 * s.y, 0.025 * s.z}) < 1e-15);
  }
  const std::string error = model_error(body_of(file + "stretch = [1, 0, 1]", kOfMesh));
  CHECK(contains(error, "meshes.made.stretch"));
  CHECK(contains(error, "none of the three factors may be 0"));
  std::filesystem::remove(path);
}

TEST_CASE("a mesh that is far longer than the space may want a scale") {
  const auto is_reported = [](const char* points) {
    const auto warnings = model_warnings(kSmallLine, {fmt::format("meshes.line.points={}", points)});
    return std::ranges::any_of(warnings, [](const std::string& text) {
      return contains(text, "mesh \"line\": is 40 m long, in a space of 2 m: is its scale right?");
    });
  };
  CHECK(is_reported("[[0, 0], [30, 0], [0, 40]]"));
  CHECK_FALSE(is_reported("[[0, 0], [0.3, 0], [0, 0.4]]"));
}

TEST_CASE("a solid is the inside of its mesh, of the mesh's hull, or a shell") {
  const std::string open = "kind = \"rectangle\"\nsize = [0.2, 0.3]";
  const auto of = [](const std::string& keys) {
    return "{ kind = \"mesh\", mesh = \"made\", density = 800.0, " + keys + " }";
  };
  const std::string convex = of("inertia = \"convex\""), skin = of("inertia = \"shell\", thickness = 1e-3");
  const std::string pipe = body_of("kind = \"pipe\"\nradius = 0.2\ninner_radius = 0.1\nlength = 0.3", convex);
  check_equal(body(pipe), body(body_of("kind = \"cylinder\"\nradius = 0.2\nlength = 0.3", kOfMesh)));
  CHECK(model_of(pipe).meshes.front().solid_masses.front() ==
        Approx(body(pipe).mass).epsilon(kAccumulatedRoundOff));
  CHECK(body(body_of("kind = \"box\"\nsize = [0.1, 0.2, 0.3]", skin)).mass ==
        Approx(800e-3 * 0.22).epsilon(kAccumulatedRoundOff));
  CHECK(body(body_of(open, skin)).mass == Approx(800e-3 * 0.06).epsilon(kAccumulatedRoundOff));
  const std::string funnel =
      "kind = \"funnel\"\nradius = 0.1\ntop_radius = 0.4\nlength = 0.4\nsegments = 1000";
  CHECK(body(body_of(funnel, skin)).mass == Approx(800e-3 * M_PI * 0.5 * 0.5).epsilon(1e-5));
  CHECK(
      body(body_of("kind = \"hopper\"\nsize = [0.2, 0.2]\ntop_size = [0.8, 0.8]\nlength = 0.4", skin)).mass ==
      Approx(800e-3 * 4 * 0.5 * 0.5).epsilon(kAccumulatedRoundOff));
  CHECK(contains(model_error(body_of(funnel, kOfMesh)), "is an open surface, which encloses no volume"));
  CHECK(contains(model_error(body_of("kind = \"funnel\"\nradius = 0.1\nlength = 0.4", kOfMesh)),
                 "meshes.made.top_radius: missing; with kind = \"funnel\" it must be"));
  CHECK(contains(model_error(body_of(open, kOfMesh)), "is an open surface, which encloses no volume"));
  CHECK(contains(model_error(body_of(open, convex)), "lie in one plane: their convex hull has no volume"));
  CHECK(contains(model_error(body_of(open, of("inertia = \"shell\""))), "thickness: missing"));
  CHECK(contains(model_error(body_of(open, of("thickness = 0.1"))), "which encloses no volume"));
  CHECK(contains(model_error(body_of("kind = \"box\"\nsize = [1, 1, 1]", of("thickness = 0.1"))),
                 "not used without inertia = \"shell\""));
}

TEST_CASE("round bodies made of triangles converge to their closed forms at order 2") {
  const Real radius = 0.3, length = 0.4, density = 800, mass = density * M_PI * radius * radius * length;
  Real before = 0;
  for (const int segments : {16, 32, 64}) {
    const Body made = body(body_of(
        fmt::format("kind = \"cylinder\"\nradius = 0.3\nlength = 0.4\nsegments = {}", segments), kOfMesh));
    const Real error = 1 - made.mass / mass;
    const Real around = 1 - made.inertia_tensor.zz / (mass * radius * radius / 2);
    CHECK(error > 0);
    CHECK(around == Approx(2 * error).epsilon(0.1));
    if (before > 0) CHECK(std::log2(before / error) == Approx(2).margin(0.05));
    before = error;
  }
}

TEST_CASE("the masses of solids made of meshes are kept for the report, each once") {
  const std::string deck =
      body_of("kind = \"box\"\nsize = [0.1, 0.1, 0.1]", kOfMesh + ", " + kOfMesh) +
      "[[bodies]]\nname = \"c\"\nkind = \"spatial\"\nposition = [0, 0, 0]\nsolids = [{ kind = "
      "\"mesh\", mesh = \"made\", density = 1.0 }]\n";
  const std::vector<Real> masses = model_of(deck).meshes.front().solid_masses;
  REQUIRE(masses.size() == 2);
  CHECK(masses[0] == Approx(0.8).epsilon(1e-12));
  CHECK(masses[1] == Approx(0.001).epsilon(1e-12));
}

TEST_CASE("lines of planar decks: refined along themselves, closed counterclockwise, in their plane") {
  const auto triangles = [](const std::vector<std::string>& overrides) {
    return model_of(kSmallLine, overrides).meshes.front().surface->triangles.size();
  };
  CHECK(triangles({}) == 4);
  CHECK(triangles({"meshes.line.closed=true"}) == 6);
  CHECK(triangles({"meshes.line.refine=0.1"}) == 2 * (3 + 5));
  CHECK(triangles({"meshes.line.closed=true", "meshes.line.refine=0.1"}) == 2 * (3 + 5 + 4));
  CHECK(
      contains(model_error(kSmallLine, {"meshes.line.closed=true", "meshes.line.points=[[0,0],[0,1],[1,0]]"}),
               "must be in counterclockwise order"));
  CHECK(contains(model_error(kSmallLine, {"meshes.line.points=[[0,0]]"}), "must be at least 2"));
  CHECK(contains(model_error(kSmallLine, {"meshes.line.points=[[0,0],[0.5,0.25],[0.5,0.25]]"}),
                 "must be apart, one from the next: (0.5, 0.25) stands twice"));
  CHECK(contains(
      model_error(kSmallLine, {"meshes.line.closed=true", "meshes.line.points=[[0,0],[1,0],[1,1],[0,0]]"}),
      "must be apart, one from the next and the last from the first: (0, 0) stands twice"));
  CHECK(contains(
      model_error(kSmallLine, {"meshes.line.closed=true",
                               "meshes.line.points=[[0,0],[1,0],[0.2,0.8],[0.8,0.8],[0,0.1]]"}),
      "meshes.line.points=[[0,0],[1,0],[0.2,0.8],[0.8,0.8],[0,0.1]]: the closed line is no outline"));
  CHECK(contains(model_error(kSmallLine, {"meshes.line.refine=1e-12"}),
                 "must be above the length of the line"));
  CHECK(contains(
      model_error(kSmallLine, {"meshes.line.rotation_axis=[1, 0]", "meshes.line.rotation_angle=1.0"}),
      "lines lie in the x-y plane and turn about z alone"));
}

TEST_CASE("bodies of closed lines weigh what is inside times a depth, or their outline's hull, or a skin") {
  const auto of_line = [](const std::string& keys) {
    return std::vector<std::string>{
        "meshes.line.points=[[0,0],[0.4,0],[0.4,0.2],[0.2,0.1],[0,0.2]]", "meshes.line.closed=true",
        fmt::format(
            "bodies=[{{name=\"b\",position=[1,0],solids=[{{kind=\"mesh\",mesh=\"line\",density=500.0{}}}]}}]",
            keys)};
  };
  const auto line_body = [&](const std::string& keys) {
    return model_of(kSmallLine, of_line(keys)).bodies.front();
  };
  // A rectangle less a triangle; both are symmetric about x = 0.2.
  const Real area = 0.08 - 0.02, y_rectangle = 0.1, y_triangle = 0.2 - 0.1 / 3,
             y = (0.08 * y_rectangle - 0.02 * y_triangle) / area,
             rectangle = 0.08 * ((0.4 * 0.4 + 0.2 * 0.2) / 12 + std::pow(y - y_rectangle, 2)),
             triangle = 0.02 * (0.1 * 0.1 / 18 + 0.4 * 0.4 / 24 + std::pow(y - y_triangle, 2));
  for (const Real depth : {1.0, 0.03}) {
    const Body body = line_body(depth == 1 ? "" : fmt::format(",depth={}", depth));
    CHECK(body.mass == Approx(500 * area * depth).epsilon(1e-12));
    CHECK(body.inertia == Approx(500 * depth * (rectangle - triangle)).epsilon(1e-12));
    CHECK(norm(body.position - Vec3{1.2, y, 0}) < 1e-15);
    CHECK(body.position.z == 0);
  }
  CHECK(line_body(",depth=2.0,inertia=\"convex\"").mass ==
        Approx(500 * 0.08 * 2).epsilon(kAccumulatedRoundOff));
  CHECK(line_body(",depth=2.0,inertia=\"shell\",thickness=1e-3").mass ==
        Approx(500 * 1e-3 * 2 * (0.8 + 2 * std::sqrt(0.05))).epsilon(kAccumulatedRoundOff));
  for (const char* turn :
       {"rotation_axis=[1,0],rotation_angle=1.0", "quaternion=[0.8,0.6,0,0]", "z_axis=[1,0]"})
    CHECK(contains(model_error(kSmallLine, of_line(fmt::format(",{}", turn))),
                   "lines lie in the x-y plane and turn about z alone"));
  const Body turned = line_body(",quaternion=[0.6,0,0,0.8]");
  CHECK(turned.inertia == Approx(line_body("").inertia).epsilon(1e-12));
  CHECK(norm(turned.center_of_mass) == Approx(norm(line_body("").center_of_mass)).epsilon(1e-12));
  // Refined far beyond the number of corners that can be triangulated as a polygon.
  std::vector<std::string> fine = of_line("");
  fine.push_back("meshes.line.refine=1e-4");
  CHECK(model_of(kSmallLine, fine).bodies.front().inertia == line_body("").inertia);
  CHECK(contains(model_error(kSmallLine, of_line(",depth=1e-320")), "its mass"));
  std::vector<std::string> open = of_line("");
  open[1] = "meshes.line.closed=false";
  CHECK(contains(model_error(kSmallLine, open), "is an open surface, which encloses no volume"));
  CHECK(contains(model_error(body_of("kind = \"box\"\nsize = [1, 1, 1]",
                                     "{ kind = \"mesh\", mesh = \"made\", density = 1.0, depth = 2.0 }")),
                 "is for lines, in 2D; this mesh has its own"));
}

TEST_CASE("with meshes the number of surfaces is limited by contact keys") {
  const std::string row = body_of("kind = \"box\"\nsize = [0.1, 0.1, 0.1]", kOfMesh);
  const std::string message =
      model_error(row, {"bodies.b.count=524289", "bodies.b.shapes=[{radius=0.01},{radius=0.02}]"});
  CHECK(contains(message, "meshes.made: the deck has 1048578 walls, shapes and meshes of bodies"));
  CHECK(contains(message, "at most 1048576"));
}

TEST_CASE("how many triangles a particle is near: of small ones the disc in reach, of large ones one") {
  const std::string deck = kSpace + R"([[contact.pairs]]
stiffness = 1e4
[[meshes]]
name = "floor"
kind = "rectangle"
size = [1.0, 1.0]
[[walls]]
name = "floor"
mesh = "floor"
[[particles]]
kind = "list"
positions = [[0, 0, 0.5]]
radius = 0.1
mass = 1.0
)";
  const Model coarse = model_of(deck), fine = model_of(deck, {"meshes.floor.refine=0.01"});
  // The skin is 0.2 radii; half squares of the same size, those inside the disc of the range and those cut
  // by its border.
  const Real within = std::sqrt(0.12 * 0.12 - 0.1 * 0.1);
  const SurfaceMesh& mesh = *fine.meshes.front().surface;
  const auto count = static_cast<Real>(mesh.triangles.size());
  const Real edge = std::sqrt(2 / count), perimeter = (2 + std::sqrt(2)) * edge;
  CHECK(triangles_near(coarse, *coarse.meshes.front().surface, 0.1) <= 2);
  CHECK(triangles_near(fine, mesh, 0.1) ==
        Approx(1 + count * (M_PI * within * within + perimeter * within)).epsilon(0.01));
}

}  // namespace scree
