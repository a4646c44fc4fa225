#include "dem/host/host_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "base/box.hpp"
#include "base/mat3.hpp"
#include "mesh/surface_mesh.hpp"

namespace scree {
namespace {

// k-th corner of a box, k = 0 ... 7.
template <class AnyBox>
Vec3 corner_of(const AnyBox& box, int k) {
  return {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z};
}

}  // namespace

HostSurfaces::HostSurfaces(const Model& model, const Subdomain& subdomain, const Ranks& ranks)
    : model_(model),
      subdomain_(subdomain),
      ranks_(ranks),
      surfaces_(model),
      bodies_(model, surfaces_, subdomain),
      motion_(surfaces_.parents()),
      step_start_(motion_),
      start_before_(motion_),
      image_(static_cast<std::size_t>(size())),
      placed_(static_cast<std::size_t>(size())),
      extra_travel_(static_cast<std::size_t>(size())),
      step_(static_cast<std::size_t>(size())),
      step_rotation_(step_) {
  for (const ModelMesh& mesh : model.meshes)
    meshes_.push_back(mesh.surface->view()), boxes_.push_back(mesh.surface->box);
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    if (surface.kind == SurfaceKind::sphere) continue;
    placed_[s].frame = static_cast<Index>(frames_.size());
    frames_.push_back({identity3(), identity3(), surface.normal, surface.mesh});
    if (surface.kind == SurfaceKind::mesh) span(surface, frames_.back());
    if (!surfaces_.is_on_body(s))
      frames_.back().surface_velocity =
          model.walls[static_cast<std::size_t>(surfaces_.number_of(s))].surface_velocity;
  }
  plan_list(model.contact.skin, kNoMotion);
}

// Determines the periods that a mesh spans: one as long as the periodic domain continues through its sides.
void HostSurfaces::span(const Surface& surface, SurfaceFrame& frame) const {
  const MeshBox& box = boxes_[static_cast<std::size_t>(surface.mesh)];
  const auto parent = static_cast<std::size_t>(surface.parent);
  const Mat3 axes = parent < model_.bodies.size()
                        ? rotation_matrix(orientation(start_motion(model_.bodies[parent])))
                        : identity3();
  const auto length = [](Vec3 row, Vec3 size) {
    return std::abs(row.x) * size.x + std::abs(row.y) * size.y + std::abs(row.z) * size.z;
  };
  const Vec3 size = box.max - box.min, period = subdomain_.period();
  frame.middle = Real(0.5) * (box.min + box.max);
  frame.spanned = {length(axes.x, size) >= period.x ? period.x : 0,
                   length(axes.y, size) >= period.y ? period.y : 0,
                   length(axes.z, size) >= period.z ? period.z : 0};
}

void HostSurfaces::bring_into_box() {
  if (ranks_.is_root()) update_poses(), bodies_.pack_list(poses());
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    image_[s] = {};
    if (surface.kind == SurfaceKind::plane) continue;  // planes have no images
    subdomain_.wrap(point_with(motion_, s) + to_middle(s), image_[s]);
  }
}

Vec3 HostSurfaces::to_middle(Index s) const {
  if (placed_[s].kind != SurfaceKind::mesh) return {};
  const SurfaceFrame& frame = frames_[static_cast<std::size_t>(placed_[s].frame)];
  const Mat3 axes = rotation_matrix(orientation(motion_[surfaces_.at(s).parent]));
  return snap(axes * frame.middle, subdomain_.snap_constant());
}

void HostSurfaces::plan_list(Real skin, Real moved) {
  skin_ = skin;
  for (Index s = 0; s < size(); ++s) extra_travel_[s] = extra_travel_for(s, skin, moved);
}

// A list lasts until particles have moved by half its skin. Until then a mesh moves in proportion to what it
// has moved beside them so far.
Real HostSurfaces::extra_travel_for(Index s, Real skin, Real moved) const {
  constexpr Real kAllowance = 1.25;  // for changes of the speeds
  constexpr Real kMostRadii = 2;     // wider rows of triangles cost every step more than a list saves
  const Surface& surface = surfaces_.at(s);
  if (surface.kind != SurfaceKind::mesh || !surface.moves) return 0;
  const Real radius = model_.particles.totals.largest_radius;
  if (moved == kNoMotion || radius == 0) return (kMeshSkins - 1) * skin;
  const Real travel =
      displacement_of(placed_[s], placed_[s].point - listed_[s].point, listed_axes_[placed_[s].frame]);
  const Real wanted = (kAllowance * travel / moved - 1) * skin / 2, least = skin / 2,
             most = std::max(least, kMostRadii * radius);
  return wanted > least ? std::min(wanted, most) : least;
}

