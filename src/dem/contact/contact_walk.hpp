// The walk over the contacts of an item: the row of its neighbours, and the surfaces near it. Shared by the
// CPU and CUDA backends; visitors define what is done with a contact.
#pragma once

#include <type_traits>

#include "dem/contact/contact_kinematics.hpp"

namespace scree {

// Visits the contacts of item i: visit(of(law, pair, history), j) with the neighbour's item j, or the
// surface's number. `of` is pure: it may be called for neighbours without contact, and its result for them is
// discarded. Contacts with placed surfaces were evaluated before, once for particle and body: of.stored(in,
// entry) returns the result, or null without contact.
//
// It is called as of(law, pair, history); of a law with a history its result has the new one as member
// `history`, which is stored only by a walk with kAccepts, of an item that accepts a step.
template <class Laws, class Rows, class Kinematics = InstantKinematics<Laws>>
struct ContactWalk {
  ContactViews<Rows> in;
  Laws laws;
  Kinematics kinematics{};

  using Self = typename Kinematics::Self;
  using Law = LawOf<Laws>;
  SCREE_HD Self self(Index i) const { return kinematics.self(in, i); }

  template <bool kAccepts = false, class Of, class Visit>
  SCREE_HD void neighbors(const Self& self, const Of& of, const Visit& visit) const {
    walk<kAccepts>(self, in_range(kinematics.test(in, self)), of, visit);
  }
  // Adds the contacts with neighbours to sum; `of` returns its Result for each.
  SCREE_HD_CALLER
  template <bool kAccepts, class Of, class Sum>
  SCREE_HD void sum_neighbors(const Self& self, const Of& of, Sum& sum) const {
    if constexpr (kShared<Rows>) {
      in.rows.sum_contacts(self.i, in_range(kinematics.test(in, self)),
                           SharedContact<kAccepts, Of>{*this, of}, sum);
    } else {
      neighbors<kAccepts>(self, of, [&](const typename Of::Result& contact, Index) { sum += contact; });
    }
  }
  // The contact of items i and j at a slot of i's row; `of` takes the history.
  template <class Of>
  SCREE_HD auto contact_at(const Of& of, Index i, Index j, std::int64_t slot) const {
    const Self owner = self(i);
    auto pair = pair_of(owner, j);
    if constexpr (requires { kinematics.at_slot(pair, slot); }) kinematics.at_slot(pair, slot);
    return of(laws.get(owner.material, in.material[j]), pair,
              in.history.template read<Law>(in.history.neighbors, slot));
  }
  // Prefetches the history of the contact at the slot.
  SCREE_HD void prepare(std::int64_t slot) const {
    constexpr int kRecords = records_of(Law::kHistory);
    for (int r = 0; r < kRecords; ++r) prefetch_record(in.history.neighbors + slot * kRecords + r);
  }
  // Visits the neighbours for which only(j) is true.
  template <class Only, class Of, class Visit>
  SCREE_HD void neighbors_if(const Self& self, const Only& only, const Of& of, const Visit& visit) const {
    const auto test = in_range(kinematics.test(in, self));
    walk<false>(
        self, [&](Index j) { return only(j) && test(j); }, of, visit);
  }
  template <bool kAccepts = false, class Of, class Visit>
  SCREE_HD void surfaces(const Self& self, const Of& of, const Visit& visit) const {
    for (Index entry = in.surface_offsets[self.i]; entry < in.surface_offsets[self.i + 1]; ++entry) {
      const Index surface = in.surfaces[entry];
      if (!in.numbers.is_static(surface)) {
        if (const auto* stored = of.stored(in, entry)) visit(*stored, surface);
        continue;
      }
      const WallPlane& plane = in.numbers.planes[surface];
      auto pair = kinematics.wall(in, self, plane);
      count_bodies(pair, self.i);
      if constexpr (requires { kinematics.at_entry(pair, entry); }) kinematics.at_entry(pair, entry);
      if (!may_be_closed(pair)) continue;
      const Law& law = laws.get(self.material, plane.material);
      const auto history = in.history.template read<Law>(in.history.ground, entry);
      const bool closed = found_closed(law, pair, history);
      if (!closed && !found_breaking(pair, history)) continue;
      const auto contact = of(law, pair, history);
      if constexpr (kAccepts && Law::kHistory > 0)
        if (closed && lasts(contact))
          in.history.template write<Law>(in.history.ground, entry, contact.history);
      visit(contact, surface);
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
      const Self owner = walk.kinematics.self(in, i);
      const Law& law = walk.laws.get(owner.material, in.material[j]);
      const auto history = in.history.template read<Law>(in.history.neighbors, slot);
      const auto pair = walk.pair_of(owner, j);
      [[maybe_unused]] const bool closed = found_closed(law, pair, history);
      if constexpr (kHasRange<Law>)
        if (!closed && !found_breaking(pair, history)) return Of::Result::nothing();
      const auto contact = of(law, pair, history);
      if constexpr (kAccepts)
        if (closed) in.history.template write<Law>(in.history.neighbors, slot, contact.history);
      return contact;
    }
    // Test for possible contacts of a row.
    SCREE_HD auto test(const Self& of_row) const {
      return walk.in_range(walk.kinematics.test(walk.in, of_row));
    }
    SCREE_HD void prepare(std::int64_t slot) const { walk.prepare(slot); }
  };

