#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/error.hpp"
#include "mesh/mesh_formats.hpp"
#include "mesh/ply_header.hpp"
#include "mesh/polygon.hpp"

namespace scree {

namespace {

// The data after the header, value by value, as text or as bytes. A Real holds the values of every type.
class TextBody {
 public:
  TextBody(const TokenReader& words, std::string_view bytes) : words_(words), bytes_(bytes) {}

  // The largest number of rows for which the rest of the file has room: a digit and a blank per value.
  std::uint64_t rows_that_fit(const PlyElement& element) const {
    return (bytes_.size() - words_.position() + 1) / (2 * element.properties.size());
  }
  void begin_row() { words_.skip_blank_lines(); }
  Real value(const PlyType& type) {
    if (!type.whole) return words_.number("value");
    return static_cast<Real>(words_.to_integer(words_.next_in_line(), "value"));
  }
  void skip(const PlyType&) {
    if (words_.next_in_line().empty()) fail("ends before all values that the header lists");
  }
  void end_row() {
    const std::string_view word = words_.next_in_line();
    if (!word.empty()) fail(fmt::format("{}: more values than the header lists", quoted(word)));
  }
  void end() {
    const std::string_view word = words_.next();
    if (!word.empty()) fail(fmt::format("{}: more rows than the header counts", quoted(word)));
  }
  [[noreturn]] void fail(const std::string& trouble) const { words_.fail(trouble); }

 private:
  TokenReader words_;
  std::string_view bytes_;
};

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, std::size_t first, bool swapped, const std::string& file)
      : bytes_(bytes), at_(first), swapped_(swapped), file_(file) {}

  std::uint64_t rows_that_fit(const PlyElement& element) const {
    std::size_t row = 0;
    for (const PlyProperty& property : element.properties)
      row += (property.count_type != nullptr ? property.count_type : property.type)->bytes;
    return (bytes_.size() - at_) / row;
  }
  void begin_row() {}
  Real value(const PlyType& type) {
    skip(type);
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < type.bytes; ++k) {
      const std::size_t from_end = swapped_ ? type.bytes - k : k + 1;
      bits = bits << 8 | static_cast<unsigned char>(bytes_[at_ - from_end]);
    }
    if (!type.whole)
      return type.bytes == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                             : std::bit_cast<double>(bits);
    const std::size_t unused = 8 * (8 - type.bytes);  // shifted out and back to extend the sign
    if (type.has_sign) return static_cast<Real>(static_cast<std::int64_t>(bits << unused) >> unused);
    return static_cast<Real>(bits);
  }
  void skip(const PlyType& type) {
    if (bytes_.size() - at_ < type.bytes) fail("the file is cut: the header promises more");
    at_ += type.bytes;
  }
  void end_row() {}
  void end() {
    if (at_ < bytes_.size()) fail(fmt::format("{} bytes more than the header counts", bytes_.size() - at_));
  }
  [[noreturn]] void fail(const std::string& trouble) const {
    throw InputError(fmt::format("{}: byte {}: {}", file_, at_, trouble));
  }

 private:
  std::string_view bytes_;
  std::size_t at_;
  bool swapped_;  // most significant byte first
  const std::string& file_;
};

// Reads the rows of all elements. Faces may precede the vertices that they refer to.
template <class Body>
class PlyReader {
 public:
  PlyReader(Body body, const std::string& file) : body_(std::move(body)), file_(file) {}

