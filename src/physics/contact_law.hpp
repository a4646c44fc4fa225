// The law of a contact at one instant, composed of a normal, a tangential and a rolling law.
#pragma once

#include <type_traits>

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_motion.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/rubbing_losses.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

// The force of one contact along its normal, and its derivatives with respect to overlap and overlap rate. F
// > 0 pushes the two apart.
template <class T>
struct ContactForceOf {
  T force;      // F [N]
  T stiffness;  // of the elastic part, [N/m]: dF/dd where the damping does not depend on d
  T damping;    // dF/d(d_dot) [N s/m]
  T loss;       // power taken out of the mechanical energy, (F - elastic force) d_dot [W]
};
using ContactForce = ContactForceOf<Real>;

// Of a closed contact: overlap d > 0 [m], overlap rate d_dot [m/s], positive when approaching.
template <class NormalLaw, class T>
SCREE_HD ContactForceOf<T> contact_force(const NormalLaw& law, T d, T d_dot) {
  const T elastic = law.elastic(d), damping = law.damping(d);
  const T force = elastic + damping * d_dot;
  if (force < 0 && !law.tension) return {0, 0, 0, -elastic * d_dot};
  return {force, law.slope(d), damping, damping * d_dot * d_dot};
}

// What one contact does to its partners.
template <class T, class Vector>
struct ContactLoadOf {
  Vector force;               // on i, and its opposite on j [N]
  T loss;                     // power that the law takes out of the mechanical energy [W]
  Vector torque_i, torque_j;  // about the centres [N m]

  // What it does to the partners by the other's name.
  SCREE_HD ContactLoadOf exchanged() const { return {opposite(force), loss, torque_j, torque_i}; }
};

// What a contact remembers from step to step; what its law does not use stays zero.
struct ContactHistory {
  Vec3 spring;           // force of the tangential spring [N]; odd under exchange of the partners
  Vec3 moment;           // of the springs of rolling and twisting [N m]; odd
  bool touched = false;  // the surfaces have met: a law with a neck may hold them beyond touch

  // What the other partner remembers.
  SCREE_HD ContactHistory mirrored() const { return {opposite(spring), opposite(moment), touched}; }
};

// Elastic energy of the springs that contacts remember [J].
struct SpringEnergies {
  Real friction = 0;  // across the normal
  Real rolling = 0;   // of rolling and twisting

  SCREE_HD Real sum() const { return friction + rolling; }
  SCREE_HD void add(const SpringEnergies& part, Real share) {
    friction += share * part.friction, rolling += share * part.rolling;
  }
};

// Elastic energy of a contact [J].
struct ContactEnergy {
  Real sum = 0;            // of the normal force, and of the springs that it remembers
  SpringEnergies springs;  // parts of the sum
  Real cohesion = 0;       // part of the sum: that less what it were without attraction; below zero
};

// A contact over the step that ends at the instant of its PairState.
struct ContactOutcome {
  ContactLoadOf<Real, Vec3> load;  // at that instant; loss: of the normal law there, and of the step's others
  ContactHistory history;
  SpringLosses friction, rolling, twisting;  // of the step [J]

  SCREE_HD RubbingLosses losses() const { return {{friction.sum(), rolling.sum(), twisting.sum()}}; }
};

// The law of a contact. Without friction, rolling and neck (kMoves false) it is a function of the instant:
// load(pair). With them it needs to know how the partners moved over the step, and what it remembers:
// load(moving pair, history), which is pure: the new history is returned, and only who accepts the step
// stores it.
template <class NormalLaw, class TangentialLaw = Frictionless, class RollingLaw = FreeRolling>
struct ContactLaw {
  using Normal = NormalLaw;
  using Tangential = TangentialLaw;
  using Rolling = RollingLaw;
  NormalLaw normal;
  TangentialLaw tangential{};
  RollingLaw rolling{};

  static constexpr bool kNeck = kHasNeck<NormalLaw>;
  static constexpr bool kReaches = kReachesBeyondTouch<NormalLaw>;  // partners apart may have a contact
  static constexpr bool kMoves = TangentialLaw::acts || RollingLaw::acts || kNeck;
  // Numbers that a contact remembers: spring, moment, whether it has touched, in this order.
  static constexpr int kHistory = TangentialLaw::kHistory + RollingLaw::kHistory + (kNeck ? 1 : 0);

