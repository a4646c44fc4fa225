#include "mesh/duplicate_triangles.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <optional>

#include "mesh/mesh_sides.hpp"

namespace scree {

namespace {

// For each triangle the first one with its corners.
std::vector<Index> firsts_of(const TriangleMesh& mesh) {
  std::vector<std::array<Index, 4>> rows;
  rows.reserve(mesh.triangles.size());
  for (std::array<Index, 3> t : mesh.triangles) {
    std::ranges::sort(t);
    rows.push_back({t[0], t[1], t[2], static_cast<Index>(rows.size())});
  }
  std::ranges::sort(rows);
  std::vector<Index> firsts(rows.size());
  for (std::size_t i = 0, first = 0; i < rows.size(); ++i) {
    if (!std::equal(rows[i].begin(), rows[i].begin() + 3, rows[first].begin())) first = i;
    firsts[rows[i][3]] = rows[first][3];
  }
  return firsts;
}

// Removes all triangles for which is_gone(triangle).
template <class IsGone>
std::vector<Index> leave_out(NumberedMesh& mesh, const IsGone& is_gone) {
  std::vector<Index> numbers;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.numbers.size(); ++t) {
    if (is_gone(static_cast<Index>(t))) {
      numbers.push_back(mesh.numbers[t]);
    } else {
      mesh.mesh.triangles[kept] = mesh.mesh.triangles[t], mesh.numbers[kept++] = mesh.numbers[t];
    }
  }
  mesh.mesh.triangles.resize(kept), mesh.numbers.resize(kept);
  return numbers;
}

// Selects the triangles with duplicates that a closed mesh keeps: each edge then has two triangles or none.
// Selection starts at edges that leave one choice and propagates from there; where no edge does, all stay.
class ClosedChoice {
 public:
  // mesh: without duplicates. had_duplicate: per triangle, whether it had some.
  ClosedChoice(const TriangleMesh& mesh, const std::vector<char>& had_duplicate)
      : kept_(mesh.triangles.size()), edges_of_(mesh.triangles.size()) {
    for_each_edge(sides_of(mesh), [&](const Side* first, const Side* last) {
      Edge edge;
      for (const Side* side = first; side != last; ++side) {
        if (!had_duplicate[side->triangle]) {
          ++edge.others;
          continue;
        }
        edge.open.push_back(side->triangle);
        edges_of_[side->triangle].push_back(edges_.size());
      }
      if (!edge.open.empty()) edges_.push_back(edge);
    });
    for (std::size_t e = 0; e < edges_.size(); ++e) decide_at(e);
    for (; !decided_.empty(); decided_.pop_front())
      for (const std::size_t e : edges_of_[decided_.front()]) decide_at(e);
  }
  bool is_kept(Index triangle) const { return kept_[triangle].value_or(true); }

 private:
  struct Edge {
    int others = 0;           // triangles without duplicates
    std::vector<Index> open;  // triangles with duplicates
  };

  void decide_at(std::size_t number) {
    const Edge& edge = edges_[number];
    int there = edge.others, unknown = 0;
    Index triangle = -1;
    for (const Index t : edge.open) {
      if (!kept_[t].has_value()) {
        triangle = t, ++unknown;
      } else if (*kept_[t]) {
        ++there;
      }
    }
    // The border of a leaf that is connected to nothing decides nothing.
    const bool is_border = edge.others == 0 && edge.open.size() == 1;
    if (unknown != 1 || is_border || there > 2) return;
    kept_[triangle] = there == 1;
    decided_.push_back(triangle);
  }

  std::vector<std::optional<bool>> kept_;
  std::vector<std::vector<std::size_t>> edges_of_;  // of the triangles with duplicates
  std::vector<Edge> edges_;
  std::deque<Index> decided_;
};

}  // namespace

std::vector<Index> remove_duplicates(NumberedMesh& mesh, bool sheet) {
  const std::vector<Index> firsts = firsts_of(mesh.mesh);
  std::vector<char> has_duplicate(firsts.size(), false);
  for (std::size_t t = 0; t < firsts.size(); ++t)
    if (firsts[t] != static_cast<Index>(t)) has_duplicate[firsts[t]] = true;
  if (std::ranges::find(has_duplicate, char(true)) == has_duplicate.end()) return {};
  std::vector<char> had_duplicate;  // of the remaining triangles
  for (std::size_t t = 0; t < firsts.size(); ++t)
    if (firsts[t] == static_cast<Index>(t)) had_duplicate.push_back(has_duplicate[t]);
  std::vector<Index> numbers = leave_out(mesh, [&](Index t) { return firsts[t] != t; });
  if (sheet) return numbers;
  const ClosedChoice choice(mesh.mesh, had_duplicate);
  const std::vector<Index> too = leave_out(mesh, [&](Index t) { return !choice.is_kept(t); });
  numbers.insert(numbers.end(), too.begin(), too.end());
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace scree
