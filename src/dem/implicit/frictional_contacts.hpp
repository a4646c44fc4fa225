// Contacts with friction over an implicit step: kinematics, solution quantities and energy accounting. Shared
// by the CPU and CUDA backends.
#pragma once

#include <cstdint>
#include <type_traits>

#include "dem/contact/contact_walk.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/implicit/step_items.hpp"
#include "physics/step_friction.hpp"
#include "physics/step_rolling.hpp"

namespace scree {

// Lagged limits, constant while the step is solved, at the list's slots and at the entries of the surfaces
// (`StepFriction::limit`) [N]; negative: no contact. Null: the limits follow the normal forces.
struct LaggedLimits {
  Real *neighbors = nullptr, *surfaces = nullptr;
};

struct SurfaceFriction;

// State at the start of a step, and mean spins over it; all items.
struct FrictionStart {
  StepStart step;
  const Vec4* spin;       // at the start
  const Vec4* mean_spin;  // over the step
  LaggedLimits lagged;
  const SurfaceFriction* on_bodies;  // per entry of the surfaces: evaluated contacts with those on bodies
};

// A contact over an implicit step, as a law with friction reads it.
struct FrictionalPath : ContactPath {
  static constexpr Index kWall = -1;
  ContactMotion motion;
  Real lever_arm_ratio0;
  Real curvature = 0;         // rotation of the normal per tangential displacement of i's centre [1/m]
  Vec3 velocity0, velocity1;  // of i relative to j [m/s]
  Vec3 arm_rotation;          // R_i times i's rotation over the step, plus the same of j; even [m]
  Vec3 relative_rotation;     // of i relative to j over the step; odd [rad]
  Vec3 surface_velocity;      // conveyor velocity of j's surface at the end of the step [m/s]
  Index i, j;                 // items; j: kWall
  std::int64_t slot;          // of the list, or entry of the surfaces
  Real lagged_limit = -1;
};

// Kinematics over an implicit step for laws with `kNeedsMotion`; the pair is a `FrictionalPath`.
struct OverFrictionStep {
  FrictionStart start;

  struct Self : OverImplicitStep::Self {
    Vec4 mean_spin;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {OverImplicitStep{start.step}.self(in, i), start.mean_spin[i]};
  }
  // With lagged limits a contact that has opened since then still has friction.
  template <class Rows>
  SCREE_HD auto test(const ContactViews<Rows>& in, const Self& self) const {
    return [&in, &self, this](Index j) {
      return start.lagged.neighbors != nullptr || touch(self.p, in.position[j]) ||
             touch(self.p0, start.step.position[j]);
    };
  }
  template <class Rows>
  SCREE_HD FrictionalPath pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    FrictionalPath out{};
    static_cast<ContactPath&>(out) = OverImplicitStep{start.step}.pair(in, self, j);
    const Vec4 q = in.position[j];
    const ContactGeometry end = sphere_pair(xyz(self.p) - xyz(q), self.p.w + q.w);
    const RotatingPartner one = partner(self.p, self.mean_spin), other = partner(q, start.mean_spin[j]);
    out.motion = sphere_motion(end, out.displacement, one, other, start.step.h);
    out.lever_arm_ratio0 = out.motion.lever_arm_ratio * end.distance / (self.p.w + q.w - out.step.overlap0);
    out.curvature = end.scale;
    return finish(in, out, one, other, self.i, j);
  }
  template <class Rows>
  SCREE_HD FrictionalPath wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    FrictionalPath out{};
    static_cast<ContactPath&>(out) = OverImplicitStep{start.step}.wall(in, self, plane);
    const RotatingPartner one = partner(self.p, self.mean_spin);
    out.motion = face_motion(wall_pair(self.p, plane), plane.normal, out.displacement, one, {}, start.step.h);
    out.lever_arm_ratio0 = 1;
    return finish(in, out, one, {}, self.i, FrictionalPath::kWall);
  }
  SCREE_HD void at_slot(FrictionalPath& path, std::int64_t slot) const {
    path.slot = slot;
    if (start.lagged.neighbors != nullptr) path.lagged_limit = start.lagged.neighbors[slot];
  }
  SCREE_HD void at_entry(FrictionalPath& path, Index entry) const {
    path.slot = entry;
    if (start.lagged.surfaces != nullptr) path.lagged_limit = start.lagged.surfaces[entry];
  }
  SCREE_HD static bool closed(const FrictionalPath& path) {
    return OverImplicitStep::closed(path) || path.lagged_limit > 0;
  }

 private:
  SCREE_HD static RotatingPartner partner(Vec4 p, Vec4 spin) { return {xyz(spin), p.w, spin.w}; }
  template <class Rows>
  SCREE_HD FrictionalPath finish(const ContactViews<Rows>& in, FrictionalPath out, const RotatingPartner& one,
                                 const RotatingPartner& other, Index i, Index j) const {
    out.arm_rotation = start.step.h * (one.arm * one.spin + other.arm * other.spin);
    out.relative_rotation = start.step.h * (one.spin - other.spin);
    out.i = i, out.j = j;
    out.velocity0 = xyz(start.step.velocity[i]), out.velocity1 = xyz(in.velocity[i]);
    if (j == FrictionalPath::kWall) return out;
    out.velocity0 -= xyz(start.step.velocity[j]), out.velocity1 -= xyz(in.velocity[j]);
    return out;
  }
};

