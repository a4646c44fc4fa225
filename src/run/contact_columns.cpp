#include "run/contact_columns.hpp"

#include <algorithm>
#include <string>

namespace scree {
namespace {

std::string torque_text(const ContactTarget& target) {
  if (target.wall >= 0) return "torque of these forces about the wall's point";
  return target.row ? "torque of these forces about the origin"
                    : "torque of these forces about the body's centre";
}

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

void add_contact_columns(const Model& model, std::vector<HistoryColumn>& columns) {
  for (const ContactTarget& target : model.output.history_contacts) {
    const std::string group = "contacts/" + target.name;
    const std::string what = target.wall >= 0 ? "the wall" : target.row ? "the row's bodies" : "the body";
    for (const char* axis : {"x", "y", "z"})
      columns.push_back({group, std::string("f") + axis, "N", "contact force on " + what});
    for (const char* axis : {"x", "y", "z"})
      columns.push_back({group, std::string("torque_") + axis, "N m", torque_text(target)});
    columns.push_back(
        {group, "contacts", "1",
         "contacts of " + what + " with particles, bodies" + (target.wall >= 0 ? "" : " and walls")});
  }
}

void add_contact_values(const Model& model, const BodyLink& link, const State& state, Backend& backend,
                        std::vector<Real>& row) {
  const std::vector<ContactTarget>& targets = model.output.history_contacts;
  std::vector<int> walls;
  for (const ContactTarget& target : targets)
    if (target.wall >= 0) walls.push_back(target.wall);
  std::vector<ContactSum> on_bodies;
  if (walls.size() < targets.size()) on_bodies = backend.body_contacts();
  const std::vector<ContactSum> on_walls = backend.wall_contacts(walls);
  std::vector<BodyMotion> motion;
  if (link.multibody() != nullptr) motion = link.multibody()->motion(state.bodies);
  auto wall = on_walls.begin();
  for (const ContactTarget& target : targets) {
    ContactSum sum;
    if (target.wall >= 0)
      sum = *wall++;
    else if (!target.row)
      sum = on_bodies[target.bodies.front()];
    else if (!motion.empty())  // rank 0
      sum = row_sum(target.bodies, on_bodies, motion);
    row.insert(row.end(), {sum.force.x, sum.force.y, sum.force.z, sum.torque.x, sum.torque.y, sum.torque.z,
                           static_cast<Real>(sum.contacts)});
  }
}

}  // namespace scree
