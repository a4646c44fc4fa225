// How the two surfaces of a contact move against each other over a time step: slip, rolling, twisting, and
// how what a contact remembers turns with it.
//
// Everything here is exactly odd or even under the exchange of the partners, bit for bit: sums over the two
// are of two terms, and products have one odd factor or two. Both sides of a pair thus keep mirrored springs
// for ever. That holds as long as R_i w_i + R_j w_j is no fused multiply-add; all others may be.
#pragma once

#include "base/fused.hpp"
#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// One partner as it turns. arm: from its centre to the contact, its radius for a sphere, 0 for a face, whose
// own motion is in the velocity at the contact.
struct TurningPartner {
  Vec3 spin;                 // of the half step, in the space frame [rad/s]
  Real arm = 0;              // [m]
  Real inertia = kInfinity;  // about its centre [kg m^2]; infinite for what does not give way
};

// Over the step that ends at the instant of a PairState.
struct ContactMotion {
  Vec3 normal0, normal1;  // at its start and its end, unit vectors from j to i
  Real overlap0;          // at its start [m]
  Vec3 slip;      // of i over j, across the normal [m], turned with the contact to the end of the step; odd
  Vec3 rolling;   // of i against j, across the normal [rad], likewise; odd
  Real twisting;  // of i against j about the normal [rad]; even
  Real turn;      // of the pair as a whole about the normal, the mean of both spins [rad]; odd
  Real leverage;  // (R_i + R_j) / |r|, 1 at a face: of the spring force for the force on the centres
  Real arm_i, arm_j;          // [m]
  Real inertia_i, inertia_j;  // [kg m^2]
  Real h;                     // [s]

  // The contact was closed over this share of the step only.
  SCREE_HD ContactMotion over(Real share) const {
    ContactMotion part = *this;
    part.slip = share * slip, part.rolling = share * rolling, part.twisting = share * twisting;
    return part;
  }
};

// All that a law with friction, rolling or a neck sees of a contact.
struct MovingPair : PairState {
  ContactMotion motion;
};

// The part of a across the unit vector n.
SCREE_HD Vec3 across(Vec3 a, Vec3 n) { return fused(-fused_dot(a, n), n, a); }

// What the motions of spheres and of faces have in common. slide: of the centre of i over that of j, or over
// the face's point, in the step [m], without its part along the normal or with it.
SCREE_HD ContactMotion contact_motion(Vec3 normal0, Vec3 normal1, Vec3 slide, const TurningPartner& i,
                                      const TurningPartner& j, Real h) {
  ContactMotion out{};
  out.normal0 = normal0, out.normal1 = normal1, out.h = h, out.leverage = 1;
  out.arm_i = i.arm, out.arm_j = j.arm, out.inertia_i = i.inertia, out.inertia_j = j.inertia;
  const Vec3 twice_middle = normal0 + normal1, relative = h * (i.spin - j.spin);
  out.turn = h / 4 * fused_dot(i.spin + j.spin, twice_middle);
  const auto to_end = [&](Vec3 a) {
    return across(fused(out.turn / 4, fused_cross(twice_middle, a), a), normal1);
  };
  out.slip = to_end(fused(-h / 2, fused_cross(i.arm * i.spin + j.arm * j.spin, twice_middle), slide));
  const Real twice_twisting = fused_dot(relative, twice_middle);
  out.twisting = twice_twisting / 2;
  out.rolling = to_end(
      fused(-twice_twisting * reciprocal(fused_dot(twice_middle, twice_middle)), twice_middle, relative));
  return out;
}

// Of two spheres. geometry: at the end of the step; travel: of i relative to j in it [m]. "Rolling arms": the
// slip is (R_i + R_j) dn/dt - (R_i w_i + R_j w_j) x n, and with forces and torques that do the same work
// spheres that roll on each other stay without slip whatever their overlap does, and angular momentum is kept
// exactly (arms that shrink with the overlap ratchet: McNamara, Garcia-Rojo, Herrmann, Phys. Rev. E 77,
// 2008).
SCREE_HD ContactMotion sphere_motion(const ContactGeometry& geometry, Vec3 travel, const TurningPartner& i,
                                     const TurningPartner& j, Real h) {
  const Vec3 r = geometry.direction, r0 = r - travel;
  const RootAndInverse<Real> distance0 = root_and_inverse(fused_dot(r0, r0));
  const Vec3 normal0 = distance0.inverse * r0, normal1 = geometry.normal();
  const Real reach = i.arm + j.arm;
  // The round-off of the difference of normals, some 1e-16 of the reach, does not add up: the next step's
  // begins where this one's ends.
  ContactMotion out = contact_motion(normal0, normal1, reach * (normal1 - normal0), i, j, h);
  out.overlap0 = reach - distance0.root;
  out.leverage = reach * geometry.scale;
  return out;
}

