// Data of backends, and whole states, compared bit for bit.
#pragma once

#include <string>

#include "dem/backend/backend.hpp"
#include "support/bits.hpp"
#include "support/checkpoint_arrays.hpp"
#include "support/particle_bits.hpp"

namespace scree {

inline auto fields(const ShapeLosses& l) {
  const auto& [contact_loss, loss_power, integrator_loss, tangential] = l;
  const auto& [friction, rolling, twisting] = tangential.of;
  return std::tie(contact_loss, loss_power, integrator_loss, friction, rolling, twisting);
}
inline auto fields(const BodyWrench& w) {
  const auto& [force, torque, belt_power] = w;
  return std::tie(force, torque, belt_power);
}
inline auto fields(const ContactSum& s) {
  const auto& [force, torque, contacts] = s;
  return std::tie(force, torque, contacts);
}
inline auto fields(const WrenchStiffness& w) {
  const auto& [body, stiffness, damping] = w;
  return std::tie(body, stiffness, damping);
}
inline auto fields(const PairStiffness& p) {
  const auto& [first, second, stiffness, damping] = p;
  return std::tie(first, second, stiffness, damping);
}
inline auto fields(const ContactWrenches& w) {
  const auto& [wrench, stiffness, pairs] = w;
  return std::tie(wrench, stiffness, pairs);
}

// Names of the arrays that differ in a bit, or that only one of the two has; "" if there are none. States
// are compared by pack(), which lists all their parts.
inline std::string differing_arrays(const Checkpoint& one, const Checkpoint& other) {
  const Checkpoint a = with_rows_as_arrays(one), b = with_rows_as_arrays(other);
  std::string names;
  for (const auto& [name, values] : a.reals)
    if (!b.reals.count(name) || !same_bits(values, b.reals.at(name))) names += name + " ";
  for (const auto& [name, values] : a.integers)
    if (!b.integers.count(name) || !same_bits(values, b.integers.at(name))) names += name + " ";
  if (a.reals.size() != b.reals.size() || a.integers.size() != b.integers.size()) names += "(other arrays)";
  return names;
}

}  // namespace scree
