#include "dem/shape_side.hpp"

#include <algorithm>
#include <cmath>

#include "partition/halo.hpp"

namespace scree {

ShapeSide::ShapeSide(const Model& model, const Subdomain& subdomain)
    : subdomain_(subdomain),
      shapes_(model),
      motion_(model.bodies.size()),
      image_(static_cast<std::size_t>(shapes_.size())) {}

void ShapeSide::lay_out(Real width, ItemLayout& layout) {
  layout.shapes = shapes_.size();
  std::vector<Vec4> centers(shapes_.items().size());
  for (Index s = 0; s < layout.shapes; ++s) {
    const ShapeItem& shape = shapes_.items()[s];
    const Vec3 p = snap(point_motion(motion_[shape.body], shape.offset).position, subdomain_.snap_constant());
    image_[s] = {};
    centers[s] = vec4(subdomain_.wrap(p, image_[s]), shape.radius);
  }
  layout.shape_images = periodic_images(subdomain_, centers, width);
  layout.items = layout.first_shape + layout.shapes + static_cast<Index>(layout.shape_images.size());
  const auto items = static_cast<std::size_t>(layout.items - layout.first_shape);
  position_.resize(items), velocity_.resize(items), contacts_.resize(items);
  step_.assign(items, Vec3{});
}

std::int64_t ShapeSide::row_key_of(const ItemLayout& layout, Index item) const {
  const GlobalId id = shapes_.items()[layout.shape_of(item)].global_id;
  if (!layout.is_shape_image(item)) return row_key(id);
  return row_key(id, layout.shape_images[item - layout.first_shape - layout.shapes].image);
}

Real ShapeSide::place(const ItemLayout& layout) {
  Real squared = 0;
  for (Index s = 0; s < layout.items - layout.first_shape; ++s) {
    const Index item = layout.first_shape + s, shape = layout.shape_of(item);
    const ShapeItem& source = shapes_.items()[shape];
    const PointMotion point = point_motion(motion_[source.body], source.offset);
    const ImageCount image = image_[shape];
    Vec3 position = moved_by_periods(snap(point.position, subdomain_.snap_constant()),
                                     {-image.x, -image.y, -image.z}, subdomain_.period());
    if (layout.is_shape_image(item)) position += layout.shape_images[s - layout.shapes].shift;
    step_[s] = position - xyz(position_[s]);
    squared = std::max(squared, dot(step_[s], step_[s]));
    position_[s] = vec4(position, source.radius);
    velocity_[s] = vec4(point.velocity, kInfinity);
  }
  return std::sqrt(squared);
}

// Ordered by shape; those of all ranks on rank 0. A shape and its images across periodic sides are one: which
// of them a particle touches changes when the particle is brought back into the box.
std::vector<ShapeSide::Touched> ShapeSide::touched(const ItemLayout& layout, const Ranks& ranks) const {
  std::vector<Touched> all;
  for (std::size_t s = 0; s < contacts_.size(); ++s)
    if (contacts_[s].forces.contacts > 0)
      all.push_back({layout.shape_of(layout.first_shape + static_cast<Index>(s)), contacts_[s].forces});
  all = ranks.gather(std::move(all));
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.shape < b.shape; });
  std::vector<Touched> merged;
  for (const Touched& one : all) {
    if (merged.empty() || merged.back().shape != one.shape)
      merged.push_back(one);
    else
      merged.back().forces.add(one.forces);
  }
  return merged;
}

template <class Visit>
void ShapeSide::for_each_touched(const ItemLayout& layout, const Ranks& ranks, const Visit& visit) const {
  if (!ranks.alone() || !layout.shape_images.empty()) {
    for (const Touched& one : touched(layout, ranks)) visit(one.shape, one.forces);
    return;
  }
  for (std::size_t s = 0; s < contacts_.size(); ++s)
    if (contacts_[s].forces.contacts > 0) visit(static_cast<Index>(s), contacts_[s].forces);
}

Vec3 ShapeSide::arm_of(const ShapeItem& shape) const {
  return point_motion(motion_[shape.body], shape.offset).position - motion_[shape.body].position;
}

