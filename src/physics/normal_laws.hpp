// Normal laws: the force along the normal, a spring beside a damper, F = elastic(d) + damping(d) d_dot. Each
// is a small type with its own parameters.
#pragma once

#include <cmath>
#include <tuple>

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// What a deck says of a pair of materials: F = K d^n + C d_dot, Kelvin-Voigt with exponent; Jung, Jun, Sohn
// (2013), Eqs. 18-24.
struct KelvinVoigt {
  Real normal_stiffness = 0;  // K [N/m^n]
  Real normal_damping = 0;    // C [N s/m]
  Real exponent = 1;          // n [-]
  bool tension = false;  // true: Eq. 18 as printed, F may pull before separation; false: F is cut at zero

  // Whether the two feel each other.
  bool acts() const { return normal_stiffness > 0; }
  // For estimates: K, C and n of partners of these sizes that overlap by some 1 % of a radius.
  static constexpr bool depends_on_size() { return false; }
  KelvinVoigt of_size(const PairSize&) const { return *this; }
};

// Every law below has
//   Law(const KelvinVoigt&)   its parameters, from a deck's; accepts() says of which
//   tension                   as in KelvinVoigt
//   as<T>()                   the same with numbers of type T
//   of_pair(size)             the law for partners of these sizes, with the functions of the overlap d > 0
//   elastic(d), slope(d)      elastic force [N] and its derivative [N/m]
//   energy(d)                 elastic energy [J]
//   damping(d)                of the damper [N s/m]
//   mean_damping(d0, d1)      its mean over the overlaps between these two, which may be 0
//   cut(d0, pull)             where the force of a contact that parts evenly from d0 on is cut [m]: the
//                             elastic force is down to the damper's, which is `pull` [N] at d0

// F = K d + C d_dot.
template <class T>
struct LinearLawOf {
  using Scalar = T;
  T normal_stiffness = 0;  // K [N/m]
  T normal_damping = 0;    // C [N s/m]
  bool tension = false;

  LinearLawOf() = default;
  SCREE_HD LinearLawOf(T stiffness, T damping, bool pulls)
      : normal_stiffness(stiffness), normal_damping(damping), tension(pulls) {}
  explicit LinearLawOf(const KelvinVoigt& p)
      : LinearLawOf(T(p.normal_stiffness), T(p.normal_damping), p.tension) {}
  static bool accepts(const KelvinVoigt& p) { return p.exponent == 1; }

  SCREE_HD LinearLawOf of_pair(const PairSizeOf<T>&) const { return *this; }
  template <class S>
  SCREE_HD LinearLawOf<S> as() const {
    return {static_cast<S>(normal_stiffness), static_cast<S>(normal_damping), tension};
  }
  SCREE_HD T elastic(T d) const { return normal_stiffness * d; }
  SCREE_HD T slope(T) const { return normal_stiffness; }
  SCREE_HD T energy(T d) const { return T(0.5) * normal_stiffness * d * d; }
  SCREE_HD T damping(T) const { return normal_damping; }
  SCREE_HD T mean_damping(T, T) const { return normal_damping; }
  SCREE_HD T cut(T, T pull) const { return pull / normal_stiffness; }
};
using LinearLaw = LinearLawOf<Real>;

// F = K d^n + C d_dot. A type of its own keeps pow() out of the linear law's kernels.
template <class T>
struct PowerLawOf {
  using Scalar = T;
  T normal_stiffness = 0;  // K [N/m^n]
  T normal_damping = 0;    // C [N s/m]
  T exponent = 1;          // n [-]
  bool tension = false;

  PowerLawOf() = default;
  SCREE_HD PowerLawOf(T stiffness, T damping, T n, bool pulls)
      : normal_stiffness(stiffness), normal_damping(damping), exponent(n), tension(pulls) {}
  explicit PowerLawOf(const KelvinVoigt& p)
      : PowerLawOf(T(p.normal_stiffness), T(p.normal_damping), T(p.exponent), p.tension) {}
  static bool accepts(const KelvinVoigt&) { return true; }

  SCREE_HD PowerLawOf of_pair(const PairSizeOf<T>&) const { return *this; }
  template <class S>
  SCREE_HD PowerLawOf<S> as() const {
    return {static_cast<S>(normal_stiffness), static_cast<S>(normal_damping), static_cast<S>(exponent),
            tension};
  }
  SCREE_HD T elastic(T d) const { return normal_stiffness * std::pow(d, exponent); }
  SCREE_HD T slope(T d) const { return normal_stiffness * exponent * std::pow(d, exponent - 1); }
  SCREE_HD T energy(T d) const { return normal_stiffness / (exponent + 1) * std::pow(d, exponent + 1); }
  SCREE_HD T damping(T) const { return normal_damping; }
  SCREE_HD T mean_damping(T, T) const { return normal_damping; }
  SCREE_HD T cut(T, T pull) const { return std::pow(pull / normal_stiffness, 1 / exponent); }
};
using PowerLaw = PowerLawOf<Real>;

// A run takes the first that accepts the parameters of all its pairs; each has its own kernels
// (cuda/contact_kernels_*.cu).
using NormalLaws = std::tuple<LinearLaw, PowerLaw>;

}  // namespace scree
