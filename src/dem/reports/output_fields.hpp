// Particle fields of snapshots (output.fields): those of the table in particle_fields.hpp, and fields derived
// from them or from contacts. Each is declared once. Shared by the CPU and CUDA backends.
#pragma once

#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "deck/deck.hpp"
#include "dem/contact/contact_items.hpp"
#include "dem/particles/particle_fields.hpp"
#include "partition/subdomain.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

// Input of an output field.
struct OutputSource {
  ParticleViews particles;
  int dimension;         // 2 or 3
  Vec3 gravity;          // [m/s^2]
  Vec3 box_min, period;  // of the domain [m]

  // The particle with its position wrapped into the periodic box.
  SCREE_HD Particle particle(Index i) const {
    Particle p = particle_at(particles, i);
    p.position = wrap(box_min, period, p.position, p.image);
    return p;
  }
};

inline OutputSource output_source(const ParticleViews& particles, const Model& model, Vec3 period) {
  return {particles, model.space.dimension, model.gravity, model.space.min, period};
}

struct OutputHead {
  const char *name, *unit, *description;
};

// An output field is a type with a Value and one of
//   operator()(source, i)         for particle i
//   operator()(source, walk, i)   for particle i and its contacts, with any ContactWalk at an instant
// Fields that are not in the table have a head, too, and are listed in DerivedOutputs.

template <auto kMember>
struct TableOutput {
  using Value = std::remove_cvref_t<decltype(std::declval<Particle>().*kMember)>;
  SCREE_HD Value operator()(const OutputSource& in, Index i) const { return in.particle(i).*kMember; }
};
using PositionOutput = TableOutput<&Particle::position>;  // point of the particle in the snapshot

struct ForceOutput {
  static constexpr OutputHead head{"force", "N", "total contact force on the particle"};
  using Value = Vec3;
  SCREE_HD Value operator()(const OutputSource& in, Index i) const {
    return in.particles.force[i] - in.particles.velocity[i].w * in.gravity;
  }
};

struct ContactsOutput {
  static constexpr OutputHead head{"contacts", "1", "touching neighbours and walls"};
  using Value = int;
  template <class Walk>
  SCREE_HD Value operator()(const OutputSource&, const Walk& walk, Index i) const {
    return touch_sums(walk, i, [](Index) { return kPairShare; }).contacts;
  }
};

// Tensor by rows.
struct Tensor {
  Vec3 x, y, z;
};

// (1/V) sum over the contacts of F x^T: F the force on the particle, x from its centre to the contact point,
// V the particle's volume, for discs its area (J. Weber, Bull. Liaison Ponts Chauss. 20, 1966;
// Christoffersen, Mehrabadi, Nemat-Nasser, J. Appl. Mech. 48, 1981). Its mean over a volume of static
// particles, times their volume fraction, is the stress of the granular material.
struct StressOutput {
  static constexpr OutputHead head{
      "stress", "Pa (2D: N/m)",
      "mean stress of the particle from its contacts, row by row; tension is positive"};
  using Value = Tensor;

  struct Acting {
    template <class Law, class Pair>
    SCREE_HD SurfaceLoad operator()(const Law& law, const Pair& pair,
                                    const typename Law::History& old) const {
      return {true, law.respond(pair, old).load, {}, {}, contact_arm(pair)};
    }
    template <class Views>
    SCREE_HD const SurfaceLoad* stored(const Views& in, Index entry) const {
      return in.loads[entry].touches ? &in.loads[entry] : nullptr;
    }
  };

  template <class Walk>
  SCREE_HD Value operator()(const OutputSource& in, const Walk& walk, Index i) const {
    const auto self = walk.self(i);
    const Real radius = self.p.w;
    const Real volume = in.dimension == 2 ? disc_mass(radius, 1, 1) : sphere_mass(radius, 1);
    Tensor sum;
    const auto add = [&](const SurfaceLoad& contact, Index) {
      const Vec3 f = (1 / volume) * contact.load.force;
      sum.x += f.x * contact.particle_arm, sum.y += f.y * contact.particle_arm;
      sum.z += f.z * contact.particle_arm;
    };
    walk.neighbors(self, Acting{}, add);
    walk.surfaces(self, Acting{}, add);
    return sum;
  }
};

