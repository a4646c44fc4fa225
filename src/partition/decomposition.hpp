// Which rank owns which cells: boxes of cells of one global grid, found by recursive bisection.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// The cells that boxes are made of: a grid over the space, at least one halo wide. Points outside belong to
// the nearest cell.
struct DomainGrid {
  Vec3 min, edge;  // lower corner, edges of a cell [m]
  Index cells[3] = {1, 1, 1};

  // Coordinate of the cell of x along an axis; a NaN is in cell 0.
  Index cell(int axis, Real x) const;
  Real lower_side(int axis, Index cell) const;  // [m]
  double count() const { return double(cells[0]) * cells[1] * cells[2]; }
};

// width: least edge of a cell [m].
DomainGrid make_domain_grid(const Space& space, Real width);

// Cells [lower, upper) along each axis.
struct CellBox {
  Index lower[3], upper[3];
  double count() const;
  bool operator==(const CellBox&) const = default;
};

// A box of cells in space; infinite where the space ends and is not periodic.
struct DomainBox {
  Vec3 min, max;  // [m]
  // Whether p lies inside, or outside by at most `width` [m].
  bool reaches(Vec3 p, Real width) const {
    return p.x >= min.x - width && p.x <= max.x + width && p.y >= min.y - width && p.y <= max.y + width &&
           p.z >= min.z - width && p.z <= max.z + width;
  }
};

// The sides of boxes come from a product and a sum: this share more of a width covers their round-off.
inline constexpr Real kBoxRoundOff = 1e-9;

class Decomposition {
 public:
  Decomposition() = default;
  // Cuts the grid into one box per rank so that the boxes' weights are as even as cuts along whole layers of
  // cells make them. Collective. position, weight: of this rank's particles. Throws InputError where there
  // are fewer cells than ranks: a subdomain would be narrower than the halo.
  Decomposition(const Ranks& ranks, const DomainGrid& grid, std::span<const Vec4> position,
                std::span<const std::int64_t> weight);

  bool exists() const { return !nodes_.empty(); }
  int owner(Vec3 p) const;
  // Per rank.
  const std::vector<CellBox>& boxes() const { return boxes_; }
  const DomainGrid& grid() const { return grid_; }
  // The box of a rank, for a space with these periods.
  DomainBox box(int rank, const Subdomain& subdomain) const;

 private:
  // Cells below `cut` along `axis` belong to `below`, the others to below + 1; a leaf has a rank.
  struct Node {
    CellBox box;
    int first_rank, ranks;
    int axis = -1;
    Index cut = 0;
    int below = -1;
  };
  struct Histograms;
  Histograms lay_out_histograms(std::size_t first_node);
  Index layer(const Node& node, Vec4 p) const;
  void split(const Histograms& histograms);
  std::pair<int, Index> cut_of(const Node& node, const std::int64_t* weight) const;

  DomainGrid grid_;
  std::vector<Node> nodes_;
  std::vector<CellBox> boxes_;  // per rank
};

// A rank's particles, and what it sends to other ranks.
struct HaloSize {
  std::int64_t owned = 0, ghosts = 0;
  std::int64_t neighbors = 0;  // ranks that it sends to
  std::int64_t bytes = 0;      // sent per update of positions and velocities [B]
};

// How evenly the work lies on the ranks, and what this one has of it at the last list.
struct LoadBalance {
  Real imbalance = 0;           // largest weight of a rank over the mean, less 1, at the last list
  Real largest = 0;             // the largest that was met
  std::int64_t rebalances = 0;  // times that the boxes were changed
  std::int64_t migrated = 0;    // particles that changed their rank
  HaloSize halo;                // of this rank
};

// Largest over mean, less 1; 0 where there is no weight. Collective.
Real measure_imbalance(const Ranks& ranks, std::int64_t weight);

}  // namespace scree
