#include "model/checks/impact_trials.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "model/checks/impact_speed.hpp"
#include "model/derived/choose_law.hpp"
#include "physics/friction_trial.hpp"
#include "physics/particle_mass.hpp"
#include "physics/plausible.hpp"
#include "physics/step_limits.hpp"

namespace scree {
namespace {

// The smallest and lightest objects of one material.
struct Partner {
  Real radius = kInfinity, mass = kInfinity;  // [m], [kg]
  bool is_particle = false;
  Real inertia_factor = 0;  // of a particle, I / (m R^2)
};

// Two objects that can meet; particles come before bodies, bodies before walls. i is never a wall.
struct Partners {
  Partner i, j;

  PairSize size() const { return {i.radius, j.radius, i.mass, j.mass}; }
  Real mass() const {
    if (i.mass == kInfinity || j.mass == kInfinity) return std::min(i.mass, j.mass);
    return reduced_mass(i.mass, j.mass);
  }
  Real radius() const { return std::min(i.radius, j.radius); }
};

Partners lightest_partners(const Model& model, const std::vector<MaterialUse>& uses, const PairLimit& limit) {
  const auto use = [&](int side) -> const MaterialUse& {
    return uses[static_cast<std::size_t>(limit.material[side])];
  };
  const auto particle = [&](int side) {
    const auto& of = model.particles.totals.materials[static_cast<std::size_t>(limit.material[side])];
    return Partner{of.smallest_radius, of.smallest_mass, true, of.smallest_inertia_factor};
  };
  const auto body = [&](int side) {
    const Real of_spheres = use(side).smallest_radius;
    const Real mass = use(side).smallest_body_mass;  // 0: all have infinite mass
    return Partner{of_spheres > 0 ? of_spheres : use(side).smallest_corner_radius,
                   mass > 0 ? mass : kInfinity, false};
  };
  const bool same = limit.material[0] == limit.material[1];
  if (use(0).particles > (same ? 1 : 0) && use(1).particles > 0) return {particle(0), particle(1)};
  for (const int side : {0, 1})
    if (use(side).particles > 0)
      return {particle(side), use(1 - side).shapes > 0 ? body(1 - side) : Partner{}};
  const bool shapes = use(0).shapes + use(1).shapes > 0;
  const int side = (shapes ? use(0).shapes : use(0).corners) > 0 ? 0 : 1;
  return {body(side), use(1 - side).shapes > (same ? 1 : 0) ? body(1 - side) : Partner{}};
}

// fastest: largest speed at which the two may meet. Where the force is linear and elastic any speed is
// equivalent; one with small rotations is used.
Real trial_speed(Real fastest, const NormalLawParameters& law, const Partners& two) {
  constexpr Real kLinear = 1e-3, kAtRest = 0.01, kMost = 0.2;  // overlap over radius
  const auto speed = [&](Real share) { return overlapping_speed(law, two.mass(), share * two.radius()); };
  if (law.is_linear()) return speed(kLinear);
  return fastest > 0 ? std::min(fastest, speed(kMost)) : speed(kAtRest);
}

// The step at which the local error of an impact, in the middle of its acceleration, equals the tolerance.
Real typical_adaptive_step(const Model& model, const Partners& two, Real speed, Real touch) {
  const Real frequency = std::numbers::pi_v<Real> / touch, jerk = frequency * frequency * speed;
  Real most = 0;  // jerk of i and j over the radius
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
  trial.good_step = trials.step_within(kReboundTolerance);
  trial.any_step_good = trial.good_step == trials.longest_step();
  if (trial.adaptive_step > 0) trial.adaptive_error = trials.with(trial.adaptive_step).error();
}

// An angle at which sliding occurs and ends: a contact that slides throughout follows Coulomb's law at any
// step size.
Real incidence(Real friction) { return std::min(std::atan(2 * friction), std::numbers::pi_v<Real> / 4); }

// Parameters of the trial of a pair's lightest partners.
struct Setup {
  Partners two;
  Real speed, touch;   // approach speed [m/s]; contact time, approximately, without damping [s]
  Real incidence = 0;  // [rad]; 0: without friction
  TrialImpact impact{};
};

// Data shared by the trials of all pairs.
struct Field {
  explicit Field(const Model& of) : model(of), uses(material_uses(of)), speeds(of), laws(of.contact) {}