  // The load of a closed contact. Pure: the same for both partners but for the sign of what is odd.
  template <class T, class Vector>
  SCREE_HD ContactLoadOf<T, Vector> load(const PairStateOf<T, Vector>& pair) const {
    static_assert(!kMoves);
    return normal_load(pair);
  }
  // Of its normal law alone.
  template <class T, class Vector>
  SCREE_HD ContactLoadOf<T, Vector> normal_load(const PairStateOf<T, Vector>& pair) const {
    const auto law = normal.template as<T>().of_pair(pair.size);
    const ContactForceOf<T> f = contact_force(law, pair.geometry.overlap, pair.geometry.rate(pair.velocity));
    return {pair.geometry.along(f.force), f.loss, {}, {}};
  }

  // Whether there is a contact, of partners that may be apart.
  SCREE_HD bool closed(const PairState& pair, const ContactHistory& old) const {
    return closed(normal.of_pair(pair.size), pair.geometry.overlap, old);
  }

  // Whether a step that leaves no contact has broken one whose neck held springs.
  SCREE_HD static bool breaks(const ContactHistory& old) { return kNeck && old.touched; }

  // All zero where there is no contact, but for the losses of one that breaks(). Pair: a MovingPair, or an
  // InstantPair.
  template <class Pair = MovingPair>
  SCREE_HD ContactOutcome load(const Pair& pair, const ContactHistory& old) const {
    ContactOutcome out{};
    const auto law = normal.of_pair(pair.size);
    const ContactGeometry& g = pair.geometry;
    const ContactMotion& step = pair.motion;
    if (!closed(law, g.overlap, old)) {
      if constexpr (std::is_same_v<Pair, MovingPair>)
        if (breaks(old)) let_go(springs_at(step.overlap0, step.normal0, pair.size, old), step.h, out);
      return out;
    }
    const ContactForce f = contact_force(law, g.overlap, g.rate(pair.velocity));
    const bool fresh = step.overlap0 < 0 && g.overlap > 0 && !old.touched;
    const ContactMotion motion = fresh ? step.over(g.overlap / (g.overlap - step.overlap0)) : step;
    const NormalContact contact = normal_contact(law, pair.size, f.force, g.overlap, motion.overlap0);
    out.load = {g.along(f.force), f.loss, {}, {}};
    if constexpr (kNeck)
      if (!old.touched) out.load.loss += law.making_loss() / step.h;
    out.history.touched = old.touched || g.overlap > 0;
    SpringSlider slider{};
    if constexpr (TangentialLaw::acts) {
      slider = tangential.slider(pair.size, motion, contact);
      SpringStep step = spring_step(slider, turned_across(motion, old.spring), motion.slip, motion.h);
      if constexpr (std::is_same_v<Pair, InstantPair>)
        step.acting = acting_at(slider, step.spring, pair.slip_rate);
      rub(step, motion, out);
    }
    if constexpr (RollingLaw::acts) {
      const RollingContact rolls{pair.size, motion, contact, slider};
      RollingStep step = rolling.step(rolls, turned_with(motion, old.moment));
      if constexpr (std::is_same_v<Pair, InstantPair>)
        step.acting = rolling.at(rolls, step.spring, pair.turning);
      roll(step, motion.h, out);
    }
    return out;
  }

