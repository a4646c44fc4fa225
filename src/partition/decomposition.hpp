// Ownership of cells: boxes of cells of one global grid, found by recursive bisection.
#pragma once

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// The grid whose cells form the boxes: it covers the domain, with cells at least as wide as the halo. Points
// outside belong to the nearest cell.
struct DomainGrid {
  Vec3 min, edge;  // lower corner, edges of a cell [m]
  Index cells[3] = {1, 1, 1};

  // Coordinate of the cell of p along an axis; 0 for a NaN.
  SCREE_HD Index cell(int axis, Vec3 p) const {
    const Real at = std::floor((along(axis, p) - along(axis, min)) / along(axis, edge));
    if (!(at > 0)) return 0;
    return at < cells[axis] ? static_cast<Index>(at) : cells[axis] - 1;
  }
  Real lower_side(int axis, Index cell) const {  // [m]
    return along(axis, min) + cell * along(axis, edge);
  }
  double count() const { return double(cells[0]) * cells[1] * cells[2]; }

 private:
  SCREE_HD static Real along(int axis, Vec3 v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
};

// width: least edge length of a cell [m].
DomainGrid make_domain_grid(const Space& space, Real width);

// Cells [lower, upper) along each axis.
struct CellBox {
  Index lower[3], upper[3];
  double count() const;
  bool operator==(const CellBox&) const = default;
};

using DomainBox = Box;  // bounds of a box of cells; infinite at sides of the domain that are not periodic

// The sides of boxes result from a product and a sum: widths are enlarged by this share to cover the
// round-off.
inline constexpr Real kBoxRoundOff = 1e-9;

// A box of the bisection tree, for owner_of(): cells below `cut` along `axis` belong to the box `below`, the
// others to the box below + 1. axis -1: the complete box belongs to `rank`.
struct DomainCut {
  int axis = -1;
  Index cut = 0;
  int below = -1;
  int rank = 0;
};

// The rank that owns the point p. cuts: root of the tree.
SCREE_HD int owner_of(const DomainGrid& grid, const DomainCut* cuts, Vec3 p) {
  const DomainCut* at = cuts;
  while (at->axis >= 0) at = cuts + at->below + (grid.cell(at->axis, p) >= at->cut);
  return at->rank;
}

class Decomposition {
 public:
  Decomposition() = default;
  // Cuts the grid into one box per rank, with weights as equal as cuts along complete layers of cells permit.
  // position, weight: of this rank's particles. Throws InputError if there are fewer cells than ranks,
  // because a subdomain would be narrower than the halo. Collective.
  Decomposition(const Ranks& ranks, const DomainGrid& grid, std::span<const Vec4> position,
                std::span<const std::int64_t> weight);

  bool exists() const { return !nodes_.empty(); }
  int owner(Vec3 p) const { return owner_of(grid_, cuts_.data(), p); }
  // The tree for owner_of(); its first box is the complete domain.
  const std::vector<DomainCut>& cuts() const { return cuts_; }
  // One box per rank.
  const std::vector<CellBox>& boxes() const { return boxes_; }
  const DomainGrid& grid() const { return grid_; }
  // The box of a rank; without a decomposition the complete domain, which a single rank owns.
  DomainBox box(int rank, const Subdomain& subdomain) const;

 private:
  // For each box in cuts_: its cells, and the ranks that share it.
  struct Node {
    CellBox box;
    int first_rank, ranks;
  };
  struct Histograms;
  Histograms lay_out_histograms(std::size_t first_node);
  void split(const Histograms& histograms);
  std::pair<int, Index> cut_of(const Node& node, int axis, const std::int64_t* weight) const;
  void add(const Node& node);

  DomainGrid grid_;
  std::vector<Node> nodes_;
  std::vector<DomainCut> cuts_;
  std::vector<CellBox> boxes_;  // per rank
};

// Numbers of a rank's particles, and of its messages to other ranks.
struct HaloSize {
  std::int64_t owned = 0, ghosts = 0;
  std::int64_t neighbors = 0;  // ranks to which it sends
  std::int64_t bytes = 0;      // sent per update of positions and velocities [B]
  // On GPUs: mean duration of the sampled updates, and the part of it that contact kernels wait for [s].
  double seconds = 0, exposed_seconds = 0;
};

// Distribution of the work over the ranks, and this rank's part at the last list build.
struct LoadBalance {
  Real imbalance = 0;           // largest weight of a rank over the mean, less 1, at the last list build
  Real largest = 0;             // largest imbalance so far
  std::int64_t rebalances = 0;  // number of changes of the boxes
  std::int64_t migrated = 0;    // particles that changed their rank
  HaloSize halo;                // of this rank
};

// Largest weight over the mean, less 1; 0 without any weight. Collective.
Real measure_imbalance(const Ranks& ranks, std::int64_t weight);

}  // namespace scree
