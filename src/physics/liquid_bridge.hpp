// Liquid bridges of constant volume between grains, and between grains and surfaces, added to a repulsive
// law. A bridge forms when the surfaces touch, acts with its full force while they do, stretches over the gap
// S that opens between them, and breaks at the rupture distance S_c = (1 + theta/2) V^(1/3) (Lian, Thornton,
// Adams, J. Colloid Interface Sci. 161, 1993), V: its volume, theta: contact angle, gamma: surface tension.
#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "base/elementary.hpp"
#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

// Parameters of liquid bridges.
struct LiquidBridge {
  Real volume = 0;           // V / r^3, r: the smaller radius [-]; 0: no liquid
  Real surface_tension = 0;  // gamma [N/m]
  Real contact_angle = 0;    // theta [rad]
  Real viscosity = 0;        // mu [Pa s]
  Real least_gap = 0;        // s_min: gap over R* below which the viscous force does not grow [-]
  bool soulie = false;       // true: force after Soulie et al.; false: after Willett et al.

  bool acts() const { return volume > 0 && surface_tension > 0; }
};

// Those of a pair of materials whose contacts have bridges.
struct BridgeParameters final : OwnParameters {
  LiquidBridge liquid;

  BridgeParameters() = default;
  explicit BridgeParameters(const LiquidBridge& of) : liquid(of) {}

  const char* key() const override { return "bridge_volume"; }
  // None: bridges have a bound of their own on the step, longest_step(), and trials are dry.
  std::vector<Real> numbers() const override { return {}; }
  std::string title() const override {
    return std::string("liquid bridges after ") + (liquid.soulie ? "Soulie" : "Willett");
  }
  std::string explicit_only() const override {
    return "liquid bridges break at a distance beyond touch, which implicit steps do not resolve";
  }
  bool attracts() const override { return true; }
  bool depends_on_size() const override { return liquid.viscosity > 0; }
  inline Real interaction_range(Real largest_radius) const override;
  inline Real damping(const PairSize& size) const override;
  inline Real stiffness(const PairSize& size) const override;
  inline Real sticking_speed(const PairSize& size, Real mass) const override;
  inline Real longest_step(const PairSize& size, Real mass) const override;
  std::string step_reason(const std::string& pair) const override {
    return "0.05 of the time in which liquid bridges of " + pair +
           " stretch, at the speed below which impacts stick, by the length over which their force decreases";
  }
};

// Force of a bridge over its force at touch, as a function of s, the gap over a length L, in one of two
// forms:
//   Willett, Adams, Johnson, Seville, Langmuir 16 (2000):  1 / (1 + 1.05 s + 2.5 s^2)
//   Soulie, Cherblanc, El Youssoufi, Saix, Int. J. Numer. Anal. Meth. Geomech. 30 (2006):  q + (1 - q) e^-s
struct BridgeShape {
  bool decays;    // true: Soulie
  Real constant;  // q [-]

  SCREE_HD Real value(Real s) const {
    if (decays) return constant + (1 - constant) * exponential(-s);
    return 1 / (1 + s * (Real(1.05) + Real(2.5) * s));
  }
  SCREE_HD Real slope(Real s) const {
    if (decays) return (constant - 1) * exponential(-s);
    const Real f = value(s);
    return -(Real(1.05) + 5 * s) * f * f;
  }
  // Integral of value() between two gaps [-]. Willett: with D = sqrt(4 x 2.5 - 1.05^2) it is 2/D (arctan y1 -
  // arctan y0), y = (5 s + 1.05) / D, here as one arc tangent.
  SCREE_HD Real integral(Real s0, Real s1) const {
    if (decays) return constant * (s1 - s0) + (1 - constant) * (exponential(-s0) - exponential(-s1));
    constexpr Real kSquare = 8.8975;  // D^2
    const Real root_of = std::sqrt(kSquare), y0 = Real(1.05) + 5 * s0, y1 = Real(1.05) + 5 * s1;
    return 2 / root_of * arc_tangent(root_of * (y1 - y0) / (kSquare + y0 * y1));
  }
};

// A repulsive law with a liquid bridge, for one pair of partners. Without liquid it is the repulsive law.
template <class Pair>
struct BridgePair {
  Pair repulsion;
  BridgeShape shape;
  Real attraction;              // F0, force of the bridge at touch [N]
  Real length;                  // L [m]
  Real range;                   // S_c [m]; 0: no liquid
  Real lubrication, least_gap;  // 6 pi mu R*^2 [N s] and s_min R* [m]: damping of a gap S is the first over
                                // the larger of S and the second
  Real radius;                  // R* [m]
  bool tension;

