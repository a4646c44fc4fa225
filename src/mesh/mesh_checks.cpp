#include "mesh/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mesh/degenerate_triangles.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_shells.hpp"
#include "mesh/mesh_sides.hpp"
#include "mesh/shell_crossings.hpp"

namespace scree {

namespace {

constexpr std::size_t kMostPositions = 5;

std::string text_of(Vec3 v) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z); }

// Collects the positions of one kind of defect: all are counted, the first are named.
class Positions {
 public:
  // text(): the name of the position.
  template <class Text>
  void add(Text text) {
    if (count_++ < kMostPositions) named_ += (named_.empty() ? "" : "; ") + text();
  }
  void report(const char* one, const char* many, const std::string& demand,
              std::vector<std::string>& troubles) const {
    if (count_ == 0) return;
    const std::string more =
        count_ > kMostPositions ? fmt::format("; and {} more", count_ - kMostPositions) : "";
    const std::string what = count_ == 1 ? one : fmt::format("{} {}", count_, many);
    troubles.push_back(fmt::format("{}; {}: {}{}", what, demand, named_, more));
  }

 private:
  std::size_t count_ = 0;
  std::string named_;
};

// Text on a mesh that is torn where vertices of open edges nearly coincide; empty where there is none.
std::string tear_text(const TriangleMesh& mesh, const std::vector<Side>& open) {
  constexpr std::size_t kMostOpen = 1000;  // all pairs are compared
  constexpr Real kNearly = 0.01;           // relative to the shortest edge
  if (open.size() > kMostOpen) return "";
  std::vector<Index> ends;
  Real nearest = kInfinity, shortest = kInfinity;
  for (const Side& edge : open) {
    ends.insert(ends.end(), {edge.low, edge.high});
    shortest = std::min(shortest, norm(mesh.vertices[edge.high] - mesh.vertices[edge.low]));
  }
  for (const Index a : ends)
    for (const Index b : ends)
      if (a < b) nearest = std::min(nearest, norm(mesh.vertices[b] - mesh.vertices[a]));
  if (!(nearest < kNearly * shortest)) return "";
  return fmt::format("; two of their ends are {:.3g} m apart, which welding within a tolerance joins",
                     nearest);
}

class Checker {
 public:
  Checker(const TriangleMesh& mesh, const std::vector<Index>& numbers) : mesh_(mesh), numbers_(numbers) {}

  std::vector<std::string> troubles(bool sheet) {
    if (mesh_.triangles.empty()) return {"no triangles"};
    check_numbers();
    if (!troubles_.empty()) return troubles_;
    check_areas();
    check_duplicates();
    check_edges(sheet);
    if (troubles_.empty() && !sheet) check_volume();
    if (troubles_.empty() && !sheet) check_shells();
    return troubles_;
  }

 private:
  Index number(Index triangle) const { return numbers_.empty() ? triangle : numbers_[triangle]; }
  std::string text_of_triangle(Index triangle) const {
    return triangle_text(mesh_, triangle, number(triangle));
  }
  std::string edge_text(const Side* first, const Side* last) const {
    std::string text = fmt::format("{} to {} of triangle{} {}", text_of(mesh_.vertices[first->low]),
                                   text_of(mesh_.vertices[first->high]), last - first > 1 ? "s" : "",
                                   number(first->triangle));
    for (const Side* side = first + 1; side < last; ++side)
      text += fmt::format("{} {}", side + 1 == last ? " and" : ",", number(side->triangle));
    return text;
  }

  void check_numbers() {
    Positions positions;
    for (Index i = 0; i < static_cast<Index>(mesh_.triangles.size()); ++i) {
      const auto [a, b, c] = corners_of(mesh_, i);
      if (!is_finite(a) || !is_finite(b) || !is_finite(c)) positions.add([&] { return text_of_triangle(i); });
    }
    positions.report("a triangle has a coordinate that is no finite number",
                     "triangles have coordinates that are no finite numbers", "all must be", troubles_);
  }

  void check_areas() {
    Positions positions;
    for (Index i = 0; i < static_cast<Index>(mesh_.triangles.size()); ++i)
      if (!has_area(corners_of(mesh_, i))) positions.add([&] { return text_of_triangle(i); });
    positions.report("a triangle has no area", "triangles have no area", "each must span a plane", troubles_);
  }

