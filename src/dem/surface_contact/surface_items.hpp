// Contact of one particle and one surface on a body: evaluated once for the particle's force and the body's
// wrench. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/contact/contact_items.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/surfaces/mesh_rows.hpp"
#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "partition/halo_plan.hpp"

namespace scree {

// State of the particles for an evaluation of contacts with surfaces.
struct SurfaceQuery {
  const Vec4 *position, *velocity, *spin;  // spin: null where particles do not rotate
  HistoryViews history;
  Real h = 0;  // length of the explicit step that ends there [s]; 0: an instant
};

// The particles, the placed surfaces, and the list of pairs that are near each other.
struct SurfaceViews {
  const Vec4 *position, *velocity;  // x, y, z, radius; x, y, z, mass
  const int* material;
  SurfaceEntries entries;
  const SurfacePose* placed;
  const SurfaceFrame* frames;
  SurfaceNumbers numbers;
  MeshRows meshes;
  const MeshTouch* touches;  // per entry with a mesh, current
  const MeshTouchBefore* before;
  PeriodicBox box;
  HistoryViews history{};
  int records = 0;             // history records per contact
  const Vec4* spin = nullptr;  // angular velocity, moment of inertia; these two for laws with `kNeedsMotion`
  Real h = 0;                  // see SurfaceQuery
  Real interaction_range = 0;  // Contact::interaction_range [m]
  // Mass of each placed surface's parent where laws read it alone; null: infinite [kg]
  const Real* masses = nullptr;
  // Radii [m] that laws use instead of the particles' own; null: the particles' own.
  const Real* law_radius = nullptr;
  // Per placed surface, and per item if these are shapes of bodies; null: nothing moves.
  const FreeBody* free_bodies = nullptr;
  const FreeShape* free_shapes = nullptr;

