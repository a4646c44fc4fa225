// The integrator and the steps: as given in the deck, otherwise chosen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "deck/pair_laws.hpp"
#include "model/builder/build_parts.hpp"
#include "model/checks/explicit_step.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/checks/impact_trials.hpp"
#include "model/checks/limits.hpp"
#include "model/checks/memory.hpp"

namespace scree {

namespace {

// Larger numbers are mistakes; below this limit counts are exact.
constexpr Real kMostSteps = 1e12;
// From this number of particles that may touch on, explicit steps cost less than adaptive implicit ones: some
// contact is closed at all times, and friction makes implicit steps more expensive.
constexpr std::int64_t kManyParticles = 50, kManyWithFriction = 20;

// Short enough for any contact; afterwards the error controls the step [s].
Real first_step(const Model& model) {
  constexpr Real kShareOfContact = 0.05, kShareOfRun = 1e-3;
  const std::optional<PairLimit> shortest = shortest_contact(pair_limits(model));
  const Real longest = kShareOfRun * model.time.end;
  return shortest ? std::min(kShareOfContact * shortest->contact_time, longest) : longest;
}

// Largest adaptive step [s].
Real longest_step(const Model& model) {
  constexpr Real kShareOfRun = 1e-2;
  return std::min(kShareOfRun * model.time.end, unnoticed_step(model));
}

// Number of particles whose material interacts with another that it can meet.
std::int64_t touching_particles(const Model& model) {
  std::vector<bool> touches(static_cast<std::size_t>(model.contact.materials()), false);
  for (const PairLimit& limit : pair_limits(model))
    for (const int material : limit.material) touches[static_cast<std::size_t>(material)] = true;
  const std::vector<MaterialUse> uses = material_uses(model);
  std::int64_t count = 0;
  for (std::size_t m = 0; m < uses.size(); ++m) count += touches[m] ? uses[m].particles : 0;
  return count;
}

struct IntegratorChoice {
  ParticleIntegrator integrator = ParticleIntegrator::hht;
  std::string reason;
};

// The integrator that follows from keys that only one of the two supports; empty without such keys.
std::optional<IntegratorChoice> named_otherwise(const DeckTable& deck, const Model& model) {
  const DeckTable &time = deck.table("time"), &method = deck.table("integrator");
  const auto with = [](ParticleIntegrator integrator, const std::string& key) {
    return IntegratorChoice{integrator,
                            fmt::format("the deck has {}, which is of this integrator alone", key)};
  };
  for (const char* key : {"tolerance", "max_step"})
    if (time.gives(key)) return with(ParticleIntegrator::hht, fmt::format("time.{}", key));
  if (time.gives("control") && model.time.control == StepControl::adaptive)
    return with(ParticleIntegrator::hht, setting("time.control", model.time.control));
  if (method.gives("contact_events")) return with(ParticleIntegrator::hht, "integrator.contact_events");
  if (model.integrator.substeps > 1) return with(ParticleIntegrator::velocity_verlet, "integrator.substeps");
  if (model.integrator.precision == Precision::mixed)
    return with(ParticleIntegrator::velocity_verlet,
                setting("integrator.precision", model.integrator.precision));
  return std::nullopt;
}

IntegratorChoice fitting_integrator(const DeckTable& deck, const Model& model) {
  const IntegratorChoice cohesive{
      ParticleIntegrator::velocity_verlet,
      "contacts have adhesion, an attraction or liquid bridges, for which explicit steps are the default"};
  if (model.particles.totals.count == 0)  // without particles there is no other reason
    return model.is_cohesive() ? cohesive : IntegratorChoice{};
  if (const auto named = named_otherwise(deck, model)) return *named;
  const std::int64_t touching = touching_particles(model);
  if (touching == 0 && !model.is_cohesive()) return {ParticleIntegrator::hht, "no particle touches anything"};
  if (model.rolls())
    return {ParticleIntegrator::velocity_verlet,
            "contacts have rolling or twisting resistance, for which explicit steps are the default"};
  if (model.is_cohesive()) return cohesive;
  const std::int64_t many = model.rotates() ? kManyWithFriction : kManyParticles;
  const std::string count =
      fmt::format("{} may touch, {} friction", counted(touching, "particle", "particles"),
                  model.rotates() ? "with" : "without");
  if (touching < many)
    return {ParticleIntegrator::hht,
            fmt::format("{}: fewer than {}, from which on explicit steps cost less", count, many)};
  const DeckTable& time = deck.table("time");
  if (time.gives("control") && time.gives("step") && !suits_explicit(model, time.real("step")))
    return {ParticleIntegrator::hht,
            fmt::format("time.step = {:g} s is named and fixed, and too long for explicit steps",
                        time.real("step"))};
  return {ParticleIntegrator::velocity_verlet,
          fmt::format("{}: from {} on explicit steps cost less", count, many)};
}

}  // namespace

void build_time(const DeckTable& deck, Model& model) {
  const DeckTable& table = deck.table("time");
  TimeControl& time = model.time;
  time.end = table.real("end");
  time.control = table.choice<StepControl>("control");
  if (time.control == StepControl::adaptive) time.tolerance = table.real("tolerance");

  const DeckTable& method = deck.table("integrator");
  Integrator& integrator = model.integrator;
  integrator.hht_alpha = method.real("hht_alpha");
  integrator.corrected_start = method.boolean("corrected_start");
  integrator.redundant = method.choice<RedundantRows>("redundant");
  if (!method.is_automatic("particles"))
    integrator.particles = method.choice<ParticleIntegrator>("particles");
  integrator.resolve_events = method.choice<ContactEvents>("contact_events") == ContactEvents::resolved;
  integrator.substeps = static_cast<int>(method.integer("substeps"));
  integrator.precision = method.choice<Precision>("precision");
  integrator.residual_tolerance = method.real("residual_tolerance");
  integrator.correction_tolerance = method.real("correction_tolerance");
  integrator.max_iterations = static_cast<int>(method.integer("max_iterations"));
}

void choose_integrator(const DeckTable& deck, Model& model, const Share& share,
                       std::vector<ChosenValue>& chosen) {
  if (!deck.table("integrator").is_automatic("particles")) return;
  IntegratorChoice choice = fitting_integrator(deck, model);
  // Trials may round differently on other hosts.
  const bool is_explicit = share.max(choice.integrator == ParticleIntegrator::velocity_verlet ? 1 : 0) > 0;
  if (is_explicit) choice.integrator = ParticleIntegrator::velocity_verlet;
  model.integrator.particles = choice.integrator;
  chosen.push_back({"integrator", "particles", word_of(choice.integrator), choice.reason});
  if (!is_explicit || deck.table("time").gives("control")) return;
  const TimeControl fixed;
  model.time.control = StepControl::fixed, model.time.tolerance = fixed.tolerance;
  chosen.push_back({"time", "control", word_of(StepControl::fixed), ""});
}

namespace {

// Parameters that single laws of a pair in the deck have.
std::vector<AnyParameters> own_parameters(const DeckTable& pair, const Contact& contact) {
  int material[2] = {0, 0};
  for (std::size_t side = 0; side < 2 && pair.has("materials"); ++side)
    material[side] =
        static_cast<int>(std::ranges::find(contact.material_names, pair.texts("materials")[side]) -
                         contact.material_names.begin());
  std::vector<AnyParameters> all{contact.law(material[0], material[1]).own,
                                 contact.rolling_of(material[0], material[1]).own};
  if (!contact.friction.empty()) all.push_back(contact.friction_of(material[0], material[1]).own);
  return all;
}

// Throws InputError where the law of a pair has no implicit steps. needs: the words for explicit steps.
void check_attraction(const DeckTable& deck, const Contact& contact, const std::string& needs) {
  for (const DeckTable& pair : deck.table("contact").tables("pairs")) {
    for (const AnyParameters& own : own_parameters(pair, contact))
      if (const std::string reason = own->explicit_only(); !reason.empty())
        pair.fail(own->key(), fmt::format("{}: {}", needs, reason));
    for (const char* key : {"surface_energy", "work_of_adhesion"})
      if (pair.has(key) && pair.real(key) > 0 &&
          (!pair.has("adhesion") || pair.choice<Adhesion>("adhesion") == Adhesion::jkr))
        pair.fail(key, fmt::format("{}: JKR contacts break at a distance beyond touch, which implicit steps "
                                   "do not resolve; {} is possible with them",
                                   needs, setting("adhesion", Adhesion::dmt)));
    if (pair.has("attraction_range") && pair.real("attraction_range") > 0 && pair.real("attraction") > 0)
      pair.fail(
          "attraction_range",
          fmt::format("{}: implicit steps do not resolve an attraction beyond touch; without "
                      "attraction_range the attraction ends where the contact opens, which they resolve",
                      needs));
  }
}

}  // namespace

void check_integrator(const DeckTable& deck, const Model& model) {
  const Integrator& integrator = model.integrator;
  const DeckTable& method = deck.table("integrator");
  if (integrator.particles == ParticleIntegrator::velocity_verlet) {
    if (model.time.control == StepControl::adaptive)
      method.fail("particles",
                  fmt::format("{} needs \"{}\": the explicit method has no error estimate",
                              setting("time.control", model.time.control), word_of(ParticleIntegrator::hht)));
    return;
  }
  const std::string explicit_steps = setting("integrator.particles", ParticleIntegrator::velocity_verlet);
  if (integrator.substeps > 1) method.fail("substeps", "must be 1, unless " + explicit_steps);
  if (integrator.precision == Precision::mixed)
    method.fail("precision",
                fmt::format("must be \"{}\", unless {}", word_of(Precision::full), explicit_steps));
  check_attraction(deck, model.contact, "needs " + explicit_steps);
}

namespace {

// [s]
Real chosen_step(const Model& model, const Share& share, std::vector<ChosenValue>& chosen) {
  constexpr Real kShareOfRun = 1e-3;
  ExplicitStep longest = longest_explicit_step(model);
  if (longest.step == kInfinity)
    longest = {two_digits_below(kShareOfRun * model.time.end),
               "a thousandth of the run, as nothing bounds it"};
  // Trials may round differently on other hosts. A run shorter than a step is one step.
  longest.step = std::min(share.max(longest.step), model.time.end);
  chosen.push_back({"time", "step", longest.step, longest.reason});
  return longest.step;
}

Real step_of(const DeckTable& table, const Model& model, const Share& share,
             std::vector<ChosenValue>& chosen) {
  if (table.has("step")) return table.real("step");
  if (model.integrator.particles == ParticleIntegrator::velocity_verlet)
    return chosen_step(model, share, chosen);
  if (model.time.control == StepControl::fixed)
    table.fail("step", fmt::format("missing; with {} and implicit steps it must be a number above 0 [s]",
                                   setting("control", model.time.control)));
  return std::min(first_step(model), model.time.max_step);
}

}  // namespace

void build_steps(const DeckTable& deck, Model& model, const Share& share, std::vector<ChosenValue>& chosen) {
  const DeckTable& table = deck.table("time");
  TimeControl& time = model.time;
  const bool adaptive = time.control == StepControl::adaptive;
  time.max_step = table.has("max_step") ? table.real("max_step") : longest_step(model);
  time.step = step_of(table, model, share, chosen);
  time.min_step = table.has("min_step") ? table.real("min_step") : time.step / (adaptive ? 1e6 : 1e3);
  if (!table.has("max_step")) time.max_step = adaptive ? std::max(time.step, time.max_step) : time.step;
  if (time.step > time.end) table.fail("step", fmt::format("must be at most time.end = {}", time.end));
  if (time.end / time.step > kMostSteps)
    table.fail("step",
               fmt::format("must be at least time.end / {:g} = {:g}", kMostSteps, time.end / kMostSteps));
  if (time.min_step > time.step)
    table.fail("min_step", fmt::format("must be at most time.step = {}", time.step));
  if (time.max_step < time.step)
    table.fail("max_step", fmt::format("must be at least time.step = {}", time.step));
}

}  // namespace scree
