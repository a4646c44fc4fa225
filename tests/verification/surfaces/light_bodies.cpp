// Restitution of contacts with free bodies, which depends on neither their mass nor where they are hit: the
// damping follows from 1/m* = 1/m + 1/M + (r x n) J^-1 (r x n).
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "physics/normal_laws.hpp"
#include "physics/plausible.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kRestitution = 0.5, kSize = 0.05, kSpeed = 0.01;  // kSize: radius of spheres and discs [m]

std::string text(Vec3 v, int dimension = 3) {
  return dimension == 3 ? fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z)
                        : fmt::format("[{:.17g}, {:.17g}]", v.x, v.y);
}

// A body with an oblique orientation, whose shape or mesh is hit off its centre.
struct Struck {
  std::string name;
  int dimension;
  Real mass;
  Vec3 at, normal;    // point of contact, and normal out of the body, in its frame
  std::string shape;  // keys of its table
  Vec3 position{};

  Mat3 axes() const {
    return dimension == 3 ? rotation_matrix(Quaternion{0.1, 0.7, -0.5, 0.5})
                          : rotation_matrix(exponential({0, 0, 0.7}));
  }
  // The body where its contact point is at p, and its velocity.
  std::string table(Vec3 p, Vec3 velocity) const {
    const std::string inertia =
        dimension == 3
            ? fmt::format(
                  "kind = \"spatial\"\nquaternion = [0.1, 0.7, -0.5, 0.5]\ninertia_tensor = [{:.17g}, "
                  "{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}]\n",
                  0.002 * mass, 0.004 * mass, 0.005 * mass, 0.0005 * mass, -0.0003 * mass, 0.0002 * mass)
            : fmt::format("angle = 0.7\ninertia = {:.17g}\n", 0.003 * mass);
    return fmt::format("[[bodies]]\nname = \"{}\"\nposition = {}\nvelocity = {}\nmass = {:.17g}\n{}{}\n",
                       name, text(p - axes() * at, dimension), text(velocity, dimension), mass, inertia,
                       shape);
  }
  // Its inverse effective mass at the contact, as the model has it [1/kg].
  Real mobility(const Model& model) const {
    for (const Body& body : model.bodies) {
      if (body.name != name) continue;
      const Vec3 lever = cross(at, normal);
      return 1 / body.mass + (dimension == 3 ? dot(lever, inverse(body.inertia_tensor) * lever)
                                             : lever.z * lever.z / body.inertia);
    }
    return 0;
  }
};

Struck shape_of(int dimension, const std::string& name, Real mass, Vec3 normal) {
  const Vec3 offset{0.06, -0.03, dimension == 3 ? 0.04 : 0};
  return {name,   dimension,
          mass,   offset + kSize * normal,
          normal, fmt::format("shapes = [{{ radius = {}, offset = {} }}]", kSize, text(offset, dimension))};
}
Vec3 oblique(int dimension) { return dimension == 3 ? Vec3{0.48, 0.6, 0.64} : Vec3{0.8, 0.6, 0}; }

const std::string kBlock = "meshes = [{ mesh = \"block\" }]";
// A face of a block, or a side of a rectangle.
Struck face_of(int dimension, const std::string& name, Real mass) {
  if (dimension == 3) return {name, 3, mass, {0.08, 0.05, 0.05}, {0, 0, 1}, kBlock};
  return {name, 2, mass, {0.15, 0.06, 0}, {1, 0, 0}, kBlock};
}
Struck corner_of(int dimension, const std::string& name, Real mass) {
  return {name, dimension, mass, {0.15, 0.1, dimension == 3 ? 0.05 : 0}, oblique(dimension), kBlock};
}

// The body is at rest, and a particle of mass 1 or another body comes; or it comes to a wall.
enum class Partner { particle, body, wall };
struct Impact {
  std::string name;
  Struck body;
  Partner partner;
  std::string method;
  std::string law = "stiffness = 1e8", materials = "";
  Real mass = 1;  // of the particle or the other body [kg]

  int dimension() const { return body.dimension; }
  Vec3 normal() const { return body.axes() * body.normal; }
  // Both bodies have the same orientation.
  Struck other() const { return shape_of(dimension(), "other", mass, -body.normal); }
};

// gap: between the surfaces at the start [m].
std::string deck_of(const Impact& of, Real gap, Real step, Real end) {
  const int d = of.dimension();
  const Vec3 normal = of.normal();
  const auto vector = [&](Vec3 v) { return text(v, d); };
  std::string deck = fmt::format(
      "[space]\ndimension = {}\nmin = {}\nmax = {}\n[time]\nend = {:.17g}\nstep = {:.17g}\ncontrol = "
      "\"fixed\"\n[integrator]\nparticles = \"{}\"\n[contact]\nskin = "
      "0.01\n[[contact.pairs]]\n{}\nrestitution "
      "= {}\nlimit_damping = false\n[output]\nhistory_interval = {:.17g}\n",
      d, vector({-2, -2, -2}), vector({2, 2, 2}), end, step, of.method, of.law, kRestitution, end);
  if (of.body.shape == kBlock)
    deck += d == 3 ? "[[meshes]]\nname = \"block\"\nkind = \"box\"\nsize = [0.3, 0.2, 0.1]\n"
                   : "[[meshes]]\nname = \"block\"\nkind = \"line\"\nclosed = true\npoints = [[-0.15, -0.1], "
                     "[0.15, -0.1], [0.15, 0.1], [-0.15, 0.1]]\n";
  deck += of.materials + of.body.table({}, of.partner == Partner::wall ? kSpeed * normal : Vec3{});
  switch (of.partner) {
    case Partner::particle:
      return deck + fmt::format(
                        "[[particles]]\nname = \"grain\"\nkind = \"list\"\npositions = [{}]\nvelocity = "
                        "{}\nradius = {}\nmass = {:.17g}\n",
                        vector((kSize + gap) * normal), vector(-kSpeed * normal), kSize, of.mass);
    case Partner::body:
      return deck + of.other().table(gap * normal, -kSpeed * normal);
    case Partner::wall:
      return deck + fmt::format("[[walls]]\nname = \"wall\"\npoint = {}\nnormal = {}\n", vector(gap * normal),
                                vector(-normal));
  }
  return deck;
}