  SCREE_HD Vec3 shift_of(Index entry) const { return image_shift(entries.images[entry], box.period); }
  SCREE_HD Index surface_of(Index entry) const { return numbers.placed(entries.surfaces[entry]); }
  SCREE_HD Index goes_on_from(const SurfacePose& surface, Index entry) const {
    return surface.kind == SurfaceKind::mesh ? touches[entry].from : entry;
  }
  // Stores the history of the contact for the case that the step is accepted.
  template <class Law, class History>
  SCREE_HD void store_history(const SurfacePose& surface, Index entry, const History& of_contact) const {
    if (history.ahead == nullptr) return;
    history.template write<Law>(history.ahead, entry, of_contact);
    if (surface.kind == SurfaceKind::mesh) history.next_features[entry] = touches[entry].feature;
  }
  template <class Law>
  SCREE_HD void store_no_history(Index entry) const {
    if (Law::kHistory > 0 && history.ahead != nullptr) history.template write_none<Law>(history.ahead, entry);
  }
};

// Geometry of a particle and a placed surface.
struct SurfaceTouch {
  SurfacePair pair;
  bool is_sphere;  // contacts act at the sphere's centre; else at pair.contact
  bool is_face;
  bool touches;
};

// interaction_range: beyond touch, in.interaction_range or 0 [m].
SCREE_HD SurfaceTouch surface_touch(const SurfaceViews& in, const SurfacePose& surface, Index entry, Vec4 p,
                                    Real interaction_range) {
  if (surface.kind == SurfaceKind::mesh) {
    const MeshTouch& touch = in.touches[entry];
    if (!touch.touches) return {};
    return {{touch.geometry, touch.contact}, false, touch.is_face, touch.touches};
  }
  const bool is_sphere = surface.kind == SurfaceKind::sphere;
  // Planes have no images: the contact point must not depend on when the particle was last wrapped.
  const SurfacePair pair = surface_pair(surface, is_sphere ? in.shift_of(entry) : in.box.beyond(xyz(p)), p);
  return {pair, is_sphere, !is_sphere, pair.geometry.overlap > -interaction_range};
}
// Walls, edges and vertices count as planes in Hertz's law. p, u: of the entry's particle.
SCREE_HD PairSize surface_size(const SurfaceViews& in, Index entry, Vec4 p, Vec4 u) {
  const Index surface = in.surface_of(entry);
  const SurfacePose& placed = in.placed[surface];
  return {in.law_radius != nullptr ? in.law_radius[in.entries.particles[entry]] : p.w,
          placed.kind == SurfaceKind::sphere ? placed.radius : kInfinity, u.w,
          in.masses != nullptr ? in.masses[surface] : kInfinity};
}
// The same with the motion of the bodies at the contact, for laws that depend on it.
template <class Law>
SCREE_HD PairSize surface_size(const SurfaceViews& in, Index entry, const SurfaceTouch& touch, Vec4 p,
                               Vec4 u) {
  PairSize size = surface_size(in, entry, p, u);
  if constexpr (kUsesMass<Law>) {
    if (in.free_bodies == nullptr) return size;
    const Index surface = in.surface_of(entry);
    const FreeBody& body = in.free_bodies[surface];
    const Vec3 normal = touch.pair.geometry.normal(), arm = in.placed[surface].arm;
    size.of_bodies = body.rotation(touch.is_sphere ? arm : arm + touch.pair.contact, normal);
    size.of_bodies += in.masses == nullptr ? body.translation(normal) : body.held(normal);
    if (in.free_shapes != nullptr)
      size.of_bodies += in.free_shapes[in.entries.particles[entry]].beside_mass(normal);
  }
  return size;
}

// Position of a contact with a plane or a mesh at the start of the step, from the surface's point then [m].
// normal0: the contact's normal then; point_displacement: of the sphere's centre relative to the surface's
// point since. On a face and an edge the contact is below the centre; at a vertex it is the vertex.
SCREE_HD Vec3 start_contact(const SurfaceTouch& touch, const SurfaceFrame& frame, Real radius, Vec3 normal0,
                            Vec3 point_displacement) {
  const Vec3 contact_point = touch.pair.contact, normal1 = touch.pair.geometry.normal();
  if (touch.is_face) return contact_point - point_displacement + radius * (normal1 - normal0);
  const Vec3 centre = contact_point - point_displacement + touch.pair.geometry.distance * normal1;
  const Vec3 material = frame.before * transposed_times(frame.axes, contact_point);
  return material + tangential_part(centre - material, normal0);
}
// Corrects a mid-step velocity along the contact's normal at the end of the step, so that its normal
// component there equals that along the mid-step normal, with the surface rotated by half.
SCREE_HD Vec3 along_middle(const SurfacePose& surface, const SurfaceTouch& touch, Vec3 velocity) {
  const Vec3 normal = touch.pair.geometry.normal();
  return velocity - Real(0.5) * dot(cross(surface.turn, normal), velocity) * normal;
}
// Motion of a sphere i over a plane or a mesh j in a step; displacement: relative to the material of j
// halfway along the contact's path [m]. face_motion() uses the tangential part at the end of the step as
// slip. Where a face has rotated, the normal part at mid-step is excluded from the slip; otherwise a contact
// that opens or closes would slip.
SCREE_HD ContactMotion motion_over(const SurfacePose& surface, const SurfaceTouch& touch, Vec3 normal0,
                                   Vec3 displacement, const RotatingPartner& i, const RotatingPartner& j,
                                   Real h) {
  const ContactGeometry& geometry = touch.pair.geometry;
  if (!touch.is_face) return edge_motion(geometry, normal0, displacement, i, j, h);
  const Vec3 normal = geometry.normal();
  if (surface.turns()) displacement += (dot(displacement, normal) / 2) * cross(surface.turn, normal);
  return face_motion(geometry, normal0, displacement, i, j, h);
}

// Loads at one instant or, for laws with `kNeedsMotion`, over the explicit step that ends there; for the k-th
// of the entries by_surface.
template <class Laws>
struct SurfaceLoadItem {
  SurfaceViews in;
  Laws laws;
  SurfaceLoad* loads;  // per entry

