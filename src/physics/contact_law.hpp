// Contact law at one instant or over a step, composed of a normal, a tangential and a rolling law.
#pragma once

#include <type_traits>

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_motion.hpp"
#include "physics/contact_parts.hpp"
#include "physics/normal_contact.hpp"
#include "physics/spring_slider.hpp"
#include "physics/tangential_losses.hpp"

namespace scree {

// Normal force of one contact, and its derivatives with respect to overlap and overlap rate. F > 0 is
// repulsive.
template <class T>
struct ContactForceOf {
  T force;      // F [N]
  T stiffness;  // of the elastic part [N/m]: dF/dd where the damping does not depend on d
  T damping;    // dF/d(d_dot) [N s/m]
  T loss;       // dissipated power, (F - elastic force) d_dot [W]
};
using ContactForce = ContactForceOf<Real>;

// Normal force of a closed contact. d: overlap > 0 [m]; d_dot: overlap rate [m/s], positive when approaching.
template <class NormalLaw, class T>
SCREE_HD ContactForceOf<T> contact_force(const NormalLaw& law, T d, T d_dot) {
  const T elastic = law.elastic(d), damping = law.damping(d);
  const T force = elastic + damping * d_dot;
  if (force < 0 && !law.tension) return {0, 0, 0, -elastic * d_dot};
  return {force, law.slope(d), damping, damping * d_dot * d_dot};
}

// `loss` of `contact_force()` alone [W]. radius: of the contact at this overlap [m].
template <class NormalLaw, class T>
SCREE_HD T damper_power(const NormalLaw& law, T d, [[maybe_unused]] T radius, T d_dot) {
  if constexpr (requires { law.damping_of(radius); }) {
    const T elastic = law.elastic_of(radius, d), damping_force = law.damping_of(radius) * d_dot;
    return (elastic + damping_force < 0 && !law.tension ? -elastic : damping_force) * d_dot;
  } else {
    return contact_force(law, d, d_dot).loss;
  }
}

// Mean power of a damper over an explicit step, from its power at the overlaps of both ends, each with the
// overlap rate of mid-step [W]. The force D of an instant acts over half a step before it and half a step
// after it: the work is that of (D_{n-1} + D_n) / 2. Summed by parts over the steps of a contact, it is to
// second order the work of (D(d_{n-1}) + 3 D(d_n)) / 4 at the rate of this step, so that nothing of the step
// before is needed. opens: whether the contact will be open at the end of the next step, in which it is not
// found; this step then counts its half as well.
template <class T>
SCREE_HD T mean_damper_power(T at_start, T at_end, bool opens) {
  return T(0.25) * at_start + (opens ? 1 : T(0.75)) * at_end;
}

// Force and torques of one contact on its partners.
template <class T, class Vector>
struct ContactLoadOf {
  Vector force;               // on i; -force acts on j [N]
  T loss;                     // dissipated power [W]
  Vector torque_i, torque_j;  // about the centres of i and j [N m]

  // The load with i and j exchanged.
  SCREE_HD ContactLoadOf exchanged() const { return {opposite(force), loss, torque_j, torque_i}; }
};

// History of a contact from step to step; members that the law does not use stay zero. State: of the normal
// law.
template <class State>
struct ContactHistoryOf {
  Vec3 spring;           // force of the tangential spring [N]; odd under exchange of i and j
  Vec3 moment;           // moment of the rolling and twisting springs [N m]; odd
  bool touched = false;  // the surfaces have touched: JKR contacts stay closed beyond touch
  State normal{};

  // The history with i and j exchanged.
  SCREE_HD ContactHistoryOf mirrored() const { return {opposite(spring), opposite(moment), touched, normal}; }
};
using ContactHistory = ContactHistoryOf<NoState>;

// Elastic energy of the springs in the contact history [J].
struct SpringEnergies {
  Real friction = 0;  // tangential spring
  Real rolling = 0;   // rolling and twisting springs

