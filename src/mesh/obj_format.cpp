#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mesh/mesh_formats.hpp"
#include "mesh/polygon.hpp"
#include "mesh/token_reader.hpp"

namespace scree {

namespace {

// Statements of appearance, names and groups.
constexpr std::array<std::string_view, 21> kIgnored{
    "vn",     "vt",         "vp",        "g",      "o",     "s",        "mg",
    "usemtl", "mtllib",     "usemap",    "maplib", "bevel", "c_interp", "d_interp",
    "lod",    "shadow_obj", "trace_obj", "ctech",  "stech", "call",     "csh"};

class Obj {
 public:
  Obj(std::string_view bytes, const std::string& file) : words_(bytes, file) {}

  TriangleMesh mesh() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (word == "v") {
        vertex();
      } else if (word == "f" || word == "fo") {
        face();
      } else if (word == "p" || word == "l") {
        words_.fail(fmt::format("{}: points and lines are no surface; leave them out", quoted(word)));
      } else if (word[0] != '#' && std::find(kIgnored.begin(), kIgnored.end(), word) == kIgnored.end()) {
        words_.fail(fmt::format("{}: no statement of a polygon mesh", quoted(word)));
      }
      words_.skip_line();
    }
    return std::move(mesh_);
  }

 private:
  void vertex() {
    const Real x = words_.number("coordinate"), y = words_.number("coordinate");
    mesh_.vertices.push_back({x, y, words_.number("coordinate")});
  }
  void face() {
    corners_.clear();
    for (std::string_view word = words_.next_in_line(); !word.empty(); word = words_.next_in_line()) {
      if (word[0] == '#') break;
      corners_.push_back(corner(word));
    }
    if (corners_.size() < 3)
      words_.fail(fmt::format("{} corners; a face must have at least 3", corners_.size()));
    const std::string trouble = add_polygon(mesh_, corners_);
    if (!trouble.empty()) words_.fail("a face cannot be cut into triangles: " + trouble);
  }
  // Parses "vertex/texture/normal"; counted from 1, or backwards from the last vertex where negative.
  Index corner(std::string_view word) const {
    const std::int64_t number = words_.to_integer(word.substr(0, word.find('/')), "vertex number");
    const std::int64_t count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (number == 0 || number > count || number < -count)
      words_.fail(fmt::format("vertex number {}: must be 1 to {}, those above this line, or -1 to -{}",
                              number, count, count));
    return static_cast<Index>(number > 0 ? number - 1 : count + number);
  }

  TokenReader words_;
  TriangleMesh mesh_;
  std::vector<Index> corners_;
};

}  // namespace

TriangleMesh parse_obj(std::string_view bytes, const std::string& file) { return Obj(bytes, file).mesh(); }

}  // namespace scree
