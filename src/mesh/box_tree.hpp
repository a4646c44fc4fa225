// Boxes around triangles and shells, and a search for the boxes that overlap a given one.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "base/types.hpp"
#include "mesh/mesh_view.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

using TriangleCorners = std::array<Vec3, 3>;
TriangleCorners corners_of(const TriangleMesh& mesh, Index triangle);

void extend(MeshBox& box, const MeshBox& other);
inline bool overlap(const MeshBox& a, const MeshBox& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

// One box per triangle.
std::vector<MeshBox> boxes_of(const TriangleMesh& mesh);
// The diagonal of the box around all boxes [m].
Real extent_of(const std::vector<MeshBox>& boxes);
// One box per shell, from those of the triangles.
std::vector<MeshBox> shell_boxes(const std::vector<MeshBox>& boxes,
                                 const std::vector<Index>& shell_of_triangle);
// Triangles whose boxes overlap the box of another shell, increasing.
std::vector<Index> triangles_near_others(const std::vector<MeshBox>& boxes,
                                         const std::vector<Index>& shell_of_triangle);

// A tree of boxes, split at the median of their centres along the longest side. Keeps a reference: the boxes
// must outlive it.
class BoxTree {
 public:
  explicit BoxTree(const std::vector<MeshBox>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), Index(0));
    if (!boxes.empty()) build(0, static_cast<Index>(boxes.size()));
  }
  // Calls visit(number) for all boxes that overlap the one given.
  template <class Visit>
  void for_each_at(const MeshBox& box, const Visit& visit) const {
    if (!nodes_.empty()) visit_node(0, box, visit);
  }

 private:
  static constexpr Index kLeaf = 8;
  struct Node {
    MeshBox box;
    Index first, last;  // into order_
    Index second = -1;  // second child; the first child follows the node; -1: a leaf
  };

  Index build(Index first, Index last) {
    const auto number = static_cast<Index>(nodes_.size());
    MeshBox box = boxes_[order_[first]];
    for (Index i = first; i < last; ++i) extend(box, boxes_[order_[i]]);
    nodes_.push_back({box, first, last});
    if (last - first <= kLeaf) return number;
    const Vec3 size = box.max - box.min;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const Index middle = first + (last - first) / 2;
    const auto along = [&](Vec3 v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
    const auto centre = [&](Index i) { return along(boxes_[i].min) + along(boxes_[i].max); };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](Index i, Index j) { return centre(i) < centre(j); });
    build(first, middle);
    const Index second = build(middle, last);
    nodes_[number].second = second;
    return number;
  }
  template <class Visit>
  void visit_node(Index number, const MeshBox& box, const Visit& visit) const {
    const Node& node = nodes_[number];
    if (!overlap(node.box, box)) return;
    if (node.second >= 0) return visit_node(number + 1, box, visit), visit_node(node.second, box, visit);
    for (Index i = node.first; i < node.last; ++i)
      if (overlap(boxes_[order_[i]], box)) visit(order_[i]);
  }

  const std::vector<MeshBox>& boxes_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace scree
