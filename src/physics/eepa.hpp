// Edinburgh elasto-plastic adhesion law (EEPA): a normal law with a history of its own, in which the pull-off
// force grows with the largest load. J. P. Morrissey, thesis, University of Edinburgh (2013); Thakur,
// Morrissey, Sun, Chen, Ooi, Granul. Matter 16 (2014). With n = 1 (linear) or 3/2 (Hertz):
//   loading     F = f0 + k1 d^n             where k2 (d^n - d_p^n) >= k1 d^n; then d_p = l^(1/n) d
//   unloading   F = f0 + k2 (d^n - d_p^n)   between the two others, in both directions
//   adhesive    F = f0 - k_a d^chi          where k2 (d^n - d_p^n) <= -k_a d^chi
// l = 1 - k1/k2: plasticity ratio; d_p: plastic overlap; f0 = -`attraction` <= 0, a constant force. k_a
// follows from d_p while the contact is loaded, and is fixed otherwise:
//   f_min = min(3/2 pi g a, k2 d_p^n / 2),  a = sqrt(2 R* d_p - d_p^2) (as in EDEM)
//   d_m = (d_p^n - f_min/k2)^(1/n),  k_a = f_min / d_m^chi
// On the adhesive branch d_p decreases, d_p^n = d^n + k_a/k2 d^chi, so that reloading follows k2 from there.
#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "base/hd.hpp"
#include "physics/cohesion.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

// Parameters of plastic pairs of materials, with `adhesion_work` as their g and `attraction` as their -f0.
struct Plasticity final : OwnParameters {
  Real ratio = 0;              // l = 1 - k1/k2 [-]
  Real adhesion_exponent = 0;  // chi [-]; 0: n

  Plasticity() = default;
  Plasticity(Real l, Real chi) : ratio(l), adhesion_exponent(chi) {}

  const char* key() const override { return "plasticity_ratio"; }
  std::vector<Real> numbers() const override { return {ratio, adhesion_exponent}; }
  std::string title() const override { return "EEPA"; }
  std::vector<std::pair<std::string, Real>> facts() const override {
    return {{"plasticity ratio", ratio}, {"adhesion exponent", adhesion_exponent}};
  }
  std::string explicit_only() const override {
    return "the force of a plastic contact depends on its path within a step, which implicit steps do not "
           "resolve";
  }
  // Plastic pairs count as cohesive without adhesion, too: they are laws of the same kind.
  bool attracts() const override { return true; }
  bool is_linear() const override { return false; }
  Real unloading_stiffness(Real loading) const override { return loading / (1 - ratio); }
};

// d^(twice / 2) by products and a square root, which have the same bits on CPU and GPU.
SCREE_HD Real half_power(Real d, int twice) {
  Real out = twice % 2 == 1 ? std::sqrt(d) : 1;
  for (int k = twice / 2; k > 0; --k) out *= d;
  return out;
}

// The exponent n of the loading curve k1 d^n of a repulsive law, with power(d) = d^n and its inverse.
template <class Repulsion>
struct LoadingCurve;
template <>
struct LoadingCurve<LinearLawOf<Real>> {
  static constexpr Real kExponent = 1;
  SCREE_HD static Real stiffness(const LinearLawOf<Real>& law) { return law.normal_stiffness; }
  SCREE_HD static Real power(Real d) { return d; }
  SCREE_HD static Real overlap(Real power) { return power; }
};
template <>
struct LoadingCurve<HertzPairOf<Real>> {
  static constexpr Real kExponent = 1.5;
  SCREE_HD static Real stiffness(const HertzPairOf<Real>& law) { return law.modulus * std::sqrt(law.radius); }
  SCREE_HD static Real power(Real d) { return d * std::sqrt(d); }
  SCREE_HD static Real overlap(Real power) {
    if (!(power > 0)) return 0;
    const Real third = cube_root(power);
    return third * third;
  }
};

// State of a contact, even under exchange of the partners. d_m is stored in place of d_p: d_p^n = d_m^n +
// k_a/k2 d_m^chi is a sum of powers, while d_m from d_p is the root of an equation once the contact was on
// the adhesive branch.
struct EepaState {
  static constexpr int kNumbers = 2;
  Real pull_overlap = 0;  // d_m, at which the unloading branch meets the adhesive one: the strongest pull [m]
  Real adhesion = 0;      // k_a [N/m^chi]