  using Law = LawOf<Laws>;

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const SurfacePose& surface = in.placed[in.surface_of(entry)];
    const Vec4 p = in.position[i], u = in.velocity[i];
    SurfaceLoad& out = loads[entry];
    const SurfaceTouch touch =
        surface_touch(in, surface, entry, p, kHasRange<Law> ? in.interaction_range : 0);
    out.touches = touch.touches;
    if (!out.touches) return in.template store_no_history<Law>(entry);
    const PairState state{touch.pair.geometry, xyz(u) - surface.velocity_at(touch.pair.contact),
                          surface_size<Law>(in, entry, touch, p, u)};
    const Law& law = laws.get(in.material[i], surface.material);
    if constexpr (Law::kNeedsMotion)
      find_moving(law, state, touch, surface, entry);
    else
      find_load(law, state, surface, entry);
    if constexpr (kHasRange<Law>)
      if (!out.touches) return;
    out.arm = Law::kNeedsMotion && touch.is_sphere ? surface.arm : surface.arm + touch.pair.contact;
    out.belt_power = Law::kNeedsMotion ? belt_power(touch, surface, out.load.force) : 0;
    out.particle_arm = contact_arm(state);
  }

 private:
  SCREE_HD void find_load(const Law& law, const PairState& state, const SurfacePose& surface,
                          Index entry) const {
    SurfaceLoad& out = loads[entry];
    const auto before = old(surface, entry);
    out.touches = is_closed(law, state, before);
    if (!out.touches) return;
    const auto outcome = law.respond(state, before);
    out.load = outcome.load, out.energy = EvaluateEnergy{}(law, state, before);
    if constexpr (Law::kHistory > 0) in.template store_history<Law>(surface, entry, outcome.history);
  }
  SCREE_HD auto old(const SurfacePose& surface, Index entry) const {
    return in.history.template read_from<Law>(in.history.bodies, in.goes_on_from(surface, entry));
  }

