#include "model/checks/explicit_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "model/checks/body_load.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/checks/impact_trials.hpp"
#include "model/checks/limits.hpp"
#include "model/derived/mesh_corners.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

std::string pair_name(const Model& model, const PairLimit& limit) {
  const std::vector<std::string>& names = model.contact.material_names;
  return fmt::format("\"{}\" on \"{}\"", names[static_cast<std::size_t>(limit.material[0])],
                     names[static_cast<std::size_t>(limit.material[1])]);
}

// Keeps the smaller step.
void bound(ExplicitStep& step, Real by, const std::string& reason) {
  if (by < step.step) step = {by, reason};
}

bool is_jkr(const Model& model, const PairLimit& limit) {
  const NormalLawParameters& law = model.contact.law(limit.material[0], limit.material[1]);
  return law.jkr && law.is_cohesive();
}

// Allowed phase per step of a body's oscillation on the vertices of its mesh [rad]: a body that joints hold
// may never lie on a plane.
Real corner_phase(bool held) { return held ? kMostBodyPhase : kGoodBodyPhase; }

void bound_by_bodies(const Model& model, ExplicitStep& step) {
  const Real substeps = model.integrator.substeps;
  bound(step, body_step_limit(model).good_step(),
        fmt::format("{:g} rad of the oscillation of a body on its contacts", kGoodBodyPhase));
  for (const bool held : {false, true}) {
    const Real phase = corner_phase(held), frequency = fastest_on_corners(model, held).frequency;
    if (frequency > 0)
      bound(step, phase / frequency,
            fmt::format("{:g} rad of the oscillation of a body on the vertices of its mesh", phase));
  }
  // A loaded body takes the steps of the particles.
  if (const std::optional<LoadedStep> loaded = shortest_loaded_step(model))
    bound(step, substeps * loaded->step,
          fmt::format(
              "{:g} rad of the oscillation of body \"{}\" under {} particles, as many as can touch it",
              kGoodLoadedPhase, model.bodies[static_cast<std::size_t>(loaded->body)].name, loaded->contacts));
}

void bound_by_pair(const Model& model, ExplicitTrials& trials, const PairLimit& limit, ExplicitStep& step) {
  const std::string name = pair_name(model, limit);
  const Real substeps = model.integrator.substeps;
  bound(step, substeps * kStableStepFraction * limit.explicit_step,
        fmt::format("{:.2g} of the stability limit in dense contacts of {}", kStableStepFraction, name));
  if (is_jkr(model, limit))
    bound(step, substeps * kPullOffShare * limit.contact_time,
          fmt::format("{:g} of the shortest contact of {}, which breaks within a small part of it",
                      kPullOffShare, name));
  bound(step, substeps * limit.longest_step, limit.law.own->step_reason(name));
  // Trials are expensive: where the step is short enough, the longest good step need not be found.
  if (step.step < kInfinity && trials.error(limit, step.step / substeps) < kReboundTolerance) return;
  bound(step, substeps * trials.good_step(limit),
        fmt::format("the longest with which trial rebounds of {} are within {:g} %", name,
                    100 * kReboundTolerance));
}

}  // namespace

Real two_digits_below(Real x) {
  if (!std::isnormal(x)) return x;  // from partners of negligible mass or size
  constexpr Real kRoundOff = 1e-12;
  const int exponent = static_cast<int>(std::floor(std::log10(x))) - 1;
  const Real digits = std::floor(x / std::pow(Real(10), exponent) * (1 + kRoundOff));
  return std::stod(fmt::format("{:.0f}e{}", digits, exponent));  // the value that a deck with this text has
}

ExplicitStep longest_explicit_step(const Model& model) {
  ExplicitStep step;
  const Real substeps = model.integrator.substeps;
  bound_by_bodies(model, step);
  bound(step, substeps * unnoticed_step(model),
        "half of the smallest radius at the fastest speed that is known beforehand");
  const std::vector<PairLimit> pairs = explicit_pairs(model);
  ExplicitTrials trials(model);
  for (const PairLimit& limit : pairs) bound_by_pair(model, trials, limit, step);
  if (step.step == kInfinity) return step;
  step.step = two_digits_below(step.step);
  // Errors usually, but not always, decrease with the step.
  constexpr int kMostTries = 10;
  constexpr Real kShorter = 0.8;
  const auto errs = [&](const PairLimit& limit) {
    return trials.error(limit, step.step / substeps) >= kReboundTolerance;
  };
  for (int k = 0; k < kMostTries && std::ranges::any_of(pairs, errs); ++k)
    step.step = two_digits_below(kShorter * step.step);
  return step;
}

bool suits_explicit(const Model& model, Real step) {
  if (step > body_step_limit(model).good_step()) return false;
  for (const bool held : {false, true})
    if (step * fastest_on_corners(model, held).frequency > corner_phase(held)) return false;
  const Real h = step / model.integrator.substeps;
  ExplicitTrials trials(model);
  for (const PairLimit& limit : explicit_pairs(model))
    if (h > limit.explicit_step || trials.error(limit, h) > kBadRebound) return false;
  return true;
}

std::string default_step_text(const Model& model) {
  const ExplicitStep longest = longest_explicit_step(model);
  return longest.step < kInfinity ? fmt::format("; left out, it is {:g} s: {}", longest.step, longest.reason)
                                  : "";
}

}  // namespace scree
