// Friction of one particle and one surface on a body over an implicit step; see surface_items.hpp. Shared by
// the CPU and CUDA backends.
#pragma once

#include "dem/implicit/friction_items.hpp"
#include "dem/surface_contact/surface_items.hpp"

namespace scree {

// Displacement of the point `point` of a body, relative to its centre, for a unit displacement along the
// body's k-th coordinate (x, y, z, rx, ry, rz).
SCREE_HD Vec3 unit_displacement(Vec3 point, int k) {
  const Vec3 axis{k % 3 == 0 ? Real(1) : Real(0), k % 3 == 1 ? Real(1) : Real(0),
                  k % 3 == 2 ? Real(1) : Real(0)};
  return k < 3 ? axis : cross(axis, point);
}

// Derivative of the moment of rolling and twisting along the axis `a` by a rotation about the axis `b`, both
// unit vectors [N m].
SCREE_HD Real turning_stiffness(const StepRolling& m, Vec3 normal, Vec3 a, Vec3 b) {
  const Real along = dot(normal, a) * dot(normal, b);
  return m.rolling * (dot(a, b) - along - dot(m.direction, a) * dot(m.direction, b)) + m.twisting * along;
}

// Unit vector of the k-th coordinate axis.
SCREE_HD Vec3 unit_axis(int k) {
  return {k == 0 ? Real(1) : Real(0), k == 1 ? Real(1) : Real(0), k == 2 ? Real(1) : Real(0)};
}

// Terms of the wrench and its blocks. The friction force acts at the centre of a sphere with a couple, as
// between two spheres, and at the contact point of other surfaces. Its part of the blocks equals that in the
// particles' Newton matrix (`FrictionEntry`): the slip is minus the tangential displacement of the contact
// point, of which one direction is left while sliding.
SCREE_HD Real sum_term(const SurfaceFriction& c, int k) {
  const StepContact& normal = c.contact.normal;
  const Vec3 n = normal.normal;
  if (k < 2 * kWrenchTerms) {
    const bool at_end = k < kWrenchTerms;
    const Vec3 friction = at_end ? c.contact.friction.end : c.contact.friction.step;
    if (k % kWrenchTerms == kBlockRows) return c.contact.lever_arm_ratio * dot(friction, c.surface_velocity);
    const Vec3 force =
        c.contact.lever_arm_ratio * friction - (at_end ? normal.end_force : normal.step.force) * n;
    Vec3 torque = cross(c.arm, force) + c.radius * cross(n, friction);
    if (c.rolls) torque += at_end ? c.contact.rolling.end : c.contact.rolling.step;
    return component(force, torque, k % kWrenchTerms);
  }
  const BlockIndex at = block_index(k);
  const Vec3 contact_point = c.arm + c.radius * n;
  const Vec3 a = unit_displacement(contact_point, at.row), b = unit_displacement(contact_point, at.column);
  const Real along = dot(n, a) * dot(n, b);
  if (!at.is_stiffness) return normal.step.damping * along;
  const Vec3 t = c.contact.friction.direction;
  const Real stiffness = normal.step.stiffness * along +
                         c.contact.friction.stiffness * (dot(a, b) - along - dot(t, a) * dot(t, b));
  if (!c.rolls || at.row < 3) return stiffness;  // at.column >= at.row
  return stiffness + turning_stiffness(c.contact.rolling, n, unit_axis(at.row - 3), unit_axis(at.column - 3));
}

// Contact over the step, for the k-th of the entries by_surface. in.spin: at the end of the step.
template <class Laws>
struct SurfaceFrictionItem {
  SurfaceViews in;
  FrictionStart start;
  const SurfacePose* start_surface_poses;
  Laws laws;
  SurfaceFriction* friction_steps;  // per entry