  void check_duplicates() {
    std::vector<std::array<Index, 4>> rows;
    for (Index i = 0; i < static_cast<Index>(mesh_.triangles.size()); ++i) {
      std::array<Index, 3> t = mesh_.triangles[i];
      std::sort(t.begin(), t.end());
      rows.push_back({t[0], t[1], t[2], i});
    }
    std::sort(rows.begin(), rows.end());
    Positions positions;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (!std::equal(rows[i].begin(), rows[i].begin() + 3, rows[i - 1].begin())) continue;
      positions.add([&] {
        return fmt::format("triangle {} and {}", number(rows[i - 1][3]), text_of_triangle(rows[i][3]));
      });
    }
    positions.report("a triangle has the corners of another", "triangles have the corners of others",
                     "each must be there once", troubles_);
  }

  void check_edges(bool sheet) {
    Positions open, crowded, opposed;
    std::vector<Side> free;
    for_each_edge(sides_of(mesh_), [&](const Side* first, const Side* last) {
      const auto text = [&] { return edge_text(first, last); };
      if (last - first == 1 && !sheet) open.add(text), free.push_back(*first);
      if (last - first > 2 && !sheet) crowded.add(text);
      if (last - first == 2 && first[0].forward == first[1].forward && !sheet) opposed.add(text);
    });
    open.report("an edge has one triangle", "edges have one triangle",
                "a closed mesh has two at each (an open surface needs sheet = true)" + tear_text(mesh_, free),
                troubles_);
    crowded.report("an edge has more than two triangles", "edges have more than two triangles",
                   "a closed mesh has two at each", troubles_);
    opposed.report("an edge lies between opposite windings", "edges lie between opposite windings",
                   "corners must run counterclockwise seen from one side of the whole", troubles_);
  }

  void check_volume() {
    // Relative to the mesh's own size: below it round-off decides the sign.
    constexpr Real kLeastThickness = 1e-12;
    const Real volume = mesh_volume(mesh_), area = mesh_area(mesh_);
    if (std::abs(volume) <= kLeastThickness * area * std::sqrt(area)) {
      troubles_.push_back(fmt::format("it encloses {:.3g} m^3, nothing but round-off", volume));
    } else if (volume < 0) {
      troubles_.push_back(fmt::format(
          "its volume is {:.9g} m^3, below 0: it is inside out; corners must run counterclockwise "
          "seen from outside",
          volume));
    }
  }

  void check_shells() {
    Positions inverted, inner;
    const std::vector<Index> shell = shells_of(mesh_);
    for (const MisplacedShell& misplaced : misplaced_shells(mesh_, shell, crossing_shells(mesh_, shell))) {
      const auto text = [&] {
        const auto first = std::find(shell.begin(), shell.end(), misplaced.shell) - shell.begin();
        return fmt::format("that of {}", text_of_triangle(static_cast<Index>(first)));
      };
      (misplaced.volume < 0 ? inverted : inner).add(text);
    }
    inverted.report("a shell is inside out", "shells are inside out",
                    "corners must run counterclockwise seen from outside, but around a cavity", troubles_);
    inner.report("a shell lies inside another", "shells lie inside others",
                 "around a cavity corners must run clockwise seen from outside; solids must not overlap",
                 troubles_);
  }

  const TriangleMesh& mesh_;
  const std::vector<Index>& numbers_;
  std::vector<std::string> troubles_;
};

}  // namespace

std::string triangle_text(const TriangleMesh& mesh, Index triangle, Index number) {
  const auto [a, b, c] = corners_of(mesh, triangle);
  return fmt::format("triangle {} {} {} {}", number, text_of(a), text_of(b), text_of(c));
}

std::vector<std::string> mesh_defects(const TriangleMesh& mesh, bool sheet,
                                      const std::vector<Index>& numbers) {
  return Checker(mesh, numbers).troubles(sheet);
}

std::string crossing_text(const TriangleMesh& mesh, const std::vector<Index>& numbers) {
  const std::vector<ShellCrossing> crossings = shell_crossings(mesh, shells_of(mesh));
  if (crossings.empty()) return "";
  const auto number = [&](Index triangle) { return numbers.empty() ? triangle : numbers[triangle]; };
  const ShellCrossing& first = crossings.front();
  return fmt::format(
      "its shells {} and {} cut through each other, first at {} (triangles {} and {}){}", first.shell[0],
      first.shell[1], text_of(first.position), number(first.triangle[0]), number(first.triangle[1]),
      crossings.size() == 1 ? "" : fmt::format("; so do {} more pairs of shells", crossings.size() - 1));
}

}  // namespace scree
