#include "dem/surfaces/triangle_sums.hpp"

#include <algorithm>

namespace scree {
namespace {

void add_contact(const SurfaceLoad& contact, const MeshTouch& touch, TriangleSums& sums) {
  const Vec3 normal = touch.geometry.normal();  // away from the surface
  const Real normal_force = dot(contact.load.force, normal);
  const Vec3 tangential_force = normal_force * normal - contact.load.force;
  sums.normal.add(normal_force);
  sums.tangential[0].add(tangential_force.x), sums.tangential[1].add(tangential_force.y),
      sums.tangential[2].add(tangential_force.z);
}

}  // namespace

void TriangleSums::add(const TriangleSums& part) {
  normal.add(part.normal);
  for (int k = 0; k < 3; ++k) tangential[k].add(part.tangential[k]);
}

std::vector<TriangleSums> triangle_sums(const MeshLoads& contacts, const SurfaceNumbers& numbers) {
  std::vector<TriangleSums> sums;
  for (const MeshGroup& group : contacts.groups)
    for (Index entry = group.entry; entry < group.entry + group.entries; ++entry) {
      const SurfaceLoad& load = contacts.loads[static_cast<std::size_t>(entry)];
      if (!load.touches) continue;
      const MeshTouch& touch = contacts.touches[static_cast<std::size_t>(entry)];
      const Index number = contacts.surfaces[static_cast<std::size_t>(entry)];
      TriangleSums& of = sums.emplace_back();
      of.surface = numbers.placed(number), of.triangle = touch.triangle;
      add_contact(load, touch, of);
    }
  return merged_by_key(std::move(sums));
}

}  // namespace scree