  // Whether a pair within the interaction range is in contact.
  SCREE_HD static bool is_closed(const Law& law, const PairState& state,
                                 const typename Law::History& before) {
    if constexpr (kHasRange<Law>)
      return law.closed(state, before);
    else
      return true;
  }
  SCREE_HD void find_moving(const Law& law, const PairState& state, const SurfaceTouch& touch,
                            const SurfacePose& surface, Index entry) const {
    const auto before = old(surface, entry);
    const bool closed = is_closed(law, state, before);
    if (!closed) {
      in.template store_no_history<Law>(entry);
      // The step that opens the contact may dissipate energy.
      loads[entry].touches = in.h > 0 && Law::breaks(before);
      if (!loads[entry].touches) return;
    }
    MovingPair pair = moving_pair(state, touch, surface, entry);
    if (in.h > 0) {
      if (!touch.is_sphere && in.frames[surface.frame].is_conveyor())
        add_surface_velocity(pair.motion, in.frames[surface.frame].middle_surface_velocity());
      const auto outcome = law.respond(pair, before);
      take(outcome, entry);
      loads[entry].energy = closed ? EvaluateEnergy{}(law, pair, outcome.history) : ContactEnergy{};
      if (closed) in.template store_history<Law>(surface, entry, outcome.history);
    } else {
      InstantPair at = at_instant(pair, xyz(in.spin[in.entries.particles[entry]]), surface.spin);
      if (!touch.is_sphere && in.frames[surface.frame].is_conveyor())
        at.slip_rate -= pair.motion.lever_arm_ratio * conveyor_velocity(touch, surface);
      take(law.respond(at, before), entry);
      loads[entry].energy = EvaluateEnergy{}(law, at, before);
    }
  }
  // Kinematics of a contact. A sphere of a body is treated like another particle: its force acts at its
  // centre, with a couple. A face acts one radius below the particle's centre, so that both rotate together
  // without slip; an edge or a vertex acts at its position.
  SCREE_HD MovingPair moving_pair(PairState state, const SurfaceTouch& touch, const SurfacePose& surface,
                                  Index entry) const {
    const Index i = in.entries.particles[entry];
    const RotatingPartner one{xyz(in.spin[i]), in.position[i].w, in.spin[i].w};
    const bool is_instant = !(in.h > 0);
    const Vec3 surface_spin = is_instant ? surface.spin : reciprocal(in.h) * surface.turn;
    if (touch.is_sphere) {
      const Vec3 displacement = is_instant ? Vec3{} : in.h * xyz(in.velocity[i]) - surface.displacement;
      state.velocity =
          is_instant ? xyz(in.velocity[i]) - surface.velocity_at({}) : reciprocal(in.h) * displacement;
      return {state, sphere_motion(state.geometry, displacement, one, {surface_spin, surface.radius}, in.h)};
    }
    const SurfaceFrame& frame = in.frames[surface.frame];
    const Vec3 normal0 = surface.kind == SurfaceKind::mesh ? in.touches[entry].normal0
                         : is_instant                      ? surface.normal
                                                           : frame.before * frame.normal;
    if (!is_instant) {
      const Vec3 point_displacement = in.h * xyz(in.velocity[i]) - surface.displacement,
                 from = start_contact(touch, frame, one.arm, normal0, point_displacement);
      state.velocity =
          xyz(in.velocity[i]) -
          reciprocal(in.h) * (surface.displacement + frame.material_displacement(touch.pair.contact, from));
    }
    const ContactMotion motion =
        motion_over(surface, touch, normal0, in.h * state.velocity, one, {surface_spin}, in.h);
    // The normal dashpot acts on the overlap rate.
    if (!is_instant && surface.turns()) state.velocity = along_middle(surface, touch, state.velocity);
    return {state, motion};
  }
  // Conveyor velocity of a surface at the contact [m/s].
  SCREE_HD Vec3 conveyor_velocity(const SurfaceTouch& touch, const SurfacePose& surface) const {
    const SurfaceFrame& frame = in.frames[surface.frame];
    return tangential_part(frame.axes * frame.surface_velocity, touch.pair.geometry.normal());
  }
  SCREE_HD Real belt_power(const SurfaceTouch& touch, const SurfacePose& surface, Vec3 force) const {
    if (touch.is_sphere || !in.frames[surface.frame].is_conveyor()) return 0;
    return -dot(force, conveyor_velocity(touch, surface));
  }
  template <class Outcome>
  SCREE_HD void take(const Outcome& outcome, Index entry) const {
    loads[entry].load = outcome.load, loads[entry].by_kind = outcome.losses();
  }
};

// Geometry of a particle and a placed surface at both ends of an implicit step.
struct SurfacePath {
  SurfaceTouch now, start;
  // Displacements [m]. displacement: of the particle's centre relative to the surface's material halfway
  // along the contact's path; turned: of that material relative to the surface's point, by rotation.
  Vec3 displacement, turned;
  Changeover change{};
};

SCREE_HD SurfacePath surface_path(const SurfaceViews& in, const SurfacePose& surface,
                                  const SurfacePose& before, Index entry, Vec4 p, Vec4 p0) {
  SurfacePath out{surface_touch(in, surface, entry, p, 0), {}, {}, {}};
  if (surface.kind == SurfaceKind::mesh) {
    out.start = out.now;
    if (!out.now.touches) return out;  // no contact at either end
    const MeshTouchBefore& at = in.before[entry];
    out.start.pair = {at.geometry, at.contact}, out.change = at.change;
    out.start.touches = at.geometry.overlap > 0, out.now.touches = out.now.pair.geometry.overlap > 0;
  } else {
    out.start = surface_touch(in, before, entry, p0, 0);
  }
  out.displacement = (xyz(p) - xyz(p0)) - (surface.point - before.point);
  if (out.now.is_sphere) return out;
  const SurfaceFrame& frame = in.frames[surface.frame];
  const Vec3 normal0 = out.start.pair.geometry.normal();
  out.turned = frame.material_displacement(out.now.pair.contact,
                                           start_contact(out.now, frame, p.w, normal0, out.displacement));
  out.displacement -= out.turned;
  return out;
}