// Group of a particle, known from its global id and the deck: added where snapshots are written, not by a
// backend.
inline constexpr OutputHead kGroupOutput{
    "group", "1", "group of particles to which it belongs, from 0 in the order of the deck"};

using DerivedOutputs = std::tuple<ForceOutput, ContactsOutput, StressOutput>;

// Calls visit(head, of) for each output field.
template <class Visit>
void for_each_output_field(const Visit& visit) {
#define SCREE_FIELD(name, type, unit, sentence, parts) \
  if constexpr (((parts)&kOutput) != 0)                \
    visit(OutputHead{#name, unit, sentence}, TableOutput<&Particle::name>{});
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) \
  SCREE_FIELD(name, Vec3, unit, sentence, parts)               \
  SCREE_FIELD(scalar, Real, __VA_ARGS__)
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
  std::apply([&](auto... of) { (visit(of.head, of), ...); }, DerivedOutputs{});
}

template <class Of>
inline constexpr bool kReadsContacts = !std::is_invocable_v<const Of&, const OutputSource&, Index>;

// The k-th value belongs to particle order[k]; without an order, to particle k.
template <class Of>
struct OwnOutputItem {
  OutputSource in;
  const Index* order;
  typename Of::Value* out;
  SCREE_HD void operator()(Index k) const { out[k] = Of{}(in, order != nullptr ? order[k] : k); }
};

template <class Of, class Walk>
struct ContactOutputItem {
  Walk walk;
  OutputSource in;
  const Index* order;
  typename Of::Value* out;
  SCREE_HD void operator()(Index k) const { out[k] = Of{}(in, walk, order != nullptr ? order[k] : k); }
};

// Request for the values of n particles; out: space for n values of the field's type.
struct OutputRequest {
  OutputSource in;
  const Index* order;
  Index n;
  std::string_view field;
  void* out;
};

// Calls run(item) with the item of the requested field, if it reads no contacts; with a walk, if it does.
template <class Run>
void with_own_output(const OutputRequest& r, const Run& run) {
  for_each_output_field([&]<class Of>(const OutputHead& head, Of) {
    if constexpr (!kReadsContacts<Of>)
      if (r.field == head.name)
        run(OwnOutputItem<Of>{r.in, r.order, static_cast<typename Of::Value*>(r.out)});
  });
}
template <class Walk, class Run>
void with_contact_output(const OutputRequest& r, const Walk& walk, const Run& run) {
  for_each_output_field([&]<class Of>(const OutputHead& head, Of) {
    if constexpr (kReadsContacts<Of>)
      if (r.field == head.name)
        run(ContactOutputItem<Of, Walk>{walk, r.in, r.order, static_cast<typename Of::Value*>(r.out)});
  });
}

// Values of one field, one entry per particle.
using OutputValues = std::variant<std::vector<Real>, std::vector<Vec3>, std::vector<Tensor>,
                                  std::vector<Quaternion>, std::vector<int>, std::vector<ImageCount>>;

// Type of the numbers in a value.
template <class Value>
using OutputNumber =
    std::conditional_t<std::is_same_v<Value, int> || std::is_same_v<Value, ImageCount>, int, Real>;

// Description of an output field for the host.
struct OutputField {
  OutputHead head;
  std::size_t bytes;  // of a value
  bool reads_contacts;
  bool of_id;                             // kGroupOutput
  bool is_constant;                       // constant in time for a particle
  OutputValues (*values)(std::size_t n);  // n zeros
};

const std::vector<OutputField>& output_fields();
// Fields that the deck requests (Output::fields), in its order. Throws std::logic_error for an unknown name.
std::vector<OutputField> wanted_fields(const Output& output);
// Requested fields that a backend computes.
std::vector<OutputField> computed_fields(const Output& output);
// Throws InputError where output.fields of the deck has an unknown or repeated name.
void check_output_fields(const Deck& deck);
// Fields with their descriptions, one per line, for `scree keys`; and as a section of its page in Markdown.
std::string output_fields_text();
std::string output_fields_markdown();

}  // namespace scree