  SCREE_HD Real sum() const { return friction + rolling; }
  SCREE_HD void add(const SpringEnergies& part, Real share) {
    friction += share * part.friction, rolling += share * part.rolling;
  }
};

// Elastic energy of a contact [J].
struct ContactEnergy {
  Real sum = 0;            // of the normal force and of the springs in the history
  SpringEnergies springs;  // parts of `sum`
  Real cohesion = 0;       // part of `sum`: sum less its value without adhesion; negative
};

// Result of a contact law over the step that ends at the instant of its `PairState`.
template <class History>
struct ContactOutcomeOf {
  ContactLoadOf<Real, Vec3> load;  // at the end of the step; loss: the mean over the step
  History history;
  SpringLosses friction, rolling, twisting;  // over the step [J]

  SCREE_HD TangentialLosses losses() const { return {{friction.sum(), rolling.sum(), twisting.sum()}}; }
};
using ContactOutcome = ContactOutcomeOf<ContactHistory>;

// The same of a law that is a function of the instant.
template <class T, class Vector>
struct InstantOutcomeOf {
  ContactLoadOf<T, Vector> load;
  NoState history{};

  SCREE_HD TangentialLosses losses() const { return {}; }
};

// The law of a contact: `respond(pair, history)`. Without friction, rolling resistance, JKR adhesion,
// liquid bridges and a state of the normal law (`kNeedsMotion` is false) it is a function of the instant, a
// `PairState`. Otherwise it needs the contact history and the motion of the partners over the step that ends
// at the instant (a `MovingPair`), or partners that do not move (an `InstantPair`). It is pure: the new
// history is returned, and only the item that accepts the step stores it.
template <class NormalLaw, class TangentialLaw = Frictionless, class RollingLaw = FreeRolling>
struct ContactLaw {
  using Normal = NormalLaw;
  using Tangential = TangentialLaw;
  using Rolling = RollingLaw;
  NormalLaw normal;
  TangentialLaw tangential{};
  RollingLaw rolling{};

  static constexpr bool kHysteretic = kIsHysteretic<NormalLaw>;
  static constexpr bool kHasRange = kActsBeyondTouch<NormalLaw>;  // contacts may exist beyond touch
  static constexpr bool kStateful = kHasState<NormalLaw>;
  static constexpr bool kNeedsMotion = TangentialLaw::acts || RollingLaw::acts || kHysteretic || kStateful;
  using State = typename NormalStateOf<NormalLaw>::State;
  using History = ContactHistoryOf<State>;
  using Outcome = ContactOutcomeOf<History>;
  // Numbers in the contact history: spring, moment, whether the surfaces have touched, state of the normal
  // law, in this order.
  static constexpr int kHistory =
      TangentialLaw::kHistory + RollingLaw::kHistory + (kHysteretic ? 1 : 0) + State::kNumbers;

  // Response of a closed contact at an instant; both partners get the same but for the sign of odd
  // quantities.
  template <class T, class Vector>
  SCREE_HD InstantOutcomeOf<T, Vector> respond(const PairStateOf<T, Vector>& pair, const History&) const {
    static_assert(!kNeedsMotion);
    const auto law = normal.template as<T>().of_pair(pair.size);
    const ContactForceOf<T> f = contact_force(law, pair.geometry.overlap, pair.geometry.rate(pair.velocity));
    return {{pair.geometry.along(f.force), f.loss, {}, {}}};
  }

  // Whether the contact is closed; the partners may be apart.
  SCREE_HD bool closed(const PairState& pair, const History& old) const {
    return closed(normal.of_pair(pair.size), pair.geometry.overlap, old);
  }

  // Whether a step that opens the contact breaks a JKR contact, whose springs hold energy.
  SCREE_HD static bool breaks(const History& old) { return kHysteretic && old.touched; }