  using Law = LawOf<Laws>;

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const SurfacePose &surface = in.placed[in.surface_of(entry)],
                      &before = start_surface_poses[in.surface_of(entry)];
    SurfaceFriction& out = friction_steps[entry];
    const SurfacePath kinematics =
        surface_path(in, surface, before, entry, in.position[i], start.step.position[i]);
    if (surface.kind == SurfaceKind::mesh && !(kinematics.now.touches || kinematics.start.touches)) {
      out.touches = false;
      return in.template store_no_history<Law>(entry);
    }
    const FrictionalPath path = path_of(kinematics, surface, before, entry, i);
    out.touches = OverFrictionStep::closed(path), out.rolls = Law::Rolling::acts;
    if (!out.touches) return in.template store_no_history<Law>(entry);
    const Law& law = laws.get(in.material[i], surface.material);
    const ContactHistory old =
        in.history.template read_from<Law>(in.history.bodies, in.goes_on_from(surface, entry));
    const Spins spins{path.motion, xyz(start.spin[i]), xyz(in.spin[i]), before.spin, surface.spin};
    static_cast<FrictionalContactOf<Law>&>(out.contact) =
        frictional_contact<true>(law, path, old, start.step.resolve_events, spins);
    if (out.contact.acts && surface.turns())
      out.contact.losses.integrator +=
          parent_work(law, path, out.contact, parent_excess(kinematics, surface, before)) +
          belt_work(surface, path, out.contact);
    out.arm = kinematics.now.is_sphere ? surface.arm : surface.arm + kinematics.now.pair.contact;
    out.radius = kinematics.now.is_sphere ? surface.radius : 0;
    out.contact_arm = kinematics.now.is_sphere ? Vec3{} : kinematics.now.pair.contact;
    out.surface_velocity = path.surface_velocity;
    if (!out.contact.lasts) return in.template store_no_history<Law>(entry);
    in.template store_history<Law>(surface, entry, out.contact.history);
  }

 private:
  // Spins of the particle i and of the surface's parent j; see `frictional_contact()`.
  struct Spins {
    const ContactMotion& motion;
    Vec3 i0, i1, j0, j1;  // at the start and the end [rad/s]

    SCREE_HD Vec3 arm_sum(bool at_end) const {
      return motion.arm_i * (at_end ? i1 : i0) + motion.arm_j * (at_end ? j1 : j0);
    }
    SCREE_HD Vec3 relative(bool at_end) const { return at_end ? i1 - j1 : i0 - j0; }
  };

