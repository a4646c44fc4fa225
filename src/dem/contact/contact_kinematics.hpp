// Kinematics policies of a walk over contacts: at an instant, or over a step. Shared by the CPU and CUDA
// backends.
#pragma once

#include <type_traits>
#include <utility>

#include "dem/contact/contact_views.hpp"
#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// A kinematics policy defines what a walk reads of item i itself, the test for contact with other items, and
// the pair type. This policy is that of one instant; the pair is a `PairState`.
struct AtInstant {
  struct Self {
    Index i;
    int material;
    Vec4 p, u;  // x, y, z, radius; velocity, mass
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], in.position[i], in.velocity[i]};
  }
  template <class Rows>
  SCREE_HD TouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return {self.p, in.position};
  }
  template <class Rows>
  SCREE_HD PairState pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    return pair(self.p, self.u, in.position[j], in.velocity[j]);
  }
  SCREE_HD static PairState pair(Vec4 p, Vec4 u, Vec4 q, Vec4 w) {
    return {sphere_pair(xyz(p) - xyz(q), p.w + q.w), xyz(u) - xyz(w), {p.w, q.w, u.w, w.w}};
  }
  template <class Rows>
  SCREE_HD PairState wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    return {wall_pair(self.p, plane), xyz(self.u), wall_size(in, self.i, self.p.w, self.u.w)};
  }
  template <class Pair>
  SCREE_HD static bool closed(const Pair& pair) {
    return pair.geometry.overlap > 0;
  }
};

// Kinematics over the explicit step that ends at this instant, for laws with `kNeedsMotion`. Velocities and
// angular velocities are those of mid-step; the pair is a `MovingPair`.
struct OverExplicitStep {
  Real h;  // [s]

  struct Self {
    Index i;
    int material;
    Vec4 p, u, spin;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], in.position[i], in.velocity[i], in.spin[i]};
  }
  template <class Rows>
  SCREE_HD TouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return {self.p, in.position};
  }
  template <class Rows>
  SCREE_HD MovingPair pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    const Vec4 q = in.position[j], w = in.velocity[j];
    const PairState state = AtInstant::pair(self.p, self.u, q, w);
    return {state, motion(state, partner(self.p, self.spin), partner(q, in.spin[j]))};
  }
  SCREE_HD static RotatingPartner partner(Vec4 p, Vec4 spin) { return {xyz(spin), p.w, spin.w}; }
  SCREE_HD ContactMotion motion(const PairState& state, const RotatingPartner& i,
                                const RotatingPartner& j) const {
    return sphere_motion(state.geometry, h * state.velocity, i, j, h);
  }
  template <class Rows>
  SCREE_HD MovingPair wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    const PairState state = AtInstant{}.wall(in, {self.i, self.material, self.p, self.u}, plane);
    return {state,
            face_motion(state.geometry, plane.normal, h * state.velocity, partner(self.p, self.spin), {}, h)};
  }
  SCREE_HD static bool closed(const PairState& pair) { return pair.geometry.overlap > 0; }
};

// Kinematics at an instant for laws with `kNeedsMotion`; the pair is an `InstantPair`.
struct AtInstantWithSpin {
  using Self = OverExplicitStep::Self;
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return OverExplicitStep{0}.self(in, i);
  }
  template <class Rows>
  SCREE_HD TouchTest test(const ContactViews<Rows>& in, const Self& self) const {
    return OverExplicitStep{0}.test(in, self);
  }
  template <class Rows>
  SCREE_HD InstantPair pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    return at_instant(OverExplicitStep{0}.pair(in, self, j), xyz(self.spin), xyz(in.spin[j]));
  }
  template <class Rows>
  SCREE_HD InstantPair wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    return at_instant(OverExplicitStep{0}.wall(in, self, plane), xyz(self.spin), {});
  }
  SCREE_HD static bool closed(const PairState& pair) { return OverExplicitStep::closed(pair); }
};

// The law type of a set of laws, and its kinematics at an instant and over an explicit step.
template <class Laws>
using LawOf = std::remove_cvref_t<decltype(std::declval<Laws>().get(0, 0))>;
template <class Laws>
using InstantKinematics = std::conditional_t<LawOf<Laws>::kNeedsMotion, AtInstantWithSpin, AtInstant>;
template <class Laws>
using StepKinematics = std::conditional_t<LawOf<Laws>::kNeedsMotion, OverExplicitStep, AtInstant>;

// State of all items at the start of a step. resolve_events: whether opening and closing of contacts within
// the step is resolved; else the force at the end of the step is used for all of it, as in the paper.
struct StepStart {
  const Vec4* position;  // x, y, z, radius
  const Vec4* velocity;
  Real h;  // [s]
  bool resolve_events;
};

// Kinematics of one contact over an implicit step.
struct ContactPath {
  ContactStep step;
  Vec3 normal0, normal1;  // at the start and the end of the step
  Vec3 displacement;      // of i relative to j [m]
  PairSize size;
};

// Kinematics over an implicit step, for contacts at its start or its end; the pair is a `ContactPath`.
struct OverImplicitStep {
  StepStart start;

  struct Self {
    Index i;
    int material;
    Vec4 p, p0;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], in.position[i], start.position[i]};
  }
  template <class Rows>
  SCREE_HD auto test(const ContactViews<Rows>& in, const Self& self) const {
    return [&in, &self, this](Index j) {
      return touch(self.p, in.position[j]) || touch(self.p0, start.position[j]);
    };
  }
  template <class Rows>
  SCREE_HD ContactPath pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    const Index i = self.i;
    const Vec4 q = in.position[j], u = in.velocity[i], w = in.velocity[j];
    const Real radius_sum = self.p.w + q.w;
    const Vec3 r = xyz(self.p) - xyz(q), r0 = xyz(self.p0) - xyz(start.position[j]);
    return path(sphere_pair(r, radius_sum), xyz(u) - xyz(w), sphere_pair(r0, radius_sum),
                xyz(start.velocity[i]) - xyz(start.velocity[j]), r - r0, {self.p.w, q.w, u.w, w.w});
  }
  template <class Rows>
  SCREE_HD ContactPath wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    const Vec4 u = in.velocity[self.i];
    return path(wall_pair(self.p, plane), xyz(u), wall_pair(self.p0, plane), xyz(start.velocity[self.i]),
                xyz(self.p) - xyz(self.p0), wall_size(in, self.i, self.p.w, u.w));
  }
  SCREE_HD static bool closed(const ContactPath& path) {
    return path.step.overlap1 > 0 || path.step.overlap0 > 0;
  }
  SCREE_HD ContactPath path(const ContactGeometry& end, Vec3 end_velocity, const ContactGeometry& begin,
                            Vec3 begin_velocity, Vec3 displacement, const PairSize& size) const {
    const Vec3 normal0 = begin.normal(), normal1 = end.normal();
    return {{begin.overlap, -dot(normal0, begin_velocity), end.overlap, -dot(normal1, end_velocity), start.h},
            normal0,
            normal1,
            displacement,
            size};
  }
};

}  // namespace scree
