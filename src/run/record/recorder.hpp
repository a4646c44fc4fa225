// History rows and snapshots from the state of both sides.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupling/body_link.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"
#include "output/history.hpp"
#include "output/snapshot.hpp"
#include "run/record/body_points.hpp"
#include "run/record/history_columns.hpp"
#include "run/record/link_lines.hpp"
#include "run/record/mesh_surfaces.hpp"
#include "run/state/records.hpp"
#include "run/state/state.hpp"

namespace scree {

class Recorder : public Records {
 public:
  // Continues existing files after state.history_rows rows and state.snapshots snapshots, or starts new ones.
  Recorder(const Model& model, Backend& backend, const BodyLink& link, const std::string& directory,
           const State& state);
  ~Recorder() override;
  Recorder(const Recorder&) = delete;  // the backend knows its address
  Recorder& operator=(const Recorder&) = delete;

  void history(State& state, Real h) override;
  void sample_energies(State& state) override;
  // After a restart with another deck: what that adds to the energies or takes from them, at this instant, is
  // neither a balance error nor exchanged. The balance goes on from its last sample.
  void rebase_balance(State& state);
  // Takes one. On one rank a backend that computes asynchronously goes on with its steps, and the snapshot is
  // written while the host would only wait for them, at the latest by flush() or before the next one.
  void snapshot(State& state) override;
  // Where the backend fails to hand out the particles, the snapshot is given up.
  void write_pending() override;
  // Brings all that was recorded to disk.
  void flush();
  void flush_history();  // rank 0's part of it alone, at any time
  void finish();         // after the last record: flushes, and brings up to date what is written seldom
  // Touching, at the last row of the history; below zero before the first.
  std::int64_t contacts() const { return contacts_; }
  std::int64_t snapshots_written() const { return snapshots_->snapshots(); }

 private:
  // Taken; its particles are with the backend until they are written.
  struct PendingSnapshot {
    Real time;
    BodyPoints bodies;            // on rank 0
    MeshSurfaces::Look surfaces;  // likewise, where there are meshes
    ContactLines contacts;        // where they are shown
    LinkLines::Look links;        // on rank 0, where they are shown
  };

  WantedLines wanted_lines() const;
  bool writes_late() const;
  HistorySample take_sample(State& state, Real h) const;  // collective; updates the balance in the state
  void take_energies(const State& state, HistorySample& sample) const;
  void balance(State& state, HistorySample& sample) const;

  const Model& model_;
  Backend& backend_;
  const BodyLink& link_;
  std::optional<MeshSurfaces> surfaces_;  // on rank 0, where there are meshes
  std::optional<LinkLines> links_;        // likewise, where they are shown
  std::vector<RecordedColumn> columns_;   // on rank 0
  std::optional<HistoryWriter> history_;  // likewise
  std::optional<SnapshotWriter> snapshots_;
  std::optional<PendingSnapshot> pending_;
  std::int64_t contacts_ = -1;
};

}  // namespace scree
