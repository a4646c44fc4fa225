#include "dem/surface_side.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

SurfaceSide::SurfaceSide(const Model& model, const Subdomain& subdomain, const Ranks& ranks)
    : model_(model),
      subdomain_(subdomain),
      ranks_(ranks),
      surfaces_(model),
      bodies_(model, surfaces_, subdomain),
      motion_(model.bodies.size()),
      step_start_(motion_),
      start_before_(motion_),
      image_(static_cast<std::size_t>(size())),
      placed_(static_cast<std::size_t>(size())),
      step_(static_cast<std::size_t>(size())),
      step_turn_(step_) {}

void SurfaceSide::bring_into_box() {
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.on_body(s);
    const Vec3 p = point_motion(motion_[surface.carrier], surface.point).position;
    image_[s] = {};
    subdomain_.wrap(snap(p, subdomain_.snap_constant()), image_[s]);
  }
}

void SurfaceSide::build_list(Real skin) {
  listed_ = placed_;
  if (ranks_.is_root()) bodies_.build(placed_, skin);
}

Real SurfaceSide::place() {
  Real squared = 0;
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.on_body(s);
    const BodyMotion& body = motion_[surface.carrier];
    const Vec3 arm = body_arm(body, surface.point);
    const ImageCount image = image_[s];
    const Vec3 with_body = snap(body.position + arm, subdomain_.snap_constant());
    const Vec3 point = moved_by_periods(with_body, {-image.x, -image.y, -image.z}, subdomain_.period());
    step_[s] = point - placed_[s].point;
    squared = std::max(squared, dot(step_[s], step_[s]));
    const Vec3 turned = placed_[s].turn;
    placed_[s] = {surface.kind, surface.material, surface.radius,    point, surface.normal,
                  arm,          body.velocity,    global_spin(body), {},    {}};
    if (!model_.rotates()) continue;
    placed_[s].travel = with_body - point_with(step_start_, s);
    placed_[s].turn = turn_between(step_start_[surface.carrier], body);
    step_turn_[s] = surface.radius * (placed_[s].turn - turned);
  }
  return std::sqrt(squared);
}

Vec3 SurfaceSide::point_with(const std::vector<BodyMotion>& motion, Index s) const {
  const Surface& surface = surfaces_.on_body(s);
  const BodyMotion& body = motion[surface.carrier];
  return snap(body.position + body_arm(body, surface.point), subdomain_.snap_constant());
}

void SurfaceSide::close_step() {
  if (!model_.rotates()) return;
  start_before_ = step_start_, step_start_ = motion_;
  for (PlacedSurface& surface : placed_) surface.travel = surface.turn = {};
}

void SurfaceSide::reopen_step() {
  if (!model_.rotates()) return;
  step_start_ = start_before_;
  place();
}

Real SurfaceSide::largest_displacement(const std::vector<PlacedSurface>& from) const {
  Real squared = 0;
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    const Vec3 d = placed_[s].point - from[s].point;
    const Real value = dot(d, d);
    if (!(value <= squared)) squared = value;  // a NaN stays
    if (std::isnan(squared)) break;
  }
  return std::sqrt(squared);
}

void SurfaceSide::take_loads(std::span<const InstantSums> of_particles) {
  loads_.assign(of_particles.begin(), of_particles.end());
  if (!ranks_.is_root()) return;
  bodies_.find(placed_);
  for (const BodyLoad& load : bodies_.loads())
    if (load.sums.contacts > 0) loads_.push_back(load.sums);
}

void SurfaceSide::take_steps(std::span<const StepSums> of_particles, Real h) {
  steps_.assign(of_particles.begin(), of_particles.end());
  if (!ranks_.is_root()) return;
  bodies_.find(placed_, start_, h);
  for (const BodyStep& step : bodies_.steps())
    if (step.sums.contacts > 0) steps_.push_back(step.sums);
}

// Of all ranks, ordered by surface, one entry each; on rank 0.
template <class Sums>
std::vector<Sums> SurfaceSide::merged(std::vector<Sums> sums) const {
  sums = ranks_.gather(std::move(sums));
  std::stable_sort(sums.begin(), sums.end(),
                   [](const Sums& a, const Sums& b) { return a.surface < b.surface; });
  std::vector<Sums> out;
  for (const Sums& part : sums) {
    if (out.empty() || out.back().surface != part.surface)
      out.push_back(part);
    else
      out.back().add(part);
  }
  return out;
}

void SurfaceSide::reduce(ContactWrenches& step, std::vector<BodyWrench>& end) const {
  std::fill(step.wrench.begin(), step.wrench.end(), BodyWrench{});
  std::fill(end.begin(), end.end(), BodyWrench{});
  step.stiffness.clear();
  for (const StepSums& sums : merged(steps_)) {
    const int body = surfaces_.on_body(sums.surface).carrier;
    end[body] += sums.wrench(), step.wrench[body] += sums.wrench(kWrenchTerms);
    // The surfaces of a body follow each other.
    if (step.stiffness.empty() || step.stiffness.back().body != body)
      step.stiffness.push_back({body, {}, {}});
    WrenchStiffness& blocks = step.stiffness.back();
    for (int k = 0; k < kBlockTerms; ++k) {
      blocks.stiffness[k] += sums.sum[2 * kWrenchTerms + k].value();
      blocks.damping[k] += sums.sum[2 * kWrenchTerms + kBlockTerms + k].value();
    }
  }
}

void SurfaceSide::reduce(std::vector<BodyWrench>& end) const {
  std::fill(end.begin(), end.end(), BodyWrench{});
  for (const InstantSums& sums : merged(loads_))
    end[surfaces_.on_body(sums.surface).carrier] += sums.wrench();
}

std::vector<ContactSum> SurfaceSide::body_contacts() const {
  std::vector<ContactSum> of_body(motion_.size());
  for (const InstantSums& sums : merged(loads_)) {
    ContactSum& sum = of_body[surfaces_.on_body(sums.surface).carrier];
    const BodyWrench wrench = sums.wrench();
    sum.force += wrench.force, sum.torque += wrench.torque, sum.contacts += sums.contacts;
  }
  return of_body;
}

void SurfaceSide::book_losses(Real h) {
  if (!ranks_.is_root()) return;
  const Real power = bodies_.loss_power();
  losses_.contact_loss += h / 2 * (losses_.loss_power + power);
  losses_.loss_power = power;
}

void SurfaceSide::book_step() {
  if (!ranks_.is_root()) return;
  ContactBooks sum;
  for (const BodyStep& step : bodies_.steps()) sum.add(step.books, 1);
  losses_.contact_loss += sum.dissipated, losses_.integrator_loss += sum.integrator;
}

ShapePack SurfaceSide::pack() const {
  ShapePack pack;
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.on_body(s);
    pack.body.push_back(surface.carrier);
    pack.radius.push_back(surface.radius);
    const PointMotion point = point_motion(motion_[surface.carrier], surface.point);
    ImageCount unused;
    pack.position.push_back(subdomain_.wrap(point.position, unused));
    pack.velocity.push_back(point.velocity);
  }
  pack.force.resize(pack.body.size()), pack.contacts.resize(pack.body.size());
  for (const InstantSums& sums : merged(loads_)) {
    pack.force[sums.surface] = sums.wrench().force;
    pack.contacts[sums.surface] = static_cast<int>(sums.contacts);
  }
  return pack;
}

}  // namespace scree
