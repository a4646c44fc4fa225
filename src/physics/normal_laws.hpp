// Normal laws: a spring and a damper in parallel, F = elastic(d) + damping(d) d_dot. Each law is a small type
// with its own parameters.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/root.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_parameters.hpp"

namespace scree {

// Every law below has
//   Law(parameters)           its parameters from those of the deck; accepts() says whether it applies
//   tension                   as in NormalLawParameters
//   kUsesMass = false         if no number depends on the partners' masses; default: some may
//   as<T>()                   the law with numbers of type T
//   of_pair(size)             the law for partners of these sizes, with functions of the overlap d > 0:
//   elastic(d), slope(d)      elastic force [N] and its derivative [N/m]
//   energy(d)                 elastic energy [J]
//   damping(d)                damping coefficient [N s/m]
//   mean_damping(d0, d1)      mean of damping(d) between two overlaps, which may be 0
//   cut(d0, damper_force)     overlap at which the force of a contact that separates at constant rate from d0
//                             is cut [m]: the elastic force has decreased to the damper's, which is
//                             `damper_force` [N] at d0

// F = K d + C d_dot.
template <class T>
struct LinearLawOf {
  using Scalar = T;
  static constexpr bool kUsesMass = false;
  T normal_stiffness = 0;  // K [N/m]
  T normal_damping = 0;    // C [N s/m]
  bool tension = false;

  LinearLawOf() = default;
  SCREE_HD LinearLawOf(T stiffness, T damping, bool tensile)
      : normal_stiffness(stiffness), normal_damping(damping), tension(tensile) {}
  explicit LinearLawOf(const NormalLawParameters& p)
      : LinearLawOf(T(p.normal_stiffness), T(p.normal_damping), p.tension) {}
  static bool accepts(const NormalLawParameters& p) {
    return p.exponent == 1 && p.effective_modulus == 0 && p.damping_ratio == 0 && !p.is_cohesive() && !p.own;
  }

  // Member by member: gcc treats a copy of the whole object as one memory access and does not vectorize it.
  SCREE_HD LinearLawOf of_pair(const PairSizeOf<T>&) const {
    return {normal_stiffness, normal_damping, tension};
  }
  template <class S>
  SCREE_HD LinearLawOf<S> as() const {
    return {static_cast<S>(normal_stiffness), static_cast<S>(normal_damping), tension};
  }
  SCREE_HD T elastic(T d) const { return normal_stiffness * d; }
  SCREE_HD T slope(T) const { return normal_stiffness; }
  SCREE_HD T energy(T d) const { return T(0.5) * normal_stiffness * d * d; }
  SCREE_HD T damping(T) const { return normal_damping; }
  SCREE_HD T mean_damping(T, T) const { return normal_damping; }
  SCREE_HD T cut(T, T damper_force) const { return damper_force / normal_stiffness; }
};
using LinearLaw = LinearLawOf<Real>;

// Linear law with a damper in proportion to the square root of the effective mass: F = K d + (C + 2 zeta
// sqrt(m* K)) d_dot.
template <class T>
struct LinearRestitutionLawOf {
  using Scalar = T;
  T normal_stiffness = 0;  // K [N/m]
  T normal_damping = 0;    // C [N s/m]
  T damping_factor = 0;    // 2 zeta sqrt(K) [(N/m)^(1/2)]
  bool tension = false;

  LinearRestitutionLawOf() = default;
  SCREE_HD LinearRestitutionLawOf(T stiffness, T damping, T factor, bool tensile)
      : normal_stiffness(stiffness), normal_damping(damping), damping_factor(factor), tension(tensile) {}
  explicit LinearRestitutionLawOf(const NormalLawParameters& p)
      : LinearRestitutionLawOf(T(p.normal_stiffness), T(p.normal_damping),
                               T(2 * p.damping_ratio * std::sqrt(p.normal_stiffness)), p.tension) {}
  static bool accepts(const NormalLawParameters& p) {
    return p.exponent == 1 && p.effective_modulus == 0 && !p.is_cohesive() && !p.own;
  }

