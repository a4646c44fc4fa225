#include "mesh/read_mesh.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"

namespace scree {

namespace {

std::string suffix_of(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (suffix == ".stl" || suffix == ".obj" || suffix == ".ply") return suffix.substr(1);
  throw InputError(path + ": must end with .stl, .obj or .ply");
}

std::string contents(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw IoError(path + ": is a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(fmt::format("{}: {}", path, std::strerror(errno)));
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  if (file.bad()) throw IoError(path + ": cannot be read");
  if (bytes.empty()) throw InputError(path + ": is empty");
  return bytes;
}

void append(const aiMesh& from, TriangleMesh& mesh) {
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (unsigned i = 0; i < from.mNumVertices; ++i)
    mesh.vertices.push_back({from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z});
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;
    mesh.triangles.push_back({first + static_cast<Index>(face.mIndices[0]),
                              first + static_cast<Index>(face.mIndices[1]),
                              first + static_cast<Index>(face.mIndices[2])});
  }
}

}  // namespace

TriangleMesh read_mesh(const std::string& path) {
  const std::string suffix = suffix_of(path), bytes = contents(path);
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, suffix.c_str());
  if (scene == nullptr) throw InputError(fmt::format("{}: {}", path, importer.GetErrorString()));
  TriangleMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(*scene->mMeshes[i], mesh);
  if (mesh.triangles.empty()) throw InputError(path + ": has no triangles");
  return mesh;
}

}  // namespace scree