  template <class Number>
  SCREE_HD static EepaState read(const Number& number) {
    return {number(0), number(1)};
  }
  template <class Store>
  SCREE_HD void write(const Store& store) const {
    store(0, pull_overlap), store(1, adhesion);
  }
  friend bool operator==(const EepaState&, const EepaState&) = default;
};

// The law of two partners in a certain state; that of new contacts is zero. Contacts exist at d > 0 only.
//
// Energy: `energy(d)` is the work that the contact can give back, from d along the unloading and the adhesive
// branch to d = 0. The constant attraction is part of it: contacts open where they close, so that its work is
// given back and its jump at touch dissipates nothing, as for an attraction without range. All that loading
// takes beyond it is `dissipated`. This sum over the loading steps, D, is a function of the state alone,
//   D = k1 d^(n+1) / (n+1) - energy at d,  d = d_p / l^(1/n) on the loading branch,
// and increases with d_p where chi >= n. A state whose d_p has decreased on the adhesive branch has a smaller
// k_a than that of its next loading, so that D increases there, too: no path creates energy.
template <class Repulsion>
struct EepaPair {
  using Curve = LoadingCurve<Repulsion>;
  Repulsion repulsion;       // the law of the first loading, with the damper
  Real stiffness;            // k1 [N/m^n]
  Real unloading_stiffness;  // k2 [N/m^n]
  Real plasticity_ratio;     // l [-]; 0: the pair is elastic
  Real plastic_share;        // l^(1/n): d_p over d on the loading branch [-]
  Real pull_off_per_radius;  // 3/2 pi g [N/m]
  Real attraction;           // -f0 [N]
  int twice_chi;             // 2 chi
  Real radius;               // R* [m]
  bool tension;
  EepaState state{};
  Real plastic_power = 0;  // d_p^n [m^n]
  Real dissipated = 0;     // by the step that led to the state [J]

  // The law after a step along a straight path from the state `old` to the overlap d.
  SCREE_HD EepaPair after(const EepaState& old, Real d) const {
    EepaPair out = *this;
    if (!(plasticity_ratio > 0) || !(d > 0)) return out;
    const Real power = Curve::power(d), before = plastic_power_of(old);
    if (plasticity_ratio * power >= before) {
      out.load_to(d, power);
      const Real sum = out.loading_loss(d, power), sum0 = loading_loss_of(old, before);
      out.dissipated = sum > sum0 ? sum - sum0 : 0;
    } else if (d > old.pull_overlap) {
      out.state = old, out.plastic_power = before;
    } else {
      out.state = {d, old.adhesion}, out.plastic_power = plastic_power_of(out.state);
    }
    return out;
  }

  // Without the constant attraction [N].
  SCREE_HD Real elastic_plastic(Real d) const {
    const Real power = Curve::power(d);
    if (plasticity_ratio * power >= plastic_power) return stiffness * power;
    if (d > state.pull_overlap) return unloading_stiffness * (power - plastic_power);
    return -state.adhesion * half_power(d, twice_chi);
  }
  SCREE_HD Real elastic(Real d) const { return d > 0 ? elastic_plastic(d) - attraction : 0; }
  SCREE_HD Real slope(Real d) const {
    if (!(d > 0)) return 0;
    const Real power = Curve::power(d);
    if (plasticity_ratio * power >= plastic_power) return repulsion.slope(d);
    if (d > state.pull_overlap) return repulsion.slope(d) / (1 - plasticity_ratio);
    return -twice_chi * state.adhesion * half_power(d, twice_chi) / (2 * d);
  }
  SCREE_HD Real energy(Real d) const { return d > 0 ? recoverable(d) - attraction * d : 0; }
  // `energy(d)` less that of a contact with the same d_p and without adhesion [J].
  SCREE_HD Real cohesion(Real d) const {
    if (!(d > 0)) return 0;
    const Real p = Curve::overlap(plastic_power);
    return energy(d) - (d > p ? unloading_work(d, p) : 0);
  }
  SCREE_HD Real damping(Real d) const { return d > 0 ? repulsion.damping(d) : 0; }
  // These two are of implicit steps, which plastic contacts do not have.
  SCREE_HD Real mean_damping(Real d0, Real d1) const { return repulsion.mean_damping(d0, d1); }
  SCREE_HD Real cut(Real d0, Real damper_force) const { return repulsion.cut(d0, damper_force); }
  // Of the first loading: a function of the overlap alone.
  SCREE_HD Real contact_stiffness(Real d) const { return d > 0 ? repulsion.slope(d) : 0; }
  // The limits of friction and rolling are mu (F - f0 + k_a d^chi): zero on the adhesive branch.
  SCREE_HD Real adhesion(Real d) const {
    return d > 0 ? attraction + state.adhesion * half_power(d, twice_chi) : attraction;
  }