  // The same over a step. All zero without a contact, but for the losses of a contact that `breaks()`. Pair:
  // `MovingPair`, or `InstantPair`.
  template <class Pair = MovingPair>
  SCREE_HD Outcome respond(const Pair& pair, const History& old) const {
    Outcome out{};
    const auto partners = normal.of_pair(pair.size);
    const ContactGeometry& g = pair.geometry;
    const ContactMotion& step = pair.motion;
    if (!closed(partners, g.overlap, old)) {
      if constexpr (std::is_same_v<Pair, MovingPair>)
        if (breaks(old))
          release_springs(springs_at(step.overlap0, step.normal0, pair.size, old), step.h, out);
      return out;
    }
    const auto& law = after_step(partners, old.normal, g.overlap);
    const Real rate = g.rate(pair.velocity);
    const ContactForce f = contact_force(law, g.overlap, rate);
    Real loss = f.loss;  // before all that follows, where it costs a GPU the fewest registers
    if constexpr (std::is_same_v<Pair, MovingPair>)
      loss = mean_damper_power(power_at_start(partners, pair, rate, old), f.loss,
                               g.overlap + step.h * rate <= -interaction_range_of(law));
    const bool fresh = step.overlap0 < 0 && g.overlap > 0 && !old.touched;
    const ContactMotion motion = fresh ? step.over(g.overlap / (g.overlap - step.overlap0)) : step;
    const NormalContact contact = normal_contact(law, pair.size, f.force, g.overlap, motion.overlap0);
    out.load = {g.along(f.force), loss, {}, {}};
    if constexpr (kHysteretic)
      if (!old.touched) out.load.loss += law.formation_loss() / step.h;
    if constexpr (kStateful) out.load.loss += law.dissipated / step.h, out.history.normal = law.state;
    out.history.touched = old.touched || g.overlap > 0;
    SpringSlider slider{};
    if constexpr (TangentialLaw::acts) {
      slider = tangential.slider(pair.size, motion, contact);
      SpringStep step = spring_step(slider, rotated_tangential(motion, old.spring), motion.slip, motion.h);
      if constexpr (std::is_same_v<Pair, InstantPair>)
        step.acting = acting_at(slider, step.spring, pair.slip_rate);
      add_friction(step, motion, out);
    }
    if constexpr (RollingLaw::acts) {
      const RollingContact rolls{pair.size, motion, contact, slider};
      RollingStep step = rolling.step(rolls, rotated_with(motion, old.moment));
      if constexpr (std::is_same_v<Pair, InstantPair>)
        step.acting = rolling.at(rolls, step.spring, pair.relative_spin);
      add_rolling(step, motion.h, out);
    }
    return out;
  }

  // Elastic energy of a closed contact [J], including what the formation of a JKR contact will dissipate in
  // the next step, and what a contact of a law with a state will that exists without history at the start of
  // a run.
  SCREE_HD ContactEnergy energy_of(const PairState& pair, const History& history) const {
    const auto partners = normal.of_pair(pair.size);
    const auto& law = after_step(partners, history.normal, pair.geometry.overlap);
    Real out = law.energy(pair.geometry.overlap), cohesion = cohesion_of(law, pair.geometry.overlap);
    if constexpr (kHysteretic)
      if (!history.touched) out += law.formation_loss(), cohesion += law.formation_loss();
    if constexpr (kStateful) out += law.dissipated;
    const SpringEnergies springs = springs_of(pair, history);
    return {out + springs.sum(), springs, cohesion};
  }
  SCREE_HD SpringEnergies springs_of(const PairState& pair, const History& history) const {
    return springs_at(pair.geometry.overlap, pair.geometry.normal(), pair.size, history);
  }
  // Elongation of the tangential spring [m].
  SCREE_HD Real slip_of(const PairState& pair, const History& history) const {
    static_assert(TangentialLaw::acts);
    const Real d = pair.geometry.overlap,
               stiffness = tangential.stiffness_at(
                   normal_contact(normal.of_pair(pair.size), pair.size, 0, d, d).radius);
    return stiffness > 0 ? norm(history.spring) / stiffness : 0;
  }
  SCREE_HD SpringEnergies springs_at(Real d, Vec3 normal_to_i, const PairSize& size,
                                     const History& history) const {
    const NormalContact contact = normal_contact(normal.of_pair(size), size, 0, d, d);
    SpringEnergies out;
    Real stiffness = 0;
    if constexpr (TangentialLaw::acts) {
      stiffness = tangential.stiffness_at(contact.radius);
      out.friction = spring_energy(history.spring, stiffness);
    }
    if constexpr (RollingLaw::acts)
      out.rolling = rolling.energy(size, contact, stiffness, normal_to_i, history.moment);
    return out;
  }

  // Whether the mirrored history of one partner equals the other's, including the signs of zeros. A Coulomb
  // limit of zero leaves zeros in the spring that keep the signs of its former components; out-of-plane
  // components in 2D are zero without a sign on both sides.
  SCREE_HD static bool is_mirrored(const History& history) {
    const auto some = [](Vec3 a) { return a.x != 0 || a.y != 0 || a.z != 0; };
    return (!TangentialLaw::acts || some(history.spring)) && (!RollingLaw::acts || some(history.moment));
  }

