#include "run/record/target_contacts.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {
namespace {

// Index of a placed wall's parent: placed walls follow the bodies, in their order.
std::size_t parent_of_wall(const Model& model, int wall) {
  std::size_t parent = model.bodies.size();
  for (int w = 0; w < wall; ++w) parent += model.walls[as_size(w)].has_pose();
  return parent;
}

// Moves the torque from the parent's origin to the wall's point, which moves with the wall.
ContactSum on_wall(const Wall& wall, ContactSum sum, const BodyMotion& motion) {
  sum.torque -= cross(body_arm(motion, wall.point), sum.force);
  return sum;
}

// The contacts of a row of bodies summed up, with torques about the global origin because the bodies move.
ContactSum row_sum(const std::vector<int>& bodies, const std::vector<ContactSum>& contacts,
                   const std::vector<BodyMotion>& motion) {
  ContactSum sum;
  for (const int b : bodies) {
    const ContactSum& one = contacts[b];
    sum.force += one.force;
    sum.torque += one.torque + cross(motion[b].position, one.force);
    sum.contacts += one.contacts;
  }
  return sum;
}

}  // namespace

std::vector<ContactSum> target_contacts(const Model& model, const BodyCoupling& link, const State& state,
                                        Backend& backend) {
  const std::vector<ContactTarget>& targets = model.output.history_contacts;
  const auto is_plane = [&](const ContactTarget& target) {
    return target.wall >= 0 && !model.walls[as_size(target.wall)].has_pose();
  };
  const auto is_mesh = [](const ContactTarget& target) { return target.mesh >= 0; };
  std::vector<int> planes;
  for (const ContactTarget& target : targets)
    if (is_plane(target)) planes.push_back(target.wall);
  std::vector<ContactSum> on_parents, on_surfaces;
  if (planes.size() < targets.size()) on_parents = backend.reports().parent_contacts();
  if (std::ranges::any_of(targets, is_mesh)) on_surfaces = backend.reports().surface_contacts();
  const std::vector<ContactSum> on_planes = backend.reports().wall_contacts(planes);
  std::vector<BodyMotion> motion;
  if (link.multibody() != nullptr) motion = link.multibody()->motion(state.bodies);
  std::vector<ContactSum> sums;
  auto plane = on_planes.begin();
  for (const ContactTarget& target : targets) {
    ContactSum& sum = sums.emplace_back();
    if (is_plane(target))
      sum = *plane++;
    else if (target.wall >= 0)
      sum = on_wall(model.walls[as_size(target.wall)], on_parents[parent_of_wall(model, target.wall)],
                    link.motion()[parent_of_wall(model, target.wall)]);
    else if (is_mesh(target))
      sum = on_surfaces[as_size(SurfaceSet::posed_mesh(model, target.bodies.front(), target.mesh))];
    else if (!target.row)
      sum = on_parents[target.bodies.front()];
    else if (!motion.empty())  // on rank 0
      sum = row_sum(target.bodies, on_parents, motion);
  }
  return sums;
}

}  // namespace scree