  TriangleMesh mesh(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      if (static_cast<std::uint64_t>(element.count) > body_.rows_that_fit(element))
        body_.fail(
            fmt::format("{} rows of element {}: the rest of the file has room for {} at most: it is cut, or "
                        "the count is wrong",
                        element.count, quoted(element.name), body_.rows_that_fit(element)));
      rows(element);
    }
    body_.end();
    for (std::size_t first = 0, row = 0; first < corners_.size(); first += sizes_[row++]) face(first, row);
    return std::move(mesh_);
  }

 private:
  void rows(const PlyElement& element) {
    const bool vertex = element.name == "vertex", face = element.name == "face";
    if (vertex) check_vertex(element);
    if (face) check_face(element);
    if (element.name == "tristrips") body_.fail("strips of triangles are not read; must be faces");
    for (std::int64_t row = 0; row < element.count; ++row) {
      body_.begin_row();
      Vec3 vertex_position;
      for (const PlyProperty& property : element.properties) {
        if (property.count_type != nullptr) {
          list(property, face && is_corners(property));
        } else if (Real* const axis = vertex ? axis_of(vertex_position, property.name) : nullptr) {
          *axis = body_.value(*property.type);
        } else {
          body_.skip(*property.type);
        }
      }
      body_.end_row();
      if (vertex && !is_finite(vertex_position))
        body_.fail(fmt::format("vertex {} (from 0): coordinates must be finite", row));
      if (vertex) mesh_.vertices.push_back(vertex_position);
    }
  }
  static Real* axis_of(Vec3& vertex_position, const std::string& name) {
    return name == "x"   ? &vertex_position.x
           : name == "y" ? &vertex_position.y
           : name == "z" ? &vertex_position.z
                         : nullptr;
  }
  static bool is_corners(const PlyProperty& property) {
    return property.name == "vertex_indices" || property.name == "vertex_index";
  }
  void check_vertex(const PlyElement& element) {
    for (const char* const axis : {"x", "y", "z"}) {
      const auto is_axis = [&](const PlyProperty& p) { return p.name == axis && p.count_type == nullptr; };
      if (std::none_of(element.properties.begin(), element.properties.end(), is_axis))
        body_.fail(fmt::format("element vertex must have a property {}", axis));
    }
  }
  void check_face(const PlyElement& element) {
    const auto is_list = [](const PlyProperty& p) {
      return is_corners(p) && p.count_type != nullptr && p.type->whole;
    };
    if (std::count_if(element.properties.begin(), element.properties.end(), is_list) != 1)
      body_.fail("element face must have one list of whole numbers vertex_indices or vertex_index");
  }
  void list(const PlyProperty& property, bool corners) {
    const Real count = body_.value(*property.count_type);
    if (count < 0) body_.fail(fmt::format("a list of {} values; must be at least 0", count));
    if (corners && count < 3) body_.fail(fmt::format("{} corners; a face must have at least 3", count));
    for (Real k = 0; k < count; ++k) {
      if (corners) {
        corners_.push_back(body_.value(*property.type));
      } else {
        body_.skip(*property.type);
      }
    }
    if (corners) sizes_.push_back(static_cast<std::size_t>(count));
  }
  void face(std::size_t first, std::size_t row) {
    std::vector<Index> corners;
    for (std::size_t k = first; k < first + sizes_[row]; ++k) {
      if (!(corners_[k] >= 0 && corners_[k] < static_cast<Real>(mesh_.vertices.size())))
        fail_face(row, fmt::format("vertex {}: must be 0 to {}", corners_[k],
                                   static_cast<std::int64_t>(mesh_.vertices.size()) - 1));
      corners.push_back(static_cast<Index>(corners_[k]));
    }
    const std::string trouble = add_polygon(mesh_, corners);
    if (!trouble.empty()) fail_face(row, "cannot be cut into triangles: " + trouble);
  }
  [[noreturn]] void fail_face(std::size_t row, const std::string& trouble) const {
    throw InputError(fmt::format("{}: face {} (from 0): {}", file_, row, trouble));
  }

  Body body_;
  const std::string& file_;
  TriangleMesh mesh_;
  std::vector<Real> corners_;       // vertex numbers of all faces, not validated yet
  std::vector<std::size_t> sizes_;  // number of corners of each face
};

}  // namespace

TriangleMesh parse_ply(std::string_view bytes, const std::string& file) {
  TokenReader words(bytes, file);
  const PlyHeader header = read_ply_header(words);
  if (header.form == PlyForm::ascii) return PlyReader(TextBody(words, bytes), file).mesh(header);
  if (words.position() == bytes.size()) words.fail("ends after the header: the file is cut");
  const bool swapped = header.form == PlyForm::high_byte_first;
  return PlyReader(BinaryBody(bytes, words.position() + 1, swapped, file), file).mesh(header);
}

}  // namespace scree
