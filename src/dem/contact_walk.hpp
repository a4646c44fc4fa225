// The one place that walks over what touches an item: the row of its neighbours, and the surfaces near it.
// One text for the CPU and CUDA; what is done with a contact its visitors say.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/history_slots.hpp"
#include "dem/surface_sums.hpp"
#include "dem/surfaces.hpp"
#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// The law of every contact: one pair of materials, or a table of them.
template <class Law>
struct OneLaw {
  Law law;
  SCREE_HD const Law& get(int, int) const { return law; }
};

template <class Law>
struct LawTable {
  const Law* laws;  // [materials * materials]
  int materials;
  SCREE_HD const Law& get(int i, int j) const { return laws[i * materials + j]; }
};

// evaluate(j) of an entry of a row, or evaluate(j, slot) where that wants to know the list's slot of the
// entry, too.
template <class Evaluate>
inline constexpr bool kAsksForSlot = std::is_invocable_v<const Evaluate&, Index, std::int64_t>;
template <class Evaluate>
SCREE_HD auto evaluate_entry(const Evaluate& evaluate, Index j, std::int64_t slot) {
  if constexpr (kAsksForSlot<Evaluate>)
    return evaluate(j, slot);
  else
    return evaluate(j);
}

// Where a neighbour list keeps the entries of its rows: one row after the other in the serial backend,
// another type of the same form on a GPU.
struct PackedRows {
  const Index* offsets;  // [items + 1]
  const Index* neighbors;

  // Slot of the row's first entry, and from one entry to the next.
  SCREE_HD std::int64_t first(Index i) const { return offsets[i]; }
  SCREE_HD static constexpr int stride() { return 1; }
  // Calls add(evaluate(j)) for the entries j of row i of which touches(j) holds, in their order. evaluate has
  // no side effects: it may be called for others, too. It may ask for the slot (evaluate_entry).
  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate,
                                 const Add& add) const {
    const Index end = offsets[i + 1];
    for (Index k = offsets[i]; k < end; ++k)
      if (const Index j = neighbors[k]; touches(j)) add(evaluate_entry(evaluate, j, k));
  }
};

// Whether rows are summed up together with those of other items: sum_contacts(i, test, evaluate, sum) calls
// evaluate(i, j, slot) once for every contact, maybe of another row.
template <class Rows>
inline constexpr bool kShared = false;
template <class Rows>
requires Rows::kShared inline constexpr bool kShared<Rows> = true;

// Read-only views of items and neighbour list.
template <class Rows>
struct ContactViews {
  const Vec4* position;  // x, y, z, radius
  const Vec4* velocity;  // x, y, z, mass
  const int* material;
  Rows rows;
  const Index* surface_offsets;  // [particles + 1]
  const Index* surfaces;         // the first `ground` are planes, on the ground; the others are on bodies
  const WallPlane* planes;
  Index ground;
  const SurfaceLoad* loads;  // per entry of the surfaces: what those on bodies do at this instant,
  const SurfaceStep* steps;  // and over an implicit step
  HistoryViews history{};
  const Vec4* spin = nullptr;  // angular velocity, moment of inertia; null where particles do not rotate
};

SCREE_HD bool touch(Vec4 p, Vec4 q) {
  const Vec3 r = xyz(p) - xyz(q);
  const Real reach = p.w + q.w;
  return dot(r, r) < reach * reach;
}

// Whether other items touch the one at p, or come within a margin of that [m].
struct TouchTest {
  Vec4 p;
  const Vec4* position;  // all items
  SCREE_HD bool operator()(Index j) const { return touch(p, position[j]); }
  SCREE_HD bool near(Index j, Real margin) const {
    const Vec4 q = position[j];
    const Vec3 r = xyz(p) - xyz(q);
    const Real reach = p.w + q.w + margin;
    return dot(r, r) < reach * reach;
  }
};

SCREE_HD ContactGeometry wall_pair(Vec4 p, const WallPlane& wall) {
  return plane_pair(xyz(p), p.w, wall.point, wall.normal);
}

SCREE_HD PairSize wall_size(Real radius, Real mass) { return {radius, kInfinity, mass, kInfinity}; }

