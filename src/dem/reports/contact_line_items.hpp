// Contacts in snapshots: each is a line from the centre of a particle. Shared by the CPU and CUDA backends.
#pragma once

#include <cstdint>

#include "dem/contact/contact_walk.hpp"
#include "dem/history/contact_key.hpp"
#include "dem/history/history_slots.hpp"
#include "dem/particles/particle_fields.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Output of a contact at an instant.
struct ShownContact {
  Vec3 branch;        // from the particle's centre to the other one's, or to the contact point on a surface
                      // [m]
  Vec3 force;         // on the particle [N]
  Real normal_force;  // normal component; positive if repulsive [N]
  Real tangential_force;  // magnitude of the tangential component [N]
  Real overlap;           // [m]
  Real slip;              // elongation of the tangential spring [m]
};

// A contact, stored with the particle of the lower id; or with the shape of a body, of two shapes with that
// of the lower number.
struct ContactLine {
  GlobalId first;   // a particle, or `surface_id()` of a shape
  GlobalId second;  // the other particle, or a `surface_id()`
  Vec3 start;       // the first one's centre, inside the periodic box [m]
  ShownContact contact;
};

template <class Law>
SCREE_HD ShownContact shown_contact(const ContactGeometry& geometry, Vec3 branch, Vec3 force, Real slip) {
  const Vec3 normal = geometry.normal();
  const Real pushing = dot(force, normal);
  ShownContact out{branch, force, pushing, 0, geometry.overlap, slip};
  if constexpr (Law::Tangential::acts) out.tangential_force = norm(force - pushing * normal);
  return out;
}
template <class Law, class History>
SCREE_HD Real slip_of(const Law& law, const PairState& pair, const History& history) {
  if constexpr (Law::Tangential::acts)
    return law.slip_of(pair, history);
  else
    return 0;
}

// Output of the contact at the k-th of the entries by_surface, whose load at this instant is in `loads`.
template <class Laws>
struct ShownSurfaceItem {
  SurfaceViews in;
  Laws laws;
  const SurfaceLoad* loads;  // per entry
  ShownContact* shown;       // per entry; of those in contact

  using Law = LawOf<Laws>;

  SCREE_HD void operator()(Index k) const {
    const Index entry = in.entries.by_surface[k], i = in.entries.particles[entry];
    const SurfaceLoad& load = loads[entry];
    if (!load.touches) return;
    const SurfacePose& surface = in.placed[in.surface_of(entry)];
    const Vec4 p = in.position[i];
    const ContactGeometry geometry =
        surface_touch(in, surface, entry, p, kHasRange<Law> ? in.interaction_range : 0).pair.geometry;
    Real slip = 0;
    if constexpr (Law::Tangential::acts)
      slip = slip_of(laws.get(in.material[i], surface.material),
                     PairState{geometry, {}, surface_size(in, entry, p, in.velocity[i])},
                     in.history.template read_from<Law>(in.history.bodies, in.goes_on_from(surface, entry)));
    shown[entry] = shown_contact<Law>(geometry, load.particle_arm, load.load.force, slip);
  }
};

struct EvaluateShownContact {
  const ShownContact* of_surfaces;  // from `ShownSurfaceItem`

  template <class Law, class Pair>
  SCREE_HD ShownContact operator()(const Law& law, const Pair& pair, const typename Law::History& old) const {
    return shown_contact<Law>(pair.geometry, branch(pair), law.respond(pair, old).load.force,
                              slip_of(law, pair, old));
  }
  template <class Views>
  SCREE_HD const ShownContact* stored(const Views& in, Index entry) const {
    return in.loads[entry].touches ? &of_surfaces[entry] : nullptr;
  }
  SCREE_HD static Vec3 branch(const PairState& pair) { return pair.geometry.along(-pair.geometry.distance); }
};

// Input of `ContactLineItem` beside the walk, and where its lines go.
struct LineRequest {
  const std::int64_t* row_key;      // of all items
  const ShownContact* of_surfaces;  // per entry of the surfaces
  Vec3 box_min, period;             // of the domain [m]
  // Null: the lines of each particle are only counted.
  ContactLine* lines = nullptr;
  const Index* offsets = nullptr;  // where the lines of each particle begin
  Index first_line = 0;            // where `lines` begins
  Index* counts = nullptr;
  Index first = 0;  // the first of the particles
};

// Lines of the contacts that belong to particle i: with particles of a higher id, every other one with its
// own images, and all with surfaces.
template <class Laws, class Rows>
struct ContactLineItem {
  ContactWalk<Laws, Rows> walk;
  LineRequest to;

  SCREE_HD void operator()(Index k) const {
    const Index i = to.first + k;
    const auto self = walk.self(i);
    const std::int64_t own_key = to.row_key[i];
    Index count = 0;
    const auto add = [&](GlobalId second, const ShownContact& contact) {
      if (to.lines != nullptr)
        to.lines[to.offsets[i] - to.first_line + count] = {id_of(own_key), second, wrapped_position(self.p),
                                                           contact};
      ++count;
    };
    const EvaluateShownContact of{to.of_surfaces};
    walk.neighbors_if(
        self, [&](Index j) { return to.row_key[j] > own_key; }, of,
        [&](const ShownContact& contact, Index j) { add(id_of(to.row_key[j]), contact); });
    walk.surfaces(self, of,
                  [&](const ShownContact& contact, Index surface) { add(surface_id(surface), contact); });
    if (to.lines == nullptr) to.counts[i] = count;
  }

 private:
  SCREE_HD Vec3 wrapped_position(Vec4 p) const {
    ImageCount unused;
    return wrap(to.box_min, to.period, xyz(p), unused);
  }
};

}  // namespace scree
