// Small mesh files, as bytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

struct MeshFile {
  std::string name, bytes;
  bool single = false;  // whether its numbers have 24 bits
};

template <class Number>
std::string bytes_of(Number number, bool high_byte_first = false) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  if (high_byte_first) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// The tetrahedron of all files: its corners, and its faces seen from outside.
inline constexpr double kCorners[4][3] = {{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

inline std::string corner_text(int corner) {
  std::string text;
  for (const double x : kCorners[corner]) text += x == 0.1 ? " 0.1" : x == 0 ? " 0" : " 1";
  return text;
}

inline std::string ascii_stl() {
  std::string text = "solid a cut corner\n";
  for (const auto& face : kFaces) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const int corner : face) text += "      vertex" + corner_text(corner) + "\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a cut corner\n";
}

inline std::string binary_stl(std::string header = "made by hand") {
  header.resize(80, ' ');
  std::string bytes = header + bytes_of(std::uint32_t(4));
  for (const auto& face : kFaces) {
    bytes += std::string(12, '\0');
    for (const int corner : face)
      for (const double x : kCorners[corner]) bytes += bytes_of(static_cast<float>(x));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline std::string obj() {
  std::string text = "# a cut corner\no corner\n";
  for (int corner = 0; corner < 4; ++corner) text += "v" + corner_text(corner) + "\n";
  for (const auto& face : kFaces) {
    text += "f";
    for (const int corner : face) text += " " + std::to_string(corner + 1);
    text += "\n";
  }
  return text;
}

inline std::string ply_header(const std::string& format, const std::string& type) {
  return "ply\nformat " + format + " 1.0\ncomment a cut corner\nelement vertex 4\nproperty " + type +
         " x\nproperty " + type + " y\nproperty " + type +
         " z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string ascii_ply() {
  std::string text = ply_header("ascii", "double");
  for (int corner = 0; corner < 4; ++corner) text += corner_text(corner).substr(1) + "\n";
  for (const auto& face : kFaces) {
    text += "3";
    for (const int corner : face) text += " " + std::to_string(corner);
    text += "\n";
  }
  return text;
}

template <class Number>
std::string binary_ply(const std::string& type, bool high_byte_first) {
  std::string bytes = ply_header(high_byte_first ? "binary_big_endian" : "binary_little_endian", type);
  for (const auto& corner : kCorners)
    for (const double x : corner) bytes += bytes_of(static_cast<Number>(x), high_byte_first);
  for (const auto& face : kFaces) {
    bytes += '\3';
    for (const std::int32_t corner : face) bytes += bytes_of(corner, high_byte_first);
  }
  return bytes;
}

inline std::vector<MeshFile> tetrahedron_files() {
  return {{"ascii.stl", ascii_stl()},
          {"binary.stl", binary_stl(), true},
          {"solid.stl", binary_stl("solid, says the header, but binary"), true},
          {"text.obj", obj()},
          {"ascii.ply", ascii_ply()},
          {"double.ply", binary_ply<double>("double", false)},
          {"turned.ply", binary_ply<double>("float64", true)},
          {"float.ply", binary_ply<float>("float", false), true}};
}

// Further features of the formats: a prism over an L with faces of four and six corners, with negative
// indices and with texture and normals; a cube of squares with elements and lists that the reader skips.
inline std::vector<MeshFile> polygon_files() {
  std::string l = "mtllib l.mtl\ng l\n", prism;
  for (const char* const z : {" 0\n", " 1\n"})
    for (const char* const xy : {"0 0", "2 0", "2 1", "1 1", "1 2", "0 2"}) l += std::string("v ") + xy + z;
  l += "vt 0 0\nvn 0 0 1\nf 6/1/1 5/1/1 4//1 3//1 2/1 1 # below\nf -6 -5 -4 \\\n -3 -2 -1\n";
  for (int k = 1; k <= 6; ++k) {
    const int next = k % 6 + 1;
    for (const int corner : {k, next, next + 6, k + 6})
      prism += (corner == k ? "f " : " ") + std::to_string(corner);
    prism += "\n";
  }
  std::string cube =
      "ply\nformat binary_big_endian 1.0\nobj_info none\nelement vertex 8\nproperty short x\nproperty int8 "
      "y\n"
      "property list uchar ushort w\nproperty uint32 z\nelement face 6\nproperty float32 quality\n"
      "property list int uint16 vertex_index\nelement edge 1\nproperty double a\nend_header\n";
  for (int k = 0; k < 8; ++k) {
    cube += bytes_of(std::int16_t(k % 2), true) + bytes_of(std::int8_t(k / 2 % 2)) + '\1' +
            bytes_of(std::uint16_t(k));
    cube += bytes_of(std::uint32_t(k / 4), true);
  }
  constexpr std::uint16_t kSquares[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& square : kSquares) {
    cube += bytes_of(0.5f, true) + bytes_of(std::int32_t(4), true);
    for (const std::uint16_t corner : square) cube += bytes_of(corner, true);
  }
  return {{"l.obj", l + prism}, {"cube.ply", cube + bytes_of(1.0)}};
}

}  // namespace scree
