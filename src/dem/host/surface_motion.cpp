// Poses of the surfaces, their changes over a step, and how far they may move until a list expires.
#include <algorithm>
#include <cmath>

#include "base/box.hpp"
#include "base/mat3.hpp"
#include "dem/host/host_surfaces.hpp"

namespace scree {
namespace {

// k-th corner of a box, k = 0 ... 7.
template <class AnyBox>
Vec3 corner_of(const AnyBox& box, int k) {
  return {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z};
}

// Not below displacement_of() of a mesh: a corner c moves by d + (A - A0) c.
Real displacement_bound(const SurfaceFrame& frame, const MeshBox& box, Vec3 moved, const Mat3& from) {
  constexpr Real kRoundOff = 1e-14;  // of both
  const Vec3 x = frame.axes.x - from.x, y = frame.axes.y - from.y, z = frame.axes.z - from.z;
  const Vec3 far{std::max(std::abs(box.min.x), std::abs(box.max.x)),
                 std::max(std::abs(box.min.y), std::abs(box.max.y)),
                 std::max(std::abs(box.min.z), std::abs(box.max.z))};
  const Real turn = std::sqrt(dot(x, x) + dot(y, y) + dot(z, z));
  return (1 + kRoundOff) * norm(moved) + norm(far) * (turn + kRoundOff);
}

}  // namespace

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

// What all surfaces of a parent share. Discs on planar bodies need no axes.
void HostSurfaces::rotate_parents() {
  rotations_.resize(motion_.size());
  for (std::size_t p = 0; p < motion_.size(); ++p) {
    ParentRotation& of = rotations_[p];
    if (has_axes_[p]) {
      of.axes = rotation_matrix(orientation(motion_[p]));
      of.start_axes = rotation_matrix(orientation(step_start_[p]));
    }
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

// Where a law depends on masses. J^-1 = A J_0^-1 A^T with the rotation A of the body's frame.
void HostSurfaces::find_free_bodies() {
  if (inverse_inertias_.empty()) return;
  free_bodies_.assign(placed_.size(), {});
  for (Index s = 0; s < size() && surfaces_.is_on_body(s); ++s) {
    const auto b = static_cast<std::size_t>(surfaces_.at(s).parent);
    const bool is_spatial = model_.bodies[b].kind == BodyKind::spatial;
    const Real inverse_mass = 1 / model_.bodies[b].mass;
    free_bodies_[s] = {{inverse_mass, inverse_mass, is_spatial ? inverse_mass : 0}, inverse_inertias_[b]};
    if (!is_spatial) continue;
    const Mat3 &axes = rotations_[b].axes, of = axes * full(inverse_inertias_[b]) * transposed(axes);
    free_bodies_[s].inverse_inertia = {of.x.x, of.x.y, of.x.z, of.y.y, of.y.z, of.z.z};
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
  find_free_bodies();
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

// The mesh with the largest bound comes first: with its displacement most others need no more than theirs.
Real HostSurfaces::largest_displacement(std::span<const Vec3> moved, std::span<const Mat3> from,
                                        Weight weight) const {
  const auto weight_of = [&](std::size_t s) { return weight == Weight::of_list ? weight_in_list(s) : 1; };
  const auto from_of = [&](std::size_t s) { return from[static_cast<std::size_t>(placed_[s].frame)]; };
  const auto bound_of = [&](std::size_t s) {
    if (placed_[s].kind == SurfaceKind::plane) return kInfinity;
    const SurfaceFrame& frame = frames_[static_cast<std::size_t>(placed_[s].frame)];
    const MeshBox& box = boxes_[static_cast<std::size_t>(frame.mesh)];
    return weight_of(s) * displacement_bound(frame, box, moved[s], from_of(s));
  };
  Real squared = 0, most = -1;  // of spheres, squared; the largest bound of other surfaces
  std::size_t first = 0;
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    if (placed_[s].kind == SurfaceKind::sphere) {
      const Real size = dot(moved[s], moved[s]);
      if (std::isnan(size)) return size;
      squared = std::max(squared, size);
    } else if (const Real bound = bound_of(s); !(bound <= most)) {
      most = bound, first = s;
    }
  }
  if (frames_.empty()) return std::sqrt(squared);
  Real largest = weight_of(first) * displacement_of(placed_[first], moved[first], from_of(first));
  for (std::size_t s = 0; s < placed_.size() && !std::isnan(largest); ++s) {
    if (s == first || placed_[s].kind == SurfaceKind::sphere || bound_of(s) <= largest) continue;
    const Real size = weight_of(s) * displacement_of(placed_[s], moved[s], from_of(s));
    if (!(size <= largest)) largest = size;
  }
  return std::isnan(largest) ? largest : std::max(std::sqrt(squared), largest);
}

Real HostSurfaces::displacement_since(const std::vector<SurfacePose>& then, const std::vector<Mat3>& axes,
                                      Weight weight) const {
  std::vector<Vec3> moved;
  moved.reserve(placed_.size());
  for (std::size_t s = 0; s < placed_.size(); ++s) moved.push_back(placed_[s].point - then[s].point);
  return largest_displacement(moved, axes, weight);
}

}  // namespace scree
