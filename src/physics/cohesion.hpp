// Normal laws of surfaces that attract each other: the neck of Johnson, Kendall and Roberts, and a pull added
// to another law, constant or after Derjaguin, Muller and Toporov. The force may pull: nothing is cut, but
// where a pair does not attract, which then follows the law without. w is the work of adhesion [J/m^2]: twice
// the surface energy where both surfaces are alike.
#pragma once

#include <cmath>
#include <numbers>
#include <tuple>
#include <type_traits>

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

// Cube root of x > 0 by Newton's method, which falls after its first step: + x / and square roots alone, for
// the same bits on CPU and GPU.
SCREE_HD Real cube_root(Real x) {
  const Real fourth = std::sqrt(std::sqrt(x));
  Real y = fourth * std::sqrt(std::sqrt(fourth));  // x^(5/16)
  y = (2 * y + x / (y * y)) / 3;
  for (Real next = y;; y = next) {
    next = (2 * y + x / (y * y)) / 3;
    if (!(next < y)) return y;
  }
}

// Johnson, Kendall, Roberts, Proc. R. Soc. A 324 (1971), of two partners:
//   F = 4 E* a^3 / (3 R*) - sqrt(8 pi w E* a^3),  d = a^2 / R* - sqrt(2 pi w a / E*)
// with a the radius of the circle of contact. A contact is made at d = 0 and, once made, holds down to d =
// -reach(), where a_s = (pi w R*^2 / (8 E*))^(1/3). With p = sqrt(a / a_s) >= 1
//   F = F_c p^3 (p^3 - 6) / 9,  d = reach (p^4 - 4 p) / 3,  F_c = 3/2 pi w R* the largest pull
// Damping as Hertz's law has it for a restitution that depends on no speed, with a in place of sqrt(R* d):
// from the stiffness F/d it would be no number where F or d change their signs.
struct JkrPair {
  HertzPairOf<Real> bare;  // the law without adhesion
  Real pull_off;           // F_c [N]
  Real last_radius;        // a_s [m]
  Real range;              // reach() [m]; 0: the pair does not attract
  bool tension;

  static constexpr bool kNeck = true;

  SCREE_HD bool attracts() const { return range > 0; }
  SCREE_HD Real reach() const { return range; }
  // p of an overlap above -reach(): Newton's method from above, on a convex function.
  SCREE_HD Real root_of(Real d) const {
    const Real scaled = 3 * d / range;
    Real p = Real(1.6) + (scaled > 0 ? std::sqrt(std::sqrt(scaled)) : 0);  // 1.6 > 4^(1/3), the root at d = 0
    for (;;) {
      const Real cube = p * p * p, next = (3 * cube * p + scaled) / (4 * (cube - 1));
      if (!(next < p)) return p;
      p = next;
    }
  }
  SCREE_HD Real contact_radius(Real d) const {
    if (!attracts()) return bare.contact_radius(d);
    const Real p = root_of(d);
    return last_radius * p * p;
  }
  SCREE_HD Real elastic(Real d) const {
    if (!attracts()) return bare.elastic(d);
    const Real p = root_of(d), cube = p * p * p;
    return pull_off / 9 * cube * (cube - 6);
  }
  SCREE_HD Real slope(Real d) const {  // infinite at -reach()
    if (!attracts()) return bare.slope(d);
    const Real p = root_of(d), cube = p * p * p;
    return pull_off * p * p * (cube - 3) / (2 * range * (cube - 1));
  }
  // Relative to a contact that breaks, at d = -reach(). At first touch it is -making_loss(): that much goes
  // into waves where a neck snaps in and out, and is counted where it is made.
  SCREE_HD Real energy(Real d) const {
    if (!attracts()) return bare.energy(d);
    const Real p = root_of(d), cube = p * p * p;
    return 4 * pull_off * range / 27 * (p * cube * (cube * cube / 10 - cube + Real(1.5)) - Real(0.6));
  }
  // What the attraction adds: energy(d) less that of the law without, at the same overlap [J].
  SCREE_HD Real cohesion(Real d) const {
    if (!attracts()) return 0;
    return energy(d) - (d > 0 ? bare.energy(d) : 0);
  }
  // 7.0922 (w^5 R*^4 / E*^2)^(1/3) [J]: impacts below the speed sqrt(2 / m* of it) stick.
  SCREE_HD Real making_loss() const {
    constexpr Real kTouch = -6.314643787085519;  // the bracket above at d = 0: -0.9 x 4^(4/3) - 0.6
    return -4 * pull_off * range / 27 * kTouch;
  }
  SCREE_HD Real damping(Real d) const {
    return bare.damping_factor * std::sqrt(bare.mass * bare.modulus * contact_radius(d));
  }
  // With adhesion by the midpoint.
  SCREE_HD Real mean_damping(Real d0, Real d1) const {
    return attracts() ? damping((d0 + d1) / 2) : bare.mean_damping(d0, d1);
  }
  SCREE_HD Real cut(Real d0, Real pull) const { return bare.cut(d0, pull); }  // where nothing attracts
  SCREE_HD Real contact_stiffness(Real d) const { return Real(1.5) * bare.modulus * contact_radius(d); }
  // The friction's limit is mu (F_n + 2 F_c): Thornton, J. Phys. D 24 (1991).
  SCREE_HD Real adhesion(Real) const { return 2 * pull_off; }
};

