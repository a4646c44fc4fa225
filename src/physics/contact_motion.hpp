// Kinematics of a contact over a time step: slip, rolling and twisting, and the rotation of the contact
// history with the pair.
//
// All results are exactly odd or even under the exchange of the partners, bit for bit: sums over the two
// partners have two terms, and products have one odd factor or two. Both sides of a pair therefore keep
// mirrored springs at all times. This requires that R_i w_i + R_j w_j is not a fused multiply-add; all other
// operations may be fused.
#pragma once

#include "base/fused.hpp"
#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// Rotation of one partner. arm: distance from its centre to the contact; its radius for a sphere, 0 for a
// face, whose rotation is part of the velocity at the contact.
struct RotatingPartner {
  Vec3 spin;                 // at mid-step, in the global frame [rad/s]
  Real arm = 0;              // [m]
  Real inertia = kInfinity;  // about its centre [kg m^2]; infinite for immovable partners
};

// Motion of a contact over the step that ends at the instant of its `PairState`.
struct ContactMotion {
  Vec3 normal0, normal1;  // unit vectors from j to i at the start and the end of the step
  Real overlap0;          // at the start of the step [m]
  Vec3 slip;      // tangential displacement of i relative to j [m], rotated with the contact to the end of
                  // the step; odd
  Vec3 rolling;   // tangential part of the rotation of i relative to j [rad], rotated likewise; odd
  Real twisting;  // rotation of i relative to j about the normal [rad]; even
  Real turn;      // rotation of the pair about the normal, the mean of both spins [rad]; odd
  Real lever_arm_ratio;       // (R_i + R_j) / |r|, 1 at a face: force on the centres over spring force
  Real arm_i, arm_j;          // [m]
  Real inertia_i, inertia_j;  // [kg m^2]
  Real h;                     // [s]

  // Motion over this fraction of the step, during which the contact was closed.
  SCREE_HD ContactMotion over(Real share) const {
    ContactMotion part = *this;
    part.slip = share * slip, part.rolling = share * rolling, part.twisting = share * twisting;
    return part;
  }
};

// State and motion of a contact, as laws with friction, rolling resistance or JKR adhesion read it.
struct MovingPair : PairState {
  ContactMotion motion;
};

// Tangential part of a at the unit normal n.
SCREE_HD Vec3 tangential_part(Vec3 a, Vec3 n) { return fused(-fused_dot(a, n), n, a); }

// Common part of the motion of sphere and face contacts. tangential_displacement: of the centre of i relative
// to that of j, or to the face's point, over the step [m]; a normal component does not matter.
SCREE_HD ContactMotion contact_motion(Vec3 normal0, Vec3 normal1, Vec3 tangential_displacement,
                                      const RotatingPartner& i, const RotatingPartner& j, Real h) {
  ContactMotion out{};
  out.normal0 = normal0, out.normal1 = normal1, out.h = h, out.lever_arm_ratio = 1;
  out.arm_i = i.arm, out.arm_j = j.arm, out.inertia_i = i.inertia, out.inertia_j = j.inertia;
  const Vec3 twice_middle = normal0 + normal1, relative = h * (i.spin - j.spin);
  out.turn = h / 4 * fused_dot(i.spin + j.spin, twice_middle);
  const auto to_end = [&](Vec3 a) {
    return tangential_part(fused(out.turn / 4, fused_cross(twice_middle, a), a), normal1);
  };
  out.slip = to_end(
      fused(-h / 2, fused_cross(i.arm * i.spin + j.arm * j.spin, twice_middle), tangential_displacement));
  const Real twice_twisting = fused_dot(relative, twice_middle);
  out.twisting = twice_twisting / 2;
  out.rolling = to_end(
      fused(-twice_twisting * reciprocal(fused_dot(twice_middle, twice_middle)), twice_middle, relative));
  return out;
}

// Motion of two spheres. geometry: at the end of the step; displacement: of i relative to j over the step
// [m]. The lever arms are the radii: the slip is (R_i + R_j) dn/dt - (R_i w_i + R_j w_j) x n. With forces and
// torques that are conjugate to it, spheres roll on each other without slip whatever their overlap does, and
// angular momentum is conserved exactly. Arms that shrink with the overlap ratchet: McNamara, Garcia-Rojo,
// Herrmann, Phys. Rev. E 77 (2008).
SCREE_HD ContactMotion sphere_motion(const ContactGeometry& geometry, Vec3 displacement,
                                     const RotatingPartner& i, const RotatingPartner& j, Real h) {
  const Vec3 r = geometry.direction, r0 = r - displacement;
  const RootAndInverse<Real> distance0 = root_and_inverse(fused_dot(r0, r0));
  const Vec3 normal0 = distance0.inverse * r0, normal1 = geometry.normal();
  const Real radius_sum = i.arm + j.arm;
  // The round-off of the difference of normals, some 1e-16 of the radii, does not accumulate: the next step
  // begins with the normal at which this one ends.
  ContactMotion out = contact_motion(normal0, normal1, radius_sum * (normal1 - normal0), i, j, h);
  out.overlap0 = radius_sum - distance0.root;
  out.lever_arm_ratio = radius_sum * geometry.scale;
  return out;
}