// Velocity at which the partner leaves the body at the contact, over the approach speed.
Real rebound(const Impact& of, const SimulationRun& run) {
  const std::vector<BodyMotion> bodies = run.multibody().motion(run.bodies());
  Vec3 partner;
  if (of.partner == Partner::particle) partner = run.particles()[0].velocity;
  if (of.partner == Partner::body) partner = point_motion(bodies[1], of.other().at).velocity;
  return dot(of.normal(), partner - point_motion(bodies[0], of.body.at).velocity) / kSpeed;
}

// Error of the restitution in steps of the contact time over `parts`.
Real error_of(const Impact& of, Real parts) {
  const Model any = model_of(deck_of(of, 1e-6, 1e-6, 1e-5));
  Real softness = of.body.mobility(any);
  if (of.partner == Partner::particle) softness += 1 / of.mass;
  if (of.partner == Partner::body) softness += of.other().mobility(any);
  const PairSize size{kSize, kInfinity, 1 / softness, kInfinity};
  const Real touch = impact_time(law_of_size(any.contact.laws[0], size), 1 / softness, kSpeed),
             h = touch / parts;
  SimulationRun run(model_of(deck_of(of, 0.3 * h * kSpeed, h, 2 * touch)));
  run.run();
  REQUIRE(run.particle_ledger().contacts == 0);
  return rebound(of, run) - kRestitution;
}

std::vector<Impact> impacts(int dimension, const std::string& method, Real mass) {
  const Vec3 normal = oblique(dimension);
  const Struck shape = shape_of(dimension, "body", mass, normal), face = face_of(dimension, "body", mass),
               corner = corner_of(dimension, "body", mass);
  return {{"particle on shape", shape, Partner::particle, method},
          {"particle on mesh", face, Partner::particle, method},
          {"shape on shape", shape, Partner::body, method},
          {"shape on mesh", face, Partner::body, method},
          {"shape on wall", shape, Partner::wall, method},
          {"corner on wall", corner, Partner::wall, method}};
}

}  // namespace

TEST_CASE("a free body of any mass rebounds with the pair's restitution, wherever it is hit") {
  for (const int dimension : {2, 3})
    for (const std::string method : {"velocity-verlet", "hht"})
      for (const Real ratio : {0.05, 0.2, 1.0, 5.0})
        for (const Impact& impact : impacts(dimension, method, 1 / ratio)) {
          CAPTURE(dimension, method, ratio, impact.name);
          CHECK(keeps(error_of(impact, method == "hht" ? 200 : 1000), {.promise = 1e-3, .measured = 2.7e-4}));
        }
}

TEST_CASE("so it does by a power law, and by Hertz's law") {
  for (const std::string method : {"velocity-verlet", "hht"})
    for (const bool hertz : {false, true})
      for (Impact impact : impacts(3, method, 5)) {
        impact.law = hertz ? "" : "stiffness = 1e9\nexponent = 1.5";
        if (hertz)
          impact.materials = "[[materials]]\nname = \"default\"\nyoung_modulus = 1e10\npoisson_ratio = 0.2\n";
        CAPTURE(method, hertz, impact.name);
        CHECK(keeps(error_of(impact, method == "hht" ? 800 : 1000), {.promise = 1e-3, .measured = 3e-4}));
      }
}

// It cannot move along z: for a surface with the normal n its effective mass is M / (n_x^2 + n_y^2).
TEST_CASE("a planar body in space rebounds so from walls and bodies across its plane") {
  const Vec3 normal{0.6, 0, 0.8};
  for (const bool meets_body : {false, true}) {
    CAPTURE(meets_body);
    const auto body = [&](const std::string& name, Vec3 at, Real speed) {
      return fmt::format(
          "[[bodies]]\nname = \"{}\"\nkind = \"planar\"\nposition = {}\nvelocity = [{}, 0.0, 0.0]\nmass = "
          "1.0\ninertia = 0.002\nshapes = [{{ radius = {} }}]\n",
          name, text(at), speed, kSize);
    };
    SimulationRun run(model_of(
        "[space]\ndimension = 3\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\n[time]\nend = 0.04\nstep = "
        "2e-6\ncontrol = \"fixed\"\n[integrator]\nparticles = \"velocity-verlet\"\n[[contact.pairs]]\n"
        "stiffness = 1e6\nrestitution = 0.5\nlimit_damping = false\n[output]\nhistory_interval = 0.04\n" +
        body("light", (meets_body ? 2 * kSize + 1e-5 : kSize + 1e-5) * normal, -kSpeed) +
        (meets_body
             ? body("other", {}, 0)
             : fmt::format("[[walls]]\nname = \"wall\"\npoint = [0, 0, 0]\nnormal = {}\n", text(normal)))));
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    const std::vector<BodyMotion> bodies = run.multibody().motion(run.bodies());
    const Real left = point_motion(bodies[0], {}).velocity.x,
               right = meets_body ? point_motion(bodies[1], {}).velocity.x : 0;
    CHECK(std::abs((left - right) / kSpeed - kRestitution) < 2e-3);
  }
}

}  // namespace scree
