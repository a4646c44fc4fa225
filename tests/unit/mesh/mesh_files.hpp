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
  bool single = false;  // its numbers have 24 bits
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

}  // namespace scree