// A look says what a walk sees of the items: what it reads of item i itself, which others touch it, and the
// pair of the two. This is the look at one instant; the pair is a PairState.
struct AtInstant {
  struct Self {
    Index i;
    int material;
    Vec4 p, u;  // x, y, z, radius; velocity, mass
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], in.position[i], in.velocity[i]};
  }
  template <class Rows>
  SCREE_HD TouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return {self.p, in.position};
  }
  template <class Rows>
  SCREE_HD PairState pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    return pair(self, in.position[j], in.velocity[j]);
  }
  SCREE_HD static PairState pair(const Self& self, Vec4 q, Vec4 w) {
    return {sphere_pair(xyz(self.p) - xyz(q), self.p.w + q.w),
            xyz(self.u) - xyz(w),
            {self.p.w, q.w, self.u.w, w.w}};
  }
  template <class Rows>
  SCREE_HD PairState wall(const ContactViews<Rows>&, const Self& self, const WallPlane& plane) const {
    return {wall_pair(self.p, plane), xyz(self.u), wall_size(self.p.w, self.u.w)};
  }
  template <class Pair>
  SCREE_HD static bool closed(const Pair& pair) {
    return pair.geometry.overlap > 0;
  }
};

// The look of laws that move (ContactLaw::kMoves): over the step that ends at this instant. The velocities
// and angular velocities are those of the middle of the step; the pair is a MovingPair.
struct OverMotion {
  Real h;  // [s]

  struct Self {
    Index i;
    int material;
    Vec4 p, u, spin;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], in.position[i], in.velocity[i], in.spin[i]};
  }
  template <class Rows>
  SCREE_HD TouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return {self.p, in.position};
  }
  template <class Rows>
  SCREE_HD MovingPair pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    const Vec4 q = in.position[j], w = in.velocity[j];
    const PairState state = AtInstant::pair({self.i, self.material, self.p, self.u}, q, w);
    return {state, sphere_motion(state.geometry, h * state.velocity, partner(self.p, self.spin),
                                 partner(q, in.spin[j]), h)};
  }
  template <class Rows>
  SCREE_HD MovingPair wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    const PairState state = AtInstant{}.wall(in, {self.i, self.material, self.p, self.u}, plane);
    return {state,
            face_motion(state.geometry, plane.normal, h * state.velocity, partner(self.p, self.spin), {}, h)};
  }
  SCREE_HD static bool closed(const PairState& pair) { return pair.geometry.overlap > 0; }

 private:
  SCREE_HD static TurningPartner partner(Vec4 p, Vec4 spin) { return {xyz(spin), p.w, spin.w}; }
};

// The same at an instant alone; the pair is an InstantPair.
struct AtMovingInstant {
  using Self = OverMotion::Self;
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return OverMotion{0}.self(in, i);
  }
  template <class Rows>
  SCREE_HD TouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return OverMotion{0}.test(in, self);
  }
  template <class Rows>
  SCREE_HD InstantPair pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    return at_instant(OverMotion{0}.pair(in, self, j), xyz(self.spin), xyz(in.spin[j]));
  }
  template <class Rows>
  SCREE_HD InstantPair wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    return at_instant(OverMotion{0}.wall(in, self, plane), xyz(self.spin), {});
  }
  SCREE_HD static bool closed(const PairState& pair) { return OverMotion::closed(pair); }
};

// The law that a choice of laws is about; what it sees at an instant, and over an explicit step.
template <class Laws>
using LawOf = std::remove_cvref_t<decltype(std::declval<Laws>().get(0, 0))>;
template <class Laws>
using InstantLook = std::conditional_t<LawOf<Laws>::kMoves, AtMovingInstant, AtInstant>;
template <class Laws>
using StepLook = std::conditional_t<LawOf<Laws>::kMoves, OverMotion, AtInstant>;

// Where a step started, all items, and whether contacts that open or close within it are resolved; else the
// force at its end counts for the whole step, as in the paper.
struct StepStart {
  const Vec4* position;  // x, y, z, radius
  const Vec4* velocity;
  Real h;  // [s]
  bool resolve_events;
};

// One contact over an implicit step, as it lies between its two partners.
struct ContactPath {
  ContactStep step;
  Vec3 normal0, normal1;  // at its start and its end
  Vec3 travel;            // of i relative to j [m]
  PairSize size;
};

// The look over an implicit step: at what touches at its start or its end; the pair is a ContactPath.
struct OverStep {
  StepStart start;

