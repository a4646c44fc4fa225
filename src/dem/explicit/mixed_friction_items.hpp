// Explicit steps with friction, and with rolling resistance, in mixed precision, see mixed_items.hpp.
#pragma once

#include "dem/explicit/mixed_items.hpp"
#include "physics/single_contact.hpp"

namespace scree {

// Evaluates a contact of two particles in single precision, with its history in double precision.
template <int kKinds>
struct EvaluateSingleLoad {
  using Result = SingleLoad<kKinds>;

  template <class Law>
  SCREE_HD SingleOutcome<kKinds> operator()(const Law& law, const SinglePair& pair,
                                            const ContactHistory& old) const {
    return single_load(law, pair, old);
  }
};

// Kinematics at fixed-point positions for laws with `kNeedsMotion`: pairs of particles in single precision,
// walls in double precision.
struct OverMixedStep {
  AtMixedInstant at;
  const MixedSpin* spin;  // all items
  Real h;                 // [s]

  struct Self {
    Index i;
    int material;
    FixedPointPosition p;
    MixedMotion u;
    MixedSpin spin;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], at.position[i], at.motion[i], spin[i]};
  }
  template <class Rows>
  SCREE_HD MixedTouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return at.test(in, {self.i, self.material, self.p, self.u});
  }
  template <class Rows>
  SCREE_HD SinglePair pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    const MixedSpin a = self.spin, b = spin[j];
    SinglePair out = single_pair(at.pair(in, {self.i, self.material, self.p, self.u}, j), {a.x, a.y, a.z},
                                 {b.x, b.y, b.z}, static_cast<float>(h));
    out.inertia_i = a.inertia, out.inertia_j = b.inertia;
    return out;
  }
  template <class Rows>
  SCREE_HD MovingPair wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    const PairState state = at.wall(in, {self.i, self.material, self.p, self.u}, plane);
    const MixedSpin w = self.spin;
    return {state, face_motion(state.geometry, plane.normal, h * state.velocity,
                               {{w.x, w.y, w.z}, state.size.radius_i, w.inertia}, {}, h)};
  }
  SCREE_HD static bool closed(const PairState& pair) { return pair.geometry.overlap > 0; }
};

// Closes a step and opens the next, in parts for a kernel that sums contacts between them.
template <class Laws, class Rows>
struct MixedFrictionItem {
  ContactWalk<Laws, Rows, OverMixedStep> walk;  // position: as converted; velocity and spin are not used
  Vec3 gravity;
  MixedViews state;
  Quaternion* orientation;
  int parity;
  Real *rolling_loss, *twisting_loss;  // null where contacts do not resist rolling

  static constexpr int kKinds = kLossKindsOf<LawOf<Laws>>;
  using Self = OverMixedStep::Self;
  using Total = TotalForce<kKinds>;
  SCREE_HD Total weight(const Self& self) const { return {Real(self.u.mass) * gravity, 0, {}, {}}; }
  SCREE_HD void add_neighbors(const Self& self, Total& sum) const {
    walk.template sum_neighbors<true>(self, EvaluateSingleLoad<kKinds>{}, sum);
    sum.share();
  }
  SCREE_HD void add_surfaces(const Self& self, Total& sum) const {
    walk.template surfaces<true>(self, Respond{}, [&](const auto& contact, Index) {
      sum += Total::of(contact.load, contact.losses());
    });
  }
  // Returns the square of the displacement.
  SCREE_HD Real advance(const Self& self, const Total& total) const {
    const Index i = self.i;
    const Real h = walk.kinematics.h;
    const QuantumGrid& grid = walk.kinematics.at.grid;
    const MixedMotion u = self.u;
    // All values are read before any is written, so that the loads overlap.
    const MixedRest rest = state.rest[i];
    const MixedSpinRest spin_rest = state.spin_rest[i];
    const Quaternion old_orientation = orientation[i];
    MixedFraction part = state.fraction[i];
    const KindsBeyondFriction losses = losses_before(i);
    const Vec3 old = Vec3{u.x, u.y, u.z} + Vec3{rest.x, rest.y, rest.z};
    const Vec3 middle = verlet_next_middle(h, old, reciprocal(u.mass) * total.force), dx = h * middle;
    const Vec3f rounded = in_single(middle), remainder = in_single(middle - in_double(rounded));
    (parity == 0 ? state.position[1] : state.position[0])[i] = moved_by(grid, dx, self.p, part);
    state.fraction[i] = part;
    (parity == 0 ? state.motion[1] : state.motion[0])[i] = {rounded.x, rounded.y, rounded.z, u.mass};
    state.rest[i] = {remainder.x, remainder.y, remainder.z,
                     rest.loss + static_cast<float>(h * total.loss_power)};
    rotate(self, spin_rest, old_orientation, total);
    store_losses(i, losses, total);
    return dot(dx, dx);
  }

 private:
  // Losses since the start of the run by the kinds for which `MixedSpinRest` has no room [J].
  struct KindsBeyondFriction {
    Real rolling = 0, twisting = 0;
  };
  SCREE_HD KindsBeyondFriction losses_before([[maybe_unused]] Index i) const {
    if constexpr (kKinds > 1)
      return {rolling_loss[i], twisting_loss[i]};
    else
      return {};
  }
  SCREE_HD void store_losses([[maybe_unused]] Index i, const KindsBeyondFriction& before,
                             const Total& total) const {
    if constexpr (kKinds > 1) {
      rolling_loss[i] = before.rolling + total.losses.of[kRollingLoss];
      twisting_loss[i] = before.twisting + total.losses.of[kTwistingLoss];
    }
  }
  SCREE_HD void rotate(const Self& self, const MixedSpinRest& rest, const Quaternion& old_orientation,
                       const Total& total) const {
    const Index i = self.i;
    const Real h = walk.kinematics.h;
    const MixedSpin w = self.spin;
    const Vec3 old = Vec3{w.x, w.y, w.z} + Vec3{rest.x, rest.y, rest.z};
    const Vec3 spin = verlet_next_middle(h, old, reciprocal(w.inertia) * total.torque);
    const Vec3f rounded = in_single(spin);
    (parity == 0 ? state.spin[1] : state.spin[0])[i] = {rounded.x, rounded.y, rounded.z, w.inertia};
    const Vec3f remainder = in_single(spin - in_double(rounded));
    const auto friction = static_cast<float>(total.losses.of[kFrictionLoss]);
    state.spin_rest[i] = {remainder.x, remainder.y, remainder.z, rest.friction + friction};
    orientation[i] = rotated_by(old_orientation, spin, h);
  }
};

}  // namespace scree