void HostSurfaces::build_list(Real skin) {
  listed_ = placed_, listed_axes_ = axes();
  if (ranks_.is_root()) bodies_.build(poses(), skin);
}

void HostSurfaces::store_start() {
  start_ = placed_, start_axes_ = axes();
  bodies_.drop();
  begin_step();
}

std::vector<Mat3> HostSurfaces::axes() const {
  std::vector<Mat3> axes;
  for (const SurfaceFrame& frame : frames_) axes.push_back(frame.axes);
  return axes;
}

// What all surfaces of a parent share.
void HostSurfaces::rotate_parents() {
  rotations_.resize(motion_.size());
  for (std::size_t p = 0; p < motion_.size(); ++p) {
    ParentRotation& of = rotations_[p];
    of.axes = rotation_matrix(orientation(motion_[p]));
    of.start_axes = rotation_matrix(orientation(step_start_[p]));
    of.spin = global_spin(motion_[p]);
    if (tracks_displacement()) of.turn = rotation_between(step_start_[p], motion_[p]);
  }
}

void HostSurfaces::rotate_frames() {
  for (Index s = 0; s < size(); ++s) {
    if (placed_[s].kind == SurfaceKind::sphere) continue;
    SurfaceFrame& frame = frames_[static_cast<std::size_t>(placed_[s].frame)];
    const ParentRotation& parent = rotations_[static_cast<std::size_t>(surfaces_.at(s).parent)];
    frame.axes = parent.axes, frame.before = parent.start_axes;
    placed_[s].normal = frame.axes * frame.normal;
    if (placed_[s].kind == SurfaceKind::mesh)
      frame.to_middle = snap(frame.axes * frame.middle, subdomain_.snap_constant());
  }
}

void HostSurfaces::update_poses() {
  axes_before_.clear();
  for (const SurfaceFrame& frame : frames_) axes_before_.push_back(frame.axes);
  rotate_parents();
  const auto arm_of = [](const BodyMotion& body, const Mat3& axes, Vec3 point) {
    return body.kind == BodyKind::spatial ? axes * point : body_arm(body, point);
  };
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    const BodyMotion &body = motion_[surface.parent], &start = step_start_[surface.parent];
    const ParentRotation& parent = rotations_[static_cast<std::size_t>(surface.parent)];
    const Vec3 arm = arm_of(body, parent.axes, surface.point);
    const ImageCount image = image_[s];
    const Vec3 with_body = snap(body.position + arm, subdomain_.snap_constant());
    const Vec3 point = moved_by_periods(with_body, {-image.x, -image.y, -image.z}, subdomain_.period());
    SurfacePose& placed = placed_[s];
    step_[s] = point - placed.point;
    const Vec3 previous_rotation = placed.turn;
    placed = {surface.kind, surface.material, surface.radius, point, surface.normal,
              arm,          body.velocity,    parent.spin,    {},    {},
              placed.frame};
    if (!tracks_displacement()) continue;
    const Vec3 start_arm = arm_of(start, parent.start_axes, surface.point);
    placed.displacement = with_body - snap(start.position + start_arm, subdomain_.snap_constant());
    placed.turn = parent.turn;
    step_rotation_[s] =
        (surface.kind == SurfaceKind::sphere ? surface.radius : 1) * (placed.turn - previous_rotation);
  }
  rotate_frames();
}

Real HostSurfaces::last_displacement() const {
  return largest_displacement(step_, axes_before_, Weight::of_list);
}

// Displacements are linear in the position, so that the largest one is at a corner of a box. For a plane it
// is the change of its distance from points of the domain.
Real HostSurfaces::displacement_of(const SurfacePose& surface, Vec3 moved, const Mat3& from) const {
  const SurfaceFrame& frame = frames_[static_cast<std::size_t>(surface.frame)];
  const bool is_plane = surface.kind == SurfaceKind::plane;
  const Box space{model_.space.min, model_.space.max};
  const Vec3 normal0 = from * frame.normal, point0 = surface.point - moved;
  Real largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Real size;
    if (is_plane) {
      const Vec3 at = corner_of(space, corner);
      size = std::abs(dot(surface.normal, at - surface.point) - dot(normal0, at - point0));
    } else {
      const Vec3 at = corner_of(boxes_[static_cast<std::size_t>(frame.mesh)], corner);
      size = norm(moved + (frame.axes * at - from * at));
    }
    if (!(size <= largest)) largest = size;
  }
  return largest;
}

Vec3 HostSurfaces::point_with(const std::vector<BodyMotion>& motion, Index s) const {
  const Surface& surface = surfaces_.at(s);
  const BodyMotion& body = motion[surface.parent];
  return snap(body.position + body_arm(body, surface.point), subdomain_.snap_constant());
}