  struct Self {
    Index i;
    int material;
    Vec4 p, p0;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], in.position[i], start.position[i]};
  }
  template <class Rows>
  SCREE_HD auto test(const ContactViews<Rows>& in, const Self& self) const {
    return [&in, &self, this](Index j) {
      return touch(self.p, in.position[j]) || touch(self.p0, start.position[j]);
    };
  }
  template <class Rows>
  SCREE_HD ContactPath pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    const Index i = self.i;
    const Vec4 q = in.position[j], u = in.velocity[i], w = in.velocity[j];
    const Real reach = self.p.w + q.w;
    const Vec3 r = xyz(self.p) - xyz(q), r0 = xyz(self.p0) - xyz(start.position[j]);
    return path(sphere_pair(r, reach), xyz(u) - xyz(w), sphere_pair(r0, reach),
                xyz(start.velocity[i]) - xyz(start.velocity[j]), r - r0, {self.p.w, q.w, u.w, w.w});
  }
  template <class Rows>
  SCREE_HD ContactPath wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    const Vec4 u = in.velocity[self.i];
    return path(wall_pair(self.p, plane), xyz(u), wall_pair(self.p0, plane), xyz(start.velocity[self.i]),
                xyz(self.p) - xyz(self.p0), wall_size(self.p.w, u.w));
  }
  SCREE_HD static bool closed(const ContactPath& path) {
    return path.step.overlap1 > 0 || path.step.overlap0 > 0;
  }
  SCREE_HD ContactPath path(const ContactGeometry& end, Vec3 end_velocity, const ContactGeometry& begin,
                            Vec3 begin_velocity, Vec3 travel, const PairSize& size) const {
    const Vec3 normal0 = begin.normal(), normal1 = end.normal();
    return {{begin.overlap, -dot(normal0, begin_velocity), end.overlap, -dot(normal1, end_velocity), start.h},
            normal0,
            normal1,
            travel,
            size};
  }
};

// Visits what touches item i: visit(of(law, pair), j) with j the neighbour's item, or the surface's number.
// `of` is pure: it may be called for neighbours that do not touch, and what it returns for them is dropped.
// Contacts with surfaces on bodies were evaluated before, once for particle and body: of.stored(in, entry)
// has what `of` would return, null where they do not touch.
//
// Where the law remembers something, an `of` that wants to see it is called as of(law, pair, history), and
// its result has as `history` what the contact will remember. Only the walk of an item that accepts a step,
// with kAccepts, stores that; all others leave no trace.
template <class Laws, class Rows, class Look = InstantLook<Laws>>
struct ContactWalk {
  ContactViews<Rows> in;
  Laws laws;
  Look look{};

  using Self = typename Look::Self;
  using Law = LawOf<Laws>;
  SCREE_HD Self self(Index i) const { return look.self(in, i); }

  template <bool kAccepts = false, class Of, class Visit>
  SCREE_HD void neighbors(const Self& self, const Of& of, const Visit& visit) const {
    walk<kAccepts>(self, look.test(in, self), of, visit);
  }
  // Adds `of` the contacts with neighbours to sum, which is of its type but for the history.
  SCREE_HD_CALLER
  template <bool kAccepts, class Of, class Sum>
  SCREE_HD void sum_neighbors(const Self& self, const Of& of, Sum& sum) const {
    if constexpr (kShared<Rows>) {
      in.rows.sum_contacts(self.i, look.test(in, self), SharedContact<kAccepts, Of, Sum>{*this, of}, sum);
    } else {
      neighbors<kAccepts>(self, of, [&](const Sum& contact, Index) { sum += contact; });
    }
  }
  // Of the neighbours those of which only(j) holds.
  template <class Only, class Of, class Visit>
  SCREE_HD void neighbors_if(const Self& self, const Only& only, const Of& of, const Visit& visit) const {
    const auto test = look.test(in, self);
    walk<false>(
        self, [&](Index j) { return only(j) && test(j); }, of, visit);
  }
  template <bool kAccepts = false, class Of, class Visit>
  SCREE_HD void surfaces(const Self& self, const Of& of, const Visit& visit) const {
    for (Index entry = in.surface_offsets[self.i]; entry < in.surface_offsets[self.i + 1]; ++entry) {
      const Index surface = in.surfaces[entry];
      if (surface >= in.ground) {
        if (const auto* stored = of.stored(in, entry)) visit(*stored, surface);
        continue;
      }
      const WallPlane& plane = in.planes[surface];
      const auto pair = look.wall(in, self, plane);
      if (!Look::closed(pair)) continue;
      const Law& law = laws.get(self.material, plane.material);
      if constexpr (sees_history<Of, decltype(pair)>()) {
        const auto contact = of(law, pair, in.history.template read<Law>(in.history.ground, entry));
        if constexpr (kAccepts) in.history.template write<Law>(in.history.ground, entry, contact.history);
        visit(contact, surface);
      } else {
        visit(of(law, pair), surface);
      }
    }
  }

