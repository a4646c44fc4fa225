// Newton matrix of contacts with friction. Shared by the CPU and CUDA backends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "base/spatial_velocity.hpp"
#include "dem/implicit/frictional_contacts.hpp"

namespace scree {

// One contact in the Newton matrix, in single precision like `ContactEntry`.
struct FrictionEntry {
  struct alignas(16) Normal {
    float x, y, z;
    Index neighbor;  // j; entry of a placed surface; FrictionalPath::kWall for a static plane
  };
  struct alignas(16) SlipDirection {
    float x, y, z;  // unit vector of sliding, or zero
    float along;    // derivative with respect to the overlap [kg]
  };
  struct alignas(16) Shear {
    float x, y, z;  // tangential part: derivative of the friction force with respect to the overlap; normal
                    // part, otherwise unused: minus the change of the normal force by rotation of the normal
                    // per tangential displacement [kg]
    float across;   // derivative with respect to the slip perpendicular to the direction of sliding [kg]
  };
  Normal normal;
  SlipDirection slip_direction;
  Shear shear;

  // j: see `neighbor`.
  SCREE_HD static FrictionEntry of(const FrictionalContact& c, const NewtonWeights& weights, Index j) {
    const auto single = [](Real x) { return static_cast<float>(x); };
    const Vec3 n = c.normal.normal, t = c.friction.direction;
    const Real along = weights.of(c.normal.step);
    const Vec3 growth = (c.friction.normal_force_slope * along) * t +
                        weights.stiffness * c.friction.overlap_slope -
                        (weights.stiffness * c.normal.step.force * c.curvature) * n;
    return {{single(n.x), single(n.y), single(n.z), j},
            {single(t.x), single(t.y), single(t.z), single(along)},
            {single(growth.x), single(growth.y), single(growth.z),
             single(weights.stiffness * c.friction.stiffness)}};
  }

  // Marks an entry without contact.
  static constexpr Index kNone = -2;
  SCREE_HD bool is_contact() const { return normal.neighbor != kNone; }

  // Product of the entry with the relative displacement and the sum of the rotations of the partners: force
  // on i, and its torque over the radius. consistent: includes the derivatives with respect to the overlap,
  // with which the matrix is neither symmetric nor strictly positive, but equals the derivative up to terms
  // of the order of overlap over radius and of the rotation in a step. Vector: Vec3, or Vec3f in a solve,
  // whose directions have their own unit.
  template <class Vector>
  SCREE_HD TwistOf<Vector> apply(Vector relative_displacement, Vector rotation_sum, bool consistent) const {
    const Vector n{normal.x, normal.y, normal.z}, t{slip_direction.x, slip_direction.y, slip_direction.z};
    const auto approach = dot(n, relative_displacement);
    const Vector slip = relative_displacement - approach * n - cross(rotation_sum, n);
    Vector force = shear.across * (slip - dot(t, slip) * t);
    Vector along = (slip_direction.along * approach) * n;
    if (consistent) {
      const Vector growth{shear.x, shear.y, shear.z};
      force = force - approach * growth, along = along + dot(n, growth) * relative_displacement;
    }
    return {along + force, -cross(n, force)};
  }
  // Adds the symmetric part to the block of i.
  SCREE_HD void add_to(Block6& block) const {
    const Vec3 n{normal.x, normal.y, normal.z}, t{slip_direction.x, slip_direction.y, slip_direction.z},
        c = cross(n, t);
    const Real k = shear.across, is_sliding = dot(t, t);
    block.move += outer(slip_direction.along, n);
    if (is_sliding > Real(0.5)) {  // only the direction c is left, together with the rotation about t
      block.move += outer(k, c), block.turn += outer(k, t), block.mixed += outer(k, c, t);
      return;
    }
    Sym3 tangent = outer(-k, n);
    tangent += Sym3{k, 0, 0, k, 0, k};
    block.move += tangent, block.turn += tangent;
    block.mixed += Mat3{{0, -k * n.z, k * n.y}, {k * n.z, 0, -k * n.x}, {-k * n.y, k * n.x, 0}};
  }
};

// Resistance to rolling and twisting of one contact in the Newton matrix, beside its `FrictionEntry`. The
// rotational rows are torques over R_i, and their unknowns rotations times the radius.
struct alignas(16) RollingEntry {
  float x, y, z;  // unit vector of rolling at the limit, or zero
  float across;   // derivative of the moment over R_i with respect to R_i times the rotation of i relative to
                  // j, across normal and direction [kg]
  float along_normal;                     // the same for twisting [kg]
  float rolling_growth, twisting_growth;  // derivatives of the moment over R_i with respect to the overlap,
                                          // along the direction and along the normal [kg]
  float partner_scale;  // R_i over the unit of j's rotation: R_i / R_j for particles, else R_i [m]