// Of a sphere i and a face, of the ground or of a body j whose arm is 0. normal0: the face's at the start of
// the step; travel: of i's centre in it, relative to the material point of the face at the contact [m].
SCREE_HD ContactMotion face_motion(const ContactGeometry& geometry, Vec3 normal0, Vec3 travel,
                                   const TurningPartner& i, const TurningPartner& j, Real h) {
  const Vec3 normal1 = geometry.normal();
  ContactMotion out = contact_motion(normal0, normal1, travel, i, j, h);
  out.overlap0 = geometry.overlap + dot(travel, Real(0.5) * (normal0 + normal1));
  return out;
}

// Of a sphere i and an edge or a corner of a body j, whose arm is 0: as of a sphere j without radius, so that
// i rolls over it without slip. normal0: at the start of the step, where the contact may have been with a
// face beside the edge; travel: of i's centre relative to the material of j at the contact [m].
SCREE_HD ContactMotion edge_motion(const ContactGeometry& geometry, Vec3 normal0, Vec3 travel,
                                   const TurningPartner& i, const TurningPartner& j, Real h) {
  const Vec3 normal1 = geometry.normal(), r0 = geometry.distance * normal1 - travel;
  const Real square0 = fused_dot(r0, r0);
  // A centre on the edge itself has no direction from it, and no lever to it.
  const RootAndInverse<Real> distance0 = square0 > 0 ? root_and_inverse(square0) : RootAndInverse<Real>{0, 0};
  const Vec3 along0 = square0 > 0 ? distance0.inverse * r0 : normal1;
  ContactMotion out = contact_motion(normal0, normal1, i.arm * (normal1 - along0), i, j, h);
  out.overlap0 = i.arm - distance0.root;
  out.leverage = geometry.distance > 0 ? i.arm * reciprocal(geometry.distance) : 1;
  return out;
}

// The surface of j, a face or an edge, runs along itself with the velocity `slide` of the middle of the step
// [m/s]: that is slip, and nothing else.
SCREE_HD void add_slide(ContactMotion& c, Vec3 slide) {
  const Vec3 ran = c.h * slide;
  c.slip -= c.leverage * across(ran + c.turn / 4 * cross(c.normal0 + c.normal1, ran), c.normal1);
}

// What such a law sees at an instant alone: nothing has moved, and what it remembers acts as it is, with
// dashpots that see the rates of slip and turning.
struct InstantPair : MovingPair {
  Vec3 slip_rate;  // of i over j, across the normal [m/s]; odd
  Vec3 turning;    // of i against j [rad/s]; odd
};

// pair: of a step of no length.
SCREE_HD InstantPair at_instant(const MovingPair& pair, Vec3 spin_i, Vec3 spin_j) {
  constexpr Real kAges = 1e30;  // what has not moved has no rate [s]
  InstantPair out{pair, {}, spin_i - spin_j};
  ContactMotion& c = out.motion;
  const Vec3 turning = cross(c.arm_i * spin_i + c.arm_j * spin_j, c.normal1);
  out.slip_rate = across(c.leverage * pair.velocity - turning, c.normal1);
  c.h = kAges;
  return out;
}

// What a contact remembers turns with it over a step: about normal0 by the turn of the pair (Cayley's form of
// a rotation, by 2 atan(turn / 2)), then by the smallest rotation that takes normal0 to normal1. Both keep
// lengths to round-off and need no root; together they follow a pair that turns as one body to second order
// in the step.
SCREE_HD Vec3 turned_about(Vec3 a, Vec3 normal, Real turn) {
  const Vec3 b = fused_cross(normal, a);
  return fused(reciprocal(fused(turn, turn / 4, 1)),
               fused(turn, b, (turn * turn / 2) * fused_cross(normal, b)), a);
}

// A vector across the normal, for which normal x (normal x a) = -a; what round-off has left along it goes.
SCREE_HD Vec3 turned_across(const ContactMotion& c, Vec3 a) {
  const Real part = c.turn * reciprocal(fused(c.turn, c.turn / 4, 1));
  const Vec3 u = fused(part, fused_cross(c.normal0, a), fused(-c.turn / 2, part, 1) * a);
  return fused(-fused_dot(u, c.normal1) * reciprocal(1 + fused_dot(c.normal0, c.normal1)),
               c.normal0 + c.normal1, u);
}

// Any vector.
SCREE_HD Vec3 turned_with(const ContactMotion& c, Vec3 a) {
  const Vec3 u = turned_about(a, c.normal0, c.turn), sum = c.normal0 + c.normal1;
  return fused(2 * fused_dot(u, c.normal0), c.normal1,
               fused(-fused_dot(u, sum) * reciprocal(1 + fused_dot(c.normal0, c.normal1)), sum, u));
}

}  // namespace scree
