#include "partition/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.hpp"

namespace scree {
namespace {

// Histograms have one entry per layer of cells; more layers than this make cuts no better.
constexpr Real kMostLayers = 1 << 14;

constexpr Real Vec3::* kAxes[3] = {&Vec3::x, &Vec3::y, &Vec3::z};

}  // namespace

Index DomainGrid::cell(int axis, Real x) const {
  const Real at = std::floor((x - min.*kAxes[axis]) / edge.*kAxes[axis]);
  if (!(at > 0)) return 0;
  return at < cells[axis] ? static_cast<Index>(at) : cells[axis] - 1;
}

Real DomainGrid::lower_side(int axis, Index cell) const {
  return min.*kAxes[axis] + cell * edge.*kAxes[axis];
}

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

// Weights per layer of the boxes that are to be cut, along the axis of each cut: one after the other.
struct Decomposition::Histograms {
  std::vector<int> nodes;
  std::vector<std::size_t> first;  // entry of the lowest layer, per node
  std::vector<std::int64_t> weight;
};

Decomposition::Decomposition(const Ranks& ranks, const DomainGrid& grid, std::span<const Vec4> position,
                             std::span<const std::int64_t> weight)
    : grid_(grid), boxes_(static_cast<std::size_t>(ranks.size())) {
  if (grid.count() < ranks.size())
    throw InputError("mpirun -n " + std::to_string(ranks.size()) + ": the space has only " +
                     std::to_string(static_cast<std::int64_t>(grid.count())) +
                     " cells as wide as the halo (a largest diameter and the skin); a subdomain would be "
                     "narrower than that: start at most so many ranks");
  Node root{{{0, 0, 0}, {grid.cells[0], grid.cells[1], grid.cells[2]}}, 0, ranks.size()};
  nodes_.push_back(root);
  std::vector<int> node_of(position.size(), 0);
  for (std::size_t level_begin = 0, level_end = 1; level_begin < level_end;) {
    Histograms h;
    std::vector<std::size_t> entry_of(nodes_.size());
    for (std::size_t n = level_begin; n < level_end; ++n) {
      Node& node = nodes_[n];
      if (node.ranks == 1) {
        boxes_[static_cast<std::size_t>(node.first_rank)] = node.box;
        continue;
      }
      Real longest = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const Index layers = node.box.upper[axis] - node.box.lower[axis];
        const Real extent = layers * grid_.edge.*kAxes[axis];
        if (layers > 1 && extent > longest) longest = extent, node.axis = axis;
      }
      entry_of[n] = h.weight.size();
      h.nodes.push_back(static_cast<int>(n)), h.first.push_back(h.weight.size());
      h.weight.resize(h.weight.size() +
                      static_cast<std::size_t>(node.box.upper[node.axis] - node.box.lower[node.axis]));
    }
    if (h.nodes.empty()) break;
    const auto layer = [&](const Node& node, Vec4 p) { return grid_.cell(node.axis, xyz(p).*kAxes[node.axis]); };
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Node& node = nodes_[static_cast<std::size_t>(node_of[i])];
      if (node.axis < 0) continue;
      const Index at = layer(node, position[i]) - node.box.lower[node.axis];
      h.weight[entry_of[static_cast<std::size_t>(node_of[i])] + static_cast<std::size_t>(at)] += weight[i];
    }
    ranks.sum(std::span<std::int64_t>(h.weight));
    split(h);
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Node& node = nodes_[static_cast<std::size_t>(node_of[i])];
      if (node.axis >= 0) node_of[i] = node.below + (layer(node, position[i]) >= node.cut);
    }
    level_begin = level_end, level_end = nodes_.size();
  }
}

// Cuts each box where the weight below comes nearest to its ranks' share, with a cell left for every rank.
void Decomposition::split(const Histograms& h) {
  for (std::size_t k = 0; k < h.nodes.size(); ++k) {
    const auto n = static_cast<std::size_t>(h.nodes[k]);
    const CellBox box = nodes_[n].box;
    const int axis = nodes_[n].axis, ranks = nodes_[n].ranks, first_rank = nodes_[n].first_rank;
    const Index layers = box.upper[axis] - box.lower[axis];
    const double layer_cells = box.count() / layers;
    const std::int64_t* weight = &h.weight[h.first[k]];
    double total = 0;
    for (Index layer = 0; layer < layers; ++layer) total += static_cast<double>(weight[layer]);

    int ranks_below = ranks / 2;
    Index best = 0;
    // An uneven number of ranks on both sides only where cells are too few for even ones.
    for (bool found = false; !found; found || --ranks_below) {
      double below = 0, nearest = std::numeric_limits<double>::infinity();
      for (Index cut = 1; cut < layers; ++cut) {
        below += total > 0 ? static_cast<double>(weight[cut - 1]) : 1;
        const double share = (total > 0 ? total : layers) * ranks_below / ranks;
        if (cut * layer_cells < ranks_below || (layers - cut) * layer_cells < ranks - ranks_below) continue;
        if (std::abs(below - share) < nearest) nearest = std::abs(below - share), best = cut, found = true;
      }
    }
    Node lower{box, first_rank, ranks_below}, upper{box, first_rank + ranks_below, ranks - ranks_below};
    nodes_[n].cut = lower.box.upper[axis] = upper.box.lower[axis] = box.lower[axis] + best;
    nodes_[n].below = static_cast<int>(nodes_.size());
    nodes_.push_back(lower), nodes_.push_back(upper);
  }
}

int Decomposition::owner(Vec3 p) const {
  const Node* node = nodes_.data();
  while (node->axis >= 0)
    node = &nodes_[static_cast<std::size_t>(node->below +
                                            (grid_.cell(node->axis, p.*kAxes[node->axis]) >= node->cut))];
  return node->first_rank;
}

DomainBox Decomposition::box(int rank, const Subdomain& subdomain) const {
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  const CellBox& cells = boxes_[static_cast<std::size_t>(rank)];
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