void HostSurfaces::close_step() {
  bodies_.accept();
  begin_step();
}

void HostSurfaces::return_to(std::span<const BodyMotion> motion) {
  set_motion(motion);
  update_poses();
  begin_step();
}

void HostSurfaces::begin_step() {
  if (!tracks_displacement()) return;
  start_before_ = step_start_, step_start_ = motion_;
  for (SurfacePose& surface : placed_) surface.displacement = surface.turn = {};
  for (SurfaceFrame& frame : frames_) frame.before = frame.axes;
}

void HostSurfaces::reopen_step() {
  if (!tracks_displacement()) return;
  step_start_ = start_before_;
  bodies_.reopen();
  update_poses();
}

Real HostSurfaces::weight_in_list(std::size_t s) const {
  return extra_travel_[s] == 0 ? 1 : skin_ / (skin_ + 2 * extra_travel_[s]);
}

Real HostSurfaces::largest_displacement(std::span<const Vec3> moved, std::span<const Mat3> from,
                                        Weight weight) const {
  Real squared = 0;  // of spheres, squared
  Real largest = 0;  // of other surfaces
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    const bool is_sphere = placed_[s].kind == SurfaceKind::sphere;
    const Real size = is_sphere ? dot(moved[s], moved[s])
                                : (weight == Weight::of_list ? weight_in_list(s) : 1) *
                                      displacement_of(placed_[s], moved[s],
                                                      from[static_cast<std::size_t>(placed_[s].frame)]);
    if (std::isnan(size)) return size;
    Real& most = is_sphere ? squared : largest;
    most = std::max(most, size);
  }
  return std::max(std::sqrt(squared), largest);
}

Real HostSurfaces::displacement_since(const std::vector<SurfacePose>& then, const std::vector<Mat3>& axes,
                                      Weight weight) const {
  std::vector<Vec3> moved;
  moved.reserve(placed_.size());
  for (std::size_t s = 0; s < placed_.size(); ++s) moved.push_back(placed_[s].point - then[s].point);
  return largest_displacement(moved, axes, weight);
}

void HostSurfaces::take_loads(std::span<const InstantSums> of_particles, Real h) {
  loads_.assign(of_particles.begin(), of_particles.end());
  particle_loads_ = loads_.size();
  if (!ranks_.is_root()) return;
  bodies_.find_loads(poses(), h);
  bodies_.add_sums(loads_);
}

void HostSurfaces::take_steps(std::span<const StepSums> of_particles, Real h) {
  steps_.assign(of_particles.begin(), of_particles.end());
  if (!ranks_.is_root()) return;
  bodies_.find_steps(poses(), h);
  bodies_.add_sums(steps_);
}

// Merges the sums of all ranks; on rank 0.
template <class Sums>
std::vector<Sums> HostSurfaces::merged(std::vector<Sums> sums) const {
  return merged_by_key(ranks_.gather(std::move(sums)));
}

void HostSurfaces::reduce(ContactWrenches& step, std::vector<BodyWrench>& end) const {
  std::fill(step.wrench.begin(), step.wrench.end(), BodyWrench{});
  std::fill(end.begin(), end.end(), BodyWrench{});
  step.stiffness.clear();
  step.pairs = bodies_.pairs();  // of rank 0
  // Index of a body's blocks plus one; 0: none yet. A body may occur again, because meshes come after the
  // shapes of all bodies.
  std::vector<std::size_t> block_of(model_.bodies.size());
  for (const StepSums& sums : merged(steps_)) {
    const int body = surfaces_.at(sums.surface).parent;
    end[body] += sums.wrench(), step.wrench[body] += sums.wrench(kWrenchTerms);
    if (!surfaces_.is_on_body(sums.surface)) continue;
    std::size_t& own = block_of[static_cast<std::size_t>(body)];
    if (own == 0) step.stiffness.push_back({body, {}, {}}), own = step.stiffness.size();
    WrenchStiffness& blocks = step.stiffness[own - 1];
    for (int k = 0; k < kBlockTerms; ++k) {
      blocks.stiffness[k] += sums.sum[2 * kWrenchTerms + k].value();
      blocks.damping[k] += sums.sum[2 * kWrenchTerms + kBlockTerms + k].value();
    }
  }
}

void HostSurfaces::reduce(std::vector<BodyWrench>& end) const {
  std::vector<std::int64_t> unused;
  reduce(end, unused);
}

