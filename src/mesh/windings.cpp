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

// What is to be turned of a mesh, so that the triangles at an edge run alike.
class Windings {
 public:
  explicit Windings(const TriangleMesh& mesh)
      : around_(mesh.triangles.size()), count_(mesh.triangles.size()), turned_(mesh.triangles.size(), false) {
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
  const std::vector<char>& turned() const { return turned_; }

 private:
  void add(Index triangle, Neighbour neighbour) {
    if (count_[triangle] < 3) around_[triangle][count_[triangle]++] = neighbour;
  }
  void find() {
    std::vector<char> seen(turned_.size(), false);
    for (Index t = 0; t < static_cast<Index>(seen.size()); ++t)
      if (!seen[t]) find_piece(t, seen);
  }
  // The piece of this triangle, the lowest of it.
  void find_piece(Index first, std::vector<char>& seen) {
    std::vector<Index> piece{first};
    seen[first] = true;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Index t = piece[i];
      for (int k = 0; k < count_[t]; ++k) {
        const auto [other, alike] = around_[t][k];
        const char turned = alike ? turned_[t] : !turned_[t];
        if (seen[other]) {
          has_two_sides_ = has_two_sides_ && turned_[other] == turned;
          continue;
        }
        seen[other] = true, turned_[other] = turned;
        piece.push_back(other);
      }
    }
    const auto turned = std::ranges::count_if(piece, [&](Index t) { return turned_[t]; });
    if (2 * turned > std::ssize(piece))
      for (const Index t : piece) turned_[t] = !turned_[t];
  }

  std::vector<std::array<Neighbour, 3>> around_;
  std::vector<int> count_;    // of these
  std::vector<char> turned_;  // of each triangle
  bool has_two_everywhere_ = true, runs_alike_ = true, has_two_sides_ = true;
};

// turned: of each triangle.
std::vector<Index> turn(NumberedMesh& mesh, const std::vector<char>& turned) {
  std::vector<Index> numbers;
  for (std::size_t t = 0; t < turned.size(); ++t) {
    if (!turned[t]) continue;
    std::swap(mesh.mesh.triangles[t][1], mesh.mesh.triangles[t][2]);
    numbers.push_back(mesh.numbers[t]);
  }
  std::ranges::sort(numbers);
  return numbers;
}

// Whether shells are not where their windings say: around the whole, or one that bounds a cavity of nothing.
bool has_inverted_shell(const TriangleMesh& mesh, const std::vector<Index>& shell,
                        const std::vector<Real>& volume) {
  if (std::ranges::all_of(volume, [](Real v) { return v > 0; })) return false;
  if (std::accumulate(volume.begin(), volume.end(), Real(0)) < 0) return true;
  return std::ranges::any_of(misplaced_shells(mesh, shell, crossing_shells(mesh, shell)),
                             [](const MisplacedShell& s) { return s.volume < 0; });
}

// Which shells to turn; from those outside to those within.
std::vector<char> inverted_shells(const ShellNesting& nesting) {
  const std::size_t count = nesting.volume.size();
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto depth = [&](Index i) { return nesting.around[i].size(); };
  std::ranges::stable_sort(order, {}, depth);
  std::vector<char> turned(count, false);
  for (const Index i : order) {
    const auto sign = [&](Index j) {
      return (nesting.volume[j] < 0) != static_cast<bool>(turned[j]) ? -1 : 1;
    };
    int solids = 0;  // around it, less cavities
    for (const Index j : nesting.around[i]) solids += sign(j);
    const std::vector<Index>& around = nesting.around[i];
    const bool is_in_turned = !around.empty() && turned[*std::ranges::max_element(around, {}, depth)];
    turned[i] = solids == 0 ? nesting.volume[i] < 0 : solids == 1 && nesting.volume[i] > 0 && is_in_turned;
  }
  return turned;
}

}  // namespace

std::vector<Index> turn_alike(NumberedMesh& sheet) { return turn(sheet, Windings(sheet.mesh).turned()); }

std::vector<Index> turn_outward(NumberedMesh& closed) {
  const Windings windings(closed.mesh);
  if (!windings.has_two_everywhere() || !windings.has_two_sides() || closed.numbers.empty()) return {};
  std::vector<char> turned = windings.turned();
  const bool is_mixed = std::ranges::find(turned, char(true)) != turned.end();
  NumberedMesh alike = closed;
  turn(alike, turned);
  const std::vector<Index> shell = shells_of(alike.mesh);
  if (is_mixed || has_inverted_shell(alike.mesh, shell, shell_volumes(alike.mesh, shell))) {
    const std::vector<char> inverted = inverted_shells(shell_nesting(alike.mesh, shell));
    for (std::size_t t = 0; t < turned.size(); ++t) turned[t] = turned[t] != inverted[shell[t]];
  }
  return turn(closed, turned);
}

}  // namespace scree