struct JkrLaw {
  using Scalar = Real;
  Real modulus = 0;         // 4/3 E* [Pa]
  Real damping_factor = 0;  // sqrt(5) zeta [-]
  Real adhesion_work = 0;   // w [J/m^2]
  bool tension = true;      // of a pair that does not attract

  static constexpr bool kNeck = true;

  JkrLaw() = default;
  SCREE_HD JkrLaw(Real m, Real factor, Real work, bool pulls = true)
      : modulus(m), damping_factor(factor), adhesion_work(work), tension(pulls) {}
  explicit JkrLaw(const KelvinVoigt& p)
      : JkrLaw(4 * p.effective_modulus / 3, std::sqrt(Real(5)) * p.damping_ratio, p.adhesion_work,
               p.tension) {}
  static bool accepts(const KelvinVoigt& p) {
    return (p.effective_modulus > 0 || !p.acts()) && p.attraction == 0 && (p.adhesion_work == 0 || p.neck);
  }

  SCREE_HD JkrPair of_pair(const PairSize& size) const {
    const Real radius = size.effective_radius(), pi = std::numbers::pi_v<Real>;
    const HertzPairOf<Real> bare{modulus, damping_factor, tension, radius, size.effective_mass()};
    if (!(adhesion_work > 0)) return {bare, 0, 0, 0, tension};
    // 8 E* = 6 x 4/3 E*
    const Real last = cube_root(pi * adhesion_work * radius * radius / (6 * modulus));
    return {bare, Real(1.5) * pi * adhesion_work * radius, last, 3 * last * last / radius, true};
  }
  template <class S>
  SCREE_HD JkrLaw as() const {
    return *this;
  }
};

// Another law with a pull on top, for pairs of its partners: the pull acts where the overlap is above 0, and
// falls evenly to zero over `range` beyond touch. Contacts without range end where they began: without
// damping they rebound as without the pull, and implicit steps take them like other laws with tension.
template <class Pair, class T>
struct AttractedPair {
  Pair repulsion;
  T attraction;  // [N]
  T range;       // [m]
  bool tension;