  static constexpr bool kHysteretic = true;

  SCREE_HD bool is_cohesive() const { return range > 0; }
  SCREE_HD Real interaction_range() const { return range; }
  // Attractive force of an existing bridge [N].
  SCREE_HD Real adhesive_force(Real d) const {
    return d > 0 || !is_cohesive() ? attraction : attraction * shape.value(-d / length);
  }
  SCREE_HD Real elastic(Real d) const { return (d > 0 ? repulsion.elastic(d) : 0) - adhesive_force(d); }
  SCREE_HD Real slope(Real d) const {
    return d > 0 ? repulsion.slope(d) : attraction / length * shape.slope(-d / length);
  }
  // Energy relative to the separated partners [J]. At first touch it is -`formation_loss()`: the liquid's
  // energy that the formation of the bridge sets free is dissipated, and is counted there.
  SCREE_HD Real energy(Real d) const { return (d > 0 ? repulsion.energy(d) : 0) + cohesion(d); }
  SCREE_HD Real cohesion(Real d) const {
    if (!is_cohesive()) return 0;
    return -attraction * (d > 0 ? length * shape.integral(0, range / length) + d
                                : length * shape.integral(-d / length, range / length));
  }
  // Work to break the bridge slowly from touch [J]. Undamped impacts below the speed sqrt(2 / m* of it)
  // stick.
  SCREE_HD Real formation_loss() const { return -cohesion(0); }
  // Viscous force of the liquid, 6 pi mu R* / max(s_min, S/R*) times the rate (Nase, Vargas, Abatan,
  // McCarthy, Powder Technol. 116, 2001).
  SCREE_HD Real liquid_damping(Real d) const {
    return lubrication > 0 ? lubrication / (-d > least_gap ? -d : least_gap) : 0;
  }
  SCREE_HD Real damping(Real d) const {
    return d > 0 ? repulsion.damping(d) + liquid_damping(d) : liquid_damping(d);
  }
  // Load of the surfaces on each other, which limits friction: the normal force without the liquid's; none in
  // a gap. force: the normal force [N].
  SCREE_HD Real friction_load(Real force, Real d) const {
    if (!(d > 0)) return 0;
    if (!(lubrication > 0)) return force + attraction;
    const Real solid = repulsion.damping(d), share = solid / (solid + liquid_damping(d));
    return repulsion.elastic(d) + share * (force - elastic(d));
  }
  // These two belong to implicit steps, which runs with liquid bridges do not have.
  SCREE_HD Real mean_damping(Real d0, Real d1) const { return repulsion.mean_damping(d0, d1); }
  SCREE_HD Real cut(Real d0, Real damper_force) const { return repulsion.cut(d0, damper_force); }
  SCREE_HD Real contact_radius(Real d) const { return d > 0 ? root(radius * d) : 0; }
  SCREE_HD Real contact_stiffness(Real d) const { return d > 0 ? repulsion.slope(d) : 0; }
};

// Rupture distance over the smaller radius.
SCREE_HD Real rupture_ratio(const LiquidBridge& of) {
  return (1 + of.contact_angle / 2) * cube_root(of.volume);
}

// The volume of each bridge is `volume` r^3, r: the smaller radius.
//   Willett: F0 = 2 pi R gamma cos(theta), L = sqrt(V / R), R = 2 R*; R = 2 r against planes
//   Soulie: F0 = pi gamma sqrt(R1 R2) (c + e^b), L = -R2 / a, q = c / (c + e^b), R2: the larger radius,
//     a = -1.1 v^-0.53, b = (-0.148 ln v - 0.96) theta^2 - 0.0082 ln v + 0.48, c = 0.0018 ln v + 0.078,
//     v = V / R2^3; not defined against planes, where Willett's form is used
template <class NormalLaw>
struct BridgeLaw {
  using Scalar = Real;
  NormalLaw repulsion{};
  LiquidBridge liquid{};
  // Functions of the liquid: gamma cos(theta) [N/m], ln of the volume, S_c / r, 6 pi mu [Pa s].
  Real wetting = 0, volume_logarithm = 0, rupture = 0, lubrication = 0;

  static constexpr bool kHysteretic = true;