// Difference between two displacements of the particle relative to the surface, for the forces at the start
// and the end of an implicit step [m]: that of a SurfacePath, and that of the parent's energy ledger, which
// moves a point at `arm` from the parent's centre by d + rotation x arm.
struct ParentExcess {
  Vec3 start, end;

  // Work that the energy accounting of the contact must leave out [J]; forces: on the particle.
  SCREE_HD Real work(Vec3 start_force, Vec3 end_force) const {
    return Real(0.5) * (dot(start_force, start) + dot(end_force, end));
  }
};
SCREE_HD ParentExcess parent_excess(const SurfacePath& path, const SurfacePose& surface,
                                    const SurfacePose& before) {
  const Vec3 of_material = path.turned + (surface.arm - before.arm);
  const auto excess = [&](const SurfacePose& at, const SurfaceTouch& touch) {
    return cross(surface.turn, at.arm + touch.pair.contact) - of_material;
  };
  return {excess(before, path.start), excess(surface, path.now)};
}
template <class Laws>
struct SurfaceStepItem {
  SurfaceViews in;
  StepStart start;
  const SurfacePose* start_surface_poses;
  Laws laws;
  SurfaceStep* steps;  // per entry

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const SurfacePose &surface = in.placed[in.surface_of(entry)],
                      &before = start_surface_poses[in.surface_of(entry)];
    const Vec4 p = in.position[i], u = in.velocity[i];
    const SurfacePath path = surface_path(in, surface, before, entry, p, start.position[i]);
    const SurfacePair &pair = path.now.pair, &pair0 = path.start.pair;
    SurfaceStep& out = steps[entry];
    out.touches = path.now.touches || path.start.touches;
    if (!out.touches) return;
    ContactPath over = OverImplicitStep{start}.path(
        pair.geometry, xyz(u) - surface.velocity_at(pair.contact), pair0.geometry,
        xyz(start.velocity[i]) - before.velocity_at(pair0.contact), path.displacement,
        surface_size<LawOf<Laws>>(in, entry, path.now, p, u));
    over.step.change = path.change;
    const auto& law = laws.get(in.material[i], surface.material);
    out.contact = RespondOverStep<true>{start.resolve_events}(law, over, {});
    if (surface.turns()) {
      const Real force0 = start_force(law.normal.of_pair(over.size), over.step);
      out.contact.losses.integrator +=
          parent_excess(path, surface, before)
              .work(force0 * over.normal0, out.contact.step.force * over.normal1);
    }
    out.arm = surface.arm + pair.contact;
    out.contact_arm = pair.contact, out.is_sphere = path.now.is_sphere;
  }
};

// Displacements of the placed surfaces by the bodies' last correction: of their points [m], and rotations; of
// spheres times the radius [m], else [rad].
struct SurfaceMoves {
  const Vec3 *move, *turn;
};

// Right-hand side for the bodies' correction, which is a known part of the solution of the particles' system.
template <class Rows>
struct SurfaceShiftItem {
  ContactViews<Rows> in;
  NewtonWeights weights;
  SurfaceMoves moves;
  Vec3* residual;  // [N]

  SCREE_HD void operator()(Index i) const {
    for (Index entry = in.surface_offsets[i]; entry < in.surface_offsets[i + 1]; ++entry) {
      if (in.numbers.is_static(in.surfaces[entry]) || !in.steps[entry].touches) continue;
      const Index surface = in.numbers.placed(in.surfaces[entry]);
      const SurfaceStep& step = in.steps[entry];
      const StepContact& c = step.contact;
      Vec3 moved = moves.move[surface];
      if (!step.is_sphere) moved += cross(moves.turn[surface], step.contact_arm);
      residual[i] += (weights.of(c.step) * (dot(c.normal, moved) / weights.stiffness)) * c.normal;
    }
  }
};

}  // namespace scree