 private:
  // Evaluates contacts of any row.
  template <bool kAccepts, class Of, class Sum>
  struct SharedContact {
    const ContactWalk& walk;
    const Of& of;

    SCREE_HD Sum operator()(Index i, Index j, std::int64_t slot) const {
      const auto& in = walk.in;
      const Self owner = walk.look.self(in, i);
      const auto contact = of(walk.laws.get(owner.material, in.material[j]), walk.look.pair(in, owner, j),
                              in.history.template read<Law>(in.history.neighbors, slot));
      if constexpr (kAccepts) in.history.template write<Law>(in.history.neighbors, slot, contact.history);
      return contact;
    }
    // It will be called for this neighbour and slot.
    SCREE_HD void prepare(Index j, std::int64_t slot) const {
      fetch_ahead(walk.in.history.neighbors + slot * records_of(Law::kHistory));
    }
  };

  template <class Of, class Pair>
  SCREE_HD static constexpr bool sees_history() {
    if constexpr (Law::kHistory > 0)
      return std::is_invocable_v<const Of&, const Law&, const Pair&,
                                 decltype(in.history.template read<Law>(nullptr, 0))>;
    else
      return false;
  }

  template <bool kAccepts, class Test, class Of, class Visit>
  SCREE_HD void walk(const Self& self, const Test& test, const Of& of, const Visit& visit) const {
    using Pair = decltype(look.pair(in, self, 0));
    if constexpr (sees_history<Of, Pair>())
      walk_with_history<kAccepts>(self, test, of, visit);
    else
      walk_without(self, test, of, visit);
  }

  template <class Test, class Of, class Visit>
  SCREE_HD void walk_without(const Self& self, const Test& test, const Of& of, const Visit& visit) const {
    struct Found {
      decltype(of(laws.get(0, 0), look.pair(in, self, 0))) contact;
      Index j;
    };
    in.rows.for_each_contact(
        self.i, test,
        [&](Index j) {
          return Found{of(laws.get(self.material, in.material[j]), look.pair(in, self, j)), j};
        },
        [&](const Found& found) { visit(found.contact, found.j); });
  }

  template <bool kAccepts, class Test, class Of, class Visit>
  SCREE_HD void walk_with_history(const Self& self, const Test& test, const Of& of,
                                  const Visit& visit) const {
    struct Found {
      decltype(of(laws.get(0, 0), look.pair(in, self, 0), in.history.template read<Law>(nullptr, 0))) contact;
      Index j;
      std::int64_t slot;
    };
    in.rows.for_each_contact(
        self.i, test,
        [&](Index j, std::int64_t slot) {
          const auto history = in.history.template read<Law>(in.history.neighbors, slot);
          return Found{of(laws.get(self.material, in.material[j]), look.pair(in, self, j), history), j, slot};
        },
        [&](const Found& found) {
          if constexpr (kAccepts)
            in.history.template write<Law>(in.history.neighbors, found.slot, found.contact.history);
          visit(found.contact, found.j);
        });
  }
};

// Over an explicit step of h [s] that ends now; laws that do not move see its end.
template <class Laws, class Rows>
using ExplicitWalk = ContactWalk<Laws, Rows, StepLook<Laws>>;
template <class Laws, class Rows>
SCREE_HD ExplicitWalk<Laws, Rows> explicit_walk(const ContactViews<Rows>& in, const Laws& laws, Real h) {
  if constexpr (LawOf<Laws>::kMoves)
    return {in, laws, {h}};
  else
    return {in, laws};
}

}  // namespace scree