// Motion of a sphere i and a face of the ground or of a body j whose arm is 0. normal0: the face's at the
// start of the step; displacement: of i's centre over the step relative to the material point of the face at
// the contact [m].
SCREE_HD ContactMotion face_motion(const ContactGeometry& geometry, Vec3 normal0, Vec3 displacement,
                                   const RotatingPartner& i, const RotatingPartner& j, Real h) {
  const Vec3 normal1 = geometry.normal();
  ContactMotion out = contact_motion(normal0, normal1, displacement, i, j, h);
  out.overlap0 = geometry.overlap + dot(displacement, Real(0.5) * (normal0 + normal1));
  return out;
}

// Motion of a sphere i and an edge or a vertex of a body j, whose arm is 0. The edge acts as a sphere without
// radius, so that i rolls over it without slip. normal0: at the start of the step, where the contact may have
// been with an adjacent face; displacement: of i's centre relative to the material of j at the contact [m].
SCREE_HD ContactMotion edge_motion(const ContactGeometry& geometry, Vec3 normal0, Vec3 displacement,
                                   const RotatingPartner& i, const RotatingPartner& j, Real h) {
  const Vec3 normal1 = geometry.normal(), r0 = geometry.distance * normal1 - displacement;
  const Real square0 = fused_dot(r0, r0);
  // A centre on the edge itself has no direction from it and no lever arm.
  const RootAndInverse<Real> distance0 = square0 > 0 ? root_and_inverse(square0) : RootAndInverse<Real>{0, 0};
  const Vec3 direction0 = square0 > 0 ? distance0.inverse * r0 : normal1;
  ContactMotion out = contact_motion(normal0, normal1, i.arm * (normal1 - direction0), i, j, h);
  out.overlap0 = i.arm - distance0.root;
  out.lever_arm_ratio = geometry.distance > 0 ? i.arm * reciprocal(geometry.distance) : 1;
  return out;
}

// Adds the slip of a conveyor surface of j, a face or an edge, which has the tangential velocity
// `surface_velocity` at mid-step [m/s].
SCREE_HD void add_surface_velocity(ContactMotion& c, Vec3 surface_velocity) {
  const Vec3 displacement = c.h * surface_velocity;
  c.slip -=
      c.lever_arm_ratio *
      tangential_part(displacement + c.turn / 4 * cross(c.normal0 + c.normal1, displacement), c.normal1);
}

// A contact at one instant, as laws with history read it: the partners have not moved, the history acts as it
// is, and dashpots act on the rates of slip and rotation.
struct InstantPair : MovingPair {
  Vec3 slip_rate;      // tangential velocity of i relative to j at the contact [m/s]; odd
  Vec3 relative_spin;  // spin of i relative to j [rad/s]; odd
};

// pair: over a step of zero length.
SCREE_HD InstantPair at_instant(const MovingPair& pair, Vec3 spin_i, Vec3 spin_j) {
  constexpr Real kLongTime = 1e30;  // a step so long that displacements have no rate [s]
  InstantPair out{pair, {}, spin_i - spin_j};
  ContactMotion& c = out.motion;
  const Vec3 spin_velocity = cross(c.arm_i * spin_i + c.arm_j * spin_j, c.normal1);
  out.slip_rate = tangential_part(c.lever_arm_ratio * pair.velocity - spin_velocity, c.normal1);
  c.h = kLongTime;
  return out;
}

// Rotation of the contact history over a step: by the rotation of the pair about normal0 (Cayley form, by 2
// atan(angle / 2)), then by the smallest rotation that takes normal0 to normal1. Both preserve lengths to
// round-off without a square root; together they follow a rigidly rotating pair to second order in the step.
SCREE_HD Vec3 rotated_about(Vec3 a, Vec3 normal, Real angle) {
  const Vec3 b = fused_cross(normal, a);
  return fused(reciprocal(fused(angle, angle / 4, 1)),
               fused(angle, b, (angle * angle / 2) * fused_cross(normal, b)), a);
}

// Rotates a tangential vector, for which normal x (normal x a) = -a. A normal component from round-off is
// removed.
SCREE_HD Vec3 rotated_tangential(const ContactMotion& c, Vec3 a) {
  const Real part = c.turn * reciprocal(fused(c.turn, c.turn / 4, 1));
  const Vec3 u = fused(part, fused_cross(c.normal0, a), fused(-c.turn / 2, part, 1) * a);
  return fused(-fused_dot(u, c.normal1) * reciprocal(1 + fused_dot(c.normal0, c.normal1)),
               c.normal0 + c.normal1, u);
}

// Rotates any vector.
SCREE_HD Vec3 rotated_with(const ContactMotion& c, Vec3 a) {
  const Vec3 u = rotated_about(a, c.normal0, c.turn), sum = c.normal0 + c.normal1;
  return fused(2 * fused_dot(u, c.normal0), c.normal1,
               fused(-fused_dot(u, sum) * reciprocal(1 + fused_dot(c.normal0, c.normal1)), sum, u));
}

}  // namespace scree
