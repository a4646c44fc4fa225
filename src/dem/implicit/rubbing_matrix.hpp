// The Newton matrix of contacts that rub. One text for the CPU and CUDA.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/twist.hpp"
#include "dem/implicit/rubbing_contacts.hpp"

namespace scree {

// One contact in the Newton matrix. In single precision, as ContactEntry.
struct RubbingEntry {
  struct alignas(16) Normal {
    float x, y, z;
    Index neighbor;  // j; of a placed surface its entry; RubbingPath::kWall of a plane at rest
  };
  struct alignas(16) Slide {
    float x, y, z;  // its direction, or zero
    float along;    // of the overlap [kg]
  };
  struct alignas(16) Shear {
    float x, y, z;  // the growth of the force across the normal with the overlap; along the normal, which is
                    // free, minus what the normal's turn makes of its force by the way across it [kg]
    float across;   // of the slip across the direction [kg]
  };
  Normal normal;
  Slide slide;
  Shear shear;

  // j: as `neighbor`.
  SCREE_HD static RubbingEntry of(const RubbingContact& c, const NewtonWeights& weights, Index j) {
    const auto single = [](Real x) { return static_cast<float>(x); };
    const Vec3 n = c.normal.normal, t = c.rub.direction;
    const Real along = weights.of(c.normal.step);
    const Vec3 growth = (c.rub.grip * along) * t + weights.stiffness * c.rub.growth -
                        (weights.stiffness * c.normal.step.force * c.curvature) * n;
    return {
        {single(n.x), single(n.y), single(n.z), j},
        {single(t.x), single(t.y), single(t.z), single(along)},
        {single(growth.x), single(growth.y), single(growth.z), single(weights.stiffness * c.rub.stiffness)}};
  }

  // What was found for an entry turned out to be no contact.
  static constexpr Index kNone = -2;
  SCREE_HD bool is_contact() const { return normal.neighbor != kNone; }

  // Force on i, and its torque over the radius, by how the partners move against each other and both turn.
  // consistent: with the growth, too, for which the matrix is neither symmetric nor quite positive, and the
  // derivative but for terms of the order of overlap over radius and of the turn in a step. Vector: Vec3, or
  // Vec3f in a solve, whose directions have units of their own.
  template <class Vector>
  SCREE_HD TwistOf<Vector> pull(Vector apart, Vector turning, bool consistent) const {
    const Vector n{normal.x, normal.y, normal.z}, t{slide.x, slide.y, slide.z};
    const auto approach = dot(n, apart);
    const Vector slip = apart - approach * n - cross(turning, n);
    Vector force = shear.across * (slip - dot(t, slip) * t);
    Vector along = (slide.along * approach) * n;
    if (consistent) {
      const Vector growth{shear.x, shear.y, shear.z};
      force = force - approach * growth, along = along + dot(n, growth) * apart;
    }
    return {along + force, -cross(n, force)};
  }
  // Its symmetric part in the block of i.
  SCREE_HD void add_to(Block6& block) const {
    const Vec3 n{normal.x, normal.y, normal.z}, t{slide.x, slide.y, slide.z}, c = cross(n, t);
    const Real k = shear.across, slides = dot(t, t);
    block.move += outer(slide.along, n);
    if (slides > Real(0.5)) {  // one direction is left: c, and the turn about t goes with it
      block.move += outer(k, c), block.turn += outer(k, t), block.mixed += outer(k, c, t);
      return;
    }
    Sym3 plane = outer(-k, n);
    plane += Sym3{k, 0, 0, k, 0, k};
    block.move += plane, block.turn += plane;
    block.mixed += Mat3{{0, -k * n.z, k * n.y}, {k * n.z, 0, -k * n.x}, {-k * n.y, k * n.x, 0}};
  }
};

// Entries with their parts in arrays of their own: a warp reads whole lines.
struct RubbingEntries {
  RubbingEntry::Normal* normal;
  RubbingEntry::Slide* slide;
  RubbingEntry::Shear* shear;

  SCREE_HD RubbingEntry operator[](std::int64_t slot) const {
    return {normal[slot], slide[slot], shear[slot]};
  }
  SCREE_HD void put(std::int64_t slot, const RubbingEntry& entry) const {
    normal[slot] = entry.normal, slide[slot] = entry.slide, shear[slot] = entry.shear;
  }
  SCREE_HD void put_none(std::int64_t slot) const { normal[slot].neighbor = RubbingEntry::kNone; }
};

// Array: std::vector, or its like on a device.
template <template <class...> class Array>
struct RubbingEntryArrays {
  Array<RubbingEntry::Normal> normal;
  Array<RubbingEntry::Slide> slide;
  Array<RubbingEntry::Shear> shear;

  void resize(std::size_t n) { normal.resize(n), slide.resize(n), shear.resize(n); }
  RubbingEntries views() { return {normal.data(), slide.data(), shear.data()}; }
};

// Entries of contacts with neighbours stand at the list's slots, packed to the front of a row, with some that
// are none among them; those with surfaces at their entries, likewise, contacts all of them.
struct RubbingMatrix {
  Index *count, *surface_count;
  RubbingEntries entries;
  RubbingEntry* surface_entries;

  // take(entry) of particle i's contacts with neighbours; the next one is under way meanwhile.
  template <class Rows, class Take>
  SCREE_HD void for_each_entry(const Rows& rows, Index i, const Take& take) const {
    std::int64_t slot = rows.first(i);
    Index left = count[i];
    if (left == 0) return;
    RubbingEntry next = entries[slot];
    while (left > 0) {
      const RubbingEntry entry = next;
      slot += Rows::stride();
      if (--left > 0) next = entries[slot];
      if (entry.is_contact()) take(entry);
    }
  }
};

// A block per particle, each number of 32 of them side by side: a warp reads and writes whole lines.
struct BlockSlices {
  static constexpr Index kRows = 32;
  float* numbers;

  static std::size_t size(std::size_t particles) {
    return (particles + kRows - 1) / kRows * kRows * Block6f::kNumbers;
  }
  SCREE_HD Block6f operator[](Index i) const {
    Block6f block;
    for (int k = 0; k < Block6f::kNumbers; ++k) block.value[k] = numbers[place(i, k)];
    return block;
  }
  SCREE_HD void put(Index i, const Block6f& block) const {
    for (int k = 0; k < Block6f::kNumbers; ++k) numbers[place(i, k)] = block.value[k];
  }

 private:
  SCREE_HD static std::int64_t place(Index i, int k) {
    return (std::int64_t{i / kRows} * Block6f::kNumbers + k) * kRows + i % kRows;
  }
};

// Inertia in the Newton matrix, with hht_inertia_weight: mass, and moment of inertia over R^2 [kg].
struct ScaledMass {
  Real move, turn;
};

}  // namespace scree