  SCREE_HD static RollingEntry of(const RollingFrictionalContact& c, const NewtonWeights& weights,
                                  Real partner_scale) {
    const auto single = [](Real x) { return static_cast<float>(x); };
    const StepRolling& m = c.rolling;
    const Real inverse = 1 / c.radius_i, scaled = weights.stiffness * inverse * inverse,
               along = weights.of(c.normal.step) * inverse;
    return {single(m.direction.x),
            single(m.direction.y),
            single(m.direction.z),
            single(scaled * m.rolling),
            single(scaled * m.twisting),
            single(m.rolling_load_slope * along),
            single(m.twisting_load_slope * along),
            single(partner_scale)};
  }

  // Product with the relative displacement and with R_i times the rotation of i relative to j: minus the
  // torque on i over R_i. n: normal; consistent: see `FrictionEntry::apply()`.
  template <class Vector>
  SCREE_HD Vector apply(Vector n, Vector relative_displacement, Vector relative_turn, bool consistent) const {
    const Vector t{x, y, z};
    const auto twist = dot(n, relative_turn);
    const Vector roll = relative_turn - twist * n;
    Vector moment = across * (roll - dot(t, roll) * t) + (along_normal * twist) * n;
    if (consistent) {
      const auto approach = dot(n, relative_displacement);
      moment = moment - (approach * rolling_growth) * t - (approach * twisting_growth) * n;
    }
    return moment;
  }
  // Adds the symmetric part to the block of i.
  SCREE_HD void add_to(Block6& block, Vec3 n) const {
    const Real k = across;
    block.turn += Sym3{k, 0, 0, k, 0, k};
    block.turn += outer(-k, Vec3{x, y, z});
    block.turn += outer(along_normal - k, n);
  }
};

// An entry of laws with rolling resistance.
struct RollingFrictionEntry : FrictionEntry {
  RollingEntry rolling;

  SCREE_HD void add_to(Block6& block) const {
    FrictionEntry::add_to(block);
    rolling.add_to(block, Vec3{normal.x, normal.y, normal.z});
  }
};
template <bool kRolls>
using FrictionEntryOf = std::conditional_t<kRolls, RollingFrictionEntry, FrictionEntry>;

// Product of an entry with the directions of i and of its partner j, an item.
SCREE_HD Twistf product_of(const FrictionEntry& entry, Twistf own, Twistf other, bool consistent) {
  return entry.apply(own.move - other.move, own.turn + other.turn, consistent);
}
SCREE_HD Twistf product_of(const RollingFrictionEntry& entry, Twistf own, Twistf other, bool consistent) {
  Twistf out = product_of(static_cast<const FrictionEntry&>(entry), own, other, consistent);
  out.turn = out.turn + entry.rolling.apply(Vec3f{entry.normal.x, entry.normal.y, entry.normal.z},
                                            own.move - other.move,
                                            own.turn - entry.rolling.partner_scale * other.turn, consistent);
  return out;
}

// Entries as a structure of arrays: a warp reads whole cache lines.
struct FrictionEntries {
  FrictionEntry::Normal* normal;
  FrictionEntry::SlipDirection* slip_direction;
  FrictionEntry::Shear* shear;
  RollingEntry* rolling = nullptr;  // for laws with rolling resistance

