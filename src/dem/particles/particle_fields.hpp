// Fields of a particle, each declared once. The arrays on either machine, the record of a single particle,
// and all loops over fields follow from the table: load, sort, migration, ghosts, checkpoint, hash and memory
// estimates.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/particles/row_key.hpp"
#include "partition/halo.hpp"
#include "partition/subdomain.hpp"
#include "physics/orientation.hpp"
#include "physics/tangential_losses.hpp"

// One line per field, with its FieldParts. A checkpoint contains all fields; the hash those of the state, in
// this order.
//
// FIELD(name, type, unit, sentence, parts): a separate array.
//
// PACKED(name, unit, sentence, parts, scalar, unit, sentence, parts): a vector and a scalar in one Vec4, so
// that a neighbour costs two loads, three where particles rotate. All items have these, and ghosts receive
// them with each update_halo.
// clang-format off
#define SCREE_PARTICLE_FIELDS(FIELD, PACKED)                                                                 \
  PACKED(position, "m", "centre, wrapped into the periodic box unless it drifts", kState,                    \
         radius, "m", "radius", kConstant | kOutput)                                                         \
  PACKED(velocity, "m/s", "velocity", kState | kOutput, mass, "kg", "mass", kConstant | kOutput)             \
  PACKED(angular_velocity, "rad/s", "angular velocity", kState | kRotation | kOutput, moment_of_inertia,     \
         "kg m^2", "moment of inertia about the centre", kConstant | kRotation)                              \
  FIELD(material, int, "1", "index of its material in the deck, from 0", kConstant | kGhost | kOutput)       \
  FIELD(acceleration, Vec3, "m/s^2", "acceleration that the next step starts from", kState | kOutput)        \
  FIELD(force, Vec3, "N", "gravity and contacts", kState)                                                    \
  FIELD(contact_loss, Real, "J", "energy dissipated in its share of its contacts since t = 0",               \
        kState | kOutput)                                                                                    \
  FIELD(loss_power, Real, "W", "power dissipated in its share of its contacts", kState | kOutput)            \
  FIELD(integrator_loss, Real, "J", "numerical dissipation of HHT since t = 0", kState | kOutput)            \
  FIELD(image, ImageCount, "1", "numbers of periods subtracted from the position", kState | kOutput)         \
  FIELD(drifting, std::uint8_t, "1", "1 if it drifts, outside the domain beyond an open side", kState)       \
  FIELD(angular_acceleration, Vec3, "rad/s^2", "angular acceleration that the next step starts from",        \
        kState | kRotation | kOutput)                                                                        \
  FIELD(orientation, Quaternion, "1", "rotation since t = 0, as a unit quaternion w, x, y, z",               \
        kState | kRotation | kOutput)                                                                        \
  SCREE_LOSS_KINDS(SCREE_LOSS_FIELD, FIELD)
#define SCREE_LOSS_FIELD(FIELD, kind, field, column, what, parts) \
  FIELD(field, Real, "J", "part of contact_loss by " what, kState | parts | kOutput)
// clang-format on

namespace scree {

enum FieldParts : unsigned {
  kState = 1,      // changes in time
  kConstant = 2,   // given by the deck: take_constants()
  kGhost = 4,      // a FIELD that ghosts also have, copied when a list is built
  kOutput = 8,     // offered to snapshots (output.fields)
  kRotation = 16,  // exists where particles rotate (Model::rotates), else an empty array and not part of the
                   // state
  kRolling = 32,   // exists where contacts also resist rolling or twisting (Model::rolls)
};

// Optional fields of a run.
struct FieldsThere {
  bool rotates = false, rolls = false;  // fields with kRotation; fields with kRolling among these

  bool has(unsigned parts) const {
    return ((parts & kRotation) == 0 || rotates) && ((parts & kRolling) == 0 || rolls);
  }
};

// One Array per FIELD and PACKED, and the items' keys. Array: device or host memory, or a plain pointer.
template <template <class> class Array>
struct FieldArrays {
#define SCREE_FIELD(name, type, unit, sentence, parts) Array<type> name{};
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) Array<Vec4> name{};
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
  Array<std::int64_t> row_key{};
};

template <class T>
using Pointer = T*;
using ParticleViews = FieldArrays<Pointer>;

// Record of a single particle with all fields.
struct Particle {
  GlobalId global_id = 0;
#define SCREE_FIELD(name, type, unit, sentence, parts) type name{};
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) \
  Vec3 name{};                                                 \
  Real scalar{};
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
};

// Kinds of arrays for loops.
enum FieldArrayKind : unsigned {
  kKeys = 1,                                     // row_key
  kMotion = 2,                                   // PACKED
  kGhostCopies = 4,                              // FIELD with kGhost
  kOwnedArrays = 8,                              // other FIELD: owned particles only
  kSpins = 16,                                   // PACKED with kRotation
  kOwnedSpins = 32,                              // FIELD with kRotation: owned particles only
  kOwnedRolling = 64,                            // FIELD with kRolling: owned particles only
  kItemArrays = kKeys | kMotion | kGhostCopies,  // all items
  kAllArrays = kItemArrays | kOwnedArrays,
  kRotationArrays = kSpins | kOwnedSpins,
  kOptionalArrays = kRotationArrays | kOwnedRolling
};

constexpr unsigned kind_of_field(unsigned parts) {
  return (parts & kRolling) != 0    ? kOwnedRolling
         : (parts & kRotation) != 0 ? kOwnedSpins
         : (parts & kGhost) != 0    ? kGhostCopies
                                    : kOwnedArrays;
}
constexpr unsigned kind_of_packed(unsigned parts) { return (parts & kRotation) != 0 ? kSpins : kMotion; }

