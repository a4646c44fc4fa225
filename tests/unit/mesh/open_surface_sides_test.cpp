// A contact with an open surface keeps the side on which it began, and pushes to that side until it ends.
#include "mesh/open_surface_sides.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 1;

// A sphere that penetrates an open surface.
class Passage {
 public:
  explicit Passage(const SurfaceMesh& mesh) : mesh_(mesh) {}

  // Contacts with the centre at c.
  const std::vector<MeshContact>& at(Vec3 c) {
    contacts_ = contacts_at(mesh_, c, kRadius);
    contacts_.resize(static_cast<std::size_t>(
        SideTracker(mesh_.view(), c, sides_).keep(contacts_.data(), static_cast<int>(contacts_.size()))));
    sides_ = {};
    for (const MeshContact& contact : contacts_) sides_.add(side_feature(mesh_.view(), contact));
    return contacts_;
  }
  // Contacts after a path from `from` to `to` in small steps.
  const std::vector<MeshContact>& go(Vec3 from, Vec3 to) {
    for (int k = 1; k < 200; ++k) at(from + (k / 200.0) * (to - from));
    return at(to);
  }
  Vec3 force() const {  // sum of forces over the stiffness [m]
    Vec3 sum;
    for (const MeshContact& contact : contacts_) sum += (kRadius - contact.distance) * contact.normal;
    return sum;
  }

 private:
  const SurfaceMesh& mesh_;
  PreviousSides sides_;
  std::vector<MeshContact> contacts_;
};

// 4 m wide, its free edge along the y axis at x = 0.
SurfaceMesh half_plane() { return sheet_mesh(plate({-4, -2, 0}, {4, 0, 0}, {0, 4, 0}, 5, 5)); }

// A sphere without its pole, which makes it an open surface: facets, edges and corners of one smooth patch.
SurfaceMesh dome(Real radius, bool inwards) {
  TriangleMesh mesh = icosphere(3, radius);
  std::erase_if(mesh.triangles, [&](const auto& t) { return mesh.vertices[t[0]].z < -0.9 * radius; });
  return sheet_mesh(welded(inwards ? flipped(mesh) : mesh));
}

}  // namespace

TEST_CASE("beyond a flat open surface the distance becomes negative, from either side, down to a radius") {
  const SurfaceMesh plane = half_plane();
  for (const Real side : {1, -1}) {
    Passage passage(plane);
    for (Real height = 0.99; height > -0.99; height -= 0.01) {
      const auto& contacts = passage.at({-1.5, 0.1 * height, side * height});
      REQUIRE(contacts.size() == 1);
      CHECK(near(contacts[0].distance, height, {.absolute = 1e-15}));
      CHECK(contacts[0].normal == Vec3{0, 0, side});
    }
    CHECK(passage.at({-1.5, 0, -1.01 * side}).empty());
    // A contact that begins now is on the other side.
    CHECK(near(passage.at({-1.5, 0, -0.9 * side})[0].distance, 0.9, {.absolute = 1e-15}));
  }
}

TEST_CASE("beyond facets, edges and corners of a smooth open surface the force has a potential") {
  constexpr Real kDome = 4, kSag = 0.02;
  MeshRandom random(7);
  for (const bool inwards : {false, true}) {
    const SurfaceMesh mesh = dome(kDome, inwards);
    for (int walk = 0; walk < 40; ++walk) {
      const Real side = walk % 2 == 0 ? 1 : -1;  // outside or inside
      Vec3 out = random.direction();
      out.z = std::abs(out.z);
      Passage passage(mesh);
      Vec3 c = (kDome + side * 0.95) * out, force;
      Real work = 0, energy = 0;
      const auto query = [&](Vec3 at) {
        const auto& contacts = passage.at(at);
        REQUIRE(contacts.size() == 1);
        CHECK(near(contacts[0].distance, side * (norm(at) - kDome), {.absolute = kSag}));
        CHECK(side * dot(contacts[0].normal, at) > 0.95 * norm(at));
        energy = std::pow(kRadius - contacts[0].distance, 2) / 2;
        return passage.force();
      };
      force = query(c);
      const Real start = energy;
      for (int k = 0; k < 400; ++k) {
        const Vec3 next =
            (kDome + side * (0.95 * std::cos(k / 40.0))) * unit_normal(c + 0.02 * random.direction());
        const Vec3 then = query(next);
        work += dot(Real(0.5) * (force + then), next - c);
        c = next, force = then;
      }
      CHECK(near(energy - start, -work, {.absolute = 0.02}));
    }
  }
}

