#include "mesh/ply_header.hpp"

#include <fmt/format.h>

#include <array>

namespace scree {

namespace {

constexpr std::array<PlyType, 8> kTypes{{{"char", "int8", 1, true, true},
                                         {"uchar", "uint8", 1, true, false},
                                         {"short", "int16", 2, true, true},
                                         {"ushort", "uint16", 2, true, false},
                                         {"int", "int32", 4, true, true},
                                         {"uint", "uint32", 4, true, false},
                                         {"float", "float32", 4, false, true},
                                         {"double", "float64", 8, false, true}}};

class HeaderReader {
 public:
  explicit HeaderReader(TokenReader& words) : words_(words) {}

  PlyHeader header() {
    if (words_.next() != "ply") words_.fail("must begin with ply");
    form();
    for (;;) {
      const std::string_view word = words_.next();
      if (word == "end_header") break;
      if (word.empty()) words_.fail("ends before end_header: the file is cut");
      if (word == "comment" || word == "obj_info") {
        words_.skip_line();
      } else if (word == "element") {
        element();
      } else if (word == "property") {
        property();
      } else {
        words_.fail(fmt::format("{}: must be element, property, comment or end_header", quoted(word)));
      }
    }
    for (const PlyElement& element : header_.elements)
      if (element.properties.empty())
        words_.fail(fmt::format("element {} has no properties", quoted(element.name)));
    words_.skip_line();
    return std::move(header_);
  }

 private:
  std::string_view word(const char* what) {
    const std::string_view word = words_.next_in_line();
    if (word.empty()) words_.fail(fmt::format("ends before {}", what));
    return word;
  }
  void form() {
    if (words_.next() != "format") words_.fail("the second line must give the format");
    const std::string_view name = word("the format");
    if (name == "binary_little_endian") {
      header_.form = PlyForm::low_byte_first;
    } else if (name == "binary_big_endian") {
      header_.form = PlyForm::high_byte_first;
    } else if (name != "ascii") {
      words_.fail(
          fmt::format("format {}: must be ascii, binary_little_endian or binary_big_endian", quoted(name)));
    }
    const std::string_view version = word("the format's version");
    if (version != "1.0") words_.fail(fmt::format("format version {}: must be 1.0", quoted(version)));
  }
  void element() {
    const std::string name(word("an element's name"));
    const std::int64_t count = words_.to_integer(word("an element's count"), "element count");
    if (count < 0) words_.fail(fmt::format("element count {}: must be at least 0", count));
    for (const PlyElement& other : header_.elements)
      if (other.name == name) words_.fail(fmt::format("element {} is repeated", quoted(name)));
    header_.elements.push_back({name, count, {}});
  }
  void property() {
    if (header_.elements.empty()) words_.fail("a property must belong to an element above it");
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    std::string_view first = word("a property's type");
    PlyProperty property{"", nullptr, nullptr};
    if (first == "list") {
      property.count_type = type(word("the type of a list's length"));
      if (!property.count_type->whole) words_.fail("the length of a list must be of a whole type");
      first = word("a property's type");
    }
    property.type = type(first);
    property.name = word("a property's name");
    for (const PlyProperty& other : properties)
      if (other.name == property.name)
        words_.fail(fmt::format("property {} is repeated", quoted(property.name)));
    properties.push_back(property);
  }
  const PlyType* type(std::string_view name) const {
    for (const PlyType& type : kTypes)
      if (name == type.name || name == type.other_name) return &type;
    words_.fail(
        fmt::format("type {}: must be char, uchar, short, ushort, int, uint, float, double or one of "
                    "int8 ... float64",
                    quoted(name)));
  }

  TokenReader& words_;
  PlyHeader header_;
};

}  // namespace

PlyHeader read_ply_header(TokenReader& words) { return HeaderReader(words).header(); }

}  // namespace scree
