#include "partition/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "base/error.hpp"
#include "base/index.hpp"

namespace scree {
namespace {

// Histograms have one entry per layer of cells; more layers than this do not improve the cuts.
constexpr Real kMostLayers = 1 << 14;

constexpr Real Vec3::*kAxes[3] = {&Vec3::x, &Vec3::y, &Vec3::z};

}  // namespace

DomainGrid make_domain_grid(const Space& space, Real width) {
  DomainGrid grid;
  grid.min = space.min, grid.edge = {1, 1, 1};
  for (int axis = 0; axis < space.dimension; ++axis) {
    const Real length = space.max.*kAxes[axis] - space.min.*kAxes[axis];
    const Real layers = std::clamp(std::floor(length / width), Real(1), kMostLayers);
    grid.cells[axis] = static_cast<Index>(layers);
    grid.edge.*kAxes[axis] = length / layers;
  }
  return grid;
}

double CellBox::count() const {
  double product = 1;
  for (int axis = 0; axis < 3; ++axis) product *= upper[axis] - lower[axis];
  return product;
}

// Weights per layer of the boxes to be cut, along the axis of each cut, box after box.
struct Decomposition::Histograms {
  std::vector<int> nodes;
  std::vector<std::size_t> first;  // entry of the lowest layer, per node of the tree
  std::vector<std::int64_t> weight;
};

Decomposition::Decomposition(const Ranks& ranks, const DomainGrid& grid, std::span<const Vec4> position,
                             std::span<const std::int64_t> weight)
    : grid_(grid), boxes_(as_size(ranks.size())) {
  if (grid.count() < ranks.size())
    throw InputError(
        "mpirun -n " + std::to_string(ranks.size()) + ": the domain has only " +
        std::to_string(static_cast<std::int64_t>(grid.count())) +
        " cells as wide as the halo (largest diameter plus skin), and a subdomain must not be narrower; "
        "start at most so many ranks");
  add({{{0, 0, 0}, {grid.cells[0], grid.cells[1], grid.cells[2]}}, 0, ranks.size()});
  std::vector<std::size_t> node_of(position.size(), 0);
  for (std::size_t first = 0; first < nodes_.size();) {  // one level of the tree per iteration
    Histograms h = lay_out_histograms(first);
    first = nodes_.size();
    for (std::size_t i = 0; i < position.size(); ++i) {
      const int axis = cuts_[node_of[i]].axis;
      if (axis < 0) continue;
      const Index layer = grid_.cell(axis, xyz(position[i])) - nodes_[node_of[i]].box.lower[axis];
      h.weight[h.first[node_of[i]] + as_size(layer)] += weight[i];
    }
    ranks.sum(std::span<std::int64_t>(h.weight));
    split(h);
    for (std::size_t i = 0; i < position.size(); ++i) {
      const DomainCut& cut = cuts_[node_of[i]];
      if (cut.axis >= 0)
        node_of[i] = as_size(cut.below + (grid_.cell(cut.axis, xyz(position[i])) >= cut.cut));
    }
  }
}

// Chooses the axis of each box's cut, its longest one, and allocates the weights along it.
Decomposition::Histograms Decomposition::lay_out_histograms(std::size_t first_node) {
  Histograms h;
  h.first.resize(nodes_.size());
  for (std::size_t n = first_node; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (node.ranks == 1) {
      boxes_[as_size(node.first_rank)] = node.box;
      continue;
    }
    int& axis_of_cut = cuts_[n].axis;
    Real longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Index layers = node.box.upper[axis] - node.box.lower[axis];
      const Real extent = layers * grid_.edge.*kAxes[axis];
      if (layers > 1 && extent > longest) longest = extent, axis_of_cut = axis;
    }
    h.nodes.push_back(as_index(n)), h.first[n] = h.weight.size();
    const Index layers = node.box.upper[axis_of_cut] - node.box.lower[axis_of_cut];
    h.weight.resize(h.weight.size() + as_size(layers));
  }
  return h;
}

// Number of ranks below the cut, and the first layer above it: the cut with the weight below nearest to the
// share of these ranks, and with at least a cell per rank. Without any weight all cells count equally.
std::pair<int, Index> Decomposition::cut_of(const Node& node, int axis, const std::int64_t* weight) const {
  const Index layers = node.box.upper[axis] - node.box.lower[axis];
  const double layer_cells = node.box.count() / layers;
  const std::int64_t total = std::accumulate(weight, weight + layers, std::int64_t{0});
  // Unequal numbers of ranks only if there are too few cells for equal ones.
  for (int ranks_below = node.ranks / 2; ranks_below > 0; --ranks_below) {
    const double share = static_cast<double>(total > 0 ? total : layers) * ranks_below / node.ranks;
    double below = 0, nearest = std::numeric_limits<double>::infinity();
    Index best = 0;
    for (Index cut = 1; cut < layers; ++cut) {
      below += total > 0 ? static_cast<double>(weight[cut - 1]) : 1;
      const bool enough =
          cut * layer_cells >= ranks_below && (layers - cut) * layer_cells >= node.ranks - ranks_below;
      if (enough && std::abs(below - share) < nearest) nearest = std::abs(below - share), best = cut;
    }
    if (best > 0) return {ranks_below, best};
  }
  throw std::logic_error("a box with fewer cells than ranks");
}

void Decomposition::split(const Histograms& h) {
  for (const int index : h.nodes) {
    const auto n = as_size(index);
    const Node node = nodes_[n];
    const int axis = cuts_[n].axis;
    const auto [ranks_below, layers_below] = cut_of(node, axis, &h.weight[h.first[n]]);
    Node lower{node.box, node.first_rank, ranks_below},
        upper{node.box, node.first_rank + ranks_below, node.ranks - ranks_below};
    const Index cut = node.box.lower[axis] + layers_below;
    lower.box.upper[axis] = upper.box.lower[axis] = cut;
    cuts_[n].cut = cut, cuts_[n].below = as_index(nodes_.size());
    add(lower), add(upper);
  }
}

void Decomposition::add(const Node& node) {
  nodes_.push_back(node);
  cuts_.push_back({.rank = node.first_rank});
}

DomainBox Decomposition::box(int rank, const Subdomain& subdomain) const {
  if (!exists()) return subdomain.periodic_box();
  const CellBox& cells = boxes_[as_size(rank)];
  DomainBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const bool open = subdomain.period().*kAxes[axis] == 0;
    const bool first = cells.lower[axis] == 0, last = cells.upper[axis] == grid_.cells[axis];
    box.min.*kAxes[axis] = first && open ? -kInfinity : grid_.lower_side(axis, cells.lower[axis]);
    box.max.*kAxes[axis] = last && open ? kInfinity : grid_.lower_side(axis, cells.upper[axis]);
  }
  return box;
}

Real measure_imbalance(const Ranks& ranks, std::int64_t weight) {
  const Real largest = ranks.max(static_cast<Real>(weight)), total = static_cast<Real>(ranks.sum(weight));
  return total > 0 ? largest * ranks.size() / total - 1 : 0;
}

}  // namespace scree
