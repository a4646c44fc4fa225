#include "dem/surfaces/corner_set.hpp"

#include <algorithm>

#include "base/countable.hpp"
#include "model/derived/mesh_corners.hpp"

namespace scree {

CornerSet::CornerSet(const Model& model, const SurfaceSet& surfaces) : surfaces_(surfaces.placed()) {
  std::size_t next = static_cast<std::size_t>(surfaces_);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (std::size_t m = 0; m < model.bodies[b].meshes.size(); ++m) {
      const MeshShape& shape = model.bodies[b].meshes[m];
      if (!touches_planes(model, b, shape)) continue;
      const HullCorners* const hull = model.meshes[static_cast<std::size_t>(shape.mesh)].corners.get();
      meshes_.push_back({SurfaceSet::posed_mesh(model, static_cast<int>(b), static_cast<int>(m)),
                         static_cast<Index>(next), hull});
      next += hull->corners.size();
      countable(next, "bodies: more corners of meshes");
    }
  if (!empty() && (model.rolls() || model.is_cohesive())) own_materials_ = model.contact.materials();
}

const CornerSet::OfMesh& CornerSet::mesh_of(Index corner) const {
  return *(std::ranges::upper_bound(meshes_, corner, {}, &OfMesh::first) - 1);
}

namespace {

bool is_near(const SurfacePoses& poses, std::span<const WallPlane> planes, Vec3 p, Real margin) {
  for (const WallPlane& wall : planes) {
    const SurfacePose* const placed =
        wall.placed < 0 ? nullptr : &poses.placed[static_cast<std::size_t>(wall.placed)];
    if (placed != nullptr && placed->kind != SurfaceKind::plane) continue;
    const Vec3 point = placed != nullptr ? placed->point : wall.point;
    if (dot(p - point, placed != nullptr ? placed->normal : wall.normal) < margin) return true;
  }
  return false;
}

}  // namespace

void CornerSet::add_near_planes(const SurfacePoses& poses, std::span<const WallPlane> planes, Real margin,
                                std::vector<Index>& to) const {
  for (const OfMesh& mesh : meshes_) {
    const SurfacePose& placed = poses.placed[static_cast<std::size_t>(mesh.surface)];
    const Mat3& axes = poses.frames[static_cast<std::size_t>(placed.frame)].axes;
    if (!is_near(poses, planes, placed.point + axes * mesh.hull->middle, mesh.hull->bounding_radius + margin))
      continue;
    for (std::size_t k = 0; k < mesh.hull->corners.size(); ++k)
      if (is_near(poses, planes, placed.point + axes * mesh.hull->corners[k], margin))
        to.push_back(mesh.first + static_cast<Index>(k));
  }
}

Contact CornerSet::with_own_materials(Contact contact) const {
  if (own_materials_ == 0) return contact;
  const auto materials = static_cast<std::size_t>(contact.materials());
  const auto twice = [&]<class T>(const std::vector<T>& of_pairs) {
    std::vector<T> out;
    for (std::size_t i = 0; i < 2 * materials && !of_pairs.empty(); ++i)
      for (std::size_t j = 0; j < 2 * materials; ++j)
        out.push_back(of_pairs[i % materials * materials + j % materials]);
    return out;
  };
  contact.laws = twice(contact.laws), contact.friction = twice(contact.friction);
  contact.rolling = twice(contact.rolling), contact.wear = twice(contact.wear);
  for (std::size_t i = 0; i < 2 * materials; ++i)
    for (std::size_t j = 0; j < 2 * materials; ++j) {
      if (std::max(i, j) < materials) continue;
      const std::size_t pair = i * 2 * materials + j;
      if (!contact.rolling.empty()) contact.rolling[pair] = {};
      // The damper of a cohesive law is that of a law with tension.
      NormalLawParameters& law = contact.laws[pair];
      if (law.is_cohesive()) law = law.without_cohesion(), law.tension = true;
    }
  contact.material_names.resize(2 * materials);
  return contact;
}

// Along periodic axes positions are multiples of the domain's quantum, so that they do not depend on the
// image of the mesh in the periodic box.
CornerPose corner_pose(const SurfacePose& mesh, const SurfaceFrame& frame, Vec3 position, bool at_start,
                       Vec3 snap_constant) {
  const Vec3 before = frame.before * position, turned = at_start ? before : frame.axes * position;
  const Vec3 from_point = snap(turned, snap_constant);
  return {mesh.point + from_point, mesh.arm + turned, mesh.velocity_at(turned),
          mesh.displacement + (from_point - snap(before, snap_constant))};
}

}  // namespace scree