void ShapeSide::reduce(const ItemLayout& layout, const Ranks& ranks, ContactWrenches& step,
                       std::vector<BodyWrench>& end) const {
  std::fill(step.wrench.begin(), step.wrench.end(), BodyWrench{});
  std::fill(end.begin(), end.end(), BodyWrench{});
  step.stiffness.clear();
  for_each_touched(layout, ranks, [&](Index s, const ShapeForces& f) {
    const ShapeItem& shape = shapes_.items()[s];
    const Vec3 arm = arm_of(shape);
    add_point_force(step.wrench[shape.body], f.step.value(), arm);
    add_point_force(end[shape.body], f.end.value(), arm);
    // The shapes of a body follow each other.
    if (step.stiffness.empty() || step.stiffness.back().body != shape.body)
      step.stiffness.push_back({shape.body});
    add_point_stiffness(step.stiffness.back(), arm, f.stiffness.value(), f.damping.value());
  });
}

void ShapeSide::reduce(const ItemLayout& layout, const Ranks& ranks, std::vector<BodyWrench>& end) const {
  std::fill(end.begin(), end.end(), BodyWrench{});
  for_each_touched(layout, ranks, [&](Index s, const ShapeForces& f) {
    const ShapeItem& shape = shapes_.items()[s];
    add_point_force(end[shape.body], f.end.value(), arm_of(shape));
  });
}

std::vector<ContactSum> ShapeSide::body_contacts(const ItemLayout& layout, const Ranks& ranks) const {
  std::vector<BodyWrench> wrench(motion_.size());
  std::vector<ContactSum> sums(motion_.size());
  for_each_touched(layout, ranks, [&](Index s, const ShapeForces& f) {
    const ShapeItem& shape = shapes_.items()[s];
    add_point_force(wrench[shape.body], f.end.value(), arm_of(shape));
    sums[shape.body].contacts += f.contacts;
  });
  for (std::size_t b = 0; b < sums.size(); ++b)
    sums[b].force = wrench[b].force, sums[b].torque = wrench[b].torque;
  return sums;
}

void ShapeSide::take_contacts(ContactSpan span, std::span<const ShapeContact> found) {
  for (std::size_t s = 0; s < found.size(); ++s) store(span, found[s], contacts_[s]);
}

void ShapeSide::book_losses(Real h) {
  Real power = 0;
  for (const ShapeContact& contact : contacts_) power += contact.loss;
  losses_.contact_loss += h / 2 * (losses_.loss_power + power);
  losses_.loss_power = power;
}

void ShapeSide::book_step(std::span<const ContactBooks> items) {
  ContactBooks sum;
  for (const ContactBooks& item : items) sum.add(item, 1);
  losses_.contact_loss += sum.dissipated, losses_.integrator_loss += sum.integrator;
}

Real ShapeSide::elastic_energy() const {
  Real sum = 0;
  for (const ShapeContact& contact : contacts_) sum += contact.energy;
  return sum;
}

Real ShapeSide::pairs() const {
  Real sum = 0;
  for (const ShapeContact& contact : contacts_) sum += contact.pairs;
  return sum;
}

ShapePack ShapeSide::pack(const ItemLayout& layout, const Ranks& ranks) const {
  ShapePack pack;
  for (const ShapeItem& shape : shapes_.items()) {
    pack.body.push_back(shape.body);
    pack.radius.push_back(shape.radius);
    const PointMotion point = point_motion(motion_[shape.body], shape.offset);
    ImageCount unused;
    pack.position.push_back(subdomain_.wrap(point.position, unused));
    pack.velocity.push_back(point.velocity);
  }
  pack.force.resize(shapes_.items().size()), pack.contacts.resize(shapes_.items().size());
  for_each_touched(layout, ranks, [&](Index s, const ShapeForces& f) {
    pack.force[s] = f.end.value();
    pack.contacts[s] = static_cast<int>(f.contacts);
  });
  return pack;
}

}  // namespace scree
