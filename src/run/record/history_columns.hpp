// The columns of the history: name, unit, description and value of each, and the sample that the values are
// taken from.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "coupling/coupled_step.hpp"
#include "coupling/ledger.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"
#include "output/history.hpp"
#include "run/state/state.hpp"

namespace scree {

// Particles born and removed up to one instant.
struct PopulationSample {
  std::vector<std::int64_t> born, waiting, dropped;  // per inserter
  std::vector<std::int64_t> removed;                 // per outlet
  std::vector<Real> removed_mass;                    // per outlet [kg]
  std::int64_t particles = 0;                        // in the run: those at t = 0 and born, less removed ones
  Real born_mass = 0;                                // of all inserters [kg]
};
PopulationSample population_sample(const Model& model, const State& state);

// The quantities of one instant, complete on rank 0.
struct HistorySample {
  Real time = 0, step = 0;  // step: length of the last step [s]
  StepCounts counts;
  ParticleLedger particles;
  Ledger ledger, inside;                      // inside: without particles outside the domain
  Real balance_error = 0, exchanged = 0;      // [J]
  TangentialLosses losses{};                  // parts of ledger.dissipated_contacts [J]
  std::int64_t left = 0, bodies_outside = 0;  // escaped particles; bodies outside the domain
  PopulationSample population;
  std::vector<Reaction> reactions;         // of the recorded joints and drivers
  std::vector<JointEffortSample> efforts;  // of the recorded elements on joints
  std::vector<JointReading> coordinates;   // of the recorded joints
  std::vector<BushingSample> bushings;     // of the recorded bushings
  std::vector<ContactSum> contacts;        // per entry of Output::history_contacts
  std::vector<RegionSums> regions;         // per entry of Output::history_regions
  std::vector<BodyMotion> bodies;          // all bodies, if some are recorded
  std::vector<TracedParticle> traced;      // per entry of Output::history_particles; NaN: removed particle
};

struct RecordedColumn {
  HistoryColumn head;
  std::function<Real(const HistorySample&)> value;
};

// reactions, efforts, coordinates, bushings: of any sample; the columns take their names from them.
std::vector<RecordedColumn> history_columns(const Model& model, const std::vector<Reaction>& reactions,
                                            const std::vector<JointEffortSample>& efforts = {},
                                            const std::vector<JointReading>& coordinates = {},
                                            const std::vector<BushingSample>& bushings = {});

}  // namespace scree
