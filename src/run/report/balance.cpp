#include "run/report/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "model/derived/mesh_corners.hpp"
#include "run/report/rebound_check.hpp"

namespace scree {
namespace {

constexpr Real kMostShare = 0.01;  // largest change of energy without a warning, over the energy exchanged
// Energy that explicit steps of the chosen length may leave unaccounted for, over the dissipation of the
// contacts.
constexpr Real kUnaccounted = 0.03;
constexpr Real kRoundOff = 1e-9;  // energies below this share of the energies present are round-off
constexpr Real kLastBits = 16 * std::numeric_limits<Real>::epsilon();  // round-off of a position, relative
constexpr std::int64_t kSamplesPerDoubling = 16;

EnergyExtremes wider(const EnergyExtremes& a, const EnergyExtremes& b) {
  return {std::max(a.max_kinetic, b.max_kinetic), std::min(a.min_elastic, b.min_elastic),
          std::max(a.max_elastic, b.max_elastic), std::min(a.min_work, b.min_work),
          std::max(a.max_work, b.max_work)};
}

// Energies below this are round-off [J]. The term with the particles' weights covers sums that cancel and
// positions far from the origin.
Real round_off(const Ledger& ledger, const Model& model) {
  Real all = 0;
  for (const Real entry : ledger.entries()) all += std::abs(entry);
  const Real far = std::max(norm(model.space.min), norm(model.space.max));
  const Real weights = static_cast<Real>(model.particles.totals.count) * model.particles.totals.largest_mass *
                       norm(model.gravity);
  return kRoundOff * all + kLastBits * weights * far;
}

// Relative error of the energy of one impact in the steps of a trial, from the errors of the normal and the
// tangential rebound velocity.
Real energy_error(const StepTrial& trial) {
  const TrialResult& r = trial.result;
  const Real normal = r.exact.restitution, tangential = std::abs(r.exact.across);
  const Real slope =
      trial.is_frictional ? std::tan(trial.incidence) : 0;  // tangential over normal approach velocity
  const Real relative_error =
      normal * normal * r.normal_error + tangential * std::max(tangential, Real(0.1)) * r.across_error;
  return 2 * relative_error / (1 + slope * slope);
}

// The largest energy error of the deck's impacts in its explicit steps. Empty for bodies with shapes and for
// meshes that touch planes: no trial covers contacts of bodies, which take steps of their own.
std::optional<Real> impact_error(const Model& model) {
  const auto has_shapes = [](const Body& body) { return !body.shapes.empty(); };
  if (std::ranges::any_of(model.bodies, has_shapes) || largest_corner_radius(model) > 0) return {};
  std::optional<Real> largest;
  for (const StepTrial& trial : try_steps(model))
    largest = std::max(largest.value_or(0), energy_error(trial));
  return largest;
}

// after: text that follows the share within the sentence.
std::string share_text(Real energy, Real exchanged, const char* after = "") {
  return exchanged > 0 ? fmt::format(", {:.2g} % of the {:.4g} J exchanged{}", 100 * energy / exchanged,
                                     exchanged, after)
                       : "";
}

// The message where explicit steps resolve the impacts: the energy is missing in the accounting alone.
std::string accounting_warning(const BalanceState& balance, Real error, Real impacts) {
  return fmt::format(
      "{:.3g} J{} are not accounted for: of the dissipation of contacts, {:.3g} J here, explicit steps "
      "integrate that of dashpots of friction and rolling to first order in time.step only. The motion is of "
      "second order: the energy of impacts in these steps is right within {:.2g} % (scree check prints the "
      "rebounds). A shorter time.step reduces the balance error",
      std::abs(error), share_text(std::abs(error), balance.exchanged, ","), balance.last.dissipated_contacts,
      100 * impacts);
}

std::string remedy(const Model& model, std::optional<Real> impacts) {
  if (model.integrator.particles == ParticleIntegrator::velocity_verlet)
    return impacts.value_or(0) > kMostShare
               ? fmt::format(
                     "shorten time.step: in these steps the energy of impacts is off by up to {:.2g} % "
                     "(scree check prints the rebounds)",
                     100 * *impacts)
               : "shorten time.step";
  return model.time.control == StepControl::adaptive
             ? "lower time.tolerance, or bring integrator.hht_alpha nearer to 0"
             : "shorten time.step, or set " + setting("time.control", StepControl::adaptive);
}

}  // namespace

std::int64_t next_energy_sample(std::int64_t steps, bool implicit) {
  const std::int64_t least = implicit ? 4 : 128, most = implicit ? 8 : 1024;
  const std::int64_t doubling =
      static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(std::max(steps, std::int64_t{1}))));
  const std::int64_t interval = std::clamp(doubling / kSamplesPerDoubling, least, most);
  return (steps / interval + 1) * interval;
}

