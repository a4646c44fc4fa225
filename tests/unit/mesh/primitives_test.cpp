// Surfaces made from numbers: sound, and as heavy as the shapes that they stand for.
#include "mesh/primitives.hpp"

#include <functional>
#include <numbers>

#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/weld.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

void check_sound(const TriangleMesh& mesh, bool sheet = false, Index shells = 1) {
  for (const std::string& trouble : mesh_troubles(mesh, sheet)) FAIL_CHECK(trouble);
  const TriangleMesh again = welded(mesh);
  CHECK(again.vertices.size() == mesh.vertices.size());
  const std::vector<Index> shell = shells_of(mesh);
  CHECK(*std::max_element(shell.begin(), shell.end()) == shells - 1);
}

// A shape with its resolution, against what its exact form has.
struct Case {
  const char* name;
  std::function<TriangleMesh(Index)> mesh;  // of n segments around
  Real volume;
  Sym3 inertia;  // of density 1, about the centre of mass
  Vec3 center;
};

}  // namespace

TEST_CASE("a box and a plate are exact") {
  const TriangleMesh box = box_mesh({{1, 2, 3}});
  check_sound(box);
  CHECK(box.triangles.size() == 12);
  CHECK(mesh_volume(box) == 6);
  CHECK(mesh_area(box) == 22);
}

TEST_CASE("primitives are closed") {
  check_sound(cylinder_mesh({0.5, 2, 3}));
  check_sound(cylinder_mesh({0.5, 2, 24}));
  check_sound(cone_mesh({1, 0, 2, 17}));
  check_sound(cone_mesh({1, 0.3, 2, 17}));
  check_sound(cone_mesh({0.2, 1, 2, 17}));
  for (int levels = 0; levels < 4; ++levels) check_sound(sphere_mesh({0.7, levels}));
  check_sound(capsule_mesh({0.3, 1, 4}));
  check_sound(capsule_mesh({0.3, 1, 16}));
  check_sound(plate_mesh({{2, 1, 0.1}, 0.3, 24}));
  check_sound(pipe_mesh({0.8, 1, 3, 12}));
  check_sound(rectangle_mesh(2, 3), true);
  check_sound(extruded_line_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, true, 0.3), true);
  for (const Index lifters : {0, 1, 2, 3, 8})
    for (const Real end_wall : {0., 0.1})  // closed, it has a cavity
      check_sound(drum_mesh({1, 0.05, 2, end_wall, lifters, 0.2, 0.1, 36}), false, end_wall > 0 ? 2 : 1);
  for (const Real pitch : {0.5, -0.4})
    for (const Real core_length : {1.5, 2.})
      check_sound(screw_mesh({0.1, 0.4, pitch, 0.05, 1.5, core_length, 24}));
}

}  // namespace scree
