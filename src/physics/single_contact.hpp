// A contact with friction over an explicit step in single precision. The contact history stays in double
// precision, because a step changes it by less than the last bit of a single. For laws of `kFrictionOnly`
// (contact_law.hpp), with the same formulas to single-precision round-off; the rotation of the contact is
// second order in the step here, and exact there.
#pragma once

#include <cmath>

#include "physics/contact_law.hpp"

namespace scree {

// Motion of two spheres over the step that ends at the instant of the pair. It is computed from the
// displacement of the centres, because differences of normals would lose their digits.
struct SinglePair : PairStateOf<float, Vec3f> {
  Vec3f normal;                // at the end of the step
  Vec3f slip;                  // tangential displacement of i relative to j [m]
  Vec3f turn;                  // rotation of the pair [rad]
  float overlap0;              // at the start of the step [m]
  float lever_arm_ratio;       // (R_i + R_j) / |r|
  float inertia_i, inertia_j;  // [kg m^2]
  float h;                     // [s]
};

// spin_i, spin_j: at mid-step [rad/s].
SCREE_HD SinglePair single_pair(const PairStateOf<float, Vec3f>& state, Vec3f spin_i, Vec3f spin_j, float h) {
  SinglePair out{state, state.geometry.normal(), {}, {}, 0, 0, 0, 0, h};
  const float inverse = state.geometry.scale, radius_sum = state.size.radius_i + state.size.radius_j;
  const Vec3f displacement = h * state.velocity;
  const auto across = [](Vec3f a, Vec3f n) { return a - dot(a, n) * n; };
  const Vec3f mid_normal = out.normal - (0.5f * inverse) * across(displacement, out.normal);
  const Vec3f tangential = across(displacement, mid_normal);
  const Vec3f rolling = state.size.radius_i * spin_i + state.size.radius_j * spin_j;
  out.lever_arm_ratio = radius_sum * inverse;
  out.slip = out.lever_arm_ratio * tangential - h * cross(rolling, mid_normal);
  out.turn =
      inverse * cross(mid_normal, tangential) + (h / 2 * dot(spin_i + spin_j, mid_normal)) * mid_normal;
  out.overlap0 = state.geometry.overlap + dot(displacement, mid_normal);
  return out;
}

struct SingleLoad {
  Vec3f force;     // on i [N]
  float loss;      // [W]
  Vec3f torque_i;  // [N m]
  float friction;  // friction's part of the loss, over the step [J]
};
struct SingleOutcome : SingleLoad {
  Vec3 history;  // force of the tangential spring [N]
};

// Stiffnesses, dashpot and limit of the step: `SpringSlider` (spring_slider.hpp) in single precision.
struct SingleSlider {
  float stiffness, stiffness0, dashpot, limit;
};

struct SingleSpring {
  Vec3 spring;   // [N]
  Vec3f acting;  // spring and dashpot [N]
  float loss;    // over the step [J]
};

SCREE_HD SingleSpring single_spring_step(const SingleSlider& p, const SinglePair& pair, Vec3 old) {
  const Vec3f start = in_single(old), first = cross(pair.turn, start);
  const bool shrinks = p.stiffness < p.stiffness0;
  const float retained = shrinks ? p.stiffness / p.stiffness0 : 1;
  float step_stiffness = p.stiffness;
  if (p.stiffness > p.stiffness0)
    step_stiffness = (p.stiffness * p.stiffness + p.stiffness * p.stiffness0 + p.stiffness0 * p.stiffness0) /
                     (1.5f * (p.stiffness + p.stiffness0));
  const Vec3f displacement = pair.slip;
  Vec3f change =
      first + 0.5f * cross(pair.turn, first) + (retained - 1) * start + step_stiffness * displacement;
  change = change - dot(start + change, pair.normal) * pair.normal;
  const Vec3f trial = start + change;
  SingleSpring out{old + in_double(change), {}, 0};
  const float square = dot(trial, trial);
  if (square > p.limit * p.limit) {
    const float share = p.limit * root_and_inverse(square).inverse;
    out.acting = share * trial;
    out.loss = dot(retained * start + out.acting, (1 - share) * trial) / (2 * step_stiffness);
    out.spring = Real(share) * out.spring;
  } else {
    out.acting = in_single(out.spring);
    if (p.dashpot > 0) {
      const Vec3f sum = out.acting + (p.dashpot / pair.h) * displacement;
      const float length = dot(sum, sum);
      const Vec3f spring = out.acting;
      out.acting = length > p.limit * p.limit ? (p.limit * root_and_inverse(length).inverse) * sum : sum;
      out.loss = dot(out.acting - spring, displacement);
    }
  }
  if (shrinks)
    out.loss += dot(start, start) / 2 * (1 - retained) / p.stiffness0;
  else if (p.stiffness > p.stiffness0) {
    const Vec3f spring = in_single(out.spring);
    const float after = dot(spring, spring) * (p.stiffness - step_stiffness) / (p.stiffness * step_stiffness);
    out.loss += p.stiffness0 > 0 ? (after + dot(start, start) * (step_stiffness - p.stiffness0) /
                                                (p.stiffness0 * step_stiffness)) /
                                       2
                                 : after / 2;
  }
  return out;
}

SCREE_HD float single_contact_radius(const PairSizeOf<float>& size, float d) {
  return d > 0 ? std::sqrt(size.effective_radius() * d) : 0;
}

template <class Law>
SCREE_HD SingleOutcome single_load(const Law& law, const SinglePair& step, Vec3 old) {
  static_assert(kFrictionOnly<Law>);
  const auto normal = law.normal.template as<float>().of_pair(step.size);
  const auto& g = step.geometry;
  const ContactForceOf<float> f = contact_force(normal, g.overlap, g.rate(step.velocity));
  SinglePair pair = step;
  if (step.overlap0 < 0) pair.slip = (g.overlap / (g.overlap - step.overlap0)) * step.slip;
  const auto stiffness = [&](float d) {
    return static_cast<float>(law.tangential.stiffness_at(single_contact_radius(step.size, d)));
  };
  SingleSlider slider{stiffness(g.overlap), stiffness(step.overlap0), 0,
                      static_cast<float>(law.tangential.friction) * f.force / step.lever_arm_ratio};
  if (law.tangential.damping_ratio > 0) {
    const float i = step.size.radius_i, j = step.size.radius_j;
    const float inverse_mass =
        1 / step.size.mass_i + 1 / step.size.mass_j + i * i / step.inertia_i + j * j / step.inertia_j;
    slider.dashpot =
        2 * static_cast<float>(law.tangential.damping_ratio) * std::sqrt(slider.stiffness / inverse_mass);
  }
  const SingleSpring spring = single_spring_step(slider, pair, old);
  SingleOutcome out;
  out.force = g.along(f.force) - step.lever_arm_ratio * spring.acting;
  out.torque_i = step.size.radius_i * cross(step.normal, spring.acting);
  out.loss = f.loss + spring.loss / step.h, out.friction = spring.loss;
  out.history = spring.spring;
  return out;
}

}  // namespace scree
