// Writes history rows and snapshots from the states of particles and bodies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupling/body_coupling.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"
#include "output/history.hpp"
#include "output/snapshot.hpp"
#include "run/record/body_points.hpp"
#include "run/record/history_columns.hpp"
#include "run/record/joint_lines.hpp"
#include "run/record/mesh_surfaces.hpp"
#include "run/record/stop_conditions.hpp"
#include "run/state/records.hpp"
#include "run/state/state.hpp"

namespace scree {

class Recorder : public Records {
 public:
  // Continues existing files after state.history_rows rows and state.snapshots snapshots, or starts new
  // files.
  Recorder(const Model& model, Backend& backend, const BodyCoupling& link, const std::string& directory,
           const State& state);
  ~Recorder() override;
  Recorder(const Recorder&) = delete;  // the backend holds its address
  Recorder& operator=(const Recorder&) = delete;

  void history(State& state, Real h) override;
  void sample_energies(State& state) override;
  // Called after a restart with another deck. The change of the energies by the new deck counts neither as
  // balance error nor as exchanged; the balance continues from its last sample.
  void rebase_balance(State& state);
  // Takes a snapshot. On a single rank an asynchronous backend continues with its steps meanwhile, and the
  // snapshot is written while the host would be idle, at the latest by flush() or before the next snapshot.
  void snapshot(State& state) override;
  // Looks whether a stop condition is met at the last row of a state from a checkpoint. Collective.
  void find_stop(State& state);
  bool should_end() const override { return should_end_; }
  // The stop condition that is met, on rank 0; empty if none is.
  const std::string& stop_reason() const { return stop_reason_; }
  // Writes a pending snapshot. It is dropped if the backend fails to return the particles.
  void write_pending() override;
  // Brings all recorded data to disk.
  void flush();
  void flush_history();  // the part of rank 0 alone, at any time
  void finish();         // after the last record: flushes, and completes what is written seldom
  // Number of contacts at the last row of the history; negative before the first row.
  std::int64_t contacts() const { return contacts_; }
  std::int64_t snapshots_written() const { return snapshots_->snapshots(); }

 private:
  // A snapshot taken but not written; its particles stay in the backend until then.
  struct PendingSnapshot {
    Real time;
    GlobalId id_bound;              // above the ids of its particles
    BodyPoints bodies;              // on rank 0
    MeshSurfaces::Sample surfaces;  // on rank 0, with meshes
    ContactLines contacts;          // if the output has them
    JointLines::Sample links;       // on rank 0, if the output has them
  };

  WantedLines wanted_lines() const;
  bool writes_deferred() const;
  HistorySample take_sample(State& state, Real h) const;  // collective; updates the balance in the state
  void take_energies(const State& state, HistorySample& sample) const;
  void balance(State& state, HistorySample& sample) const;

  const Model& model_;
  Backend& backend_;
  const BodyCoupling& body_coupling_;
  std::optional<MeshSurfaces> surfaces_;  // on rank 0, with meshes
  std::optional<JointLines> links_;       // on rank 0, if the output has them
  std::vector<RecordedColumn> columns_;   // on rank 0
  std::optional<StopConditions> stops_;   // on rank 0
  std::optional<HistoryWriter> history_;  // on rank 0
  std::optional<SnapshotWriter> snapshots_;
  std::optional<PendingSnapshot> pending_;
  std::int64_t contacts_ = -1;
  std::string stop_reason_;  // on rank 0
  bool should_end_ = false;
};

}  // namespace scree
