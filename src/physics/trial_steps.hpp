// Relative motion of two partners in a trial impact, with the law and integrator functions that a run calls.
#pragma once

#include <cmath>

#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Two spheres, or a sphere i on a plane (radius_j infinite), that meet without spin.
struct TrialImpact {
  PairSize size;              // as in `PairSize` of the law
  Real mass;                  // effective mass [kg]
  Real inertia_i, inertia_j;  // [kg m^2]; infinite for partners that do not rotate
  Real approach, sliding;     // relative normal and tangential speeds [m/s]
};

inline bool on_plane(const PairSize& size) { return size.radius_j == kInfinity; }
// Sphere i at r from j, or above the plane z = 0.
inline ContactGeometry trial_geometry(const PairSize& size, Vec3 r) {
  return on_plane(size) ? plane_pair(r, size.radius_i, {0, 0, 0}, {0, 0, 1})
                        : sphere_pair(r, size.radius_i + size.radius_j);
}
// Position of i this long before the surfaces meet [s].
inline Vec3 trial_start(const TrialImpact& impact, Real gap) {
  const PairSize& size = impact.size;
  return Vec3{0, 0, on_plane(size) ? size.radius_i : size.radius_i + size.radius_j} -
         gap * Vec3{impact.sliding, 0, -impact.approach};
}

// Trial in velocity Verlet, or for laws with `kNeedsMotion` in its leapfrog form
// (dem/implicit/step_items.hpp). Every trial has step(h), which returns whether the contact was closed at the
// end of the step, and parting() and across(), the normal and tangential relative velocity.
template <class Law>
class ExplicitTrial {
 public:
  // gap: time until the surfaces meet [s].
  ExplicitTrial(const Law& law, const TrialImpact& impact, Real gap)
      : law_(law),
        impact_(impact),
        r_(trial_start(impact, gap)),
        velocity_{impact.sliding, 0, -impact.approach} {}

  bool step(Real h) {
    if constexpr (Law::kNeedsMotion)
      return step_by_halves(h);
    else
      return step_whole(h);
  }
  Real parting() const { return dot(velocity_, normal()); }
  Real tangential_part() const { return scree::tangential_part(velocity_, normal()).x; }

 private:
  Vec3 normal() const { return trial_geometry(impact_.size, r_).normal(); }
  PairState pair(Vec3 velocity) const { return {trial_geometry(impact_.size, r_), velocity, impact_.size}; }

  bool step_whole(Real h) {
    r_ += verlet_displacement(h, velocity_, acceleration_);
    const Vec3 predicted = verlet_predicted_velocity(h, velocity_, acceleration_);
    const PairState state = pair(predicted);
    const bool closed = state.geometry.overlap > 0;
    const Vec3 a = closed ? (1 / impact_.mass) * law_.respond(state, {}).load.force : Vec3{};
    velocity_ = verlet_velocity(h, predicted, acceleration_, a), acceleration_ = a;
    return closed;
  }
  bool step_by_halves(Real h) {
    velocity_ = verlet_half_kick(h, velocity_, acceleration_);
    spin_i_ = verlet_half_kick(h, spin_i_, angular_acceleration_i_),
    spin_j_ = verlet_half_kick(h, spin_j_, angular_acceleration_j_);
    const Vec3 displacement = h * velocity_;
    r_ += displacement;
    const RotatingPartner i{spin_i_, impact_.size.radius_i, impact_.inertia_i},
        j{spin_j_, on_plane(impact_.size) ? 0 : impact_.size.radius_j, impact_.inertia_j};
    const PairState state = pair(velocity_);
    const MovingPair moving{state, on_plane(impact_.size)
                                       ? face_motion(state.geometry, {0, 0, 1}, displacement, i, j, h)
                                       : sphere_motion(state.geometry, displacement, i, j, h)};
    const bool closed = law_.closed(moving, history_);
    const auto out = law_.respond(moving, history_);
    history_ = out.history;
    acceleration_ = (1 / impact_.mass) * out.load.force;
    angular_acceleration_i_ = (1 / impact_.inertia_i) * out.load.torque_i;
    angular_acceleration_j_ = (1 / impact_.inertia_j) * out.load.torque_j;
    velocity_ = verlet_half_kick(h, velocity_, acceleration_);
    spin_i_ = verlet_half_kick(h, spin_i_, angular_acceleration_i_),
    spin_j_ = verlet_half_kick(h, spin_j_, angular_acceleration_j_);
    return closed;
  }