// Calls visit(a.name, b.name, ...) with the arrays of these kinds of all sets.
SCREE_HD_CALLER template <unsigned kinds, class Visit, class... Sets>
constexpr SCREE_HD void for_each_array(const Visit& visit, Sets&... sets) {
#define SCREE_FIELD(name, type, unit, sentence, parts)                                                   \
  static_assert(((parts)&kRotation) == 0 || ((parts)&kGhost) == 0, #name ": not copied to ghosts once"); \
  if constexpr ((kinds & kind_of_field(parts)) != 0) visit(sets.name...);
#define SCREE_PACKED(name, unit, sentence, parts, ...) \
  if constexpr ((kinds & kind_of_packed(parts)) != 0) visit(sets.name...);
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
  if constexpr ((kinds & kKeys) != 0) visit(sets.row_key...);
}

// Includes the optional arrays of the same items that exist in the run.
template <unsigned kinds, class Visit, class... Sets>
void for_each_array(const FieldsThere& there, const Visit& visit, Sets&... sets) {
  constexpr unsigned kSpinsToo =
      ((kinds & kMotion) != 0 ? kSpins : 0u) | ((kinds & kOwnedArrays) != 0 ? kOwnedSpins : 0u);
  constexpr unsigned kRollingToo = (kinds & kOwnedArrays) != 0 ? kOwnedRolling : 0u;
  there.rotates ? for_each_array<kinds | kSpinsToo>(visit, sets...) : for_each_array<kinds>(visit, sets...);
  if (there.rolls) for_each_array<kRollingToo>(visit, sets...);
}

// Whether an array has values.
template <class T>
SCREE_HD bool is_there(T* const& array) {
  return array != nullptr;
}
template <class Array>
bool is_there(const Array& array) {
  return array.size() > 0;
}

// Bytes per item in the arrays of these kinds, and the number of these arrays.
template <unsigned kinds>
constexpr std::size_t bytes_in_arrays() {
  std::size_t bytes = 0;
  const ParticleViews none;
  for_each_array<kinds>([&](auto* array) { bytes += sizeof(*array); }, none);
  return bytes;
}
template <unsigned kinds>
constexpr std::size_t count_arrays() {
  std::size_t count = 0;
  const ParticleViews none;
  for_each_array<kinds>([&](auto*) { ++count; }, none);
  return count;
}

// Record of item i; an owned particle has all fields that exist.
template <class Arrays>
SCREE_HD Particle particle_at(const Arrays& arrays, Index i) {
  Particle p;
  p.global_id = id_of(arrays.row_key[i]);
#define SCREE_FIELD(name, type, unit, sentence, parts) \
  if (((parts)&kRotation) == 0 || is_there(arrays.name)) p.name = arrays.name[i];
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) \
  if (((parts)&kRotation) == 0 || is_there(arrays.name)) {     \
    const Vec4 name = arrays.name[i];                          \
    p.name = xyz(name), p.scalar = name.w;                     \
  }
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
  return p;
}

template <class Arrays>
SCREE_HD void put_particle(Arrays& arrays, Index i, const Particle& p) {
  arrays.row_key[i] = row_key(p.global_id);
#define SCREE_FIELD(name, type, unit, sentence, parts) \
  if (((parts)&kRotation) == 0 || is_there(arrays.name)) arrays.name[i] = p.name;
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) \
  if (((parts)&kRotation) == 0 || is_there(arrays.name)) arrays.name[i] = vec4(p.name, p.scalar);
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
}

// Plain pointers to the arrays, for kernels.
template <class Arrays>
ParticleViews views_of(Arrays& arrays) {
  ParticleViews views;
  for_each_array<kAllArrays | kOptionalArrays>([](auto*& view, auto& array) { view = array.data(); }, views,
                                               arrays);
  return views;
}

// Declaration of a field in the table.
struct ParticleField {
  const char *name, *unit, *description;
  unsigned parts;
};

// Calls visit(field, member) for each field; member: pointer to the member of Particle.
template <class Visit>
void for_each_field(const Visit& visit) {
#define SCREE_FIELD(name, type, unit, sentence, parts)                                               \
  static_assert((((parts)&kState) != 0) != (((parts)&kConstant) != 0), #name ": state or constant"); \
  visit(ParticleField{#name, unit, sentence, parts}, &Particle::name);
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) \
  SCREE_FIELD(name, Vec3, unit, sentence, parts)               \
  SCREE_FIELD(scalar, Real, __VA_ARGS__)
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
}

// The numbers of a value in checkpoints and hashes: Reals, or integers.
inline std::array<Real, 1> numbers_of(Real value) { return {value}; }
inline std::array<Real, 3> numbers_of(const Vec3& v) { return {v.x, v.y, v.z}; }
inline std::array<Real, 4> numbers_of(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }
inline std::array<std::int64_t, 1> numbers_of(std::integral auto value) { return {value}; }
inline std::array<std::int64_t, 3> numbers_of(const ImageCount& n) { return {n.x, n.y, n.z}; }

// Sets the value from its numbers; integers out of range are converted silently.
inline void set_value(Real& value, const Real* from) { value = *from; }
inline void set_value(Vec3& v, const Real* from) { v = {from[0], from[1], from[2]}; }
inline void set_value(Quaternion& q, const Real* from) { q = {from[0], from[1], from[2], from[3]}; }
template <std::integral T>
void set_value(T& value, const std::int64_t* from) {
  value = static_cast<T>(*from);
}
inline void set_value(ImageCount& n, const std::int64_t* from) {
  set_value(n.x, from), set_value(n.y, from + 1), set_value(n.z, from + 2);
}

}  // namespace scree
