// Decks of single impacts without gravity, and the closed forms for them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/models.hpp"

namespace scree {

// Domain and contact law of an impact of discs of radius 0.05 m and mass 1 kg.
inline std::string impact_deck(Real stiffness, Real damping, bool tension, Real exponent = 1) {
  return fmt::format(R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
y_min = "wall"
[time]
end = 1.0
step = 1e-5
control = "fixed"
[[contact.pairs]]
stiffness = {}
damping = {}
limit_damping = {}
exponent = {}
[[particles]]
name = "disc"
kind = "list"
positions = [[0.0, 0.0]]
radius = 0.05
mass = 1.0
)",
                     stiffness, damping, !tension, exponent);
}

// A linear spring-dashpot impact in closed form (tests/reference/README.md): restitution and duration.
struct ClosedImpact {
  Real ratio;      // z = C / (2 sqrt(K m*)), below 1
  Real frequency;  // w = sqrt(K / m*) [1/s]
  bool tension;

  Real duration() const {
    const Real damped = frequency * std::sqrt(1 - ratio * ratio);
    if (tension) return std::numbers::pi_v<Real> / damped;
    const Real angle = std::atan2(2 * ratio * std::sqrt(1 - ratio * ratio), 1 - 2 * ratio * ratio);
    return (std::numbers::pi_v<Real> - angle) / damped;
  }
  Real restitution() const { return std::exp(-ratio * frequency * duration()); }
};

}  // namespace scree
