#include "mesh/box_tree.hpp"

namespace scree {

namespace {

const MeshBox kNoBox{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

}  // namespace

TriangleCorners corners_of(const TriangleMesh& mesh, Index triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

void extend(MeshBox& box, const MeshBox& other) {
  box.min = {std::min(box.min.x, other.min.x), std::min(box.min.y, other.min.y),
             std::min(box.min.z, other.min.z)};
  box.max = {std::max(box.max.x, other.max.x), std::max(box.max.y, other.max.y),
             std::max(box.max.z, other.max.z)};
}

std::vector<MeshBox> boxes_of(const TriangleMesh& mesh) {
  std::vector<MeshBox> boxes(mesh.triangles.size(), kNoBox);
  for (Index t = 0; t < static_cast<Index>(boxes.size()); ++t)
    for (const Vec3 v : corners_of(mesh, t)) extend(boxes[t], {v, v});
  return boxes;
}

Real extent_of(const std::vector<MeshBox>& boxes) {
  MeshBox whole = kNoBox;
  for (const MeshBox& box : boxes) extend(whole, box);
  return norm(whole.max - whole.min);
}

std::vector<MeshBox> shell_boxes(const std::vector<MeshBox>& boxes,
                                 const std::vector<Index>& shell_of_triangle) {
  std::vector<MeshBox> shells(1 + static_cast<std::size_t>(*std::ranges::max_element(shell_of_triangle)),
                              kNoBox);
  for (std::size_t t = 0; t < boxes.size(); ++t) extend(shells[shell_of_triangle[t]], boxes[t]);
  return shells;
}

std::vector<Index> triangles_near_others(const std::vector<MeshBox>& boxes,
                                         const std::vector<Index>& shell_of_triangle) {
  const std::vector<MeshBox> shells = shell_boxes(boxes, shell_of_triangle);
  const BoxTree tree(shells);
  std::vector<Index> near;
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    bool found = false;
    tree.for_each_at(boxes[t], [&](Index s) { found = found || s != shell_of_triangle[t]; });
    if (found) near.push_back(static_cast<Index>(t));
  }
  return near;
}

}  // namespace scree