  BridgeLaw() = default;
  BridgeLaw(const NormalLaw& law, const LiquidBridge& of) : repulsion(law), liquid(of) {
    if (!of.acts()) return;
    wetting = of.surface_tension * std::cos(of.contact_angle), volume_logarithm = logarithm(of.volume);
    rupture = rupture_ratio(of), lubrication = 6 * std::numbers::pi_v<Real> * of.viscosity;
  }
  explicit BridgeLaw(const NormalLawParameters& p)
      : BridgeLaw(NormalLaw(p), p.own.value<BridgeParameters>().liquid) {}
  static bool accepts(const NormalLawParameters& p) {
    return NormalLaw::accepts(p.without_cohesion()) && p.adhesion_work == 0 && p.attraction == 0 &&
           p.own.are_only<BridgeParameters>();
  }

  SCREE_HD auto of_pair(const PairSize& size) const {
    const auto bare = repulsion.of_pair(size);
    const Real radius = size.effective_radius();
    BridgePair<std::remove_const_t<decltype(bare)>> out{bare, {false, 0}, 0,      1,           0,
                                                        0,    0,          radius, bare.tension};
    if (rupture > 0) add_liquid(size, out);
    return out;
  }
  template <class S>
  SCREE_HD BridgeLaw as() const {
    return *this;
  }
  // The law without liquid, with the damping force as beside bridges.
  BridgeLaw dry() const {
    BridgeLaw law(repulsion, {});
    law.repulsion.tension = repulsion.tension || rupture > 0;
    return law;
  }

 private:
  template <class Pair>
  SCREE_HD void add_liquid(const PairSize& size, Pair& out) const {
    const bool i_is_smaller = size.radius_i < size.radius_j;
    const Real r = i_is_smaller ? size.radius_i : size.radius_j,
               larger = i_is_smaller ? size.radius_j : size.radius_i;
    out.range = rupture * r, out.tension = true;
    out.lubrication = lubrication * out.radius * out.radius, out.least_gap = liquid.least_gap * out.radius;
    constexpr Real kPi = std::numbers::pi_v<Real>;
    if (!liquid.soulie || larger == kInfinity) {
      const Real R = 2 * out.radius;
      out.attraction = 2 * kPi * R * wetting, out.length = root(liquid.volume * r * r * r / R);
      return;
    }
    const Real ln_v = volume_logarithm + 3 * logarithm(r / larger),
               square = liquid.contact_angle * liquid.contact_angle;
    const Real decaying = exponential((Real(-0.148) * ln_v - Real(0.96)) * square - Real(0.0082) * ln_v +
                                      Real(0.48)),
               constant = Real(0.0018) * ln_v + Real(0.078);
    out.shape = {true, constant / (constant + decaying)};
    out.attraction = kPi * liquid.surface_tension * root(r * larger) * (constant + decaying);
    out.length = larger * exponential(Real(0.53) * ln_v) / Real(1.1);
  }
};

// A bridge between partners of these sizes, without a repulsive law.
inline BridgePair<LinearLaw> bridge_alone(const LiquidBridge& of, const PairSize& size) {
  return BridgeLaw<LinearRestitutionLaw>({}, of).of_pair(size);
}

// The rupture distance, with a margin for round-off.
Real BridgeParameters::interaction_range(Real largest_radius) const {
  constexpr Real kRoundOff = 1e-9;
  return rupture_ratio(liquid) * largest_radius * (1 + kRoundOff);
}
// That of the liquid between touching surfaces.
Real BridgeParameters::damping(const PairSize& size) const {
  if (!(liquid.viscosity > 0)) return 0;
  return 6 * std::numbers::pi_v<Real> * liquid.viscosity * size.effective_radius() / liquid.least_gap;
}
// Largest decrease of the force with the gap. In Willett's form the slope is steepest at s = 0.134, and
// -1.224 there.
Real BridgeParameters::stiffness(const PairSize& size) const {
  const auto pair = bridge_alone(liquid, size);
  return pair.attraction / pair.length * (pair.shape.decays ? 1 - pair.shape.constant : Real(1.224));
}
Real BridgeParameters::sticking_speed(const PairSize& size, Real mass) const {
  return std::sqrt(2 * bridge_alone(liquid, size).formation_loss() / mass);
}
// A share of the time in which the force decreases at the speed below which impacts stick.
Real BridgeParameters::longest_step(const PairSize& size, Real mass) const {
  constexpr Real kShare = 0.05;
  return kShare * bridge_alone(liquid, size).length / sticking_speed(size, mass);
}

}  // namespace scree
