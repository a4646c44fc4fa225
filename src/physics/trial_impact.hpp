// Trial impacts: the rebound of a single contact in the steps of a run, over the phases of a step at which
// the surfaces can meet.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/trial_steps.hpp"

namespace scree {

// Rebound velocity over the approach speed: normal, and tangential in the direction of the sliding before.
struct TrialRebound {
  Real restitution = 0, across = 0;

  // Rebound angle from the normal [rad].
  Real angle() const { return std::atan2(across, restitution); }
};

// Rebound of a trial in at most this many steps of h [s]; zero where the contact does not open within them.
template <class Trial>
TrialRebound rebound_of(Trial trial, Real approach, Real h, int most_steps) {
  constexpr int kApart = 3;  // steps after which no earlier force acts any longer
  bool met = false;
  for (int k = 0, open = 0; k < most_steps; ++k) {
    const bool closed = trial.step(h);
    met = met || closed;
    open = met && !closed ? open + 1 : 0;
    if (open == kApart) return {trial.parting() / approach, trial.tangential_part() / approach};
  }
  return {};
}

// Result of a step size: mean over the phases, and root-mean-square error relative to the exact rebound:
// normal, over the restitution; tangential, over the rebound speed; or over a tenth of the approach speed
// where that is more.
struct TrialResult {
  TrialRebound mean, exact;
  Real normal_error = 0, across_error = 0;

  Real error() const { return std::max(normal_error, across_error); }
};

// Impacts of one pair. make(gap) makes a trial in which the surfaces meet after `gap` [s].
template <class Make>
class Trials {
 public:
  // touch: approximate duration of the undamped contact [s]. The exact rebound is found with explicit steps.
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
      const Real along = one.restitution - exact_.restitution, tangential = one.across - exact_.across;
      out.mean.restitution += one.restitution / kPhases, out.mean.across += one.across / kPhases;
      normal += along * along / kPhases, across += tangential * tangential / kPhases;
    }
    constexpr Real kLeast = 0.1;
    out.normal_error = std::sqrt(normal) / std::max(exact_.restitution, kLeast);
    out.across_error = std::sqrt(across) / std::max(std::hypot(exact_.restitution, exact_.across), kLeast);
    return out;
  }

  // Longest step up to which errors stay below `tolerance`, to 7 % [s]; at most longest_step(), at least a
  // 2000th of the contact.
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
  static constexpr int kPerContact = 5000;  // steps of the exact rebound per contact

  int most_steps(Real h) const {
    constexpr Real kContacts = 20;
    return static_cast<int>(std::min(kContacts * touch_ / h, kContacts * kPerContact)) + 10;
  }
  // Rebound with steps so short that their error is negligible.
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