  SCREE_HD auto pair_of(const Self& self, Index j) const {
    auto pair = kinematics.pair(in, self, j);
    count_bodies(pair, self.i, j);
    return pair;
  }
  // Where the items are shapes, adds the motion of their bodies to the effective mass of the contact; their
  // masses are those of the items.
  SCREE_HD static Vec3 normal_of(const PairState& pair) { return pair.geometry.normal(); }
  SCREE_HD static Vec3 normal_of(const ContactPath& path) { return path.normal1; }
  template <class Pair, class... Item>
  SCREE_HD void count_bodies([[maybe_unused]] Pair& pair, [[maybe_unused]] Item... item) const {
    if constexpr (std::is_same_v<Rows, PackedRows> && kUsesMass<Law>)
      if (in.free_shapes != nullptr)
        pair.size.of_bodies = (in.free_shapes[item].beside_mass(normal_of(pair)) + ...);
  }

  // The test, extended by the interaction range of the law.
  template <class Test>
  SCREE_HD auto in_range(const Test& test) const {
    if constexpr (kHasRange<Law> && requires { test.near(Index{}, Real{}); })
      return RangeTest<Test>{test, in.interaction_range};
    else
      return test;
  }
  // Over an implicit step the kinematics policy alone decides which contacts act.
  template <class Pair>
  static constexpr bool kLawCloses = kHasRange<Law>&& std::is_base_of_v<PairState, Pair>;
  template <class Pair>
  SCREE_HD bool may_be_closed(const Pair& pair) const {
    if constexpr (kLawCloses<Pair>)
      return pair.geometry.overlap > -in.interaction_range;
    else
      return Kinematics::closed(pair);
  }
  // Whether the law confirms a contact that `may_be_closed()`, or the test of a row, has accepted.
  template <class Pair, class History>
  SCREE_HD static bool found_closed(const Law& law, const Pair& pair, const History& history) {
    if constexpr (kLawCloses<Pair>)
      return law.closed(pair, history);
    else
      return true;
  }

  // Whether a contact that opened in the step has stored energy to dissipate.
  template <class Pair, class History>
  SCREE_HD static bool found_breaking(const Pair&, const History& history) {
    if constexpr (kHasRange<Law> && std::is_same_v<Pair, MovingPair>)
      return Law::breaks(history);
    else
      return false;
  }

  // Whether the contact exists at the end of the step; else no history is stored.
  template <class Contact>
  SCREE_HD static bool lasts(const Contact& contact) {
    if constexpr (requires { contact.lasts; })
      return contact.lasts;
    else
      return true;
  }

  // Calls add(evaluate(j, slot)) for the entries of a row, as the rows do. Without a history no slots are
  // found, which costs a GPU loads.
  template <class Test, class Evaluate, class Add>
  SCREE_HD void for_each_entry(Index i, const Test& test, const Evaluate& evaluate, const Add& add) const {
    if constexpr (Law::kHistory > 0)
      in.rows.for_each_contact(i, test, evaluate, add);
    else
      in.rows.for_each_contact(
          i, test, [&](Index j) { return evaluate(j, 0); }, add);
  }

  template <bool kAccepts, class Test, class Of, class Visit>
  SCREE_HD void walk(const Self& self, const Test& test, const Of& of, const Visit& visit) const {
    using Pair = decltype(kinematics.pair(in, self, 0));
    if constexpr (kLawCloses<Pair>)
      walk_in_range<kAccepts>(self, test, of, visit);
    else
      walk_tested<kAccepts>(self, test, of, visit);
  }

  template <bool kAccepts, class Test, class Of, class Visit>
  SCREE_HD void walk_tested(const Self& self, const Test& test, const Of& of, const Visit& visit) const {
    struct Found {
      decltype(of(laws.get(0, 0), kinematics.pair(in, self, 0),
                  in.history.template read<Law>(nullptr, 0))) contact;
      Index j;
      std::int64_t slot;
    };
    for_each_entry(
        self.i, test,
        [&](Index j, std::int64_t slot) {
          const auto history = in.history.template read<Law>(in.history.neighbors, slot);
          auto pair = pair_of(self, j);
          if constexpr (requires { kinematics.at_slot(pair, slot); }) kinematics.at_slot(pair, slot);
          return Found{of(laws.get(self.material, in.material[j]), pair, history), j, slot};
        },
        [&](const Found& found) {
          if constexpr (kAccepts && Law::kHistory > 0)
            if (lasts(found.contact))
              in.history.template write<Law>(in.history.neighbors, found.slot, found.contact.history);
          visit(found.contact, found.j);
        });
  }

  // The law decides whether an accepted entry is a contact: it is evaluated where it is added.
  template <bool kAccepts, class Test, class Of, class Visit>
  SCREE_HD void walk_in_range(const Self& self, const Test& test, const Of& of, const Visit& visit) const {
    struct EntryIndex {
      Index j;
      std::int64_t slot;
    };
    for_each_entry(
        self.i, test,
        [](Index j, std::int64_t slot) {
          return EntryIndex{j, slot};
        },
        [&](const EntryIndex& at) {
          const Law& law = laws.get(self.material, in.material[at.j]);
          const auto pair = pair_of(self, at.j);
          const auto history = in.history.template read<Law>(in.history.neighbors, at.slot);
          const bool closed = found_closed(law, pair, history);
          if (!closed && !found_breaking(pair, history)) return;
          const auto contact = of(law, pair, history);
          if constexpr (kAccepts && Law::kHistory > 0)
            if (closed) in.history.template write<Law>(in.history.neighbors, at.slot, contact.history);
          visit(contact, at.j);
        });
  }
};

// Walk over the explicit step of h [s] that ends now; laws without `kNeedsMotion` see its end.
template <class Laws, class Rows>
using ExplicitWalk = ContactWalk<Laws, Rows, StepKinematics<Laws>>;
template <class Laws, class Rows>
SCREE_HD ExplicitWalk<Laws, Rows> explicit_walk(const ContactViews<Rows>& in, const Laws& laws, Real h) {
  if constexpr (LawOf<Laws>::kNeedsMotion)
    return {in, laws, {h}};
  else
    return {in, laws};
}

}  // namespace scree