EnergyExtremes extremes_at(Real kinetic, Real elastic, const MultibodyState& bodies) {
  return {kinetic, elastic, elastic, bodies.driver_work, bodies.driver_work};
}

Real energy_exchanged(const EnergyExtremes& extremes, const MultibodyState& bodies, const Ledger& now) {
  return extremes.max_kinetic + (bodies.max_kinetic - bodies.min_kinetic) +
         (extremes.max_elastic - extremes.min_elastic) + (extremes.max_work - extremes.min_work) +
         now.dissipated_contacts + now.dissipated_force_elements;
}

void add_sample(BalanceState& balance, const EnergyExtremes& now) {
  balance.extremes = wider(balance.extremes, now);
}

void add_row(BalanceState& balance, const Ledger& ledger, const EnergyExtremes& now,
             const MultibodyState& bodies) {
  if (!balance.open) balance = {true, ledger.accounted(), ledger.dissipated_integrator, 0, 0, now, ledger};
  balance.exchanged = std::max(balance.exchanged_under_old_deck,
                               energy_exchanged(wider(balance.extremes, now), bodies, ledger));
  balance.last = ledger;
}

void rebase(BalanceState& balance, const Ledger& ledger, const EnergyExtremes& now) {
  if (!balance.open) return;
  balance.start += ledger.accounted() - balance.last.accounted();
  balance.start_integrator += ledger.dissipated_integrator - balance.last.dissipated_integrator;
  balance.exchanged_under_old_deck = balance.exchanged;
  balance.extremes = now;
  balance.last = ledger;
}

// The round-off has three terms: the energy that the forces could exchange, the weights times their distances
// from the origin, and the kinetic energy of velocities that result from the last bits of positions. In a
// system without motion all energies, and the energy exchanged, are that small.
BodyBalance body_balance(const Model& model, const Multibody& bodies, const State& state) {
  const Real t = state.clock.time;
  const MultibodyEnergies energies = bodies.energies(state.bodies, t);
  const std::vector<BodyMotion> motion = bodies.motion(state.bodies);
  Real weights = 0, moves = 0;
  for (std::size_t b = 0; b < motion.size(); ++b) {
    const Real far = norm(motion[b].position), mass = model.bodies[b].mass;
    weights += mass * norm(model.gravity) * far;
    moves += mass / 2 * far * far;
  }
  const Real rate = kLastBits * static_cast<Real>(state.counts.steps) / std::max(t, model.time.min_step);
  const Real small = kRoundOff * (bodies.energy_of_forces(state.bodies) + weights) + moves * rate * rate;
  return {energies.kinetic + std::abs(energies.elastic), state.bodies.integrator_loss, small};
}

// HHT has a ledger entry for its numerical dissipation. The effect of velocity-Verlet on contacts is the
// balance error; its own ledger entry is a function of the state and oscillates. Bodies may hold much energy
// and exchange almost none, for example a crank driven at constant speed: energy taken out of bodies is then
// compared with the energy that they hold.
std::string balance_warning(const BalanceState& balance, const BodyBalance& bodies, const Model& model) {
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const Real error = balance_error(balance), taken = taken_by_integrator(balance);
  const Real noise = round_off(balance.last, model) + bodies.round_off;
  Real counts = std::abs(implicit ? taken : bodies.taken);
  if (std::abs(bodies.taken) <= kMostShare * bodies.held)
    counts = implicit ? std::min(counts, std::abs(taken - bodies.taken)) : 0;
  const Real most = std::max(kMostShare * balance.exchanged, noise);
  if (!(std::max(std::abs(error), counts) > most)) return "";
  const std::optional<Real> impacts = implicit ? std::nullopt : impact_error(model);
  const bool accounting = impacts && *impacts <= kMostShare && balance.last.dissipated_contacts > 0;
  if (accounting && counts <= most)
    return std::abs(error) <= kUnaccounted * balance.last.dissipated_contacts
               ? ""
               : accounting_warning(balance, error, *impacts);
  const Real largest = std::max(std::abs(error), counts);
  return fmt::format(
      "the time integration has changed the energy by {:.3g} J{} (it took out {:.3g} J, and {:.3g} J are not "
      "accounted for): {}",
      largest, share_text(largest, balance.exchanged), taken, std::abs(error) > noise ? error : 0,
      remedy(model, impacts));
}

}  // namespace scree
