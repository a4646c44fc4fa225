// Rolling and twisting over an explicit step in single precision, for the laws of rolling_laws.hpp. The
// moment in the contact history stays in double precision; only its increment is in single.
//
// Inside, moments are forces at the arm R*, M / R* [N], and angles are displacements R* w [m]: squares of the
// moments of small particles, some 1e-18 N m with radii of 5 um, would underflow in single precision.
#pragma once

#include <cmath>

#include "base/root.hpp"
#include "physics/single_pair.hpp"

namespace scree {

// a b + c with a single rounding, as in base/fused.hpp.
SCREE_HD float fused(float a, float b, float c) {
#ifdef __CUDA_ARCH__
  return __fmaf_rn(a, b, c);
#else
  return std::fma(a, b, c);
#endif
}
SCREE_HD Vec3f fused(float s, Vec3f a, Vec3f b) {
  return {fused(s, a.x, b.x), fused(s, a.y, b.y), fused(s, a.z, b.z)};
}
SCREE_HD float fused_dot(Vec3f a, Vec3f b) { return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z)); }
SCREE_HD Vec3f fused_cross(Vec3f a, Vec3f b) {
  return {fused(a.y, b.z, -(a.z * b.y)), fused(a.z, b.x, -(a.x * b.z)), fused(a.x, b.y, -(a.y * b.x))};
}

// `NormalContact` (normal_contact.hpp) in single precision.
struct SingleNormal {
  float friction_load;
  float radius, radius0;
  float stiffness, stiffness0;
  float effective_radius;
};

// law: of the pair; radius: of the contact at this overlap [m].
template <class NormalPair>
SCREE_HD float single_contact_stiffness(const NormalPair& law, float d, [[maybe_unused]] float radius) {
  if constexpr (requires { law.slope_of(radius); })
    return d > 0 ? law.slope_of(radius) : 0;
  else
    return d > 0 ? law.slope(d) : 0;
}

// For springs with one component.
SCREE_HD float dot(float a, float b) { return a * b; }

// 1 / x to a few units in the last place, without the compiler's branch for numbers that are not normal.
SCREE_HD float near_reciprocal(float x) {
#ifdef __CUDA_ARCH__
  float y;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
#else
  return 1 / x;
#endif
}

// `stiffness_step()`.
struct SingleStiffness {
  float of_step;   // force per displacement [N/m]
  float lost;      // fraction of the old force that is lost where k shrinks [-]
  float inverse0;  // 1 / k0 where k shrinks
};
// `lost` from the difference: 1 less a quotient would have the quotient's round-off, which adds up over
// steps.
SCREE_HD SingleStiffness single_stiffness_step(const SingleSlider& p) {
  const float k0 = p.stiffness0, k1 = p.stiffness;
  const bool grows = k1 > k0, shrinks = k1 < k0;
  const float inverse = near_reciprocal(grows ? 1.5f * (k1 + k0) : k0);
  return {grows ? fused(k1, k1, fused(k1, k0, k0 * k0)) * inverse : k1, shrinks ? (k0 - k1) * inverse : 0,
          inverse};
}

// `unloading_loss()`. start, spring: a `Vec3f` or one component.
template <class Spring>
SCREE_HD float single_unloading_loss(const SingleSlider& p, const SingleStiffness& k, Spring start,
                                     Spring spring) {
  const bool grows = p.stiffness > p.stiffness0, shrinks = p.stiffness < p.stiffness0;
  if (!grows && !shrinks) return 0;
  const float before = dot(start, start);
  if (shrinks) return before / 2 * k.lost * k.inverse0;
  const float after =
      dot(spring, spring) * (p.stiffness - k.of_step) * near_reciprocal(p.stiffness * k.of_step);
  if (!(p.stiffness0 > 0)) return after / 2;
  return fused(before * (k.of_step - p.stiffness0), near_reciprocal(p.stiffness0 * k.of_step), after) / 2;
}

// Step of a spring, a `Vec3f` or one component.
template <class Spring>
struct SingleStep {
  Spring change;   // of the spring over the step [N]
  Spring dashpot;  // force beyond the spring [N]
  float loss;      // over the step [J]
};

// `spring_step()`. start: rotated with the contact [N].
template <class Spring>
SCREE_HD SingleStep<Spring> single_slider_step(const SingleSlider& p, Spring start, Spring displacement,
                                               float h) {
  const SingleStiffness k = single_stiffness_step(p);
  SingleStep<Spring> out{fused(k.of_step, displacement, -k.lost * start), {}, 0};
  const Spring trial = start + out.change;
  if (const float square = dot(trial, trial); square > p.limit * p.limit) {
    const float share = p.limit * root_and_inverse(square).inverse;
    out.change = out.change - (1 - share) * trial;
    out.loss =
        dot((1 - k.lost) * start + share * trial, (1 - share) * trial) * near_reciprocal(2 * k.of_step);
  } else if (p.dashpot > 0) {
    const Spring sum = fused(p.dashpot * near_reciprocal(h), displacement, trial);
    const float length = dot(sum, sum);
    out.dashpot =
        (length > p.limit * p.limit ? (p.limit * root_and_inverse(length).inverse) * sum : sum) - trial;
    out.loss = dot(out.dashpot, displacement);
  }
  out.loss += single_unloading_loss(p, k, start, start + out.change) + k.lost / 2 * dot(start, displacement);
  return out;
}

