// Normal laws with adhesion: the theory of Johnson, Kendall and Roberts (JKR), and a cohesive force added to
// another law, constant or after Derjaguin, Muller and Toporov (DMT); liquid bridges: liquid_bridge.hpp. The
// force is not cut at zero, but for pairs without adhesion, which follow the law without it. w is the work of
// adhesion [J/m^2]: twice the surface energy where both surfaces are alike.
#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "base/elementary.hpp"
#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

// JKR contact of two partners; Johnson, Kendall, Roberts, Proc. R. Soc. A 324 (1971):
//   F = 4 E* a^3 / (3 R*) - sqrt(8 pi w E* a^3),  d = a^2 / R* - sqrt(2 pi w a / E*)
// with the contact radius a. The contact forms at d = 0 and breaks under tension at d = -`range`, where
// a = a_s = (pi w R*^2 / (8 E*))^(1/3). With p = sqrt(a / a_s) >= 1 and l = `range`
//   F = F_c p^3 (p^3 - 6) / 9,  d = l (p^4 - 4 p) / 3,  F_c = 3/2 pi w R* the pull-off force
// The damping is that of Hertz's law, whose restitution does not depend on the speed, with a in place of
// sqrt(R* d). Damping from the stiffness F/d would be undefined where F or d change their signs.
struct JkrPair {
  HertzPairOf<Real> bare;  // Hertz's law without adhesion
  Real pull_off;           // F_c, the pull-off force [N]
  Real pull_off_radius;    // a_s, contact radius at pull-off [m]
  Real range;              // overlap at pull-off, negated [m]; 0: the pair has no adhesion
  bool tension;

  static constexpr bool kHysteretic = true;

  SCREE_HD bool is_cohesive() const { return range > 0; }
  SCREE_HD Real interaction_range() const { return range; }
  // p of an overlap d > -`range`, by Newton's method on a convex function, started above the root.
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
    if (!is_cohesive()) return bare.contact_radius(d);
    const Real p = root_of(d);
    return pull_off_radius * p * p;
  }
  SCREE_HD Real elastic(Real d) const {
    if (!is_cohesive()) return bare.elastic(d);
    const Real p = root_of(d), cube = p * p * p;
    return pull_off / 9 * cube * (cube - 6);
  }
  SCREE_HD Real slope(Real d) const {  // infinite at d = -`range`
    if (!is_cohesive()) return bare.slope(d);
    const Real p = root_of(d), cube = p * p * p;
    return pull_off * p * p * (cube - 3) / (2 * range * (cube - 1));
  }
  // Elastic energy relative to the separated partners, at d = -`range` [J]. At first touch it is
  // -`formation_loss()`: that energy is dissipated in elastic waves when the contact forms, and is counted
  // there.
  SCREE_HD Real energy(Real d) const {
    if (!is_cohesive()) return bare.energy(d);
    const Real p = root_of(d), cube = p * p * p;
    return 4 * pull_off * range / 27 * (p * cube * (cube * cube / 10 - cube + Real(1.5)) - Real(0.6));
  }
  // Adhesive part of the energy: `energy(d)` less the elastic energy without adhesion at the same overlap
  // [J].
  SCREE_HD Real cohesion(Real d) const {
    if (!is_cohesive()) return 0;
    return energy(d) - (d > 0 ? bare.energy(d) : 0);
  }
  // Energy that the formation of a contact dissipates, 7.0922 (w^5 R*^4 / E*^2)^(1/3) [J]. Impacts below the
  // speed sqrt(2 / m* of it) stick.
  SCREE_HD Real formation_loss() const {
    constexpr Real kTouch = -6.314643787085519;  // bracket of `energy()` at d = 0: -0.9 x 4^(4/3) - 0.6
    return -4 * pull_off * range / 27 * kTouch;
  }
  SCREE_HD Real damping(Real d) const {
    return bare.damping_factor * std::sqrt(bare.mass * bare.modulus * contact_radius(d));
  }
  // With adhesion the mean is taken at the midpoint.
  SCREE_HD Real mean_damping(Real d0, Real d1) const {
    return is_cohesive() ? damping((d0 + d1) / 2) : bare.mean_damping(d0, d1);
  }
  // For pairs without adhesion.
  SCREE_HD Real cut(Real d0, Real damper_force) const { return bare.cut(d0, damper_force); }
  SCREE_HD Real contact_stiffness(Real d) const { return Real(1.5) * bare.modulus * contact_radius(d); }
  // Twice the pull-off force: the Coulomb limit is mu (F_n + 2 F_c) (Thornton, J. Phys. D 24, 1991).
  SCREE_HD Real adhesion(Real) const { return 2 * pull_off; }
};

struct JkrLaw {
  using Scalar = Real;
  Real modulus = 0;         // 4/3 E* [Pa]
  Real damping_factor = 0;  // sqrt(5) zeta [-]
  Real adhesion_work = 0;   // w [J/m^2]
  bool tension = true;      // for pairs without adhesion, see `NormalLawParameters`

  static constexpr bool kHysteretic = true;

  JkrLaw() = default;
  SCREE_HD JkrLaw(Real m, Real factor, Real work, bool tensile = true)
      : modulus(m), damping_factor(factor), adhesion_work(work), tension(tensile) {}
  explicit JkrLaw(const NormalLawParameters& p)
      : JkrLaw(4 * p.effective_modulus / 3, std::sqrt(Real(5)) * p.damping_ratio, p.adhesion_work,
               p.tension) {}
  static bool accepts(const NormalLawParameters& p) {
    return (p.effective_modulus > 0 || !p.acts()) && p.attraction == 0 && (p.adhesion_work == 0 || p.jkr) &&
           !p.own;
  }

