// History rows and snapshots from the state of both sides.
#pragma once

#include <memory>
#include <string>

#include "coupling/body_link.hpp"
#include "dem/backend.hpp"
#include "model/model.hpp"
#include "output/history.hpp"
#include "output/snapshot.hpp"
#include "run/state.hpp"

namespace scree {

class Recorder {
 public:
  // Continues existing files after state.history_rows rows and state.snapshots snapshots, or starts new ones.
  Recorder(const Model& model, Backend& backend, const BodyLink& link, const std::string& directory,
           const State& state);

  // One row; h: length of the step just taken [s]. Updates the balance in the state.
  void history(State& state, Real h);
  void snapshot(State& state);
  void flush() { history_.flush(); }

 private:
  void energy_row(State& state, std::vector<Real>& row);
  void body_row(const State& state, std::vector<Real>& row) const;
  void particle_row(std::vector<Real>& row);

  const Model& model_;
  Backend& backend_;
  const BodyLink& link_;
  HistoryWriter history_;
  SnapshotWriter snapshots_;
};

}  // namespace scree
