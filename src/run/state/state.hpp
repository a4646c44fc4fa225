// State: all variables that change in time, and the particles' constants. A checkpoint stores exactly this.
#pragma once

#include <string>
#include <vector>

#include "coupling/coupled_step.hpp"
#include "coupling/ledger.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "output/checkpoint.hpp"
#include "run/population/outlets.hpp"
#include "run/population/population_state.hpp"
#include "run/state/step_clock.hpp"
#include "run/state/stop_watch.hpp"

namespace scree {

// Extremes of energies over sample instants, which depend on the number of steps alone (next_energy_sample)
// [J].
struct EnergyExtremes {
  Real max_kinetic = 0;                   // of particles that have not escaped
  Real min_elastic = 0, max_elastic = 0;  // of force elements
  Real min_work = 0, max_work = 0;        // Ledger::driver_work
};

// Energy balance since t = 0. Its ledgers come from inside_ledger().
struct BalanceState {
  bool open = false;          // whether the history has its first row
  Real start = 0;             // Ledger::accounted() at t = 0 [J]
  Real start_integrator = 0;  // Ledger::dissipated_integrator at t = 0 [J]
  Real exchanged = 0;         // energy_exchanged() at the last row [J]
  // energy_exchanged() with the decks before --allow-changes changed them [J].
  Real exchanged_under_old_deck = 0;
  EnergyExtremes extremes;
  Ledger last;  // at the last row
};

struct State {
  ClockState clock;
  StepCounts counts;
  MultibodyState bodies;
  // The particles of one rank, ordered by global id; between checkpoints they are in the backend.
  std::vector<Particle> particles;
  FieldsThere there;       // fields that the particles have
  PackedHistory contacts;  // of these particles, for laws with a history
  ShapeLosses shapes;
  ShapeContacts shape_contacts;  // for laws with a history; on rank 0, between checkpoints in the backend
  // Dissipation at the triangles of meshes (TriangleWorks), if the output asks for it; in a checkpoint summed
  // over all ranks. Between checkpoints it is in the backend.
  std::vector<std::int64_t> works;
  CarriedOut carried_out;
  PopulationState population;
  OutletState outlets;
  BalanceState balance;
  std::vector<StopWatch> stop_watches;  // of the deck's stop conditions; on rank 0
  // Numbers recorded so far. All of them are on disk before a checkpoint with these numbers.
  std::int64_t history_rows = 0, snapshots = 0;
};

// Names of Ledger::carried_in and of PopulationState::waiting.
inline constexpr const char *kCarriedInName = "balance/carried_in", *kWaitingName = "population/waiting";
// Name of the dataset of State::works.
inline constexpr const char* kWorksName = "surfaces/works";
// Names of the datasets of State::shape_contacts (kShapeSides*: contacts that store their side alone) and of
// the frictional losses in ShapeLosses.
inline constexpr const char *kShapeContactsOf = "shapes/contact_shape",
                            *kShapeContactsWith = "shapes/contact_partner",
                            *kShapeHistory = "shapes/contact_history", *kShapeSidesOf = "shapes/side_shape",
                            *kShapeSidesWith = "shapes/side_partner",
                            *kShapeFrictionLosses = "shapes/rubbing_losses";
// ShapeContacts::content according to the names of the datasets: `kSidesOnly` or `kNoHistory`.
HistoryContent shape_content_in(const Checkpoint& in);
// The fields that the particles of a checkpoint have.
FieldsThere fields_there(const Checkpoint& in);
// The state as a checkpoint, with this rank's particles. It refers to the state, which must not change or end
// before it.
Checkpoint pack(const State& state);
Checkpoint pack(const State&& state) = delete;
// Hash of all bits of the state except the amounts of output and the stop watches. The hashes of ranks, each
// of its own particles, add up (modulo 2^64) to the hash of the whole. with_rest: also hashes everything
// except the particles, on one rank.
std::uint64_t state_hash(const State& state, bool with_rest);
// The state of a checkpoint, with the particles of this rank's rows. Throws IoError naming what is missing,
// on every rank. Collective.
State unpack(const Checkpoint& checkpoint, const Ranks& ranks = {});
// Number of particles that have existed, and a bound above their ids.
std::int64_t particles_so_far(const ParticleSet& particles, const PopulationState& population);
GlobalId id_bound(const ParticleSet& particles, const PopulationState& population);
// Checks a state that was read against the particles of the deck. Throws IoError naming the file, on every
// rank, if ids do not increase from particle to particle and from rank to rank, are outside [0, id_bound()),
// or are missing without a removal, or if a value is not finite. Collective.
void check_state(const State& state, const std::string& path, const ParticleSet& particles,
                 const Ranks& ranks);
// Throws IoError likewise if the radius, mass or material of a particle is outside the range of the deck.
void check_constants(const State& state, const std::string& path, const ParticleTotals& deck);

}  // namespace scree