  SCREE_HD T reach() const { return range; }
  SCREE_HD T pull(T d) const {
    if (d > 0) return attraction;
    return d > -range ? attraction * (1 + d / range) : 0;
  }
  SCREE_HD T elastic(T d) const { return (d > 0 ? repulsion.elastic(d) : 0) - pull(d); }
  SCREE_HD T slope(T d) const {
    if (d > 0) return repulsion.slope(d);
    return d > -range ? -attraction / range : 0;
  }
  // Relative to partners out of reach [J].
  SCREE_HD T energy(T d) const {
    if (d > 0) return repulsion.energy(d) - attraction * (range / 2 + d);
    return d > -range ? -pull(d) * (range + d) / 2 : 0;
  }
  // What the pull adds to it [J].
  SCREE_HD T cohesion(T d) const { return d > 0 ? -attraction * (range / 2 + d) : energy(d); }
  SCREE_HD T damping(T d) const { return d > 0 ? repulsion.damping(d) : 0; }
  SCREE_HD T mean_damping(T d0, T d1) const { return repulsion.mean_damping(d0, d1); }
  SCREE_HD T cut(T d0, T pull) const { return repulsion.cut(d0, pull); }
  SCREE_HD T contact_stiffness(T d) const { return d > 0 ? repulsion.slope(d) : 0; }
  SCREE_HD T adhesion(T d) const { return pull(d); }
};

// attraction + adhesion_per_radius x R*. Derjaguin, Muller, Toporov, J. Colloid Interface Sci. 53 (1975):
// Hertz's law with adhesion_per_radius = 2 pi w.
template <class NormalLaw>
struct AttractedLaw {
  using Scalar = typename NormalLaw::Scalar;
  NormalLaw repulsion{};
  Scalar attraction = 0;           // [N]
  Scalar adhesion_per_radius = 0;  // [N/m]
  Scalar range = 0;                // [m]

  AttractedLaw() = default;
  SCREE_HD AttractedLaw(NormalLaw law, Scalar pull, Scalar per_radius, Scalar reach)
      : repulsion(law), attraction(pull), adhesion_per_radius(per_radius), range(reach) {}
  explicit AttractedLaw(const KelvinVoigt& p)
      : AttractedLaw(NormalLaw(p), static_cast<Scalar>(p.attraction),
                     static_cast<Scalar>(2 * std::numbers::pi_v<Real> * p.adhesion_work),
                     static_cast<Scalar>(p.range)) {}
  static bool accepts(const KelvinVoigt& p) {
    return NormalLaw::accepts(p.without_attraction()) && !(p.neck && p.adhesion_work > 0);
  }

  SCREE_HD auto of_pair(const PairSizeOf<Scalar>& size) const {
    const auto pair = repulsion.of_pair(size);
    const Scalar pull = attraction + adhesion_per_radius * size.effective_radius();
    return AttractedPair<std::remove_const_t<decltype(pair)>, Scalar>{pair, pull, range,
                                                                      pair.tension || pull > 0};
  }
  template <class S>
  SCREE_HD auto as() const {
    const auto other = repulsion.template as<S>();
    return AttractedLaw<std::remove_const_t<decltype(other)>>{
        other, static_cast<S>(attraction), static_cast<S>(adhesion_per_radius), static_cast<S>(range)};
  }
};

// How far beyond touch a pair of materials can have a contact [m], of particles of at most this radius.
inline Real longest_reach(const KelvinVoigt& law, Real largest_radius) {
  if (law.range > 0) return law.range;
  if (!law.neck || law.adhesion_work == 0) return 0;
  // It grows with the radius of either: that of a sphere on a plane, and what round-off may add.
  return JkrLaw(law).of_pair({largest_radius, kInfinity, 1, 1}).reach() * (1 + Real(1e-9));
}

// How far partners are looked for: a step that breaks a neck must still see the two, for what it loses.
inline Real searched_reach(const KelvinVoigt& law, Real largest_radius) {
  constexpr Real kPastNeck = 1.25;
  return (law.range > 0 ? 1 : kPastNeck) * longest_reach(law, largest_radius);
}

// A run takes the first that accepts the parameters of all its pairs; each has its own kernels
// (cuda/contact_kernels_*.cu).
using NormalLaws = std::tuple<LinearLaw, RatedLinearLaw, PowerLaw, HertzLaw, AttractedLaw<RatedLinearLaw>,
                              AttractedLaw<HertzLaw>, JkrLaw>;

}  // namespace scree