  // The kHistory numbers of a contact: `number(k)` reads the k-th, `store(k, value)` writes it.
  template <class Number>
  SCREE_HD static History read_history(const Number& number) {
    History out;
    if constexpr (TangentialLaw::kHistory > 0) out.spring = {number(0), number(1), number(2)};
    constexpr int first = TangentialLaw::kHistory;
    if constexpr (RollingLaw::kHistory > 0)
      out.moment = {number(first), number(first + 1), number(first + 2)};
    if constexpr (kHysteretic) out.touched = number(kTouched) != 0;
    out.normal = State::read([&](int k) { return number(kHistory - State::kNumbers + k); });
    return out;
  }
  template <class Store>
  SCREE_HD static void write_history(const History& history, const Store& store) {
    const auto put = [&](int first, Vec3 a) {
      store(first, a.x), store(first + 1, a.y), store(first + 2, a.z);
    };
    if constexpr (TangentialLaw::kHistory > 0) put(0, history.spring);
    if constexpr (RollingLaw::kHistory > 0) put(TangentialLaw::kHistory, history.moment);
    if constexpr (kHysteretic) store(kTouched, history.touched ? 1 : 0);
    history.normal.write([&](int k, Real value) { store(kHistory - State::kNumbers + k, value); });
  }

 private:
  static constexpr int kTouched = TangentialLaw::kHistory + RollingLaw::kHistory;

  // of: the normal law of these partners.
  template <class Pair>
  SCREE_HD static bool closed(const Pair& of, Real overlap, const History& old) {
    return overlap > 0 || ((!kHysteretic || old.touched) && overlap > -interaction_range_of(of));
  }
  // Power of the damper at the overlap and in the state at the start of the step [W]; of: the normal law of
  // these partners in the state of new contacts.
  template <class Of>
  SCREE_HD static Real power_at_start(const Of& of, const MovingPair& pair, Real rate, const History& old) {
    const Real d = pair.motion.overlap0;
    if (!closed(of, d, old)) return 0;
    const auto& law = after_step(of, old.normal, d);
    return damper_power(law, d, contact_radius(law, effective_radius(law, pair.size), d), rate);
  }
  SCREE_HD static void add_friction(const SpringStep& step, const ContactMotion& motion, Outcome& out) {
    out.load.force = fused(-motion.lever_arm_ratio, step.acting, out.load.force);
    const Vec3 moment = fused_cross(motion.normal1, step.acting);
    out.load.torque_i = motion.arm_i * moment, out.load.torque_j = motion.arm_j * moment;
    if (const Real loss = step.losses.sum(); loss != 0) out.load.loss += loss * reciprocal(motion.h);
    out.history.spring = step.spring, out.friction = step.losses;
  }
  SCREE_HD static void release_springs(const SpringEnergies& springs, Real h, Outcome& out) {
    out.friction.unloading = springs.friction, out.rolling.unloading = springs.rolling;
    out.load.loss = springs.sum() * reciprocal(h);
  }
  SCREE_HD static void add_rolling(const RollingStep& step, Real h, Outcome& out) {
    out.load.torque_i -= step.acting, out.load.torque_j += step.acting;
    SpringLosses both = step.losses;
    both += step.twisting;
    out.load.loss += both.sum() * reciprocal(h);
    out.history.moment = step.spring, out.rolling = step.losses, out.twisting = step.twisting;
  }
};

// Whether a law with `kNeedsMotion` has implicit steps: all laws with friction but those of JKR contacts and
// liquid bridges, which form and break at different distances, and those whose normal force depends on the
// path.
template <class Law>
inline constexpr bool kHasFrictionSteps = false;
template <class Law>
requires Law::kNeedsMotion inline constexpr bool kHasFrictionSteps<Law> =
    Law::Tangential::acts && !Law::kHysteretic && !Law::kStateful;

// How many kinds of losses (`LossKind`) the contacts of a law distinguish.
template <class Law>
inline constexpr int kLossKindsOf = 0;
template <class Law>
requires Law::kNeedsMotion inline constexpr int kLossKindsOf<Law> = Law::Rolling::acts ? kLossKinds : 1;

}  // namespace scree