  SCREE_HD LinearLawOf<T> of_pair(const PairSizeOf<T>& size) const {
    return {normal_stiffness, normal_damping + damping_factor * std::sqrt(size.effective_mass()), tension};
  }
  template <class S>
  SCREE_HD LinearRestitutionLawOf<S> as() const {
    return {static_cast<S>(normal_stiffness), static_cast<S>(normal_damping), static_cast<S>(damping_factor),
            tension};
  }
};
using LinearRestitutionLaw = LinearRestitutionLawOf<Real>;

// F = K d^n + C d_dot, or with c d^((n-1)/2) in place of C, c = 2 zeta sqrt(m* K (n+1)/2). A separate type
// keeps pow() out of the linear law's kernels.
template <class T>
struct PowerLawOf {
  using Scalar = T;
  T normal_stiffness = 0;  // K [N/m^n]
  T normal_damping = 0;    // C [N s/m]; 0 where damping_factor is used
  T exponent = 1;          // n [-]
  bool tension = false;
  T damping_factor = 0;  // c [N s/m^((n+1)/2)] for a pair, else c / sqrt(m*)

  PowerLawOf() = default;
  SCREE_HD PowerLawOf(T stiffness, T damping, T n, bool tensile, T factor = 0)
      : normal_stiffness(stiffness),
        normal_damping(damping),
        exponent(n),
        tension(tensile),
        damping_factor(factor) {}
  explicit PowerLawOf(const NormalLawParameters& p)
      : PowerLawOf(T(p.normal_stiffness), T(p.normal_damping), T(p.exponent), p.tension,
                   T(2 * p.damping_ratio * std::sqrt(p.normal_stiffness * (p.exponent + 1) / 2))) {}
  static bool accepts(const NormalLawParameters& p) {
    return p.effective_modulus == 0 && !p.is_cohesive() && !p.own;
  }

  SCREE_HD PowerLawOf of_pair(const PairSizeOf<T>& size) const {
    PowerLawOf pair = *this;
    if (damping_factor > 0) pair.damping_factor *= std::sqrt(size.effective_mass());
    return pair;
  }
  template <class S>
  SCREE_HD PowerLawOf<S> as() const {
    return {static_cast<S>(normal_stiffness), static_cast<S>(normal_damping), static_cast<S>(exponent),
            tension, static_cast<S>(damping_factor)};
  }
  SCREE_HD T elastic(T d) const { return normal_stiffness * std::pow(d, exponent); }
  SCREE_HD T slope(T d) const { return normal_stiffness * exponent * std::pow(d, exponent - 1); }
  SCREE_HD T energy(T d) const { return normal_stiffness / (exponent + 1) * std::pow(d, exponent + 1); }
  SCREE_HD T damping(T d) const {
    return damping_factor > 0 ? damping_factor * std::pow(d, (exponent - 1) / 2) : normal_damping;
  }
  SCREE_HD T mean_damping(T d0, T d1) const {
    if (!(damping_factor > 0)) return normal_damping;
    const T n = (exponent + 1) / 2, span = d1 - d0;
    // Over a span that round-off would spoil, the midpoint.
    if (!(std::abs(span) > T(1e-4) * (d0 + d1))) return damping((d0 + d1) / 2);
    return damping_factor / n * (std::pow(d1, n) - std::pow(d0, n)) / span;
  }
  SCREE_HD T cut(T d0, T damper_force) const {
    if (!(damping_factor > 0)) return std::pow(damper_force / normal_stiffness, 1 / exponent);
    return d0 * std::pow(damper_force / elastic(d0), 2 / (exponent + 1));
  }
};
using PowerLaw = PowerLawOf<Real>;

// Hertz's law for two partners: F = K d^(3/2) + c d^(1/4) d_dot, K = 4/3 E* sqrt(R*), c = 2 zeta sqrt(5/4 m*
// K). With dtau = d^(1/4) dt and y = 4/5 d^(5/4), whose rate is d_dot, this is a linear oscillator of damping
// ratio zeta: the restitution does not depend on the speed. Only roots and quotients are used, which have the
// same bits on a GPU.
template <class T>
struct HertzPairOf {
  T modulus;         // 4/3 E* [Pa]
  T damping_factor;  // sqrt(5) zeta [-]
  bool tension;
  T radius, mass;  // R* [m], m* [kg]

