// What happens for one particle and one surface on a body: the contact is evaluated once, for the particle's
// force and for the body's wrench. One text for the CPU and CUDA.
#pragma once

#include "dem/contact_items.hpp"
#include "dem/surface_sums.hpp"
#include "dem/surfaces.hpp"
#include "dem/system_items.hpp"
#include "partition/halo_plan.hpp"

namespace scree {

// The particles, the surfaces on bodies and the list of those that are near each other.
struct SurfaceViews {
  const Vec4 *position, *velocity;  // x, y, z, radius; x, y, z, mass
  const int* material;
  SurfaceEntries entries;
  const PlacedSurface* placed;  // counts from the first surface on a body
  Index ground;
  Vec3 period;  // [m]
  HistoryViews history{};

  SCREE_HD Vec3 shift_of(Index entry) const { return image_shift(entries.images[entry], period); }
  SCREE_HD Index surface_of(Index entry) const { return entries.surfaces[entry] - ground; }
};

// Contacts at one instant, for the k-th of the entries by_surface.
template <class Laws>
struct SurfaceLoadItem {
  SurfaceViews in;
  Laws laws;
  SurfaceLoad* loads;  // per entry

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const PlacedSurface& surface = in.placed[in.surface_of(entry)];
    const Vec4 p = in.position[i], u = in.velocity[i];
    SurfaceLoad& out = loads[entry];
    const SurfacePair pair = surface_pair(surface, in.shift_of(entry), p);
    out.touches = pair.geometry.overlap > 0;
    if (!out.touches) return;
    const PairState state{
        pair.geometry, xyz(u) - surface.velocity_at(pair.contact), {p.w, surface.radius, u.w, kInfinity}};
    const auto& law = laws.get(in.material[i], surface.material);
    find_load(law, state, entry);
    out.energy = EnergyOf{}(law, state);
    out.arm = surface.arm + pair.contact, out.particle_arm = contact_arm(state);
  }

 private:
  template <class Law>
  SCREE_HD void find_load(const Law& law, const PairState& state, Index entry) const {
    if constexpr (Law::kHistory == 0 || Law::kMoves) {
      loads[entry].load = law.normal_load(state);
    } else {
      const HistoryViews& at = in.history;
      const auto load = LoadOf{}(law, state, at.template read<Law>(at.surfaces, entry));
      loads[entry].load = load;
      if (at.ahead != nullptr) at.template write<Law>(at.ahead, entry, load.history);
    }
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
