// State: all that changes in time, and the particles' constants. A checkpoint stores exactly this.
#pragma once

#include <string>
#include <vector>

#include "coupling/coupled_step.hpp"
#include "coupling/ledger.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "output/checkpoint.hpp"
#include "run/state/step_clock.hpp"

namespace scree {

// Extremes of energies at instants that follow from the number of steps alone (next_energy_sample) [J].
struct EnergyExtremes {
  Real most_kinetic = 0;                     // of particles that have not left
  Real least_elastic = 0, most_elastic = 0;  // of force elements
  Real least_work = 0, most_work = 0;        // Ledger::driver_work
};

// Energy balance since t = 0. Its ledgers are those of inside_ledger().
struct BalanceState {
  bool open = false;          // whether the first row of the history was taken
  Real start = 0;             // Ledger::accounted() at t = 0 [J]
  Real start_integrator = 0;  // Ledger::dissipated_integrator at t = 0 [J]
  Real exchanged = 0;         // energy_exchanged() at the last row [J]
  Real exchanged_before = 0;  // the same with the decks before --allow-changes changed them [J]
  EnergyExtremes extremes;
  Ledger last;  // at the last row
};

struct State {
  ClockState clock;
  StepCounts counts;
  MultibodyState bodies;
  // Of one rank, ordered by global id; they live in the backend between checkpoints.
  std::vector<Particle> particles;
  FieldsThere there;      // of these
  KeptContacts contacts;  // of these, where the law remembers something
  ShapeLosses shapes;
  ShapeContacts
      shape_contacts;  // where the law remembers something; rank 0's, in the backend like the others
  // Lost at the triangles of meshes (TriangleWorks), where the output asks for it; in a checkpoint those of
  // all ranks. Between checkpoints they live in the backend, too.
  std::vector<std::int64_t> works;
  CarriedOut carried_out;
  BalanceState balance;
  // Taken so far; all of them are on disk before a checkpoint with these counts is.
  std::int64_t history_rows = 0, snapshots = 0;
};

// The dataset of State::works.
inline constexpr const char* kWorksName = "surfaces/works";
// The datasets of State::shape_contacts, the latter two where sides of sheets are all that is kept, and of
// what ShapeLosses has lost by rubbing.
inline constexpr const char *kShapeContactsOf = "shapes/contact_shape",
                            *kShapeContactsWith = "shapes/contact_partner",
                            *kShapeHistory = "shapes/contact_history", *kShapeSidesOf = "shapes/side_shape",
                            *kShapeSidesWith = "shapes/side_partner",
                            *kShapeRubbing = "shapes/rubbing_losses";
// ShapeContacts::numbers as far as the names of datasets tell: kSidesAlone, else 0.
int shape_numbers_in(const Checkpoint& in);
// Which fields the checkpoint's particles have.
FieldsThere fields_there(const Checkpoint& in);
// With this rank's particles; to be used as long as the state is there, and the same.
Checkpoint pack(const State& state);
Checkpoint pack(const State&& state) = delete;
// Of all bits of the state but the counts of what was written; several ranks' hashes, each of the particles
// of its own, add up (modulo 2^64) to that of the whole. with_rest: all but the particles, which one rank
// counts.
std::uint64_t state_hash(const State& state, bool with_rest);
// With the particles of the checkpoint's rows on this rank. Throws IoError naming what is missing, on every
// rank. Collective.
State unpack(const Checkpoint& checkpoint, const Ranks& ranks = {});
// Throws IoError naming the file, on every rank, where a read state cannot be one of a model with this number
// of particles: where ids do not increase from particle to particle and from rank to rank, are outside
// [0, particles), or are missing without having been removed, and where a value is not finite. Collective.
void check_state(const State& state, const std::string& path, std::int64_t particles, const Ranks& ranks);
// The same where a particle's radius, mass or material is none of the deck that the state belongs to.
void check_constants(const State& state, const std::string& path, const ParticleTotals& deck);

}  // namespace scree