  // Radius of the contact area [m].
  SCREE_HD T contact_radius(T d) const { return root(radius * d); }
  SCREE_HD T elastic(T d) const { return elastic_of(contact_radius(d), d); }
  SCREE_HD T elastic_of(T contact_radius, T d) const { return modulus * contact_radius * d; }
  SCREE_HD T slope(T d) const { return slope_of(contact_radius(d)); }
  SCREE_HD T slope_of(T contact_radius) const { return T(1.5) * modulus * contact_radius; }
  SCREE_HD T energy(T d) const { return T(0.4) * modulus * contact_radius(d) * d * d; }
  SCREE_HD T damping(T d) const { return damping_of(contact_radius(d)); }
  SCREE_HD T damping_of(T contact_radius) const {
    return damping_factor * root(mass * modulus * contact_radius);
  }
  // 4/5 c (q^5 - p^5) / (q^4 - p^4) with p, q = d^(1/4), expanded to avoid the cancellation.
  SCREE_HD T mean_damping(T d0, T d1) const {
    const T p2 = std::sqrt(d0), q2 = std::sqrt(d1), p = std::sqrt(p2), q = std::sqrt(q2);
    const T parts = (p + q) * (p2 + q2);
    if (!(parts > 0)) return 0;
    const T c = damping_factor * std::sqrt(mass * modulus * std::sqrt(radius));
    return T(0.8) * c * (p2 * p2 + p * q * (p2 + p * q + q2) + q2 * q2) / parts;
  }
  // d0 x^4 where x^5 is the damper force over the elastic force at d0, by Newton's method with decreasing
  // iterates.
  SCREE_HD T cut(T d0, T damper_force) const {
    const T share = damper_force / elastic(d0);
    if (!(share > 0)) return 0;
    T x = 1, x4 = 1;
    for (T next = (4 + share) / 5; next < x; next = (4 * x + share / x4) / 5) x = next, x4 = x * x * x * x;
    return d0 * x4;
  }
};

template <class T>
struct HertzLawOf {
  using Scalar = T;
  T modulus = 0;         // 4/3 E* [Pa]
  T damping_factor = 0;  // sqrt(5) zeta [-]
  bool tension = false;

  HertzLawOf() = default;
  SCREE_HD HertzLawOf(T m, T factor, bool tensile) : modulus(m), damping_factor(factor), tension(tensile) {}
  explicit HertzLawOf(const NormalLawParameters& p)
      : HertzLawOf(T(4 * p.effective_modulus / 3), T(std::sqrt(Real(5)) * p.damping_ratio), p.tension) {}
  // Pairs that do not interact are accepted by any law.
  static bool accepts(const NormalLawParameters& p) {
    return (p.effective_modulus > 0 || !p.acts()) && !p.is_cohesive() && !p.own;
  }

  SCREE_HD HertzPairOf<T> of_pair(const PairSizeOf<T>& size) const {
    return {modulus, damping_factor, tension, size.effective_radius(), size.effective_mass()};
  }
  template <class S>
  SCREE_HD HertzLawOf<S> as() const {
    return {static_cast<S>(modulus), static_cast<S>(damping_factor), tension};
  }
};
using HertzLaw = HertzLawOf<Real>;

// Equivalent K, C and n of partners of these sizes at an overlap of 1 % of a radius, with the law's own
// parameters; for estimates.
inline NormalLawParameters law_of_size(const NormalLawParameters& law, const PairSize& size) {
  if (!law.depends_on_size()) {
    NormalLawParameters same = law;
    same.normal_damping += law.own->damping(size);
    return same;
  }
  const Real overlap = Real(0.01) * (size.radius_i < size.radius_j ? size.radius_i : size.radius_j);
  NormalLawParameters out{law.normal_stiffness, 0, law.exponent, law.tension};
  if (law.effective_modulus == 0) {
    out.normal_damping = PowerLaw(law).of_pair(size).damping(overlap);
  } else {
    const auto pair = HertzLaw(law).of_pair(size);
    out.normal_stiffness = pair.modulus * std::sqrt(pair.radius), out.exponent = Real(1.5);
    out.normal_damping = pair.damping(overlap);
  }
  out.normal_damping += law.own->damping(size), out.own = law.own;
  return out;
}

}  // namespace scree