  SCREE_HD JkrPair of_pair(const PairSize& size) const {
    const Real radius = size.effective_radius(), pi = std::numbers::pi_v<Real>;
    const HertzPairOf<Real> bare{modulus, damping_factor, tension, radius, size.effective_mass()};
    if (!(adhesion_work > 0)) return {bare, 0, 0, 0, tension};
    // 8 E* = 6 x 4/3 E*
    const Real pull_off_radius = cube_root(pi * adhesion_work * radius * radius / (6 * modulus));
    return {bare, Real(1.5) * pi * adhesion_work * radius, pull_off_radius,
            3 * pull_off_radius * pull_off_radius / radius, true};
  }
  template <class S>
  SCREE_HD JkrLaw as() const {
    return *this;
  }
};

// A repulsive law with a cohesive force, for one pair of partners: the force is constant at overlaps above 0
// and decreases linearly to zero over `range` beyond touch. Contacts without range open where they closed:
// without damping they rebound as without cohesion, and implicit steps treat them like other laws with
// tension.
template <class Pair, class T>
struct CohesivePair {
  Pair repulsion;
  T attraction;  // [N]
  T range;       // [m]
  bool tension;

  SCREE_HD T interaction_range() const { return range; }
  SCREE_HD T adhesive_force(T d) const {
    if (d > 0) return attraction;
    return d > -range ? attraction * (1 + d / range) : 0;
  }
  SCREE_HD T elastic(T d) const { return (d > 0 ? repulsion.elastic(d) : 0) - adhesive_force(d); }
  SCREE_HD T slope(T d) const {
    if (d > 0) return repulsion.slope(d);
    return d > -range ? -attraction / range : 0;
  }
  // Energy relative to partners beyond the range of the force [J].
  SCREE_HD T energy(T d) const {
    if (d > 0) return repulsion.energy(d) - attraction * (range / 2 + d);
    return d > -range ? -adhesive_force(d) * (range + d) / 2 : 0;
  }
  // Cohesive part of `energy(d)` [J].
  SCREE_HD T cohesion(T d) const { return d > 0 ? -attraction * (range / 2 + d) : energy(d); }
  SCREE_HD T damping(T d) const { return d > 0 ? repulsion.damping(d) : 0; }
  SCREE_HD T mean_damping(T d0, T d1) const { return repulsion.mean_damping(d0, d1); }
  SCREE_HD T cut(T d0, T damper_force) const { return repulsion.cut(d0, damper_force); }
  SCREE_HD T contact_stiffness(T d) const { return d > 0 ? repulsion.slope(d) : 0; }
  SCREE_HD T adhesion(T d) const { return adhesive_force(d); }
};

// The cohesive force is attraction + adhesion_per_radius x R*. With adhesion_per_radius = 2 pi w and Hertz's
// law this is DMT: Derjaguin, Muller, Toporov, J. Colloid Interface Sci. 53 (1975).
template <class NormalLaw>
struct CohesiveLaw {
  using Scalar = typename NormalLaw::Scalar;
  NormalLaw repulsion{};
  Scalar attraction = 0;           // [N]
  Scalar adhesion_per_radius = 0;  // [N/m]
  Scalar range = 0;                // [m]

  CohesiveLaw() = default;
  SCREE_HD CohesiveLaw(NormalLaw law, Scalar force, Scalar per_radius, Scalar max_distance)
      : repulsion(law), attraction(force), adhesion_per_radius(per_radius), range(max_distance) {}
  explicit CohesiveLaw(const NormalLawParameters& p)
      : CohesiveLaw(NormalLaw(p), static_cast<Scalar>(p.attraction),
                    static_cast<Scalar>(2 * std::numbers::pi_v<Real> * p.adhesion_work),
                    static_cast<Scalar>(p.range)) {}
  static bool accepts(const NormalLawParameters& p) {
    return NormalLaw::accepts(p.without_cohesion()) && !(p.jkr && p.adhesion_work > 0) && !p.own;
  }

  SCREE_HD auto of_pair(const PairSizeOf<Scalar>& size) const {
    const auto pair = repulsion.of_pair(size);
    const Scalar force = attraction + adhesion_per_radius * size.effective_radius();
    return CohesivePair<std::remove_const_t<decltype(pair)>, Scalar>{pair, force, range,
                                                                     pair.tension || force > 0};
  }
  template <class S>
  SCREE_HD auto as() const {
    const auto other = repulsion.template as<S>();
    return CohesiveLaw<std::remove_const_t<decltype(other)>>{
        other, static_cast<S>(attraction), static_cast<S>(adhesion_per_radius), static_cast<S>(range)};
  }
};

// Largest interaction range beyond touch of a pair of materials [m], for particles of at most this radius.
inline Real largest_interaction_range(const NormalLawParameters& law, Real largest_radius) {
  if (law.range > 0) return law.range;
  constexpr Real kRoundOff = 1e-9;
  if (law.own) return law.own->interaction_range(largest_radius);
  if (!law.jkr || law.adhesion_work == 0) return 0;
  // The pull-off distance grows with both radii: the bound is that of a sphere on a plane, plus a margin for
  // round-off.
  return JkrLaw(law).of_pair({largest_radius, kInfinity, 1, 1}).interaction_range() * (1 + kRoundOff);
}

// Range of the contact search beyond touch [m]. The step in which a JKR contact breaks must still find the
// pair, to count the dissipated energy; a bridge that breaks has no springs.
inline Real contact_search_range(const NormalLawParameters& law, Real largest_radius) {
  constexpr Real kPastPullOff = 1.25;
  return (law.jkr ? kPastPullOff : 1) * largest_interaction_range(law, largest_radius);
}

}  // namespace scree
