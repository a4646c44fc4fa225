#include "mesh/read_mesh.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "mesh/mesh_formats.hpp"
#include "mesh/token_reader.hpp"

namespace scree {

namespace {

// No format has more vertices or triangles than bytes: below this size an Index counts them.
constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 31;

std::string contents(const std::string& path) {
  if (const std::string trouble = input_file_error(path); !trouble.empty())
    throw IoError(fmt::format("{}: {}", path, trouble));
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw IoError(fmt::format("{}: cannot be read: {}", path, error.message()));
  if (size == 0) throw InputError(path + ": is empty");
  if (size >= kMostBytes)
    throw InputError(fmt::format("{}: {} bytes; must be less than {}", path, size, kMostBytes));
  std::string bytes(size, '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw IoError(fmt::format("{}: cannot be read to its end: {}", path, std::strerror(errno)));
  return bytes;
}

}  // namespace

TriangleMesh parse_mesh(std::string_view bytes, const std::string& path) {
  using Parse = TriangleMesh (*)(std::string_view, const std::string&);
  const std::string suffix = lower(std::filesystem::path(path).extension().string());
  const Parse parse = suffix == ".stl"   ? parse_stl
                      : suffix == ".obj" ? parse_obj
                      : suffix == ".ply" ? parse_ply
                                         : nullptr;
  if (parse == nullptr) throw InputError(path + ": must end with .stl, .obj or .ply");
  TriangleMesh mesh = parse(bytes, path);
  if (mesh.triangles.empty()) throw InputError(path + ": has no triangles");
  return mesh;
}

TriangleMesh read_mesh(const std::string& path) { return parse_mesh(contents(path), path); }

}  // namespace scree
