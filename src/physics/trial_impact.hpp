// What steps of a given length make of an impact: one contact by itself, in the steps that a run takes, over
// the phases of a step at which the surfaces can meet.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/trial_steps.hpp"

namespace scree {

// After an impact, over the speed of approach: the velocity at which the two part, along the normal and
// across it, in the direction of the sliding before.
struct TrialRebound {
  Real restitution = 0, across = 0;

  // Of the way on which they part, from the normal [rad].
  Real angle() const { return std::atan2(across, restitution); }
};

// The rebound of a trial in at most so many steps of h [s]: where the two hold each other that long there is
// none.
template <class Trial>
TrialRebound rebound_of(Trial trial, Real approach, Real h, int most_steps) {
  constexpr int kApart = 3;  // steps after which no force of before is felt any longer
  bool met = false;
  for (int k = 0, open = 0; k < most_steps; ++k) {
    const bool closed = trial.step(h);
    met = met || closed;
    open = met && !closed ? open + 1 : 0;
    if (open == kApart) return {trial.parting() / approach, trial.across() / approach};
  }
  return {};
}

// What a step gives: its mean over the phases, and how far single ones are from the exact rebound, as root
// mean square: along the normal over its restitution, across over its velocity, or a tenth of the speed of
// approach where that is more.
struct TrialResult {
  TrialRebound mean, exact;
  Real normal_error = 0, across_error = 0;

  Real error() const { return std::max(normal_error, across_error); }
};

// Impacts of one pair. make(gap) makes the trial of two that meet after so long [s] in the steps that are
// tried.
template <class Make>
class Trials {
 public:
  // touch: the time that the contact lasts without damping, about [s]. The exact rebound is that of explicit
  // steps.
  template <class Law>
  Trials(const Law& law, const TrialImpact& impact, Real touch, const Make& make)
      : make_(make), approach_(impact.approach), touch_(touch), exact_(exact(law, impact)) {}

  TrialResult with(Real h) const {
    constexpr int kPhases = 16;
    TrialResult out{{}, exact_};
    Real normal = 0, across = 0;
    for (int k = 0; k < kPhases; ++k) {
      const Real gap = (k + Real(0.5)) / kPhases * h;
      const TrialRebound one = rebound_of(make_(gap), approach_, h, most_steps(h));
      const Real along = one.restitution - exact_.restitution, beside = one.across - exact_.across;
      out.mean.restitution += one.restitution / kPhases, out.mean.across += one.across / kPhases;
      normal += along * along / kPhases, across += beside * beside / kPhases;
    }
    constexpr Real kLeast = 0.1;
    out.normal_error = std::sqrt(normal) / std::max(exact_.restitution, kLeast);
    out.across_error = std::sqrt(across) / std::max(std::hypot(exact_.restitution, exact_.across), kLeast);
    return out;
  }

  // The longest step up to which errors stay below `tolerance`, to 7 % [s]; longest_step() where all do, and
  // not below a 2000th of the contact.
  Real step_within(Real tolerance) const {
    const auto good = [&](Real h) { return with(h).error() < tolerance; };
    Real bad = longest_step(), fine = touch_ / 2000;
    if (good(bad)) return bad;
    for (int k = 0; k < 7; ++k) {
      const Real middle = std::sqrt(bad * fine);
      (good(middle) ? fine : bad) = middle;
    }
    return fine;
  }
  Real longest_step() const { return 2 * touch_; }

 private:
  static constexpr int kPerContact = 5000;  // steps of the exact rebound

  int most_steps(Real h) const {
    constexpr Real kContacts = 20;
    return static_cast<int>(std::min(kContacts * touch_ / h, kContacts * kPerContact)) + 10;
  }
  // In steps so short that what they err is far below what is asked of them.
  template <class Law>
  TrialRebound exact(const Law& law, const TrialImpact& impact) const {
    const Real h = touch_ / kPerContact;
    TrialRebound out;
    for (const Real phase : {0.25, 0.75}) {
      const TrialRebound one =
          rebound_of(ExplicitTrial<Law>(law, impact, phase * h), approach_, h, most_steps(h));
      out.restitution += one.restitution / 2, out.across += one.across / 2;
    }
    return out;
  }

  Make make_;
  Real approach_;  // [m/s]
  Real touch_;     // [s]
  TrialRebound exact_;
};

}  // namespace scree