void HostSurfaces::reduce(std::vector<BodyWrench>& end, std::vector<std::int64_t>& contacts) const {
  std::fill(end.begin(), end.end(), BodyWrench{});
  contacts.assign(end.size(), 0);
  const auto parent = [this](const InstantSums& sums) {
    return static_cast<std::size_t>(surfaces_.at(sums.surface).parent);
  };
  for (const InstantSums& sums : merged(loads_))
    end[parent(sums)] += sums.wrench(), contacts[parent(sums)] += sums.contacts;
  for (std::size_t own = particle_loads_; own < loads_.size() && ranks_.is_root(); ++own)
    contacts[parent(loads_[own])] -= loads_[own].contacts;
}

// count: number of sums; where: maps a surface to its sum.
template <class Where>
std::vector<ContactSum> HostSurfaces::contacts_of(std::size_t count, const Where& where) const {
  std::vector<ContactSum> contacts(count);
  for (const InstantSums& sums : merged(loads_)) {
    ContactSum& sum = contacts[static_cast<std::size_t>(where(sums.surface))];
    const BodyWrench wrench = sums.wrench();
    sum.force += wrench.force, sum.torque += wrench.torque, sum.contacts += sums.contacts;
  }
  return contacts;
}

std::vector<ContactSum> HostSurfaces::parent_contacts() const {
  return contacts_of(motion_.size(), [this](Index surface) { return surfaces_.at(surface).parent; });
}

std::vector<ContactSum> HostSurfaces::surface_contacts() const {
  return contacts_of(static_cast<std::size_t>(surfaces_.placed()), [](Index surface) { return surface; });
}

std::vector<TriangleLoad> HostSurfaces::triangle_loads(std::vector<TriangleSums> contacts) const {
  std::vector<TriangleLoad> loads;
  const std::vector<TriangleSums> of_shapes = bodies_.triangle_sums();  // of rank 0
  contacts.insert(contacts.end(), of_shapes.begin(), of_shapes.end());
  for (const TriangleSums& sums : merged(std::move(contacts))) {
    const ExactSum* const t = sums.tangential;
    loads.push_back(
        {sums.surface, sums.triangle, sums.normal.value(), {t[0].value(), t[1].value(), t[2].value()}});
  }
  return loads;
}

void HostSurfaces::accumulate_losses(Real h) {
  if (!ranks_.is_root()) return;
  const BodyContactTotals step = bodies_.totals();
  if (h > 0) bodies_.accumulate_load_works(poses(), h);
  if (model_.rotates()) {
    losses_.contact_loss += h * step.loss_power;
    if (h > 0) losses_.tangential.add(step.losses);
    return;
  }
  losses_.contact_loss += h / 2 * (losses_.loss_power + step.loss_power);
  losses_.loss_power = step.loss_power;
}

void HostSurfaces::book_step() {
  if (!ranks_.is_root()) return;
  const BodyStep step = bodies_.step_totals();
  losses_.contact_loss += step.losses.dissipated, losses_.integrator_loss += step.losses.integrator;
  losses_.tangential.of[kFrictionLoss] += step.friction;
  bodies_.accumulate_step_works(poses());
  bodies_.accept();
}

void HostSurfaces::load(const ShapeLosses& losses) {
  losses_ = ranks_.is_root() ? losses : ShapeLosses{};
  bodies_.load({}), bodies_.clear_works();
}

void HostSurfaces::add_works(std::vector<std::int64_t>& words) const {
  if (ranks_.is_root()) scree::add_works(bodies_.works(), words);
}

ShapeContacts HostSurfaces::shape_contacts() {
  if (!ranks_.is_root()) return {};
  update_poses();
  return bodies_.contacts(poses());
}

std::vector<ContactLine> HostSurfaces::contact_lines() {
  return ranks_.is_root() ? bodies_.lines(poses()) : std::vector<ContactLine>{};
}
ShapePack HostSurfaces::pack() const {
  ShapePack pack;
  std::vector<std::size_t> row(placed_.size(), placed_.size());  // row of each sphere in the pack
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    if (surface.kind != SurfaceKind::sphere) continue;
    row[s] = pack.body.size();
    pack.body.push_back(surface.parent);
    pack.radius.push_back(surface.radius);
    const PointMotion point = point_motion(motion_[surface.parent], surface.point);
    ImageCount unused;
    pack.position.push_back(subdomain_.wrap(point.position, unused));
    pack.velocity.push_back(point.velocity);
  }
  pack.force.resize(pack.body.size()), pack.contacts.resize(pack.body.size());
  for (const InstantSums& sums : merged(loads_)) {
    const std::size_t at = row[sums.surface];
    if (at == placed_.size()) continue;
    pack.force[at] = sums.wrench().force;
    pack.contacts[at] = static_cast<int>(sums.contacts);
  }
  return pack;
}

}  // namespace scree
