#include "run/record/contact_network.hpp"

#include <utility>

#include "dem/history/contact_key.hpp"
#include "partition/id_order.hpp"

namespace scree {

ContactNetwork::ContactNetwork(const Model& model, const Ranks& ranks, GlobalId bound, ContactLines lines)
    : friction_steps_(model.rotates()) {
  const IdOrder order(ranks, bound, lines.global_id);
  const SurfaceSet surfaces(model);
  for (const ContactLine& line : lines.of_bodies) add(line, surfaces);
  for (const ContactLine& line : order.apply(std::move(lines.lines), std::move(lines.counts)))
    add(line, surfaces);
}

void ContactNetwork::add(const ContactLine& line, const SurfaceSet& surfaces) {
  const ShownContact& contact = line.contact;
  ends_.insert(ends_.end(), {line.start, line.start + contact.branch});
  force_.push_back(contact.force);
  normal_force_.push_back(contact.normal_force), tangential_force_.push_back(contact.tangential_force);
  overlap_.push_back(contact.overlap);
  if (friction_steps_) slip_.push_back(contact.slip);
  const auto body_of = [&](Index surface) {
    return surface >= surfaces.ground() ? surfaces.at(surface - surfaces.ground()).parent : -1;
  };
  const Index surface = surface_with_id(line.second);
  const bool with_surface = surface >= 0, with_body = surface >= surfaces.ground();
  first_.push_back(surface_with_id(line.first) >= 0 ? -1 : line.first);
  second_.push_back(with_surface ? -1 : line.second);
  kind_.push_back(static_cast<int>(with_body      ? ContactKind::body
                                   : with_surface ? ContactKind::wall
                                                  : ContactKind::particle));
  wall_.push_back(with_body ? -1 : surface);
  body_.push_back(body_of(surface)), first_body_.push_back(body_of(surface_with_id(line.first)));
}

LineSnapshot ContactNetwork::snapshot() const {
  LineSnapshot out{ends_, {}};
  const auto add = [&](const char* name, const DatasetLabel& label, const auto& values) {
    out.fields.push_back(field_of(name, label, values));
  };
  add("normal_force", {"N", "normal force; positive: repulsive"}, normal_force_);
  add("tangential_force", {"N", "magnitude of the tangential force"}, tangential_force_);
  add("force", {"N", "contact force on the particle or body at the line's start"}, force_);
  add("overlap", {"m", "overlap; negative: gap across which the two attract each other"}, overlap_);
  if (friction_steps_) add("slip", {"m", "elongation of the tangential spring"}, slip_);
  add("first", {"1", "global id of the particle at the line's start, the lower of two ids; -1: none"},
      first_);
  add("second", {"1", "global id of the particle at the line's end; -1: none"}, second_);
  add("kind", {"1", "partner at the line's end: 0 a particle, 1 a wall, 2 a body"}, kind_);
  add("wall",
      {"1", "wall at the line's end, counted from 0 in the deck's order, sides of the domain last; -1: none"},
      wall_);
  add("body", {"1", "body at the line's end, counted from 0 in the deck's order; -1: none"}, body_);
  add("first_body",
      {"1",
       "body whose disc, sphere or mesh corner is at the line's start, counted likewise; -1: a particle"},
      first_body_);
  return out;
}

std::vector<std::string> ContactNetwork::field_names(const Model& model) {
  ContactNetwork none;
  none.friction_steps_ = model.rotates();
  std::vector<std::string> names;
  for (const PointField& field : none.snapshot().fields) names.push_back(field.name);
  return names;
}

}  // namespace scree
