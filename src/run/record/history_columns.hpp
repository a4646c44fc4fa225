// The columns of the history: name, unit, sentence and value of each in one place, and what the values are
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

namespace scree {

// One instant, complete on rank 0.
struct HistorySample {
  Real time = 0, step = 0;  // step: length of the one just taken [s]
  StepCounts counts;
  ParticleLedger particles;
  Ledger ledger, inside;                      // the latter without what drifts outside the space
  Real balance_error = 0, exchanged = 0;      // [J]
  RubbingLosses losses{};                     // parts of ledger.dissipated_contacts [J]
  std::int64_t left = 0, bodies_outside = 0;  // particles, bodies
  std::vector<Reaction> reactions;            // of the joints and drivers that are recorded
  std::vector<JointEffortSample> efforts;     // of all on joints that is recorded
  std::vector<JointReading> coordinates;      // of the joints that are recorded
  std::vector<BushingSample> bushings;        // those that are recorded
  std::vector<ContactSum> contacts;           // per entry of Output::history_contacts
  std::vector<BodyMotion> bodies;             // all of them, where some are recorded
  std::vector<TracedParticle> traced;         // per entry of Output::history_particles; NaN: removed
};

struct RecordedColumn {
  HistoryColumn head;
  std::function<Real(const HistorySample&)> value;
};

// reactions, efforts, coordinates, bushings: of any sample; they name the joints, what acts on them, and the
// bushings.
std::vector<RecordedColumn> history_columns(const Model& model, const std::vector<Reaction>& reactions,
                                            const std::vector<JointEffortSample>& efforts = {},
                                            const std::vector<JointReading>& coordinates = {},
                                            const std::vector<BushingSample>& bushings = {});

}  // namespace scree
