// Surfaces beyond open sides, and particles that escape there.
#include "run/report/surfaces_outside.hpp"

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

const std::string kDisc = kSmallDeck + R"([[contact.pairs]]
stiffness = 1e5
[[bodies]]
name = "disc"
mass = 1.0
inertia = 0.01
position = [0.5, 0.0]
shapes = [{ radius = 0.1, offset = [0.3, 0.0] }]
[[particles]]
kind = "list"
positions = [[-0.5, 0.0]]
radius = 0.02
mass = 1.0
)";
const std::string kDrift = "space.leaving=ballistic";

std::string at_start(const std::vector<std::string>& overrides, const std::string& leaving = kDrift) {
  std::vector<std::string> all = overrides;
  all.push_back(leaving);
  return outside_at_start(model_of(kDisc, all));
}

// Message on one particle that escapes there while the disc is static at its position.
std::string escaping_at(Vec3 position, std::vector<std::string> overrides) {
  overrides.push_back(kDrift);
  const Model model = model_of(kDisc, overrides);
  const std::vector<BodyMotion> motion{start_motion(model.bodies.front())};
  EscapedParticle escaped_particle{};
  escaped_particle.global_id = 7, escaped_particle.position = position;
  return SurfacesOutside(model).warning(std::span(&escaped_particle, 1), motion, 0.5);
}

}  // namespace

TEST_CASE("shapes beyond open sides are warned of, those in periodic space and inside are not") {
  CHECK(at_start({}).empty());
  CHECK(contains(at_start({"bodies.disc.position=[0.65,0]"}), "body \"disc\" reaches beyond an open side"));
  CHECK(at_start({"bodies.disc.position=[0.65,0]", "space.x_min=periodic", "space.x_max=periodic"}).empty());
  CHECK(contains(at_start({"bodies.disc.position=[0.65,0]"}, "space.leaving=remove"), "are removed"));
  CHECK(at_start({"bodies.disc.position=[0.65,0]", "bodies.disc.angle=3.14159"}).empty());
  CHECK(at_start({"bodies.disc.position=[0.65,0]"}, "space.leaving=error").empty());
}

TEST_CASE("walls of triangles whose motion crosses an open side are warned of, whatever their rotation") {
  const std::string line = "meshes=[{name='line',kind='line',points=[[-0.1,0.0],[0.1,0.0]]}]";
  for (const char* frequency : {"0.75", "3", "50", "100", "400"}) {
    CAPTURE(frequency);
    const auto with = [&](const std::string& amplitude) {
      return at_start({line,
                       "walls=[{name='lid',mesh='line',motions=[{type='translation',direction=[0,1],"
                       "displacement={kind='sine',amplitude=" +
                           amplitude + ",frequency=" + frequency + "}}]}]"});
    };
    CHECK(contains(with("1.3"), "wall \"lid\""));
    CHECK(with("0.9").empty());
  }
}

TEST_CASE("a particle leaves at surfaces where it is in their box or beside it, in any image") {
  const std::vector<std::string> right = {"bodies.disc.position=[0.65,0]"};
  CHECK(contains(escaping_at({1.02, 0, 0}, right),
                 "particle 7 leaves the domain at t = 0.5 s at the surfaces of body \"disc\""));
  CHECK(contains(escaping_at({1.02, 0.13, 0}, right), "particle 7"));
  CHECK(escaping_at({1.02, 0.15, 0}, right).empty());
  CHECK(escaping_at({-1.02, 0, 0}, right).empty());
  CHECK(escaping_at({1.02, 0, 0}, {"bodies.disc.position=[0.55,0]"}).empty());  // the disc is inside
  const std::string walls = "space={dimension=2,min=[-1,-1],max=[1,1],y_min=\"periodic\",y_max=\"periodic\"}";
  CHECK(contains(escaping_at({1.02, 4, 0}, {walls, "bodies.disc.position=[0.65,0]"}), "particle 7"));
  CHECK(escaping_at({1.02, 5, 0}, {walls, "bodies.disc.position=[0.65,0]"}).empty());
}

}  // namespace scree
