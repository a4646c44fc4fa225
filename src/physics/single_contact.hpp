// A contact with friction and with resistance to rolling and twisting over an explicit step in single
// precision. The contact history stays in double precision, because a step changes it by less than the last
// bit of a single. For laws of `kHasSingleForm`, with the same formulas as in contact_law.hpp and
// rolling_laws.hpp to single-precision round-off; the rotation of the contact is second order in the step
// here, and exact there.
#pragma once

#include <cmath>

#include "physics/contact_law.hpp"
#include "physics/single_rolling.hpp"

namespace scree {

// A tangential law whose formulas are not those below says kDoubleOnly, as one beside another rolling law
// than AnyRolling.
template <class Tangential>
inline constexpr bool kHasOtherFormulas = requires {
  Tangential::kDoubleOnly;
};

// Laws with friction, without adhesion and without a state of the normal law. Those without friction have
// `ContactLaw::respond`.
template <class Law>
inline constexpr bool kHasSingleForm = false;
template <class Law>
requires Law::kNeedsMotion inline constexpr bool kHasSingleForm<Law> =
    Law::Tangential::acts && !Law::kHasRange && !Law::kStateful &&
    !kHasOtherFormulas<typename Law::Tangential>;

template <int kKinds>
struct SingleLoad {
  Vec3f force;           // on i [N]
  float loss;            // [W]
  Vec3f torque_i;        // [N m]
  float losses[kKinds];  // parts of the loss by `LossKind`, over the step [J]
};
template <int kKinds>
struct SingleOutcome : SingleLoad<kKinds> {
  ContactHistory history;
};

// a / b. kNear: to a few units in the last place, in an eighth of the operations; for laws with rolling
// resistance. The bits of runs with friction alone rest on correctly rounded quotients.
template <bool kNear>
SCREE_HD float single_quotient(float a, float b) {
  if constexpr (kNear)
    return a * near_reciprocal(b);
  else
    return a / b;
}

struct SingleSpring {
  Vec3 spring;   // [N]
  Vec3f acting;  // spring and dashpot [N]
  float loss;    // over the step [J]
};

template <bool kNear>
SCREE_HD SingleSpring single_spring_step(const SingleSlider& p, const SinglePair& pair, Vec3 old) {
  const Vec3f start = in_single(old), first = cross(pair.turn, start);
  const bool shrinks = p.stiffness < p.stiffness0;
  const float retained = shrinks ? p.stiffness / p.stiffness0 : 1;
  float step_stiffness = p.stiffness;
  if (p.stiffness > p.stiffness0)
    step_stiffness = single_quotient<kNear>(
        p.stiffness * p.stiffness + p.stiffness * p.stiffness0 + p.stiffness0 * p.stiffness0,
        1.5f * (p.stiffness + p.stiffness0));
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
    out.loss =
        single_quotient<kNear>(dot(retained * start + out.acting, (1 - share) * trial), 2 * step_stiffness);
    out.spring = Real(share) * out.spring;
  } else {
    out.acting = in_single(out.spring);
    if (p.dashpot > 0) {
      const Vec3f sum = out.acting + single_quotient<kNear>(p.dashpot, pair.h) * displacement;
      const float length = dot(sum, sum);
      const Vec3f spring = out.acting;
      out.acting = length > p.limit * p.limit ? (p.limit * root_and_inverse(length).inverse) * sum : sum;
      out.loss = dot(out.acting - spring, displacement);
    }
  }
  if (shrinks)
    out.loss += (1 - retained) / 2 *
                (single_quotient<kNear>(dot(start, start), p.stiffness0) + dot(start, displacement));
  else if (p.stiffness > p.stiffness0) {
    const Vec3f spring = in_single(out.spring);
    const float after = single_quotient<kNear>(dot(spring, spring) * (p.stiffness - step_stiffness),
                                               p.stiffness * step_stiffness);
    out.loss += p.stiffness0 > 0
                    ? (after + single_quotient<kNear>(dot(start, start) * (step_stiffness - p.stiffness0),
                                                      p.stiffness0 * step_stiffness)) /
                          2
                    : after / 2;
  }
  return out;
}

SCREE_HD float single_contact_radius(const PairSizeOf<float>& size, float d) {
  return d > 0 ? std::sqrt(size.effective_radius() * d) : 0;
}

template <class Law>
SCREE_HD SingleOutcome<kLossKindsOf<Law>> single_load(const Law& law, const SinglePair& step,
                                                      const ContactHistory& old) {
  static_assert(kHasSingleForm<Law>);
  constexpr bool kNear = Law::Rolling::acts;
  const auto normal = law.normal.template as<float>().of_pair(step.size);
  const auto& g = step.geometry;
  const float rate = g.rate(step.velocity);
  const ContactForceOf<float> f = contact_force(normal, g.overlap, rate);
  const SinglePair pair =
      step.overlap0 < 0 ? step.over(single_quotient<kNear>(g.overlap, g.overlap - step.overlap0)) : step;
  const float radius = single_contact_radius(step.size, g.overlap),
              radius0 = single_contact_radius(step.size, step.overlap0);
  const auto stiffness = [&](float of) { return static_cast<float>(law.tangential.stiffness_at(of)); };
  const float load = f.force > 0 ? f.force : 0;
  SingleSlider slider{
      stiffness(radius), stiffness(radius0), 0,
      single_quotient<kNear>(static_cast<float>(law.tangential.friction) * load, step.lever_arm_ratio)};
  if (law.tangential.damping_ratio > 0) {
    const float i = step.size.radius_i, j = step.size.radius_j;
    const float inverse_mass =
        single_quotient<kNear>(1, step.size.mass_i) + single_quotient<kNear>(1, step.size.mass_j) +
        single_quotient<kNear>(i * i, step.inertia_i) + single_quotient<kNear>(j * j, step.inertia_j);
    slider.dashpot = 2 * static_cast<float>(law.tangential.damping_ratio) *
                     std::sqrt(single_quotient<kNear>(slider.stiffness, inverse_mass));
  }
  const SingleSpring spring = single_spring_step<kNear>(slider, pair, old.spring);
  SingleOutcome<kLossKindsOf<Law>> out;
  out.force = g.along(f.force) - step.lever_arm_ratio * spring.acting;
  out.torque_i = step.size.radius_i * cross(step.normal, spring.acting);
  const float at_start = step.overlap0 > 0 ? damper_power(normal, step.overlap0, radius0, rate) : 0;
  out.loss = mean_damper_power(at_start, f.loss, g.overlap + step.h * rate <= 0) +
             single_quotient<kNear>(spring.loss, step.h);
  out.losses[kFrictionLoss] = spring.loss;
  out.history = {spring.spring, {}, false};
  if constexpr (Law::Rolling::acts) {
    const SingleNormal contact{load,
                               radius,
                               radius0,
                               single_contact_stiffness(normal, g.overlap, radius),
                               single_contact_stiffness(normal, step.overlap0, radius0),
                               step.size.effective_radius()};
    const SingleMoment moment = single_moment_step(law.rolling, pair, contact, slider, old.moment);
    out.torque_i = out.torque_i - moment.acting;
    out.loss += single_quotient<kNear>(moment.rolling_loss + moment.twisting_loss, step.h);
    out.losses[kRollingLoss] = moment.rolling_loss, out.losses[kTwistingLoss] = moment.twisting_loss;
    out.history.moment = moment.spring;
  }
  return out;
}

}  // namespace scree