 private:
  // d_p^n [m^n].
  SCREE_HD Real plastic_power_of(const EepaState& of) const {
    return Curve::power(of.pull_overlap) +
           of.adhesion / unloading_stiffness * half_power(of.pull_overlap, twice_chi);
  }
  SCREE_HD void load_to(Real d, Real power) {
    const Real p = plastic_share * d;
    plastic_power = plasticity_ratio * power;
    state = {p, 0};
    if (!(pull_off_per_radius > 0)) return;
    const Real square = p * (2 * radius - p), most = unloading_stiffness * plastic_power / 2,
               full = square > 0 ? pull_off_per_radius * std::sqrt(square) : 0,
               pull = full < most ? full : most;
    state.pull_overlap = Curve::overlap(plastic_power - pull / unloading_stiffness);
    state.adhesion = pull / half_power(state.pull_overlap, twice_chi);
  }
  // Work of the unloading branch from d to d0 [J].
  SCREE_HD Real unloading_work(Real d, Real d0) const {
    return unloading_stiffness * ((d * Curve::power(d) - d0 * Curve::power(d0)) / (Curve::kExponent + 1) -
                                  plastic_power * (d - d0));
  }
  SCREE_HD Real recoverable(Real d) const {
    const Real m = state.pull_overlap, low = d < m ? d : m,
               pull = 2 * state.adhesion * low * half_power(low, twice_chi) / (twice_chi + 2);
    return (d > m ? unloading_work(d, m) : 0) - pull;
  }
  // D where the state is that of loading to d.
  SCREE_HD Real loading_loss(Real d, Real power) const {
    return stiffness * d * power / (Curve::kExponent + 1) - recoverable(d);
  }
  // D of a state; power: its d_p^n.
  SCREE_HD Real loading_loss_of(const EepaState& of, Real power) const {
    if (!(power > 0)) return 0;
    EepaPair then = *this;
    then.state = of, then.plastic_power = power;
    const Real loaded = power / plasticity_ratio;
    return then.loading_loss(Curve::overlap(loaded), loaded);
  }
};

// EEPA with the loading curve and the damper of a law: LinearRestitutionLaw or HertzLaw.
template <class NormalLaw>
struct EepaLaw {
  using Scalar = Real;
  using State = EepaState;
  NormalLaw repulsion{};
  Real plasticity_ratio = 0;     // l [-]
  Real plastic_share = 0;        // l^(1/n) [-]
  Real pull_off_per_radius = 0;  // 3/2 pi g [N/m]
  Real attraction = 0;           // -f0 [N]
  int twice_chi = 2;             // 2 chi

  using Pair = EepaPair<std::remove_cvref_t<decltype(NormalLaw{}.of_pair(PairSize{}))>>;

  EepaLaw() = default;
  explicit EepaLaw(const NormalLawParameters& p) : EepaLaw(p, p.own.value<Plasticity>()) {}
  EepaLaw(const NormalLawParameters& p, const Plasticity& own)
      : repulsion(p),
        plasticity_ratio(own.ratio),
        plastic_share(Pair::Curve::overlap(own.ratio)),
        pull_off_per_radius(Real(1.5) * std::numbers::pi_v<Real> * p.adhesion_work),
        attraction(p.attraction),
        twice_chi(static_cast<int>(
            std::lround(2 * (own.adhesion_exponent > 0 ? own.adhesion_exponent : Pair::Curve::kExponent)))) {}
  static bool accepts(const NormalLawParameters& p) {
    return NormalLaw::accepts(p.without_cohesion()) && p.range == 0 && p.own.are_only<Plasticity>() &&
           (p.own || p.adhesion_work == 0);
  }

  SCREE_HD Pair of_pair(const PairSize& size) const {
    const auto first = repulsion.of_pair(size);
    const Real k1 = Pair::Curve::stiffness(first);
    return {first,
            k1,
            k1 / (1 - plasticity_ratio),
            plasticity_ratio,
            plastic_share,
            pull_off_per_radius,
            attraction,
            twice_chi,
            size.effective_radius(),
            first.tension || pull_off_per_radius > 0 || attraction > 0};
  }
  template <class S>
  SCREE_HD EepaLaw as() const {
    return *this;
  }
};

}  // namespace scree
