#include "run/step_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/choose_law.hpp"
#include "model/memory.hpp"
#include "model/plausibility.hpp"
#include "physics/particle_mass.hpp"
#include "physics/plausible.hpp"
#include "physics/rubbing_trial.hpp"
#include "physics/step_limits.hpp"

namespace scree {
namespace {

// The smallest and lightest things of one material.
struct Partner {
  Real radius = kInfinity, mass = kInfinity;  // [m], [kg]
  bool is_particle = false;
  Real inertia_factor = 0;  // of a particle, I / (m R^2)
};

// Two that can meet, particles before bodies before walls; i is never a wall.
struct Partners {
  Partner i, j;

  // As the law sees them: bodies that particles touch count as unmovable.
  PairSize size() const {
    const bool beside_particle = i.is_particle && !j.is_particle;
    return {i.radius, j.radius, i.mass, beside_particle ? kInfinity : j.mass};
  }
  Real mass() const { return j.mass < kInfinity ? reduced_mass(i.mass, j.mass) : i.mass; }
  Real radius() const { return std::min(i.radius, j.radius); }
};

Partners lightest_partners(const Model& model, const PairLimit& limit) {
  const std::vector<MaterialUse> uses = material_uses(model);
  const auto use = [&](int side) -> const MaterialUse& {
    return uses[static_cast<std::size_t>(limit.material[side])];
  };
  const auto particle = [&](int side) {
    const auto& of = model.particles.totals.materials[static_cast<std::size_t>(limit.material[side])];
    return Partner{of.smallest_radius, of.smallest_mass, true, of.smallest_inertia_factor};
  };
  const auto body = [&](int side) {
    return Partner{use(side).smallest_radius, use(side).smallest_body_mass, false};
  };
  const bool same = limit.material[0] == limit.material[1];
  if (use(0).particles > (same ? 1 : 0) && use(1).particles > 0) return {particle(0), particle(1)};
  for (const int side : {0, 1})
    if (use(side).particles > 0)
      return {particle(side), use(1 - side).shapes > 0 ? body(1 - side) : Partner{}};
  const int side = use(0).shapes > 0 ? 0 : 1;
  return {body(side), use(1 - side).shapes > (same ? 1 : 0) ? body(1 - side) : Partner{}};
}

// Where the force is linear any speed will do: one at which the two stay as they lie to each other.
Real trial_speed(const Model& model, const PairLimit& limit, const KelvinVoigt& law, const Partners& two) {
  constexpr Real kLinear = 1e-3, kAtRest = 0.01, kMost = 0.2;  // overlaps over the radius
  const auto speed = [&](Real share) { return overlapping_speed(law, two.mass(), share * two.radius()); };
  if (law.exponent == 1) return speed(kLinear);
  const Real fastest = impact_speed(model, limit);
  return fastest > 0 ? std::min(fastest, speed(kMost)) : speed(kAtRest);
}

// The step at which the local error of an impact in the middle of its acceleration is the tolerance.
Real typical_adaptive_step(const Model& model, const Partners& two, Real speed, Real touch) {
  const Real frequency = std::numbers::pi_v<Real> / touch, jerk = frequency * frequency * speed;
  Real most = 0;  // of i's and j's jerk over its radius
  for (const Partner& one : {two.i, two.j})
    if (one.mass < kInfinity) most = std::max(most, jerk * two.mass() / (one.mass * one.radius));
  const HhtCoefficients hht = hht_coefficients(model.integrator.hht_alpha);
  const Real step = std::cbrt(model.time.tolerance / (hht.error_constant * most));
  return std::clamp(step, model.time.min_step, model.time.max_step);
}

Real inertia_of(const Partner& one) {
  return one.is_particle ? moment_of_inertia(one.inertia_factor, one.mass, one.radius) : kInfinity;
}

void judge(StepTrial& trial, const auto& trials) {
  trial.result = trials.with(trial.step);
  trial.good_step = trials.step_within(kGoodRebound);
  trial.any_step_good = trial.good_step == trials.longest_step();
  if (trial.adaptive_step > 0) trial.adaptive_error = trials.with(trial.adaptive_step).error();
}

// Far enough from the normal for a slide and near enough for it to end: what slides all the time leaves as
// Coulomb's law says, whatever the steps are.
Real incidence(Real friction) { return std::min(std::atan(2 * friction), std::numbers::pi_v<Real> / 4); }

// In the steps of the model's integrator.
template <class Law>
void try_impact(const Model& model, const Law& law, const TrialImpact& impact, Real touch, StepTrial& trial) {
  if (model.integrator.particles == ParticleIntegrator::velocity_verlet) {
    const auto make = [&](Real gap) { return ExplicitTrial<Law>(law, impact, gap); };
    judge(trial, Trials(law, impact, touch, make));
    return;
  }
  const TrialMethod method{hht_coefficients(model.integrator.hht_alpha), model.integrator.resolve_events};
  if constexpr (kFrictionAlone<Law>)
    if (trial.rubs) {
      // Exact is where finer steps of this kind lead: dashpots of friction go off elsewhere in explicit ones.
      constexpr Real kFine = 1000;  // of second order
      const auto make = [&](Real gap) { return RubbingTrial<Law>(law, method, impact, gap); };
      return judge(trial, Trials(impact, touch, make, touch / kFine, make));
    }
  if constexpr (!Law::kNeck) {
    const auto pair = law.normal.of_pair(impact.size);
    const auto make = [&](Real gap) { return ImplicitTrial(pair, method, impact, gap); };
    judge(trial, Trials(ContactLaw<typename Law::Normal>{law.normal}, impact, touch, make));
  }
}

StepTrial try_pair(const Model& model, const PairLimit& limit) {
  const Partners two = lightest_partners(model, limit);
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const KelvinVoigt law = model.contact.law(limit.material[0], limit.material[1]).of_size(two.size());
  StepTrial trial{limit, trial_speed(model, limit, law, two), 0, false, false, 0, {}, 0, false, 0, 0};
  const Real touch = impact_time(law, two.mass(), trial.speed);
  trial.is_adaptive = model.time.control == StepControl::adaptive;
  trial.step = model.time.step / (implicit ? 1 : model.integrator.substeps);
  if (implicit) {
    const Real fastest = impact_speed(model, limit);
    (trial.is_adaptive ? trial.step : trial.adaptive_step) =
        typical_adaptive_step(model, two, fastest > 0 ? fastest : trial.speed, touch);
  }
  with_contact_laws(model.contact, [&]<class Law>(const std::vector<Law>& laws) {
    const int at = limit.material[0] * model.contact.materials() + limit.material[1];
    const Law& one = laws[static_cast<std::size_t>(at)];
    if constexpr (Law::Tangential::acts)
      if (two.i.is_particle) trial.incidence = incidence(one.tangential.friction);
    trial.rubs = trial.incidence > 0;
    const TrialImpact impact{two.size(),        two.mass(),  inertia_of(two.i),
                             inertia_of(two.j), trial.speed, std::tan(trial.incidence) * trial.speed};
    try_impact(model, one, impact, touch, trial);
  });
  return trial;
}

std::string percent(Real share) {
  return share < 1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string good_steps(const StepTrial& trial) {
  if (trial.any_step_good) return "any step would do";
  return fmt::format("steps up to {:.2g} s keep within {}", trial.good_step, percent(kGoodRebound));
}

Real degrees(Real angle) { return angle * 180 / std::numbers::pi_v<Real>; }

}  // namespace

std::vector<StepTrial> try_steps(const Model& model) {
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const std::vector<MaterialUse> uses = material_uses(model);
  std::vector<StepTrial> trials;
  for (const PairLimit& limit : pair_limits(model)) {
    const auto particles = [&](int side) {
      return uses[static_cast<std::size_t>(limit.material[side])].particles;
    };
    if (implicit || particles(0) + particles(1) > 0) trials.push_back(try_pair(model, limit));
  }
  return trials;
}

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
  return fmt::format(
      "time.step: steps of {:.4g} s misjudge rebounds of \"{}\" on \"{}\"{} by {}: {} instead of {}{}; steps "
      "up to "
      "{:.2g} s keep within {}{}",
      worst.step, names[static_cast<std::size_t>(worst.limit.material[0])],
      names[static_cast<std::size_t>(worst.limit.material[1])], others, percent(r.error()), rebound(r.mean),
      rebound(r.exact), worst.rubs ? fmt::format(", at {:.0f} degrees", degrees(worst.incidence)) : "",
      worst.good_step, percent(kGoodRebound),
      implicit ? fmt::format(", time.control = \"adaptive\" within {}",
                             percent(std::max(worst.adaptive_error, kLeastError)))
               : "");
}

}  // namespace scree