  const Model& model;
  std::vector<MaterialUse> uses;
  ImpactSpeeds speeds;
  PairLaws laws;
};

std::size_t pair_of(const Field& field, const PairLimit& limit) {
  return static_cast<std::size_t>(limit.material[0] * field.model.contact.materials() + limit.material[1]);
}

// Returns the result of use(law, setup), which has one type for all laws.
template <class Use>
auto with_setup(const Field& field, const PairLimit& limit, const Use& use) {
  const Partners two = lightest_partners(field.model, field.uses, limit);
  const NormalLawParameters law =
      law_of_size(field.model.contact.law(limit.material[0], limit.material[1]), two.size());
  Setup setup{two, trial_speed(field.speeds.of(limit), law, two), 0};
  setup.touch = impact_time(law, two.mass(), setup.speed);
  return field.laws.with(pair_of(field, limit), [&]<class Law>(const Law& one) {
    if constexpr (Law::Tangential::acts)
      if (two.i.is_particle) setup.incidence = incidence(one.tangential.friction);
    setup.impact = {two.size(),        two.mass(),  inertia_of(two.i),
                    inertia_of(two.j), setup.speed, std::tan(setup.incidence) * setup.speed};
    // Liquid bridges have a bound of their own on the step: they may hold partners for many contact times.
    if constexpr (requires { one.normal.dry(); })
      return use(Law{one.normal.dry(), one.tangential, one.rolling}, setup);
    else
      return use(one, setup);
  });
}

// Returns the result of use(trials) with the Trials of velocity-verlet, whatever the model's integrator is.
template <class Use>
auto with_explicit_trials(const Field& field, const PairLimit& limit, const Use& use) {
  return with_setup(field, limit, [&]<class Law>(const Law& law, const Setup& setup) {
    const auto make = [&](Real gap) { return ExplicitTrial<Law>(law, setup.impact, gap); };
    return use(Trials(law, setup.impact, setup.touch, make));
  });
}

// All data on which the trial of a pair depends, besides the model's step and integrator.
using TrialKey = std::vector<Real>;
TrialKey key_of(const Field& field, const PairLimit& limit) {
  const Contact& contact = field.model.contact;
  const std::size_t pair = pair_of(field, limit);
  TrialKey key{field.speeds.of(limit)};
  const auto add = [&](const std::vector<Real>& numbers) {
    key.insert(key.end(), numbers.begin(), numbers.end());
  };
  add(contact.laws[pair].numbers());
  if (!contact.friction.empty()) add(contact.friction[pair].numbers());
  if (!contact.rolling.empty()) add(contact.rolling[pair].numbers());
  const Partners two = lightest_partners(field.model, field.uses, limit);
  for (const auto& [radius, mass, is_particle, inertia_factor] : {two.i, two.j})
    key.insert(key.end(), {radius, mass, Real(is_particle), inertia_factor});
  return key;
}

// Caches a function of a trial for pairs with equal data.
template <class Result>
class Remembered {
 public:
  template <class Find>
  const Result& of(TrialKey key, const Find& find) {
    const auto known = results_.find(key);
    return known != results_.end() ? known->second : results_.emplace(std::move(key), find()).first->second;
  }

 private:
  std::map<TrialKey, Result> results_;
};

template <class Law>
void try_implicit(const Model& model, const Law& law, const Setup& setup, StepTrial& trial) {
  const TrialImpact& impact = setup.impact;
  const TrialMethod method{hht_coefficients(model.integrator.hht_alpha), model.integrator.resolve_events};
  if constexpr (kHasFrictionSteps<Law>)
    if (trial.is_frictional) {
      const auto make = [&](Real gap) { return FrictionTrial<Law>(law, method, impact, gap); };
      return judge(trial, Trials(law, impact, setup.touch, make));
    }
  if constexpr (!Law::kHysteretic && !Law::kStateful) {
    const auto pair = law.normal.of_pair(impact.size);
    const auto make = [&](Real gap) { return ImplicitTrial(pair, method, impact, gap); };
    judge(trial, Trials(ContactLaw<typename Law::Normal>{law.normal}, impact, setup.touch, make));
  }
}

// Trial of a pair in the steps of the model's integrator.
StepTrial try_pair(const Field& field, const PairLimit& limit) {
  const Model& model = field.model;
  const Real fastest = field.speeds.of(limit);
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  StepTrial trial{limit, 0, 0, false, false, 0, {}, 0, false, 0, 0};
  trial.is_adaptive = model.time.control == StepControl::adaptive;
  trial.step = model.time.step / (implicit ? 1 : model.integrator.substeps);
  with_setup(field, limit, [&](const auto& law, const Setup& setup) {
    trial.speed = setup.speed, trial.incidence = setup.incidence, trial.is_frictional = setup.incidence > 0;
    if (!implicit) return;
    (trial.is_adaptive ? trial.step : trial.adaptive_step) =
        typical_adaptive_step(model, setup.two, fastest > 0 ? fastest : setup.speed, setup.touch);
    try_implicit(model, law, setup, trial);
  });
  if (!implicit) with_explicit_trials(field, limit, [&](const auto& trials) { judge(trial, trials); });
  return trial;
}

}  // namespace

std::vector<StepTrial> try_steps(const Model& model) {
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const Field field(model);
  Remembered<StepTrial> known;
  std::vector<StepTrial> trials;
  for (const PairLimit& limit : implicit ? pair_limits(model) : explicit_pairs(model)) {
    trials.push_back(known.of(key_of(field, limit), [&] { return try_pair(field, limit); }));
    trials.back().limit = limit;
  }
  return trials;
}

std::vector<PairLimit> explicit_pairs(const Model& model) {
  std::vector<PairLimit> limits = pair_limits(model);
  std::erase_if(limits, [](const PairLimit& limit) { return limit.explicit_step == 0; });
  return limits;
}

struct ExplicitTrials::Impl {
  explicit Impl(const Model& model) : field(model) {}
  Field field;
  Remembered<Real> good_steps, errors;
};

ExplicitTrials::ExplicitTrials(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
ExplicitTrials::~ExplicitTrials() = default;

Real ExplicitTrials::good_step(const PairLimit& limit) {
  return impl_->good_steps.of(key_of(impl_->field, limit), [&] {
    return with_explicit_trials(impl_->field, limit,
                                [](const auto& trials) { return trials.step_within(kReboundTolerance); });
  });
}

Real ExplicitTrials::error(const PairLimit& limit, Real step) {
  TrialKey key = key_of(impl_->field, limit);
  key.push_back(step);
  return impl_->errors.of(std::move(key), [&] {
    return with_explicit_trials(impl_->field, limit,
                                [&](const auto& trials) { return trials.with(step).error(); });
  });
}

}  // namespace scree