// `EitherRolling`. inverse_arm: 1 / R* [1/m].
template <class Rolling>
SCREE_HD SingleStep<Vec3f> single_rolling_step(const Rolling& law, const SinglePair& pair,
                                               const SingleNormal& normal, float inverse_arm, Vec3f start) {
  const Vec3f displacement = normal.effective_radius * pair.rolling;
  SingleStep<Vec3f> out{-start, {}, 0};
  if (law.spring.friction > 0) {
    const auto friction = static_cast<float>(law.spring.friction);
    const float factor = static_cast<float>(law.spring.stiffness_factor) * friction * friction,
                given = static_cast<float>(law.spring.stiffness) * inverse_arm * inverse_arm;
    SingleSlider slider{fused(factor, normal.stiffness, given), fused(factor, normal.stiffness0, given), 0,
                        friction * normal.friction_load};
    if (law.spring.damping_ratio > 0) {
      const auto& size = pair.size;
      const float inverse_inertia =
          near_reciprocal(fused(size.mass_i * size.radius_i, size.radius_i, pair.inertia_i)) +
          near_reciprocal(fused(size.mass_j * size.radius_j, size.radius_j, pair.inertia_j));
      slider.dashpot = 2 * static_cast<float>(law.spring.damping_ratio) * inverse_arm *
                       std::sqrt(slider.stiffness * near_reciprocal(inverse_inertia));
    }
    out = single_slider_step(slider, start, displacement, pair.h);
  }
  if (law.viscous.damping > 0) {
    const float damping = static_cast<float>(law.viscous.damping) * inverse_arm * inverse_arm;
    const Vec3f force = (damping * near_reciprocal(pair.h)) * displacement;
    out.dashpot = out.dashpot + force, out.loss += dot(force, displacement);
  }
  return out;
}

// `MarshallTwisting`. friction: slider of the tangential law.
template <class Twisting>
SCREE_HD SingleStep<float> single_twisting_step(const Twisting& law, const SinglePair& pair,
                                                const SingleNormal& normal, const SingleSlider& friction,
                                                float inverse_arm, float start) {
  if (!(law.friction > 0)) return {-start, 0, 0};
  const float ratio = normal.radius * inverse_arm, ratio0 = normal.radius0 * inverse_arm;
  return single_slider_step(
      SingleSlider{ratio * ratio / 2 * friction.stiffness, ratio0 * ratio0 / 2 * friction.stiffness0,
                   ratio * ratio / 2 * friction.dashpot,
                   static_cast<float>(law.friction) * (2.0f / 3) * ratio * normal.friction_load},
      start, normal.effective_radius * pair.twisting, pair.h);
}

struct SingleMoment {
  Vec3 spring;                        // for the history [N m]
  Vec3f acting;                       // springs, dashpots and viscous part; -acting acts on i [N m]
  float rolling_loss, twisting_loss;  // over the step [J]
};

// `RollingAndTwisting::step()`. old: from the history [N m].
template <class Law>
SCREE_HD SingleMoment single_moment_step(const Law& law, const SinglePair& pair, const SingleNormal& normal,
                                         const SingleSlider& friction, Vec3 old) {
  const float arm = normal.effective_radius, inverse_arm = near_reciprocal(arm);
  const Vec3f start = in_single(old), first = fused_cross(pair.turn, start);
  const Vec3f rotation = fused(0.5f, fused_cross(pair.turn, first), first);
  const Vec3f rotated = inverse_arm * (start + rotation);
  const float along = fused_dot(rotated, pair.normal);
  const Vec3f across = fused(-along, pair.normal, rotated);
  const SingleStep<Vec3f> rolling = single_rolling_step(law.rolling, pair, normal, inverse_arm, across);
  const SingleStep<float> twisting =
      single_twisting_step(law.twisting, pair, normal, friction, inverse_arm, along);
  const Vec3f change = fused(twisting.change, pair.normal, rolling.change);
  const Vec3f dashpots = fused(twisting.dashpot, pair.normal, rolling.dashpot);
  return {old + in_double(fused(arm, change, rotation)), arm * (rotated + change + dashpots), rolling.loss,
          twisting.loss};
}

}  // namespace scree
