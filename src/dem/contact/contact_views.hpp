// Building blocks of a walk over contacts: the laws of all pairs of materials, the rows of a list, the arrays
// of the items, and contact tests. Shared by the CPU and CUDA backends.
#pragma once

#include <cstdint>
#include <type_traits>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/history/history_slots.hpp"
#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// The law of every contact: of one pair of materials, or a table of all pairs.
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

// Calls evaluate(j) for an entry of a row, or evaluate(j, slot) if it takes the number of the entry in the
// list: its slot in packed rows, and the index of its history record in all rows.
template <class Evaluate>
inline constexpr bool kTakesSlot = std::is_invocable_v<const Evaluate&, Index, std::int64_t>;
template <class Evaluate>
SCREE_HD auto evaluate_entry(const Evaluate& evaluate, Index j, std::int64_t slot) {
  if constexpr (kTakesSlot<Evaluate>)
    return evaluate(j, slot);
  else
    return evaluate(j);
}

// Rows of a neighbour list, stored contiguously in the serial backend; a GPU has another type with the same
// interface.
struct PackedRows {
  const Index* offsets;  // [items + 1]
  const Index* neighbors;

  // Slot of the row's first entry, and the distance between its entries.
  SCREE_HD std::int64_t first(Index i) const { return offsets[i]; }
  SCREE_HD static constexpr int stride() { return 1; }
  // Number of the row's first entry in the contact history.
  SCREE_HD std::int64_t first_number(Index i) const { return offsets[i]; }
  SCREE_HD Index count(Index i) const { return offsets[i + 1] - offsets[i]; }
  // Calls add(evaluate(j)) for the entries j of row i for which touches(j) is true, in order. evaluate must
  // have no side effects, because it may be called for other entries as well. It may take the slot
  // (`evaluate_entry`).
  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate,
                                 const Add& add) const {
    const Index end = offsets[i + 1];
    for (Index k = offsets[i]; k < end; ++k)
      if (const Index j = neighbors[k]; touches(j)) add(evaluate_entry(evaluate, j, k));
  }
};

// Whether rows are summed together with those of other items: sum_contacts(i, test, evaluate, sum) calls
// evaluate(i, j, slot) once for every contact, which may belong to another row.
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
  const Index* surfaces;         // surface numbers
  SurfaceNumbers numbers;
  const SurfaceLoad* loads;  // per entry of the surfaces: loads of placed ones at this instant
  const SurfaceStep* steps;  // per entry, over an implicit step
  HistoryViews history{};
  const Vec4* spin = nullptr;  // angular velocity, moment of inertia; null where particles do not rotate
  Real interaction_range = 0;  // Contact::interaction_range [m]
  // Radii [m] that laws use at planes instead of the items' own; null: the items' own. Supported by packed
  // rows only.
  const Real* law_radius = nullptr;
  // Where the items are shapes of bodies, and laws may depend on masses; else null. Packed rows only.
  const FreeShape* free_shapes = nullptr;
};

// The views with other rows.
template <class Rows, class From>
SCREE_HD ContactViews<Rows> with_rows(const ContactViews<From>& in, const Rows& rows) {
  return {in.position, in.velocity,          in.material,   rows,          in.surface_offsets,
          in.surfaces, in.numbers,           in.loads,      in.steps,      in.history,
          in.spin,     in.interaction_range, in.law_radius, in.free_shapes};
}

SCREE_HD bool touch(Vec4 p, Vec4 q) {
  const Vec3 r = xyz(p) - xyz(q);
  const Real distance = p.w + q.w;
  return dot(r, r) < distance * distance;
}

// Tests whether other items touch the one at p, or come within a margin of touch [m].
struct TouchTest {
  Vec4 p;
  const Vec4* position;  // all items
  SCREE_HD bool operator()(Index j) const { return touch(p, position[j]); }
  SCREE_HD bool near(Index j, Real margin) const {
    const Vec4 q = position[j];
    const Vec3 r = xyz(p) - xyz(q);
    const Real distance = p.w + q.w + margin;
    return dot(r, r) < distance * distance;
  }
};

// Whether contacts may exist beyond touch with this law.
template <class Law>
inline constexpr bool kHasRange = false;
template <class Law>
requires requires { Law::kHasRange; }
inline constexpr bool kHasRange<Law> = Law::kHasRange;

// Whether a law may depend on the partners' masses.
template <class Law>
inline constexpr bool kUsesMass = true;
template <class Law>
requires requires { Law::Normal::kUsesMass; }
inline constexpr bool kUsesMass<Law> = Law::Normal::kUsesMass;

// Tests whether items are within the interaction range of the law [m], where they may have a contact.
template <class Test>
struct RangeTest {
  Test test;
  Real interaction_range;
  SCREE_HD bool operator()(Index j) const { return test.near(j, interaction_range); }
  SCREE_HD bool near(Index j, Real margin) const { return test.near(j, interaction_range + margin); }
};

SCREE_HD ContactGeometry wall_pair(Vec4 p, const WallPlane& wall) {
  return plane_pair(xyz(p), p.w, wall.point, wall.normal);
}

SCREE_HD PairSize wall_size(Real radius, Real mass) { return {radius, kInfinity, mass, kInfinity}; }
template <class Rows>
SCREE_HD PairSize wall_size(const ContactViews<Rows>& in, Index i, Real radius, Real mass) {
  if constexpr (std::is_same_v<Rows, PackedRows>)
    if (in.law_radius != nullptr) radius = in.law_radius[i];
  return wall_size(radius, mass);
}

}  // namespace scree
