// Two spheres over an explicit step in single precision, and the parameters of a spring of their contact.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// Motion of two spheres over the step that ends at the instant of the pair. It is computed from the
// displacement of the centres, because differences of normals would lose their digits.
struct SinglePair : PairStateOf<float, Vec3f> {
  Vec3f normal;                // at the end of the step
  Vec3f slip;                  // tangential displacement of i relative to j [m]
  Vec3f turn;                  // rotation of the pair [rad]
  Vec3f rolling;               // tangential part of the rotation of i relative to j [rad]
  float twisting;              // rotation of i relative to j about the normal [rad]
  float overlap0;              // at the start of the step [m]
  float lever_arm_ratio;       // (R_i + R_j) / |r|
  float inertia_i, inertia_j;  // [kg m^2]
  float h;                     // [s]

  // Motion over this fraction of the step, during which the contact was closed.
  SCREE_HD SinglePair over(float share) const {
    SinglePair part = *this;
    part.slip = share * slip, part.rolling = share * rolling, part.twisting = share * twisting;
    return part;
  }
};

// spin_i, spin_j: at mid-step [rad/s].
SCREE_HD SinglePair single_pair(const PairStateOf<float, Vec3f>& state, Vec3f spin_i, Vec3f spin_j, float h) {
  SinglePair out{state, state.geometry.normal(), {}, {}, {}, 0, 0, 0, 0, 0, h};
  const float inverse = state.geometry.scale, radius_sum = state.size.radius_i + state.size.radius_j;
  const Vec3f displacement = h * state.velocity;
  const auto across = [](Vec3f a, Vec3f n) { return a - dot(a, n) * n; };
  const Vec3f mid_normal = out.normal - (0.5f * inverse) * across(displacement, out.normal);
  const Vec3f tangential = across(displacement, mid_normal);
  const Vec3f at_contact = state.size.radius_i * spin_i + state.size.radius_j * spin_j;
  out.lever_arm_ratio = radius_sum * inverse;
  out.slip = out.lever_arm_ratio * tangential - h * cross(at_contact, mid_normal);
  out.turn =
      inverse * cross(mid_normal, tangential) + (h / 2 * dot(spin_i + spin_j, mid_normal)) * mid_normal;
  const Vec3f rotation = h * (spin_i - spin_j);
  out.twisting = dot(rotation, mid_normal);
  out.rolling = across(rotation - out.twisting * mid_normal, out.normal);
  out.overlap0 = state.geometry.overlap + dot(displacement, mid_normal);
  return out;
}

// Stiffnesses, dashpot and limit of the step: `SpringSlider` (spring_slider.hpp) in single precision.
struct SingleSlider {
  float stiffness, stiffness0, dashpot, limit;
};

}  // namespace scree
