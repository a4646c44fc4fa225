// Per-particle kernels of the contact stages at one instant. Shared by the CPU and CUDA backends.
#pragma once

#include <type_traits>

#include "dem/contact/contact_walk.hpp"

namespace scree {

// A particle's share of the energies of a contact with another particle; those of contacts with surfaces
// count in full.
inline constexpr Real kPairShare = 0.5;

// A load with the new contact history.
template <class Load, class History>
struct LoadWithHistory : Load {
  History history;
};

// Response of a contact by its law; contacts with bodies were evaluated before.
struct Respond {
  template <class Law, class Pair>
  SCREE_HD auto operator()(const Law& law, const Pair& pair, const typename Law::History& old) const {
    return law.respond(pair, old);
  }
  template <class Views>
  SCREE_HD const SurfaceLoad* stored(const Views& in, Index entry) const {
    return in.loads[entry].touches ? &in.loads[entry] : nullptr;
  }
};

// Load of one contact, or of all contacts of a particle.
template <int kKinds>
struct TotalForce {
  Vec3 force;                   // [N], gravity included
  Real loss_power;              // dissipation of the contacts, or the particle's share of it [W]
  Vec3 torque;                  // about its centre, for laws with `kNeedsMotion` [N m]
  LossesByKind<kKinds> losses;  // parts of the dissipation, over the step [J]

  SCREE_HD TotalForce& operator+=(const TotalForce& part) {
    force += part.force, loss_power += part.loss_power, torque += part.torque, losses.add(part.losses);
    return *this;
  }
  // Of one contact.
  SCREE_HD static TotalForce of(const ContactLoadOf<Real, Vec3>& load, const TangentialLosses& losses) {
    TotalForce out{load.force, load.loss, load.torque_i, {}};
    out.losses.add(losses);
    return out;
  }
  // Reduces the losses to the particle's share of contacts with other particles.
  SCREE_HD void share() { loss_power *= kPairShare, losses.scale(kPairShare); }
  // No contact: adding it changes no bit, not even the sign of a zero.
  SCREE_HD static TotalForce nothing() {
    constexpr Real z = -0.0;
    TotalForce out{{z, z, z}, z, {z, z, z}, {}};
    out.losses.fill(z);
    return out;
  }
};

// The load on one partner.
template <int kKinds>
struct RespondWithForce {
  using Result = TotalForce<kKinds>;

  template <class Law, class Pair>
  SCREE_HD auto operator()(const Law& law, const Pair& pair, const typename Law::History& old) const {
    const auto outcome = law.respond(pair, old);
    return LoadWithHistory<Result, decltype(outcome.history)>{Result::of(outcome.load, outcome.losses()),
                                                              outcome.history};
  }
};

// Total force on particle i at the current positions and velocities, and its share of the dissipation.
// kAccepts: as in `ContactWalk`, at the end of an explicit step.
template <class Laws, class Rows, bool kAccepts = false>
struct ContactForceItem {
  std::conditional_t<kAccepts, ExplicitWalk<Laws, Rows>, ContactWalk<Laws, Rows>> walk;
  Vec3 gravity;
  Vec3* force;                 // [N]
  Real* loss_power;            // [W]
  Vec3* angular_acceleration;  // for laws with `kNeedsMotion` [rad/s^2]

  static constexpr bool kNeedsMotion = LawOf<Laws>::kNeedsMotion;
  static constexpr int kKinds = kLossKindsOf<LawOf<Laws>>;
  using Total = TotalForce<kKinds>;

  SCREE_HD void operator()(Index i) const { store(i, total(i)); }

  SCREE_HD void store(Index i, const Total& sum) const {
    force[i] = sum.force;
    loss_power[i] = sum.loss_power;
    if constexpr (kNeedsMotion) angular_acceleration[i] = reciprocal(walk.in.spin[i].w) * sum.torque;
  }

  SCREE_HD Total total(Index i) const {
    const Self self = walk.self(i);
    Total sum = weight(self);
    add_neighbors(self, sum);
    add_surfaces(self, sum);
    return sum;
  }

  // The parts of the total in this order: weight, neighbours, surfaces.
  using Self = typename decltype(walk)::Self;
  SCREE_HD Total weight(const Self& self) const { return {self.u.w * gravity, 0, {}, {}}; }
  SCREE_HD void add_neighbors(const Self& self, Total& sum) const {
    walk.template sum_neighbors<kAccepts>(self, RespondWithForce<kKinds>{}, sum);
    sum.share();
  }
  SCREE_HD void add_surfaces(const Self& self, Total& sum) const {
    walk.template surfaces<kAccepts>(self, Respond{}, [&](const auto& contact, Index) {
      sum += Total::of(contact.load, contact.losses());
    });
  }
};

// Weighted sums over the contacts of a particle.
struct TouchSums {
  Real energy = 0;         // elastic [J]
  SpringEnergies springs;  // parts of the energy
  Real cohesion = 0;       // part of the energy [J]
  Real share = 0;          // sum of the weights
  Index contacts = 0;
};

// Elastic energy of a closed contact, including that of the springs in the history [J].
struct EvaluateEnergy {
  template <class Law>
  SCREE_HD ContactEnergy operator()(const Law& law, const PairState& pair,
                                    const typename Law::History& history) const {
    return law.energy_of(pair, history);
  }
  template <class Views>
  SCREE_HD const ContactEnergy* stored(const Views& in, Index entry) const {
    return in.loads[entry].touches ? &in.loads[entry].energy : nullptr;
  }
};

// share(j): weight of a contact with item j; contacts with surfaces count in full.
template <class Laws, class Rows, class Share>
SCREE_HD TouchSums touch_sums(const ContactWalk<Laws, Rows>& walk, Index i, const Share& share) {
  TouchSums sum;
  const auto add = [&](const ContactEnergy& energy, Real weight) {
    sum.energy += weight * energy.sum;
    if constexpr (LawOf<Laws>::kNeedsMotion) sum.springs.add(energy.springs, weight);
    if constexpr (kMayBeCohesive<typename LawOf<Laws>::Normal>) sum.cohesion += weight * energy.cohesion;
    sum.share += weight;
    ++sum.contacts;
  };
  const auto self = walk.self(i);
  walk.neighbors(self, EvaluateEnergy{},
                 [&](const ContactEnergy& energy, Index j) { add(energy, share(j)); });
  walk.surfaces(self, EvaluateEnergy{}, [&](const ContactEnergy& energy, Index) { add(energy, 1); });
  return sum;
}

// Outputs per particle.
struct EnergyOutputs {
  Real* energy;  // [J]
  Index* contacts;
  Real* pairs;              // half of each contact with another particle, all of any other contact
  SpringEnergies* springs;  // parts of the energy; null where particles do not rotate
  Real* cohesion;           // part of the energy; null without adhesion [J]
};

// Particle i's share of the elastic energy and of the number of its contacts, and that number.
template <class Laws, class Rows>
struct ContactEnergyItem {
  ContactWalk<Laws, Rows> walk;
  EnergyOutputs out;

  SCREE_HD void operator()(Index i) const {
    const TouchSums sum = touch_sums(walk, i, [](Index) { return kPairShare; });
    out.energy[i] = sum.energy;
    out.contacts[i] = sum.contacts;
    out.pairs[i] = sum.share;
    if (out.springs != nullptr) out.springs[i] = sum.springs;
    if (out.cohesion != nullptr) out.cohesion[i] = sum.cohesion;
  }
};

}  // namespace scree
