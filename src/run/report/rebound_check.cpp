#include "run/report/rebound_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "model/checks/explicit_step.hpp"
#include "model/checks/memory.hpp"

namespace scree {
namespace {

std::string percent(Real share) {
  return share < 1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string good_steps(const StepTrial& trial) {
  if (trial.any_step_good) return "every step length suffices";
  return fmt::format("steps up to {:g} s: error at most {}", two_digits_below(trial.good_step),
                     percent(kReboundTolerance));
}

Real degrees(Real angle) { return angle * 180 / std::numbers::pi_v<Real>; }

}  // namespace

std::string rebound_lines(const StepTrial& trial) {
  const TrialResult& r = trial.result;
  const std::string steps = trial.is_adaptive ? fmt::format("adaptive steps of about {:.2g} s", trial.step)
                                              : fmt::format("steps of {:.4g} s", trial.step);
  const bool linear = trial.limit.law.is_linear();
  std::string lines = fmt::format("               restitution{}: {:.4g}{}; in {}: {:.4g}, error {}; {}\n",
                                  linear ? "" : fmt::format(" at {:.3g} m/s", trial.speed),
                                  r.exact.restitution, trial.is_frictional ? " (normal)" : "", steps,
                                  r.mean.restitution, percent(r.normal_error), good_steps(trial));
  if (trial.is_frictional)
    lines += fmt::format(
        "               impact at {:.0f} degrees: rebound at {:.1f} degrees, in these steps at {:.1f}, error "
        "{}\n",
        degrees(trial.incidence), degrees(r.exact.angle()), degrees(r.mean.angle()), percent(r.across_error));
  return lines;
}

std::string step_warning(const Model& model) {
  constexpr Real kLeastError = 1e-4;  // smallest error that the estimate of a single step resolves
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
    return fmt::format("restitution {:.4g}{}", one.restitution,
                       worst.is_frictional ? fmt::format(" and {:.1f} degrees", degrees(one.angle())) : "");
  };
  const std::string others =
      bad.size() == 1
          ? ""
          : fmt::format(", and of {},", counted(std::ssize(bad) - 1, "other pair", "other pairs"));
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const std::string remedy = implicit ? fmt::format(
                                            "; the error is at most {1} with steps up to {0:g} s, and {2} "
                                            "with time.control = \"adaptive\"",
                                            two_digits_below(worst.good_step), percent(kReboundTolerance),
                                            percent(std::max(worst.adaptive_error, kLeastError)))
                                      : default_step_text(model);
  return fmt::format(
      "time.step: with steps of {:.4g} s the rebound of \"{}\" on \"{}\"{} has an error of {}: {} instead of "
      "{}{}{}",
      worst.step, names[as_size(worst.limit.material[0])], names[as_size(worst.limit.material[1])], others,
      percent(r.error()), rebound(r.mean), rebound(r.exact),
      worst.is_frictional ? fmt::format(", at {:.0f} degrees", degrees(worst.incidence)) : "", remedy);
}

}  // namespace scree
