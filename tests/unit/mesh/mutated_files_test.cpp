// Random changes of files of every format: each file is read or refused, and every mesh that is read is
// checked and its mass computed. SCREE_MUTATIONS: number of files (200,000); SCREE_SEED: seed of the first.
#include <cstdlib>
#include <random>

#include "base/error.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_repair.hpp"
#include "mesh/read_mesh.hpp"
#include "mesh/weld.hpp"
#include "mesh_files.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

std::uint32_t from_environment(const char* name, std::uint32_t otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr ? otherwise : static_cast<std::uint32_t>(std::strtoul(value, nullptr, 10));
}

// Parts of headers, counts and numbers of all formats, and limits of numbers.
const std::vector<std::string> kWords{"2147483647",
                                      "2147483648",
                                      "4294967295",
                                      "99999999999999999999",
                                      "-1",
                                      "0",
                                      "3",
                                      "nan",
                                      "inf",
                                      "1e999",
                                      "1e-999",
                                      "-0",
                                      "solid",
                                      "facet",
                                      "endsolid",
                                      "vertex",
                                      "ply",
                                      "element vertex 4",
                                      "property list uchar int vertex_indices",
                                      "property list int float a",
                                      "property double x",
                                      "format ascii 1.0",
                                      "format binary_big_endian 1.0",
                                      "end_header",
                                      "v",
                                      "f 1 2 3 4",
                                      "l",
                                      "#",
                                      "\\\n",
                                      "\n",
                                      " ",
                                      "/",
                                      std::string(1, '\0'),
                                      "\x7f\xff\xff\xff",
                                      "\xff\xff\xff\xff"};

class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  std::string of(std::string bytes) {
    for (std::size_t k = below(5); k < 5; ++k) change(bytes);
    return bytes;
  }
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

 private:
  void change(std::string& bytes) {
    const std::size_t at = below(bytes.size() + 1), length = below(12);
    const std::string& word = kWords[below(kWords.size())];
    switch (below(8)) {
      case 0:
        bytes.insert(at, word);
        break;
      case 1:
        bytes.replace(at, word.size(), word);
        break;  // as in a binary count
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size() + 1), length));
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5:
        replace_number(bytes, at, word);
        break;
      case 6:
        bytes.replace(std::min<std::size_t>(bytes.size(), 80), 4, word);
        break;  // the count of binary STL
      case 7:
        if (at < bytes.size()) bytes[at] = static_cast<char>(random_());
        break;
    }
  }
  static void replace_number(std::string& bytes, std::size_t at, const std::string& word) {
    const std::size_t first = bytes.find_first_of("0123456789", at);
    if (first == std::string::npos) return;
    const std::size_t last = bytes.find_first_not_of("0123456789.", first);
    bytes.replace(first, std::min(last, bytes.size()) - first, word);
  }

  std::mt19937 random_;
};

// A repaired mesh needs no further repair.
void check_repair(const NumberedMesh& mesh, bool sheet) {
  if (!mesh_defects(mesh.mesh, sheet).empty()) return;
  if (!sheet && !(mesh_volume(mesh.mesh) > 0)) throw std::logic_error("not sound");
  if (!repair_text(repaired(mesh, sheet), sheet).empty()) throw std::logic_error("not put right");
}

// Whether the file is read.
bool is_read(const std::string& bytes, const std::string& name) {
  try {
    const TriangleMesh read = parse_mesh(bytes, name);
    if (read.triangles.size() > bytes.size() || read.vertices.size() > bytes.size())
      throw std::logic_error("too much");
    for (const auto& triangle : read.triangles)
      for (const Index corner : triangle)
        if (!is_finite(read.vertices.at(static_cast<std::size_t>(corner))))
          throw std::logic_error("not finite");
    for (const bool sheet : {false, true}) check_repair(repaired(numbered(welded(read)), sheet).mesh, sheet);
    return true;
  } catch (const InputError& error) {
    if (!std::string(error.what()).starts_with(name + ":")) throw std::logic_error(error.what());
    return false;
  }
}

}  // namespace

TEST_CASE("files changed at random are read or refused") {
  std::vector<MeshFile> files = tetrahedron_files();
  for (const MeshFile& file : polygon_files()) files.push_back(file);
  const std::uint32_t count = from_environment("SCREE_MUTATIONS", 200'000),
                      seed = from_environment("SCREE_SEED", 1);
  std::vector<std::size_t> read(files.size()), refused(files.size());
  for (std::uint32_t i = seed; i < seed + count; ++i) {
    const std::size_t format = i % files.size();
    INFO("SCREE_SEED=" << i << " SCREE_MUTATIONS=1");
    Mutator mutator(i);
    ++(is_read(mutator.of(files[format].bytes), files[format].name) ? read : refused)[format];
  }
  for (std::size_t k = 0; k < files.size() && count > 1000; ++k) {
    CAPTURE(files[k].name, read[k], refused[k]);
    CHECK(read[k] > count / files.size() / 100);
    CHECK(refused[k] > count / files.size() / 100);
  }
}

}  // namespace scree
