#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "base/error.hpp"
#include "mesh/mesh_formats.hpp"
#include "mesh/token_reader.hpp"

namespace scree {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers of STL files have their low byte first");

// Binary: 80 bytes of any text, the number of triangles, and 50 bytes for each: normal, three corners, two
// bytes.
constexpr std::size_t kHeader = 80, kStart = 84, kTriangle = 50, kNormal = 12;

std::uint64_t binary_count(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kStart) std::memcpy(&count, bytes.data() + kHeader, sizeof count);
  return count;
}

void add_triangle(TriangleMesh& mesh) {
  const Index end = static_cast<Index>(mesh.vertices.size());
  mesh.triangles.push_back({end - 3, end - 2, end - 1});
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& file) {
  const std::uint64_t count = binary_count(bytes);
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    float corners[9];
    std::memcpy(corners, bytes.data() + kStart + i * kTriangle + kNormal, sizeof corners);
    for (int k = 0; k < 9; k += 3) {
      mesh.vertices.push_back({corners[k], corners[k + 1], corners[k + 2]});
      if (!is_finite(mesh.vertices.back()))
        throw InputError(
            fmt::format("{}: triangle {} (from 0): coordinates must be finite numbers", file, i));
    }
    add_triangle(mesh);
  }
  return mesh;
}

class AsciiStl {
 public:
  AsciiStl(std::string_view bytes, const std::string& file) : words_(bytes, file) {}

  TriangleMesh mesh() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (lower(word) != "solid") words_.fail(fmt::format("{}: must be solid", quoted(word)));
      words_.skip_line();  // name of the solid
      while (facet()) {
      }
      words_.skip_line();
    }
    return std::move(mesh_);
  }

 private:
  // False where the solid ends instead.
  bool facet() {
    const std::string_view word = words_.next();
    if (lower(word) == "endsolid") return false;
    check(word, "facet", "facet or endsolid");
    expect("normal");
    for (int k = 0; k < 3; ++k) words_.next();  // normals follow from the corners
    expect("outer");
    expect("loop");
    for (int k = 0; k < 3; ++k) {
      expect("vertex");
      const Real x = words_.number("coordinate"), y = words_.number("coordinate");
      mesh_.vertices.push_back({x, y, words_.number("coordinate")});
    }
    expect("endloop");
    expect("endfacet");
    add_triangle(mesh_);
    return true;
  }
  void expect(const char* demand) { check(words_.next(), demand, demand); }
  void check(std::string_view word, const char* demand, const char* allowed) const {
    if (word.empty()) words_.fail(fmt::format("ends before {}: the file is cut", allowed));
    if (lower(word) != demand) words_.fail(fmt::format("{}: must be {}", quoted(word), allowed));
  }

  TokenReader words_;
  TriangleMesh mesh_;
};

// Whether a file is text, which has no zero byte and begins with the word "solid", as the headers of some
// binary files do.
bool is_ascii(std::string_view bytes) {
  const std::string_view word = TokenReader(bytes, "").next();
  return lower(word) == "solid" && bytes.find('\0') == std::string_view::npos;
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& file) {
  const std::uint64_t count = binary_count(bytes), needed = kStart + kTriangle * count;
  if (bytes.size() >= kStart && bytes.size() == needed) return parse_binary(bytes, file);
  if (is_ascii(bytes)) return AsciiStl(bytes, file).mesh();
  if (bytes.size() < kStart)
    throw InputError(
        fmt::format("{}: is neither text that begins with \"solid\" nor as long as the {} bytes "
                    "that binary STL begins with",
                    file, kStart));
  throw InputError(fmt::format("{}: {} bytes; must be {}, as binary STL with {} triangles{}", file,
                               bytes.size(), needed, count,
                               bytes.size() < needed ? ": the file is cut" : ""));
}

}  // namespace scree
