// Escape of particles from the domain, and removal in outlets: energies of the escaped particles, and the
// removal of their contacts. Shared by the CPU and CUDA backends.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"
#include "dem/contact/contact_items.hpp"
#include "dem/reports/remaining_space.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// A particle that has escaped from the domain, or is in an outlet.
struct EscapedParticle {
  GlobalId global_id;
  Index local_index;                   // on its rank
  Vec3 position;                       // [m]
  bool lost;                           // beyond a wall side, through which no particle may leave
  Real energy;                         // kinetic and gravitational [J]
  Real contact_loss, integrator_loss;  // losses of the particle so far [J]
  TangentialLosses losses;             // parts of contact_loss
  Real elastic = 0;                    // elastic energy of its contacts, which end [J]
  int rank = 0;                        // rank that owns it
  int outlet = -1;                     // index of the outlet; -1: it has escaped from the domain
  Real mass = 0;                       // [kg]

  bool is_removed(OutsidePolicy policy) const { return outlet >= 0 || policy == OutsidePolicy::remove; }
};

// Whether an item leaves, while all particles of the rows are in the search. All ranks agree,
// because ghosts have their particles' positions.
template <class Rows>
struct IsEscaped {
  const ContactViews<Rows>& in;
  const RemainingSpace& space;
  SCREE_HD bool operator()(Index j) const { return !space.holds(xyz(in.position[j])); }
};

// Elastic energy of the contacts of an escaped particle, which end with it: half of those with another
// escaped one, all of the others.
template <class Laws, class Rows>
struct EscapeEnergyItem {
  ContactWalk<Laws, Rows> walk;
  RemainingSpace space;
  EscapedParticle* escaped_particles;

  SCREE_HD void operator()(Index k) const {
    const IsEscaped<Rows> is_escaped{walk.in, space};
    const auto share = [&](Index j) { return is_escaped(j) ? kPairShare : Real(1); };
    escaped_particles[k].elastic = touch_sums(walk, escaped_particles[k].local_index, share).energy;
  }
};

// State from which the next step starts.
struct StartViews {
  Vec3 *force, *acceleration;  // [N], [m/s^2]
  Real* loss_power;            // [W]; null for HHT
  Real* integrator_loss;       // [J]
  const std::uint8_t* drifting;
  HhtCoefficients hht;                   // hht_alpha = 0 for velocity-Verlet
  Real verlet_step;                      // of velocity-Verlet [s]
  Vec3* angular_acceleration = nullptr;  // null where particles do not rotate [rad/s^2]
};

// Removes the contacts of escaped particles from the state that the next step starts from: for a remaining
// particle those with escaped ones, for an escaped one all. Otherwise the next step would do half a step's
// work with a force that has no elastic energy any more. in: as the forces were computed, with the velocities
// that the law used.
template <class Laws, class Rows>
struct EscapedContactsItem {
  ContactWalk<Laws, Rows> walk;
  Vec3 gravity;
  RemainingSpace space;
  StartViews start;

  SCREE_HD void operator()(Index i) const {
    if (start.drifting[i]) return;
    const IsEscaped<Rows> is_escaped{walk.in, space};
    const auto self = walk.self(i);
    const Real mass = self.u.w;
    if (is_escaped(i)) {
      set_start(i, mass, mass * gravity);
      if constexpr (LawOf<Laws>::kNeedsMotion) set_rotation_start(i, self.spin.w, {});
      if (start.loss_power != nullptr) start.loss_power[i] = 0;
      return;
    }
    Vec3 ended_force, ended_torque;
    Real ended_loss = 0;
    Index ended = 0;
    walk.neighbors_if(self, is_escaped, Respond{}, [&](const auto& contact, Index) {
      const auto& load = contact.load;
      ended_force += load.force, ended_torque += load.torque_i, ended_loss += load.loss, ++ended;
    });
    if (ended == 0) return;
    set_start(i, mass, start.force[i] - ended_force);
    if constexpr (LawOf<Laws>::kNeedsMotion)
      set_rotation_start(i, self.spin.w, start.angular_acceleration[i] - (1 / self.spin.w) * ended_torque);
    if (start.loss_power != nullptr) start.loss_power[i] -= kPairShare * ended_loss;
  }

  SCREE_HD void set_rotation_start(Index i, Real inertia, Vec3 after) const {
    const Vec3 before = start.angular_acceleration[i];
    start.angular_acceleration[i] = after;
    start.integrator_loss[i] += verlet_energy_shift(start.verlet_step, inertia, after) -
                                verlet_energy_shift(start.verlet_step, inertia, before);
  }

  SCREE_HD void set_start(Index i, Real mass, Vec3 force) const {
    const Vec3 a0 = start.acceleration[i];
    const Vec3 a1 = a0 + hht_event_acceleration(start.hht, mass, start.force[i], force);
    start.force[i] = force, start.acceleration[i] = a1;
    if (start.loss_power == nullptr) return;
    // The accounting of kinetic energy contains this function of the acceleration, while the kinetic energy
    // has not changed.
    start.integrator_loss[i] +=
        verlet_energy_shift(start.verlet_step, mass, a1) - verlet_energy_shift(start.verlet_step, mass, a0);
  }
};

}  // namespace scree