// Energy accounting of a contact over the step.
struct FrictionLosses : ContactLosses {
  TangentialLosses by_kind;  // parts of the dissipation [J]
};

// Response of one contact to the step.
struct FrictionalContact {
  StepContact normal;
  StepFriction friction;
  Vec3 normal0;
  Real lever_arm_ratio0, lever_arm_ratio;
  Real curvature;  // see FrictionalPath
  std::int64_t slot;
  bool acts;   // else all members above are undefined
  bool lasts;  // the contact exists at the end of the step, with this history
  ContactHistory history;
  FrictionLosses losses;  // only where asked for
};

// The same for laws with rolling resistance.
struct RollingFrictionalContact : FrictionalContact {
  StepRolling rolling;
  Real radius_i, radius_j;  // radius_j: 0 for surfaces without a radius [m]
};
template <class Law>
using FrictionalContactOf =
    std::conditional_t<Law::Rolling::acts, RollingFrictionalContact, FrictionalContact>;

SCREE_HD void add_rolling_losses(const FrictionalPath& c, const StepRolling& m, FrictionLosses& out) {
  const Real work = Real(-0.5) * dot(m.start + m.step, c.relative_rotation);
  const Real rolling = m.rolling_losses.sum(), twisting = m.twisting_losses.sum(), lost = rolling + twisting;
  out.by_kind.of[kRollingLoss] = rolling, out.by_kind.of[kTwistingLoss] = twisting;
  out.dissipated += lost, out.integrator += (m.stored0 - m.stored1) - work - lost;
}

template <class Contact>
SCREE_HD FrictionLosses friction_losses(const FrictionalPath& c, const Contact& at) {
  FrictionLosses out{at.normal.losses, {}};
  const StepFriction& friction = at.friction;
  const Vec3 force = at.lever_arm_ratio0 * friction.start + at.lever_arm_ratio * friction.step;
  const Vec3 moment = cross(c.normal0, friction.start) + cross(c.normal1, friction.step);
  const Real work =
      Real(0.5) * (dot(moment, c.arm_rotation) - dot(force, c.displacement - c.step.h * c.surface_velocity));
  const Real lost = friction.losses.sum();
  out.dissipated += lost, out.integrator += (friction.stored0 - friction.stored1) - work - lost;
  out.by_kind.of[kFrictionLoss] = lost;
  if constexpr (std::is_same_v<Contact, RollingFrictionalContact>) add_rolling_losses(c, at.rolling, out);
  return out;
}

