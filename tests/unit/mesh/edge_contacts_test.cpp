// Edges and corners: the force is k times the overlap along closed paths around them, with no net work.
#include <cmath>
#include <functional>
#include <vector>

#include "mesh/mesh_contacts.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 1;      // of the particle [m]
constexpr Real kDistance = 0.9;  // distance of its centre from the touched feature [m]

// Around the rectangle from (0, 0) to (x, y) at this distance: sides and quarters of circles.
std::vector<Vec3> around_rectangle(Real x, Real y, Real distance) {
  constexpr int kPieces = 100;
  std::vector<Vec3> path;
  const Vec3 corners[] = {{x, 0, 0}, {x, y, 0}, {0, y, 0}, {0, 0, 0}};
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i <= kPieces; ++i) {
      const Real angle = M_PI / 2 * (side - 1 + Real(i) / kPieces);
      path.push_back(corners[side] + distance * Vec3{std::cos(angle), std::sin(angle), 0});
    }
  return path;
}

// Errors along a path at constant distance from a mesh.
struct PathErrors {
  Real force = 0;   // the largest of |force / k| - overlap [m]
  Real work = 0;    // of the force over k along the whole path [m^2]
  int not_one = 0;  // positions without or with several contacts
};

PathErrors errors_along(const SurfaceMesh& mesh, const std::vector<Vec3>& path, const Mat3& turn) {
  PathErrors errors;
  constexpr int kParts =
      20;  // of a piece of the path, so that it also passes close to the borders of regions
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3 from = path[i], to = path[(i + 1) % path.size()];
    const auto contacts = contacts_at(mesh, turn * from, kRadius);
    errors.not_one += contacts.size() != 1;
    if (contacts.size() == 1)
      errors.force = std::max(errors.force, std::abs(contacts[0].distance - kDistance));
    for (int part = 0; part < kParts; ++part) {
      const Vec3 c = from + ((part + 0.5) / kParts) * (to - from);
      errors.not_one += contacts_at(mesh, turn * c, kRadius).size() != 1;
      errors.work += dot(push_on(mesh, turn * c, kRadius), turn * ((1.0 / kParts) * (to - from)));
    }
  }
  return errors;
}

void check(const SurfaceMesh& mesh, const std::vector<Vec3>& path, const Mat3& turn) {
  const PathErrors errors = errors_along(mesh, path, turn);
  CHECK(errors.not_one == 0);
  CHECK(errors.force <= 1e-12 * (kRadius - kDistance));
  CHECK(std::abs(errors.work) < 1e-12 * kRadius * kRadius);
}

std::vector<Vec3> moved(std::vector<Vec3> path, const std::function<Vec3(Vec3)>& move) {
  for (Vec3& p : path) p = move(p);
  return path;
}

}  // namespace

TEST_CASE("around a block the force is k times the overlap, over sides, edges and corners") {
  MeshRandom random(11);
  for (const int n : {1, 3, 8}) {
    const TriangleMesh box = block({0, 0, 0}, {3, 4, 5}, n);
    for (const Mat3& turn : {identity3(), random.turn()}) {
      const SurfaceMesh mesh = closed_mesh(rotated(box, turn));
      const auto level = [&](Real above) {
        const Real across = std::sqrt(kDistance * kDistance - above * above);
        return moved(around_rectangle(3, 4, across), [&](Vec3 p) { return p + Vec3{0, 0, 5 + above}; });
      };
      for (const Real above : {-2.5, -1.0}) {
        const auto path = moved(around_rectangle(3, 4, kDistance), [&](Vec3 p) {
          return p + Vec3{0, 0, 5 + above};
        });
        check(mesh, path, turn);
      }
      for (const Real above : {0.0, 1e-13, 0.3, 0.7}) check(mesh, level(above), turn);
      check(mesh, moved(around_rectangle(4, 5, kDistance), [](Vec3 p) { return Vec3{1.5, p.x, p.y}; }), turn);
    }
  }
}

TEST_CASE("around an open surface's free border the force is k times the overlap") {
  MeshRandom random(12);
  for (const int n : {1, 5}) {
    const TriangleMesh sheet = plate({0, 0, 0}, {3, 0, 0}, {0, 4, 0}, n, n);
    for (const Mat3& turn : {identity3(), random.turn()}) {
      const SurfaceMesh mesh = sheet_mesh(rotated(sheet, turn));
      for (const Real y : {0.0, 0.3, 2.0, 3.2})
        check(mesh,
              moved(around_rectangle(3, 0, kDistance),
                    [&](Vec3 p) {
                      return Vec3{p.x, y, p.y};
                    }),
              turn);
      for (const Real above : {-0.5, 0.0, 0.2})
        check(mesh,
              moved(around_rectangle(3, 4, std::sqrt(kDistance * kDistance - above * above)),
                    [&](Vec3 p) {
                      return p + Vec3{0, 0, above};
                    }),
              turn);
    }
  }
}

TEST_CASE("the nearest point of a block is found, from anywhere outside") {
  const SurfaceMesh mesh = closed_mesh(block({0, 0, 0}, {1, 2, 3}, 2));
  MeshRandom random(13);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 c = random.in({-1, -1, -1}, {2, 3, 4});
    const Vec3 nearest{std::clamp(c.x, 0.0, 1.0), std::clamp(c.y, 0.0, 2.0), std::clamp(c.z, 0.0, 3.0)};
    const Real distance = norm(c - nearest);
    if (distance == 0) continue;
    const auto contacts = contacts_at(mesh, c, 2);
    wrong += contacts.size() != 1 || std::abs(contacts[0].distance - distance) > 1e-14 ||
             norm(contacts[0].distance * contacts[0].normal - (c - nearest)) > 1e-14;
  }
  CHECK(wrong == 0);
}

TEST_CASE("inside a block the nearest side alone pushes outwards") {
  const SurfaceMesh mesh = closed_mesh(block({0, 0, 0}, {1, 2, 3}, 3));
  MeshRandom random(14);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 c = random.in({0, 0, 0}, {1, 2, 3});
    const Real depth = std::min({c.x, c.y, c.z, 1 - c.x, 2 - c.y, 3 - c.z});
    const auto contacts = contacts_at(mesh, c, 1.5);
    wrong += contacts.size() != 1 || std::abs(contacts[0].distance + depth) > 1e-15 ||
             std::abs(dot(c - contacts[0].point, contacts[0].normal) + depth) > 1e-15;
  }
  CHECK(wrong == 0);
}

TEST_CASE("a thin plate pushes to the side of the centre, never from behind") {
  constexpr Real kThickness = 0.01;
  const SurfaceMesh mesh = closed_mesh(block({0, 0, 0}, {5, 5, kThickness}, 2));
  MeshRandom random(15);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 c = random.in({0.1, 0.1, -0.9}, {4.9, 4.9, 0.9});
    const auto contacts = contacts_at(mesh, c, kRadius);
    const bool above = c.z > kThickness / 2;
    const Real height = above ? c.z - kThickness : -c.z;
    wrong += contacts.size() != 1 || std::abs(contacts[0].distance - height) > 1e-15 ||
             contacts[0].normal.z != (above ? 1 : -1);
  }
  CHECK(wrong == 0);
}

}  // namespace scree