  // Adds the conveyor velocity of the surface to the kinematics of the contact.
  SCREE_HD static void add_conveyor_motion(const SurfaceFrame& frame, FrictionalPath& path) {
    add_surface_velocity(path.motion, frame.middle_surface_velocity());
    const Vec3 surface_velocity = frame.axes * frame.surface_velocity;
    path.velocity0 -= frame.before * frame.surface_velocity, path.velocity1 -= surface_velocity;
    path.surface_velocity = tangential_part(surface_velocity, path.normal1);
  }
  // Correction of the work on the parent, `ParentExcess::work()`, for all forces.
  SCREE_HD static Real parent_work(const Law& law, const FrictionalPath& path,
                                   const FrictionalContact& contact, const ParentExcess& excess) {
    const Real force0 = start_force(law.normal.of_pair(path.size), path.step);
    return excess.work(
        force0 * path.normal0 - contact.lever_arm_ratio0 * contact.friction.start,
        contact.normal.step.force * path.normal1 - contact.lever_arm_ratio * contact.friction.step);
  }
  // Correction of the belt work [J]: the accounting of the belt uses its velocity at the start for the force
  // there.
  SCREE_HD Real belt_work(const SurfacePose& surface, const FrictionalPath& path,
                          const FrictionalContact& contact) const {
    if (path.surface_velocity == Vec3{}) return 0;
    const SurfaceFrame& frame = in.frames[surface.frame];
    const Vec3 surface_velocity0 = tangential_part(frame.before * frame.surface_velocity, path.normal0);
    return path.step.h / 2 * contact.lever_arm_ratio0 *
           dot(contact.friction.start, path.surface_velocity - surface_velocity0);
  }
  SCREE_HD FrictionalPath path_of(const SurfacePath& kinematics, const SurfacePose& surface,
                                  const SurfacePose& before, Index entry, Index i) const {
    const Vec4 p = in.position[i], w = start.mean_spin[i];
    const ContactGeometry &end = kinematics.now.pair.geometry, &begin = kinematics.start.pair.geometry;
    const bool is_sphere = kinematics.now.is_sphere;
    const Vec3 contact_point = is_sphere ? Vec3{} : kinematics.now.pair.contact,
               contact_point0 = is_sphere ? Vec3{} : kinematics.start.pair.contact;
    const Real h = start.step.h, arm = is_sphere ? surface.radius : 0;
    const RotatingPartner one{xyz(w), p.w, w.w}, other{reciprocal(h) * surface.turn, arm};
    FrictionalPath out{};
    out.velocity0 = xyz(start.step.velocity[i]) - before.velocity_at(contact_point0);
    out.velocity1 = xyz(in.velocity[i]) - surface.velocity_at(contact_point);
    static_cast<ContactPath&>(out) =
        OverImplicitStep{start.step}.path(end, out.velocity1, begin, out.velocity0, kinematics.displacement,
                                          surface_size<Law>(in, entry, kinematics.now, p, in.velocity[i]));
    out.step.change = kinematics.change;
    if (is_sphere)
      out.motion = sphere_motion(end, kinematics.displacement, one, other, h);
    else
      out.motion = motion_over(surface, kinematics.now, out.normal0, kinematics.displacement, one, other, h);
    if (!is_sphere && in.frames[surface.frame].is_conveyor())
      add_conveyor_motion(in.frames[surface.frame], out);
    const Real radius_sum = p.w + arm;
    out.lever_arm_ratio0 = kinematics.now.is_face
                               ? 1
                               : out.motion.lever_arm_ratio * end.distance / (radius_sum - out.step.overlap0);
    out.curvature = kinematics.now.is_face ? 0 : out.motion.lever_arm_ratio / radius_sum;
    out.arm_rotation = h * (one.arm * one.spin + other.arm * other.spin);
    out.relative_rotation = h * (one.spin - other.spin);
    out.i = i, out.j = FrictionalPath::kWall;
    OverFrictionStep{start}.at_entry(out, entry);
    return out;
  }
};

// Right-hand side for the bodies' correction, see `SurfaceShiftItem`. friction_steps, surfaces, numbers: of
// the entries.
struct FrictionShiftItem {
  FrictionMatrix matrix;
  const Index *surface_offsets, *surfaces;
  SurfaceNumbers numbers;
  const SurfaceFriction* friction_steps;
  NewtonWeights weights;
  bool consistent;
  SurfaceMoves moves;
  Twist* residual;  // [N]

  SCREE_HD void operator()(Index i) const {
    const Real scale = 1 / weights.stiffness;
    for (Index k = 0; k < matrix.surface_count[i]; ++k) {
      const FrictionEntry& of = matrix.surface_entries[surface_offsets[i] + k];
      if (of.normal.neighbor == FrictionalPath::kWall) continue;
      const SurfaceFriction& contact = friction_steps[of.normal.neighbor];
      const Index surface = numbers.placed(surfaces[of.normal.neighbor]);
      const Vec3 move = moves.move[surface], turn = moves.turn[surface];
      residual[i] -= contact.radius > 0
                         ? of.apply(-scale * move, scale * turn, consistent)
                         : of.apply(-scale * (move + cross(turn, contact.contact_arm)), Vec3{}, consistent);
      if (matrix.surface_rolling == nullptr) continue;
      const RollingEntry& rolling = matrix.surface_rolling[surface_offsets[i] + k];
      const Vec3 moved = contact.radius > 0 ? move : move + cross(turn, contact.contact_arm),
                 rotation = contact.radius > 0 ? (1 / contact.radius) * turn : turn;
      residual[i].turn -= rolling.apply(Vec3{of.normal.x, of.normal.y, of.normal.z}, -scale * moved,
                                        -(scale * rolling.partner_scale) * rotation, consistent);
    }
  }
};

}  // namespace scree
