// What happens for one particle and one surface on a body: the contact is evaluated once, for the particle's
// force and for the body's wrench. One text for the CPU and CUDA.
#pragma once

#include "dem/contact_items.hpp"
#include "dem/surface_sums.hpp"
#include "dem/surfaces.hpp"
#include "dem/system_items.hpp"
#include "partition/halo_plan.hpp"

namespace scree {

// Particles as contacts with bodies are looked at.
struct SurfaceLook {
  const Vec4 *position, *velocity, *spin;  // spin: null where particles do not rotate
  HistoryViews history;
  Real h = 0;  // of the explicit step that ends there [s]; 0: an instant
};

// The particles, the surfaces on bodies and the list of those that are near each other.
struct SurfaceViews {
  const Vec4 *position, *velocity;  // x, y, z, radius; x, y, z, mass
  const int* material;
  SurfaceEntries entries;
  const PlacedSurface* placed;  // counts from the first surface on a body
  Index ground;
  Vec3 period;  // [m]
  HistoryViews history{};
  const Vec4* spin = nullptr;  // angular velocity, moment of inertia; these two for laws that move
  Real h = 0;                  // SurfaceLook

  SCREE_HD Vec3 shift_of(Index entry) const { return image_shift(entries.images[entry], period); }
  SCREE_HD Index surface_of(Index entry) const { return entries.surfaces[entry] - ground; }
};

// Contacts at one instant or, of laws that move, over the explicit step that ends there; for the k-th of the
// entries by_surface.
template <class Laws>
struct SurfaceLoadItem {
  SurfaceViews in;
  Laws laws;
  SurfaceLoad* loads;  // per entry

  using Law = LawOf<Laws>;

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const PlacedSurface& surface = in.placed[in.surface_of(entry)];
    const Vec4 p = in.position[i], u = in.velocity[i];
    SurfaceLoad& out = loads[entry];
    const SurfacePair pair = surface_pair(surface, in.shift_of(entry), p);
    out.touches = pair.geometry.overlap > 0;
    if (!out.touches) return find_none(entry);
    const PairState state{
        pair.geometry, xyz(u) - surface.velocity_at(pair.contact), {p.w, surface.radius, u.w, kInfinity}};
    const Law& law = laws.get(in.material[i], surface.material);
    if constexpr (Law::kMoves)
      find_moving(law, state, surface, entry);
    else
      find_load(law, state, entry);
    out.arm = Law::kMoves ? surface.arm : surface.arm + pair.contact;
    out.particle_arm = contact_arm(state);
  }

 private:
  SCREE_HD void find_load(const Law& law, const PairState& state, Index entry) const {
    SurfaceLoad& out = loads[entry];
    if constexpr (Law::kHistory == 0) {
      out.load = law.load(state);
    } else {
      const auto load = LoadOf{}(law, state, in.history.template read<Law>(in.history.bodies, entry));
      out.load = load;
      remember(load.history, entry);
    }
    out.energy = EnergyOf{}(law, state);
  }

  // As between two spheres that move, of which the surface is one: its force acts at its centre, with a
  // couple about that.
  SCREE_HD void find_moving(const Law& law, const PairState& state, const PlacedSurface& surface,
                            Index entry) const {
    const ContactHistory old = in.history.template read<Law>(in.history.bodies, entry);
    if (in.h > 0) {
      const MovingPair pair = over_step(state, surface, in.entries.particles[entry]);
      const ContactOutcome outcome = law.load(pair, old);
      take(law, pair, outcome, outcome.history, entry);
      remember(outcome.history, entry);
    } else {
      const InstantPair pair = at_rest(state, surface, in.entries.particles[entry]);
      take(law, pair, law.load(pair, old), old, entry);
    }
  }
  SCREE_HD MovingPair over_step(PairState state, const PlacedSurface& surface, Index i) const {
    const Vec3 travel = in.h * xyz(in.velocity[i]) - surface.travel;
    state.velocity = reciprocal(in.h) * travel;
    return {state, sphere_motion(state.geometry, travel, particle(i),
                                 {reciprocal(in.h) * surface.turn, surface.radius}, in.h)};
  }
  SCREE_HD InstantPair at_rest(PairState state, const PlacedSurface& surface, Index i) const {
    state.velocity = xyz(in.velocity[i]) - surface.velocity_at({});
    return at_instant(
        {state, sphere_motion(state.geometry, {}, particle(i), {surface.spin, surface.radius}, 0)},
        xyz(in.spin[i]), surface.spin);
  }
  SCREE_HD TurningPartner particle(Index i) const {
    return {xyz(in.spin[i]), in.position[i].w, in.spin[i].w};
  }
  SCREE_HD void take(const Law& law, const PairState& state, const ContactOutcome& outcome,
                     const ContactHistory& history, Index entry) const {
    loads[entry].load = outcome.load, loads[entry].losses = outcome.losses();
    loads[entry].energy = EnergyOf{}(law, state, history);
  }

  template <class History>
  SCREE_HD void remember(const History& history, Index entry) const {
    if (in.history.ahead != nullptr) in.history.template write<Law>(in.history.ahead, entry, history);
  }
  SCREE_HD void find_none(Index entry) const {
    if constexpr (Law::kHistory > 0)
      if (in.history.ahead != nullptr) in.history.template write_none<Law>(in.history.ahead, entry);
  }
};

// Contacts over an implicit step.
template <class Laws>
struct SurfaceStepItem {
  SurfaceViews in;
  StepStart start;
  const PlacedSurface* start_placed;
  Laws laws;
  SurfaceStep* steps;  // per entry

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const PlacedSurface &surface = in.placed[in.surface_of(entry)],
                        &before = start_placed[in.surface_of(entry)];
    const Vec4 p = in.position[i], p0 = start.position[i], u = in.velocity[i];
    const Vec3 shift = in.shift_of(entry);
    const SurfacePair pair = surface_pair(surface, shift, p), pair0 = surface_pair(before, shift, p0);
    SurfaceStep& out = steps[entry];
    out.touches = pair.geometry.overlap > 0 || pair0.geometry.overlap > 0;
    if (!out.touches) return;
    const Vec3 travel = (xyz(p) - xyz(p0)) - (surface.point - before.point);
    const ContactPath path =
        OverStep{start}.path(pair.geometry, xyz(u) - surface.velocity_at(pair.contact), pair0.geometry,
                             xyz(start.velocity[i]) - before.velocity_at(pair0.contact), travel,
                             {p.w, surface.radius, u.w, kInfinity});
    const auto& law = laws.get(in.material[i], surface.material);
    const StepContactOf of{start.resolve_events};
    out.contact = of(law, path);
    out.books = StepBooksOf{of}(law, path);
    out.arm = surface.arm + pair.contact;
  }
};

// The bodies have taken their correction: as a known part of the solution it moves to the right-hand side of
// the particles' system.
template <class Rows>
struct SurfaceShiftItem {
  ContactViews<Rows> in;
  NewtonWeights weights;
  const Vec3* displacement;  // of the surfaces on bodies by the correction [m]
  Vec3* residual;            // [N]

  SCREE_HD void operator()(Index i) const {
    for (Index entry = in.surface_offsets[i]; entry < in.surface_offsets[i + 1]; ++entry) {
      if (in.surfaces[entry] < in.ground || !in.steps[entry].touches) continue;
      const StepContact& c = in.steps[entry].contact;
      const Real along = dot(c.normal, displacement[in.surfaces[entry] - in.ground]) / weights.stiffness;
      residual[i] += (weights.of(c.step) * along) * c.normal;
    }
  }
};

}  // namespace scree
