#include "run/report/step_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/checks/explicit_step.hpp"
#include "model/checks/memory.hpp"

namespace scree {
namespace {

std::string percent(Real share) {
  return share < 1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string good_steps(const StepTrial& trial) {
  if (trial.any_step_good) return "any step would do";
  return fmt::format("steps up to {:g} s keep within {}", two_digits_below(trial.good_step),
                     percent(kGoodRebound));
}

Real degrees(Real angle) { return angle * 180 / std::numbers::pi_v<Real>; }

}  // namespace

std::string trial_lines(const StepTrial& trial) {
  const TrialResult& r = trial.result;
  const std::string steps = trial.is_adaptive ? fmt::format("steps that adapt, to about {:.2g} s", trial.step)
                                              : fmt::format("steps of {:.4g} s", trial.step);
  const bool linear = trial.limit.law.exponent == 1;
  std::string lines =
      fmt::format("               rebounds{} with {:.4g} of the speed{}, in {} with {:.4g}, {} off; {}\n",
                  linear ? "" : fmt::format(" at {:.3g} m/s", trial.speed), r.exact.restitution,
                  trial.rubs ? " along the normal" : "", steps, r.mean.restitution, percent(r.normal_error),
                  good_steps(trial));
  if (trial.rubs)
    lines += fmt::format(
        "               at {:.0f} degrees it leaves at {:.1f} degrees, in these steps at {:.1f}, {} off\n",
        degrees(trial.incidence), degrees(r.exact.angle()), degrees(r.mean.angle()), percent(r.across_error));
  return lines;
}

std::string step_warning(const Model& model) {
  constexpr Real kLeastError = 1e-4;  // that one estimate of the step lets tell
  if (model.time.control == StepControl::adaptive) return "";
  std::vector<StepTrial> bad = try_steps(model);
  std::erase_if(bad, [](const StepTrial& trial) { return !(trial.result.error() > kBadRebound); });
  if (bad.empty()) return "";
  const StepTrial& worst = *std::max_element(bad.begin(), bad.end(), [](const auto& a, const auto& b) {
    return a.result.error() < b.result.error();
  });
  const TrialResult& r = worst.result;
  const std::vector<std::string>& names = model.contact.material_names;
  const auto rebound = [&](const TrialRebound& one) {
    return fmt::format("{:.4g} of the speed{}", one.restitution,
                       worst.rubs ? fmt::format(" and {:.1f} degrees", degrees(one.angle())) : "");
  };
  const std::string others =
      bad.size() == 1 ? ""
                      : fmt::format(", and of {}", counted(std::ssize(bad) - 1, "other pair", "other pairs"));
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const std::string remedy =
      implicit ? fmt::format("; steps up to {:g} s keep within {}, time.control = \"adaptive\" within {}",
                             two_digits_below(worst.good_step), percent(kGoodRebound),
                             percent(std::max(worst.adaptive_error, kLeastError)))
               : left_out_step(model);
  return fmt::format(
      "time.step: steps of {:.4g} s misjudge rebounds of \"{}\" on \"{}\"{} by {}: {} instead of {}{}{}",
      worst.step, names[static_cast<std::size_t>(worst.limit.material[0])],
      names[static_cast<std::size_t>(worst.limit.material[1])], others, percent(r.error()), rebound(r.mean),
      rebound(r.exact), worst.rubs ? fmt::format(", at {:.0f} degrees", degrees(worst.incidence)) : "",
      remedy);
}

}  // namespace scree