TEST_CASE(
    "a sphere that goes round a free edge is on the other side there, and can be pressed through again") {
  const SurfaceMesh plane = half_plane();
  Passage passage(plane);
  for (Real angle = 0; angle < M_PI; angle += 0.01) {  // from above to below
    const Vec3 out{0.6 * std::sin(angle), 0, 0.6 * std::cos(angle)};
    const auto& contacts = passage.at(out);
    REQUIRE(contacts.size() == 1);
    CHECK(near(contacts[0].distance, 0.6, {.absolute = 1e-14}));
    CHECK(near(contacts[0].normal, (1 / 0.6) * out, {.absolute = 1e-14}));
  }
  CHECK(near(passage.go({0, 0, -0.6}, {-1, 0, -0.6})[0].distance, 0.6, {.absolute = 1e-14}));
  const auto& up = passage.go({-1, 0, -0.6}, {-1, 0, 0.5});
  CHECK(near(up[0].distance, -0.5, {.absolute = 1e-14}));
  CHECK(up[0].normal == Vec3{0, 0, -1});
  // Beyond the surface and past its free edge the sphere touches the edge, whatever its path was.
  const auto& beside = passage.go({-1, 0, 0.5}, {0.3, 0, 0.4});
  REQUIRE(beside.size() == 1);
  CHECK(near(beside[0].distance, 0.5, {.absolute = 1e-14}));
  CHECK(near(beside[0].normal, {0.6, 0, 0.8}, {.absolute = 1e-14}));
  CHECK(near(passage.go({0.3, 0, 0.4}, {-1, 0, 0.4})[0].distance, 0.4, {.absolute = 1e-14}));
}

TEST_CASE("past one face of a roof the other does not act from within, and takes over at the ridge") {
  for (const Real turn : {0.4, 1.0, 2.0}) {  // of one patch, and of two
    CAPTURE(turn);
    const Vec3 left{-4 * std::cos(turn / 2), 0, -4 * std::sin(turn / 2)}, right{-left.x, 0, left.z};
    const SurfaceMesh roof = sheet_mesh(strip({left, {0, 0, 0}, right}, 4, 4));
    const Vec3 normal{-std::sin(turn / 2), 0, std::cos(turn / 2)};  // of the left face
    Passage passage(roof);
    const Vec3 on_left = Real(0.5) * left + Vec3{0, 1.9, 0};
    passage.go(on_left + 0.9 * normal, on_left - 0.1 * normal);
    Vec3 c = on_left - 0.1 * normal;
    for (const Real x : {-0.2, 0.2, -0.2}) {  // inside the roof, just below it
      const Vec3 from = std::exchange(c, {x, 1.9, -std::tan(turn / 2) * 0.2 - 0.1});
      const auto& contacts = passage.go(from, c);
      REQUIRE(contacts.size() == 1);
      CHECK(contacts[0].distance < 0);
      CHECK(contacts[0].normal.x * x > 0);
      CHECK(contacts[0].normal.z > 0);
    }
  }
}

TEST_CASE("a sphere in a slot that is pressed through one wall is still beside the other") {
  TriangleMesh walls = plate({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 3, 3);
  append(walls, plate({-2, -2, 1.5}, {4, 0, 0}, {0, 4, 0}, 3, 3));
  const SurfaceMesh slot = sheet_mesh(walls);
  Passage passage(slot);
  CHECK(passage.go({0.1, 0, 3}, {0.1, 0, 2}).size() == 1);
  const auto& between = passage.go({0.1, 0, 2}, {0.1, 0, 0.8});
  REQUIRE(between.size() == 2);
  CHECK(near(passage.force(), {0, 0, (1 + 0.7) + (1 - 0.8)}, {.absolute = 1e-14}));
}

}  // namespace scree
