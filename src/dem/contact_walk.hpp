// The one place that walks over what touches an item: the row of its neighbours, and the surfaces near it.
// One text for the CPU and CUDA; what is done with a contact its visitors say.
#pragma once

#include <type_traits>
#include <utility>

#include "dem/contact_views.hpp"
#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"

namespace scree {

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
    walk<kAccepts>(self, reaching(look.test(in, self)), of, visit);
  }
  // Adds `of` the contacts with neighbours, its Result each, to sum.
  SCREE_HD_CALLER
  template <bool kAccepts, class Of, class Sum>
  SCREE_HD void sum_neighbors(const Self& self, const Of& of, Sum& sum) const {
    if constexpr (kShared<Rows>) {
      in.rows.sum_contacts(self.i, reaching(look.test(in, self)), SharedContact<kAccepts, Of>{*this, of},
                           sum);
    } else {
      neighbors<kAccepts>(self, of, [&](const typename Of::Result& contact, Index) { sum += contact; });
    }
  }
  // Of the neighbours those of which only(j) holds.
  template <class Only, class Of, class Visit>
  SCREE_HD void neighbors_if(const Self& self, const Only& only, const Of& of, const Visit& visit) const {
    const auto test = reaching(look.test(in, self));
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
      auto pair = look.wall(in, self, plane);
      if constexpr (requires { look.at_entry(pair, entry); }) look.at_entry(pair, entry);
      if (!may_be_closed(pair)) continue;
      const Law& law = laws.get(self.material, plane.material);
      if constexpr (sees_history<Of, decltype(pair)>()) {
        const auto history = in.history.template read<Law>(in.history.ground, entry);
        if (!found_closed(law, pair, history)) continue;
        const auto contact = of(law, pair, history);
        if constexpr (kAccepts)
          if (lasts(contact)) in.history.template write<Law>(in.history.ground, entry, contact.history);
        visit(contact, surface);
      } else if (found_closed(law, pair, ContactHistory{})) {
        visit(of(law, pair), surface);
      }
    }
  }

 private:
  // Evaluates contacts of any row.
  template <bool kAccepts, class Of>
  struct SharedContact {
    const ContactWalk& walk;
    const Of& of;

    SCREE_HD typename Of::Result operator()(Index i, Index j, std::int64_t slot) const {
      const auto& in = walk.in;
      const Self owner = walk.look.self(in, i);
      const Law& law = walk.laws.get(owner.material, in.material[j]);
      const auto pair = walk.look.pair(in, owner, j);
      const auto history = in.history.template read<Law>(in.history.neighbors, slot);
      if constexpr (kReaches<Law>)
        if (!found_closed(law, pair, history)) return Of::Result::nothing();
      const auto contact = of(law, pair, history);
      if constexpr (kAccepts) in.history.template write<Law>(in.history.neighbors, slot, contact.history);
      return contact;
    }
    // It will be called for this neighbour and slot.
    SCREE_HD void prepare(Index j, std::int64_t slot) const {
      fetch_ahead(walk.in.history.neighbors + slot * records_of(Law::kHistory));
    }
  };

  // What of the row may have a contact.
  template <class Test>
  SCREE_HD auto reaching(const Test& test) const {
    if constexpr (kReaches<Law> && requires { test.near(Index{}, Real{}); })
      return ReachTest<Test>{test, in.reach};
    else
      return test;
  }
  // Over a step that may open and close contacts the look alone says what touches.
  template <class Pair>
  static constexpr bool kLawCloses = kReaches<Law>&& std::is_base_of_v<PairState, Pair>;
  template <class Pair>
  SCREE_HD bool may_be_closed(const Pair& pair) const {
    if constexpr (kLawCloses<Pair>)
      return pair.geometry.overlap > -in.reach;
    else
      return Look::closed(pair);
  }
  // Of what may_be_closed(), or a test of the row, has let through.
  template <class Pair, class History>
  SCREE_HD static bool found_closed(const Law& law, const Pair& pair, const History& history) {
    if constexpr (kLawCloses<Pair>)
      return law.closed(pair, history);
    else
      return true;
  }

  // Whether a contact is there at the end of the step: of one that has ended nothing is remembered.
  template <class Contact>
  SCREE_HD static bool lasts(const Contact& contact) {
    if constexpr (requires { contact.lasts; })
      return contact.lasts;
    else
      return true;
  }

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
    if constexpr (kLawCloses<Pair>)
      walk_reaching<kAccepts>(self, test, of, visit);
    else if constexpr (sees_history<Of, Pair>())
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
          auto pair = look.pair(in, self, j);
          if constexpr (requires { look.at_slot(pair, slot); }) look.at_slot(pair, slot);
          return Found{of(laws.get(self.material, in.material[j]), pair, history), j, slot};
        },
        [&](const Found& found) {
          if constexpr (kAccepts)
            if (lasts(found.contact))
              in.history.template write<Law>(in.history.neighbors, found.slot, found.contact.history);
          visit(found.contact, found.j);
        });
  }

  // What the test has found may turn out to be no contact: it is evaluated where it is added.
  template <bool kAccepts, class Test, class Of, class Visit>
  SCREE_HD void walk_reaching(const Self& self, const Test& test, const Of& of, const Visit& visit) const {
    using Pair = decltype(look.pair(in, self, 0));
    struct Place {
      Index j;
      std::int64_t slot;
    };
    const auto add = [&](const Place& at) {
      const Law& law = laws.get(self.material, in.material[at.j]);
      const auto pair = look.pair(in, self, at.j);
      if constexpr (sees_history<Of, Pair>()) {
        const auto history = in.history.template read<Law>(in.history.neighbors, at.slot);
        if (!found_closed(law, pair, history)) return;
        const auto contact = of(law, pair, history);
        if constexpr (kAccepts)
          in.history.template write<Law>(in.history.neighbors, at.slot, contact.history);
        visit(contact, at.j);
      } else if (found_closed(law, pair, ContactHistory{})) {
        visit(of(law, pair), at.j);
      }
    };
    in.rows.for_each_contact(
        self.i, test,
        [](Index j, std::int64_t slot) {
          return Place{j, slot};
        },
        add);
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