// Response of a contact to the step. spins: of both partners at the ends of the step, as functions of at_end:
// arm_sum(), the sum of the spins times their arms, even [m/s], for laws with a tangential dashpot; and
// relative(), the spin of i relative to j, odd [rad/s], for laws with rolling resistance. kLosses: with the
// energy accounting.
template <bool kLosses, class Law, class Spins>
SCREE_HD FrictionalContactOf<Law> frictional_contact(const Law& law, const FrictionalPath& c,
                                                     const ContactHistory& old, bool resolve_events,
                                                     const Spins& spins) {
  FrictionalContactOf<Law> out{};
  out.slot = c.slot;
  out.acts = OverFrictionStep::closed(c), out.lasts = c.step.acts_at_end();
  if (!out.acts) return out;
  const auto normal = law.normal.of_pair(c.size);
  out.normal = RespondOverStep<kLosses>{resolve_events}.of(normal, c);
  out.normal0 = c.normal0, out.lever_arm_ratio0 = c.lever_arm_ratio0,
  out.lever_arm_ratio = c.motion.lever_arm_ratio;
  out.curvature = c.curvature;
  FrictionStep step{c.step,
                    c.motion,
                    c.lever_arm_ratio0,
                    {},
                    {},
                    c.size,
                    start_force(normal, c.step),
                    out.normal.end_force,
                    out.normal.step.force,
                    c.lagged_limit};
  if (law.tangential.damping_ratio > 0) {
    const auto rate = [](Real lever_arm_ratio, Vec3 velocity, Vec3 both, Vec3 across_normal) {
      return tangential_part(lever_arm_ratio * velocity - cross(both, across_normal), across_normal);
    };
    step.slip_rate0 = rate(c.lever_arm_ratio0, c.velocity0, spins.arm_sum(false), c.normal0);
    step.slip_rate1 = rate(c.motion.lever_arm_ratio, c.velocity1, spins.arm_sum(true), c.normal1);
  }
  out.friction = step_friction(law, step, old.spring);
  out.history.spring = out.friction.spring;
  if constexpr (Law::Rolling::acts) {
    out.rolling = step_rolling(law, step, {spins.relative(false), spins.relative(true)}, old.moment);
    out.history.moment = out.rolling.spring;
    out.radius_i = c.motion.arm_i, out.radius_j = c.motion.arm_j;
  }
  if constexpr (kLosses) out.losses = friction_losses(c, out);
  return out;
}

template <bool kLosses = false>
struct RespondWithFriction {
  FrictionStart start;
  const Vec4* spin;  // at the end of the step

  // Spins of a pair of items; see `frictional_contact()`.
  struct ItemSpins {
    const RespondWithFriction& of;
    const FrictionalPath& c;

    SCREE_HD Vec3 arm_sum(bool at_end) const {
      const Vec4* spins = at_end ? of.spin : of.start.spin;
      Vec3 sum = c.motion.arm_i * xyz(spins[c.i]);
      if (c.j != FrictionalPath::kWall) sum = sum + c.motion.arm_j * xyz(spins[c.j]);
      return sum;
    }
    SCREE_HD Vec3 relative(bool at_end) const {
      const Vec4* spins = at_end ? of.spin : of.start.spin;
      const Vec3 own = xyz(spins[c.i]);
      return c.j != FrictionalPath::kWall ? own - xyz(spins[c.j]) : own;
    }
  };

  template <class Law>
  SCREE_HD FrictionalContactOf<Law> operator()(const Law& law, const FrictionalPath& c,
                                               const ContactHistory& old) const {
    return frictional_contact<kLosses>(law, c, old, start.step.resolve_events, ItemSpins{*this, c});
  }
  template <class Views>
  SCREE_HD const RollingFrictionalContact* stored(const Views&, Index entry) const;
};

// One contact of a particle with a surface on a body over the step; evaluated once for both.
struct SurfaceFriction {
  bool touches;  // else all members below are undefined
  bool rolls;    // whether the law resists rolling; else that part of the contact is undefined
  RollingFrictionalContact contact;
  Vec3 arm;          // from the body's centre to that of a sphere, or to the contact point, at the end of the
                     // step [m]
  Real radius;       // of a sphere; else 0 [m]
  Vec3 contact_arm;  // from the surface's point to the contact point, at the end of the step; zero for a
                     // sphere [m]
  Vec3 surface_velocity;  // see FrictionalPath
};

template <bool kLosses>
template <class Views>
SCREE_HD const RollingFrictionalContact* RespondWithFriction<kLosses>::stored(const Views&,
                                                                              Index entry) const {
  const SurfaceFriction& at = start.on_bodies[entry];
  return at.touches ? &at.contact : nullptr;
}

}  // namespace scree
