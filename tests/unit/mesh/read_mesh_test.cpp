// Meshes from files: the three formats, and what is said of broken ones.
#include "mesh/read_mesh.hpp"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/weld.hpp"
#include "support/catch.hpp"
#include "unit/mesh/mesh_files.hpp"

namespace scree {

namespace {

// The message with which the text is refused; "": it is read.
std::string refusal(const std::string& bytes, const std::string& name) {
  try {
    parse_mesh(bytes, name);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void check_tetrahedron(const TriangleMesh& read) {
  const TriangleMesh mesh = welded(read);
  CHECK(mesh.vertices.size() == 4);
  CHECK(mesh.triangles.size() == 4);
  for (const std::string& trouble : mesh_troubles(mesh, false)) FAIL_CHECK(trouble);
}

}  // namespace

TEST_CASE("one tetrahedron in every format") {
  for (const MeshFile& file : tetrahedron_files()) {
    CAPTURE(file.name);
    check_tetrahedron(parse_mesh(file.bytes, file.name));
  }
}

TEST_CASE("decimal numbers become the nearest double") {
  for (const MeshFile& file : tetrahedron_files()) {
    CAPTURE(file.name);
    const TriangleMesh mesh = parse_mesh(file.bytes, file.name);
    CHECK(mesh.vertices[mesh.triangles[0][0]].x == (file.single ? Real(0.1f) : 0.1));
  }
}

}  // namespace scree