  const Law& law_;
  TrialImpact impact_;
  Vec3 r_, velocity_, acceleration_{};  // of i relative to j
  Vec3 spin_i_{}, spin_j_{}, angular_acceleration_i_{}, angular_acceleration_j_{};
  typename Law::History history_{};
};

// Parameters of implicit steps.
struct TrialMethod {
  HhtCoefficients hht;
  bool resolve_events;
};

// Contact force that an implicit step is solved with, and the force at its end [N].
struct TrialForce {
  StepContactForce step;
  Real at_end;
};
template <class Pair>
TrialForce trial_force(const Pair& pair, const ContactStep& step, bool resolve_events) {
  TrialForce out{{0, 0, 0}, 0};
  if (step.overlap1 > 0) {
    const ContactForce at_end = contact_force(pair, step.overlap1, step.rate1);
    out = {{at_end.force, at_end.stiffness, at_end.damping}, at_end.force};
  }
  if (resolve_events) out.step = step_contact_force(pair, step);
  return out;
}

// Trial in HHT steps along the normal, each solved to round-off. A step without a solution, which exists
// where the damping of a contact jumps at touch, is halved, as in a run.
template <class Pair>
class ImplicitTrial {
 public:
  ImplicitTrial(const Pair& pair, const TrialMethod& method, const TrialImpact& impact, Real gap)
      : pair_(pair),
        method_(method),
        mass_(impact.mass),
        overlap_(-gap * impact.approach),
        rate_(impact.approach) {}

  bool step(Real h) {
    constexpr int kMostHalvings = 10;
    take(h, kMostHalvings);
    return overlap_ > 0;
  }
  Real parting() const { return -rate_; }
  Real tangential_part() const { return 0; }

 private:
  // State at the end of a step with this acceleration.
  struct End {
    ContactStep step;
    TrialForce force;
    Real residual;  // [N]
  };

  End end_of(Real h, Real a) const {
    const HhtCoefficients& c = method_.hht;
    End end{{overlap_, rate_, overlap_ + newmark_displacement(c, h, rate_, acceleration_, a),
             newmark_velocity(c, h, rate_, acceleration_, a), h},
            {},
            0};
    end.force = trial_force(pair_, end.step, method_.resolve_events);
    end.residual = hht_residual(c, mass_, {a, 0, 0}, {-end.force.step.force, 0, 0}, {-force_, 0, 0}).x;
    return end;
  }

  void take(Real h, int halvings) {
    Real a = acceleration_;
    if (!solve(h, a) && halvings > 0) {
      take(h / 2, halvings - 1), take(h / 2, halvings - 1);
      return;
    }
    const End end = end_of(h, a);
    overlap_ = end.step.overlap1, rate_ = end.step.rate1, force_ = end.force.at_end;
    acceleration_ = a + hht_event_acceleration(method_.hht, mass_, {-end.force.step.force, 0, 0},
                                               {-end.force.at_end, 0, 0})
                            .x;
  }

  // Newton's method for the acceleration at the end, safeguarded by a bracket: the residual increases with
  // it. Returns whether it converged.
  bool solve(Real h, Real& a) const {
    constexpr int kMostIterations = 60;
    constexpr Real kTolerance = 1e-12;
    const HhtCoefficients& c = method_.hht;
    const Real inertia = mass_ * hht_inertia_weight(c);
    Real low = -kInfinity, high = kInfinity;
    for (int k = 0; k < kMostIterations; ++k) {
      const End end = end_of(h, a);
      const StepContactForce& force = end.force.step;
      const Real scale = std::abs(force.force) + std::abs(force_) + inertia * std::abs(a);
      if (std::abs(end.residual) <= kTolerance * scale) return true;
      (end.residual > 0 ? high : low) = a;
      const Real slope = inertia + newmark_position_gain(c, h) * force.stiffness +
                         newmark_velocity_gain(c, h) * force.damping;
      const Real next = a - end.residual / slope;
      a = low < next && next < high ? next : low + (high - low) / 2;
    }
    return false;
  }

  const Pair& pair_;
  TrialMethod method_;
  Real mass_;
  Real overlap_, rate_, acceleration_ = 0;  // [m], and its rates
  Real force_ = 0;                          // at the start of the next step [N]
};

}  // namespace scree
