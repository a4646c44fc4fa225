// Particles compared bit for bit, and particles with all values different: both made from the table of
// fields.
#pragma once

#include <string>
#include <vector>

#include "dem/particles/particle_store.hpp"
#include "support/bits.hpp"

namespace scree {

// Names of the fields that differ in a bit, signs of zeros included; "" if there is none.
inline std::string differing_fields(const Particle& a, const Particle& b) {
  std::string names = a.global_id == b.global_id ? "" : "global_id ";
  for_each_field([&](const ParticleField& field, auto member) {
    if (!same_bits(numbers_of(a.*member), numbers_of(b.*member))) names += std::string(field.name) + " ";
  });
  return names;
}

// The differing fields of the first particle that differs.
inline std::string differing_fields(const std::vector<Particle>& a, const std::vector<Particle>& b) {
  if (a.size() != b.size())
    return std::to_string(a.size()) + " and " + std::to_string(b.size()) + " particles";
  for (std::size_t i = 0; i < a.size(); ++i)
    if (const std::string names = differing_fields(a[i], b[i]); !names.empty())
      return "particle " + std::to_string(a[i].global_id) + ": " + names;
  return "";
}

inline bool same_bits(const Particle& a, const Particle& b) { return differing_fields(a, b).empty(); }

// Fills every field with numbers that occur in no other field and no other particle, as far as its type
// permits, and that decimal text or a cast would change; only the present fields.
inline void fill_fields(Particle& particle, std::int64_t number, const FieldsThere& there = {true, true}) {
  std::int64_t next = 100 * number;
  for_each_field([&](const ParticleField& field, auto member) {
    if (!there.has(field.parts)) return;
    auto& value = particle.*member;
    auto numbers = numbers_of(value);
    for (auto& number : numbers) {
      number = static_cast<std::decay_t<decltype(number)>>(++next);
      if constexpr (std::is_same_v<decltype(numbers), std::array<Real, numbers.size()>>)
        number = next % 5 == 0 ? -0.0 : number / 7;
      else if (sizeof(value) == 1)
        number %= 2;
    }
    set_value(value, numbers.data());
  });
}

// Particles of a model with all fields filled, except those that determine positions and contacts.
inline std::vector<Particle> filled_records(const Model& model) {
  std::vector<Particle> records = initial_records(model.particles, Subdomain(model.space));
  for (Particle& p : records) {
    const Particle start = p;
    p = {.global_id = start.global_id};
    fill_fields(p, p.global_id, fields_there(model));
    p.position = start.position, p.radius = start.radius, p.material = start.material;
  }
  return records;
}

}  // namespace scree