  // Of a closed contact, with what a neck that the next step makes will lose.
  SCREE_HD ContactEnergy energy_of(const PairState& pair, const ContactHistory& history) const {
    const auto law = normal.of_pair(pair.size);
    Real out = law.energy(pair.geometry.overlap), cohesion = cohesion_of(law, pair.geometry.overlap);
    if constexpr (kNeck)
      if (!history.touched) out += law.making_loss(), cohesion += law.making_loss();
    const SpringEnergies springs = springs_of(pair, history);
    return {out + springs.sum(), springs, cohesion};
  }
  SCREE_HD SpringEnergies springs_of(const PairState& pair, const ContactHistory& history) const {
    return springs_at(pair.geometry.overlap, pair.geometry.normal(), pair.size, history);
  }
  // How far the spring of friction is stretched [m].
  SCREE_HD Real slip_of(const PairState& pair, const ContactHistory& history) const {
    static_assert(TangentialLaw::acts);
    const Real d = pair.geometry.overlap,
               stiffness = tangential.stiffness_at(
                   normal_contact(normal.of_pair(pair.size), pair.size, 0, d, d).radius);
    return stiffness > 0 ? norm(history.spring) / stiffness : 0;
  }
  SCREE_HD SpringEnergies springs_at(Real d, Vec3 normal_to_i, const PairSize& size,
                                     const ContactHistory& history) const {
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

  // Whether the mirror image of what one partner remembers is what the other finds, to the signs of zeros. A
  // limit of zero leaves of a spring zeros with the signs of what it would have been; those of one in a
  // plane, across it, have none on either side.
  SCREE_HD static bool is_mirrored(const ContactHistory& history) {
    const auto some = [](Vec3 a) { return a.x != 0 || a.y != 0 || a.z != 0; };
    return (!TangentialLaw::acts || some(history.spring)) && (!RollingLaw::acts || some(history.moment));
  }

  // The kHistory numbers of a contact: number(k) reads the k-th, store(k, value) writes it.
  template <class Number>
  SCREE_HD static ContactHistory read_history(const Number& number) {
    ContactHistory out;
    if constexpr (TangentialLaw::kHistory > 0) out.spring = {number(0), number(1), number(2)};
    constexpr int first = TangentialLaw::kHistory;
    if constexpr (RollingLaw::kHistory > 0)
      out.moment = {number(first), number(first + 1), number(first + 2)};
    if constexpr (kNeck) out.touched = number(kHistory - 1) != 0;
    return out;
  }
  template <class Store>
  SCREE_HD static void write_history(const ContactHistory& history, const Store& store) {
    const auto put = [&](int first, Vec3 a) {
      store(first, a.x), store(first + 1, a.y), store(first + 2, a.z);
    };
    if constexpr (TangentialLaw::kHistory > 0) put(0, history.spring);
    if constexpr (RollingLaw::kHistory > 0) put(TangentialLaw::kHistory, history.moment);
    if constexpr (kNeck) store(kHistory - 1, history.touched ? 1 : 0);
  }

 private:
  // of: the normal law's, for these partners.
  template <class Pair>
  SCREE_HD static bool closed(const Pair& of, Real overlap, const ContactHistory& old) {
    return overlap > 0 || ((!kNeck || old.touched) && overlap > -reach_of(of));
  }
  SCREE_HD static void rub(const SpringStep& step, const ContactMotion& motion, ContactOutcome& out) {
    out.load.force = fused(-motion.leverage, step.acting, out.load.force);
    const Vec3 moment = fused_cross(motion.normal1, step.acting);
    out.load.torque_i = motion.arm_i * moment, out.load.torque_j = motion.arm_j * moment;
    if (const Real loss = step.losses.sum(); loss != 0) out.load.loss += loss * reciprocal(motion.h);
    out.history.spring = step.spring, out.friction = step.losses;
  }
  SCREE_HD static void let_go(const SpringEnergies& held, Real h, ContactOutcome& out) {
    out.friction.unloading = held.friction, out.rolling.unloading = held.rolling;
    out.load.loss = held.sum() * reciprocal(h);
  }
  SCREE_HD static void roll(const RollingStep& step, Real h, ContactOutcome& out) {
    out.load.torque_i -= step.acting, out.load.torque_j += step.acting;
    SpringLosses both = step.losses;
    both += step.twisting;
    out.load.loss += both.sum() * reciprocal(h);
    out.history.moment = step.spring, out.rolling = step.losses, out.twisting = step.twisting;
  }
};

// Laws with a spring and slider beside a normal law without attraction, and nothing that resists rolling:
// those of which there are implicit steps and a form in single precision.
template <class Law>
inline constexpr bool kFrictionAlone = false;
template <class Law>
requires Law::kMoves inline constexpr bool kFrictionAlone<Law> =
    Law::Tangential::acts && !Law::Rolling::acts && !Law::kReaches;

// How many of LossKind its contacts tell apart.
template <class Law>
inline constexpr int kLossKindsOf = 0;
template <class Law>
requires Law::kMoves inline constexpr int kLossKindsOf<Law> = Law::Rolling::acts ? kLossKinds : 1;

}  // namespace scree