  template <bool kRolls>
  SCREE_HD FrictionEntryOf<kRolls> at(std::int64_t slot) const {
    if constexpr (kRolls)
      return {(*this)[slot], rolling[slot]};
    else
      return (*this)[slot];
  }
  SCREE_HD FrictionEntry operator[](std::int64_t slot) const {
    return {normal[slot], slip_direction[slot], shear[slot]};
  }
  SCREE_HD void put(std::int64_t slot, const FrictionEntry& entry) const {
    normal[slot] = entry.normal, slip_direction[slot] = entry.slip_direction, shear[slot] = entry.shear;
  }
  SCREE_HD void put_none(std::int64_t slot) const { normal[slot].neighbor = FrictionEntry::kNone; }
};

// Array: std::vector, or DeviceArray.
template <template <class...> class Array>
struct FrictionEntryArrays {
  Array<FrictionEntry::Normal> normal;
  Array<FrictionEntry::SlipDirection> slip_direction;
  Array<FrictionEntry::Shear> shear;
  Array<RollingEntry> rolling;

  // rolls: whether the law has rolling resistance.
  void resize(std::size_t n, bool rolls) {
    normal.resize(n), slip_direction.resize(n), shear.resize(n);
    if (rolls) rolling.resize(n);
  }
  FrictionEntries views() { return {normal.data(), slip_direction.data(), shear.data(), rolling.data()}; }
};

// Entries of contacts with neighbours are at the list's slots, packed to the front of a row; some of them may
// be marked as no contact. Those with surfaces are packed likewise at the surfaces' entries.
struct FrictionMatrix {
  Index *count, *surface_count;
  FrictionEntries entries;
  FrictionEntry* surface_entries;
  RollingEntry* surface_rolling = nullptr;  // for laws with rolling resistance

  // Calls take(entry) for particle i's contacts with neighbours; the next entry is loaded meanwhile. kRolls:
  // whether the law has rolling resistance.
  template <bool kRolls, class Rows, class Take>
  SCREE_HD void for_each_entry(const Rows& rows, Index i, const Take& take) const {
    std::int64_t slot = rows.first(i);
    Index left = count[i];
    if (left == 0) return;
    FrictionEntryOf<kRolls> next = entries.at<kRolls>(slot);
    while (left > 0) {
      const FrictionEntryOf<kRolls> entry = next;
      slot += Rows::stride();
      if (--left > 0) next = entries.at<kRolls>(slot);
      if (entry.is_contact()) take(entry);
    }
  }
};

// Calls use(std::bool_constant) with whether the law has rolling resistance: items that read the matrix are
// compiled for both.
template <class Use>
decltype(auto) with_rolling(bool rolls, const Use& use) {
  return rolls ? use(std::true_type{}) : use(std::false_type{});
}

// A 6x6 block per particle, in slices of 32 with each number contiguous: a warp reads and writes whole cache
// lines.
struct BlockSlices {
  static constexpr Index kRows = 32;
  float* numbers;

  static std::size_t size(std::size_t particles) {
    return (particles + kRows - 1) / kRows * kRows * Block6f::kNumbers;
  }
  SCREE_HD Block6f operator[](Index i) const {
    Block6f block;
    for (int k = 0; k < Block6f::kNumbers; ++k) block.value[k] = numbers[index(i, k)];
    return block;
  }
  SCREE_HD void put(Index i, const Block6f& block) const {
    for (int k = 0; k < Block6f::kNumbers; ++k) numbers[index(i, k)] = block.value[k];
  }

 private:
  SCREE_HD static std::int64_t index(Index i, int k) {
    return (std::int64_t{i / kRows} * Block6f::kNumbers + k) * kRows + i % kRows;
  }
};

// Inertia in the Newton matrix, times hht_inertia_weight: mass, and moment of inertia over R^2 [kg].
struct ScaledMass {
  Real move, turn;
};

}  // namespace scree
