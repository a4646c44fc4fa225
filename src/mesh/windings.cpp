#include "mesh/windings.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "mesh/mesh_shells.hpp"
#include "mesh/mesh_sides.hpp"
#include "mesh/shell_crossings.hpp"

namespace scree {

namespace {

struct Neighbour {
  Index triangle;
  bool runs_alike;
};

// The triangles to reorient so that the windings at each edge are consistent.
class Windings {
 public:
  explicit Windings(const TriangleMesh& mesh)
      : around_(mesh.triangles.size()),
        count_(mesh.triangles.size()),
        reversed_(mesh.triangles.size(), false) {
    for_each_edge(sides_of(mesh), [&](const Side* first, const Side* last) {
      has_two_everywhere_ = has_two_everywhere_ && last - first == 2;
      if (last - first != 2 || first[0].triangle == first[1].triangle) return;
      const bool alike = first[0].forward != first[1].forward;
      runs_alike_ = runs_alike_ && alike;
      for (int k = 0; k < 2; ++k) add(first[k].triangle, {first[1 - k].triangle, alike});
    });
    if (!runs_alike_) find();
  }
  bool has_two_everywhere() const { return has_two_everywhere_; }
  bool has_two_sides() const { return has_two_sides_; }
  const std::vector<char>& reversed() const { return reversed_; }

 private:
  void add(Index triangle, Neighbour neighbour) {
    if (count_[triangle] < 3) around_[triangle][count_[triangle]++] = neighbour;
  }
  void find() {
    std::vector<char> seen(reversed_.size(), false);
    for (Index t = 0; t < static_cast<Index>(seen.size()); ++t)
      if (!seen[t]) find_piece(t, seen);
  }
  // Collects the piece of this triangle, its lowest.
  void find_piece(Index first, std::vector<char>& seen) {
    std::vector<Index> piece{first};
    seen[first] = true;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Index t = piece[i];
      for (int k = 0; k < count_[t]; ++k) {
        const auto [other, alike] = around_[t][k];
        const char reversed = alike ? reversed_[t] : !reversed_[t];
        if (seen[other]) {
          has_two_sides_ = has_two_sides_ && reversed_[other] == reversed;
          continue;
        }
        seen[other] = true, reversed_[other] = reversed;
        piece.push_back(other);
      }
    }
    const auto reversed = std::ranges::count_if(piece, [&](Index t) { return reversed_[t]; });
    if (2 * reversed > std::ssize(piece))
      for (const Index t : piece) reversed_[t] = !reversed_[t];
  }

  std::vector<std::array<Neighbour, 3>> around_;
  std::vector<int> count_;      // number of neighbours
  std::vector<char> reversed_;  // per triangle, whether to reorient it
  bool has_two_everywhere_ = true, runs_alike_ = true, has_two_sides_ = true;
};

// reversed: per triangle, whether to reorient it.
std::vector<Index> reorient(NumberedMesh& mesh, const std::vector<char>& reversed) {
  std::vector<Index> numbers;
  for (std::size_t t = 0; t < reversed.size(); ++t) {
    if (!reversed[t]) continue;
    std::swap(mesh.mesh.triangles[t][1], mesh.mesh.triangles[t][2]);
    numbers.push_back(mesh.numbers[t]);
  }
  std::ranges::sort(numbers);
  return numbers;
}

// Whether the orientation of a shell does not suit its position: inverted around the whole, or a cavity
// outside any solid.
bool has_inverted_shell(const TriangleMesh& mesh, const std::vector<Index>& shell,
                        const std::vector<Real>& volume) {
  if (std::ranges::all_of(volume, [](Real v) { return v > 0; })) return false;
  if (std::accumulate(volume.begin(), volume.end(), Real(0)) < 0) return true;
  return std::ranges::any_of(misplaced_shells(mesh, shell, crossing_shells(mesh, shell)),
                             [](const MisplacedShell& s) { return s.volume < 0; });
}

// Selects the shells to invert, from the outer to the inner ones.
std::vector<char> inverted_shells(const ShellNesting& nesting) {
  const std::size_t count = nesting.volume.size();
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto depth = [&](Index i) { return nesting.around[i].size(); };
  std::ranges::stable_sort(order, {}, depth);
  std::vector<char> reversed(count, false);
  for (const Index i : order) {
    const auto sign = [&](Index j) {
      return (nesting.volume[j] < 0) != static_cast<bool>(reversed[j]) ? -1 : 1;
    };
    int solids = 0;  // solids around it, less cavities
    for (const Index j : nesting.around[i]) solids += sign(j);
    const std::vector<Index>& around = nesting.around[i];
    const bool is_in_reversed = !around.empty() && reversed[*std::ranges::max_element(around, {}, depth)];
    reversed[i] =
        solids == 0 ? nesting.volume[i] < 0 : solids == 1 && nesting.volume[i] > 0 && is_in_reversed;
  }
  return reversed;
}

}  // namespace

std::vector<Index> orient_consistently(NumberedMesh& sheet) {
  return reorient(sheet, Windings(sheet.mesh).reversed());
}

std::vector<Index> orient_outward(NumberedMesh& closed) {
  const Windings windings(closed.mesh);
  if (!windings.has_two_everywhere() || !windings.has_two_sides() || closed.numbers.empty()) return {};
  std::vector<char> reversed = windings.reversed();
  const bool is_mixed = std::ranges::find(reversed, char(true)) != reversed.end();
  NumberedMesh alike = closed;
  reorient(alike, reversed);
  const std::vector<Index> shell = shells_of(alike.mesh);
  if (is_mixed || has_inverted_shell(alike.mesh, shell, shell_volumes(alike.mesh, shell))) {
    const std::vector<char> inverted = inverted_shells(shell_nesting(alike.mesh, shell));
    for (std::size_t t = 0; t < reversed.size(); ++t) reversed[t] = reversed[t] != inverted[shell[t]];
  }
  return reorient(closed, reversed);
}

}  // namespace scree
