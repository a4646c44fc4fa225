#include "run/target_contacts.hpp"

namespace scree {
namespace {

// The contacts of a row as one: torques about the origin, because the bodies move.
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

std::vector<ContactSum> target_contacts(const Model& model, const BodyLink& link, const State& state,
                                        Backend& backend) {
  const std::vector<ContactTarget>& targets = model.output.history_contacts;
  std::vector<int> walls;
  for (const ContactTarget& target : targets)
    if (target.wall >= 0) walls.push_back(target.wall);
  std::vector<ContactSum> on_bodies;
  if (walls.size() < targets.size()) on_bodies = backend.reports().body_contacts();
  const std::vector<ContactSum> on_walls = backend.reports().wall_contacts(walls);
  std::vector<BodyMotion> motion;
  if (link.multibody() != nullptr) motion = link.multibody()->motion(state.bodies);
  std::vector<ContactSum> sums;
  auto wall = on_walls.begin();
  for (const ContactTarget& target : targets) {
    ContactSum& sum = sums.emplace_back();
    if (target.wall >= 0)
      sum = *wall++;
    else if (!target.row)
      sum = on_bodies[target.bodies.front()];
    else if (!motion.empty())  // rank 0
      sum = row_sum(target.bodies, on_bodies, motion);
  }
  return sums;
}

}  // namespace scree
