// What happens for one particle and one surface on a body over an implicit step in which contacts rub; beside
// surface_items.hpp. One text for the CPU and CUDA.
#pragma once

#include "dem/rubbing_items.hpp"
#include "dem/surface_items.hpp"

namespace scree {

// How the place on the body at `place` from its centre moves where the body takes a unit step along its k-th
// coordinate (x, y, z, rx, ry, rz).
SCREE_HD Vec3 moved_by_unit(Vec3 place, int k) {
  const Vec3 axis{k % 3 == 0 ? Real(1) : Real(0), k % 3 == 1 ? Real(1) : Real(0),
                  k % 3 == 2 ? Real(1) : Real(0)};
  return k < 3 ? axis : cross(axis, place);
}

// The force of friction acts at the surface's centre with a couple about it, as between two spheres. Its
// part of the blocks is that of the Newton matrix of the particles (RubbingEntry): the slip is minus the
// motion of the place of contact across the normal, one direction of which is left in a slide.
SCREE_HD Real sum_term(const SurfaceRub& c, int k) {
  const StepContact& normal = c.contact.normal;
  const Vec3 n = normal.normal;
  if (k < 2 * kWrenchTerms) {
    const bool at_end = k < kWrenchTerms;
    const Vec3 rub = at_end ? c.contact.rub.end : c.contact.rub.step;
    const Vec3 force = c.contact.leverage * rub - (at_end ? normal.end_force : normal.step.force) * n;
    return component(force, cross(c.arm, force) + c.radius * cross(n, rub), k % kWrenchTerms);
  }
  const BlockPlace at = block_place(k);
  const Vec3 place = c.arm + c.radius * n;
  const Vec3 a = moved_by_unit(place, at.row), b = moved_by_unit(place, at.column);
  const Real along = dot(n, a) * dot(n, b);
  if (!at.is_stiffness) return normal.step.damping * along;
  const Vec3 t = c.contact.rub.direction;
  return normal.step.stiffness * along +
         c.contact.rub.stiffness * (dot(a, b) - along - dot(t, a) * dot(t, b));
}

// Contacts over the step, for the k-th of the entries by_surface. in.spin: at the end.
template <class Laws>
struct SurfaceRubItem {
  SurfaceViews in;
  RubbingStart start;
  const PlacedSurface* start_placed;
  Laws laws;
  SurfaceRub* rubs;  // per entry

  using Law = LawOf<Laws>;

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const PlacedSurface &surface = in.placed[in.surface_of(entry)],
                        &before = start_placed[in.surface_of(entry)];
    const RubbingPath path = path_of(surface, before, entry, i);
    SurfaceRub& out = rubs[entry];
    out.touches = OverRubbingStep::closed(path);
    if (!out.touches) return find_none(entry);
    const Law& law = laws.get(in.material[i], surface.material);
    const bool resolve_events = start.step.resolve_events;
    const ContactHistory old = in.history.template read<Law>(in.history.bodies, entry);
    out.contact = rubbing_contact(law, path, old, resolve_events, [&](bool at_end) {
      return path.motion.arm_i * xyz((at_end ? in.spin : start.spin)[i]) +
             path.motion.arm_j * (at_end ? surface : before).spin;
    });
    out.books = rubbing_books(law, path, out.contact, resolve_events);
    out.arm = surface.arm, out.radius = surface.radius;
    if (!out.contact.lasts) return find_none(entry);
    if (in.history.ahead != nullptr)
      in.history.template write<Law>(in.history.ahead, entry, out.contact.history);
  }

 private:
  SCREE_HD RubbingPath path_of(const PlacedSurface& surface, const PlacedSurface& before, Index entry,
                               Index i) const {
    const Vec4 p = in.position[i], p0 = start.step.position[i], w = start.mean_spin[i];
    const Vec3 shift = in.shift_of(entry);
    const ContactGeometry end = surface_pair(surface, shift, p).geometry,
                          begin = surface_pair(before, shift, p0).geometry;
    const Vec3 travel = (xyz(p) - xyz(p0)) - (surface.point - before.point);
    const Real h = start.step.h, reach = p.w + surface.radius;
    const TurningPartner one{xyz(w), p.w, w.w}, other{reciprocal(h) * surface.turn, surface.radius};
    RubbingPath out{};
    out.velocity0 = xyz(start.step.velocity[i]) - before.velocity_at({});
    out.velocity1 = xyz(in.velocity[i]) - surface.velocity_at({});
    static_cast<ContactPath&>(out) = OverStep{start.step}.path(
        end, out.velocity1, begin, out.velocity0, travel, {p.w, surface.radius, in.velocity[i].w, kInfinity});
    out.motion = sphere_motion(end, travel, one, other, h);
    out.leverage0 = out.motion.leverage * end.distance / (reach - out.step.overlap0);
    out.turning = h * (one.arm * one.spin + other.arm * other.spin);
    out.i = i, out.j = RubbingPath::kWall;
    OverRubbingStep{start}.at_entry(out, entry);
    return out;
  }
  SCREE_HD void find_none(Index entry) const {
    if (in.history.ahead != nullptr) in.history.template write_none<Law>(in.history.ahead, entry);
  }
};

// By the bodies' last correction: of the centres of surfaces, and of the surfaces about them, the turn times
// the radius [m].
struct SurfaceMoves {
  const Vec3 *move, *turn;
};

// As SurfaceShiftItem.
struct RubbingShiftItem {
  RubbingMatrix matrix;
  const Index* surface_offsets;
  NewtonWeights weights;
  bool with_grip;
  SurfaceMoves moves;
  Twist* residual;  // [N]

  SCREE_HD void operator()(Index i) const {
    const Real scale = 1 / weights.stiffness;
    for (Index k = 0; k < matrix.surface_count[i]; ++k) {
      const RubbingEntry& entry = matrix.surface_entries[surface_offsets[i] + k];
      if (entry.normal.neighbor == RubbingPath::kWall) continue;
      residual[i] -= entry.pull(-scale * moves.move[entry.normal.neighbor],
                                scale * moves.turn[entry.normal.neighbor], with_grip);
    }
  }
};

}  // namespace scree
