// The contact history of a rank's particles on its GPU: src/dem/host/cpu_history.hpp for device memory.
#pragma once

#include <optional>
#include <vector>

#include "dem/history/history_slots.hpp"
#include "dem/history/packed_history.hpp"
#include "device.cuh"
#include "device_list.cuh"
#include "device_surfaces.cuh"
#include "packed_history_rows.cuh"
#include "particle_arrays.cuh"

namespace scree {

class DeviceHistory {
 public:
  // Memory that is free while a list is built: the second arrays except during the sort, and the arrays of
  // explicit steps.
  struct ScratchArrays {
    SecondArrays& second;
    DeviceArena& of_steps;
  };
  // If `content` has no history, the functions below do nothing. Work without a device argument is queued on
  // the stream.
  DeviceHistory(HistoryContent content, const PeriodicBox& box, cudaStream_t stream,
                const ScratchArrays& scratch);

  bool exists() const { return content_.exists(); }
  bool at_slots() const { return at_slots_; }
  // For loops over the list outside a run of explicit steps. ahead: the history of contacts with surfaces is
  // in the arrays of the next step.
  HistoryViews views(bool ahead = false);

  // In a run of explicit steps the device numbers the steps, starting from first_step().
  void begin_run();
  const Real* first_step() const { return first_step_.data(); }
  HistoryViews views_in_run();
  HistoryViews surface_views_in_run(bool ahead);            // for surfaces only
  void closed(Index steps) { step_ = run_start_ + steps; }  // since the start of the run
  void accepted() { closed_last(), commit_next(); }
  void closed_last() { step_ += 1; }  // one more than the last closed() reported
  HistoryContent content() const { return content_; }
  Real step() const { return step_; }  // grows by one with each closed step, with or without a history
  // Makes the next history of contacts with surfaces the present one; in a run this happens when the
  // velocities of the open step are copied into the state.
  void commit_next() { bodies_.swap(ahead_), features_.swap(next_features_); }
  // For a second evaluation of the contacts with bodies over the step that was closed last: reads the history
  // before that step and writes the one after. ahead: whether the latter is in the arrays of the next step.
  HistoryViews views_before(bool ahead);

  // The list with the present positions of its items, including ghosts and surfaces on bodies.
  struct Listed {
    const Vec4* position;
    const std::int64_t* row_key;
    Index owned;
    const DeviceList& list;
    const DeviceSurfaces& surfaces;
  };
  // pack_history packs the history before a list is rebuilt, and waits; unpack_history unpacks it into the
  // slots of the new list.
  void pack_history(const Listed& at);
  void unpack_history(const Listed& at);
  // The packed rows in the order of the particles; for kernels between the two.
  StoredRows stored_contacts();
  // Also between the two, following the particles: replaces the rows, reorders them, appends rows of arriving
  // particles. numbers: scratch for one `Index` per particle.
  void load(const PackedHistory& contacts, Index owned);
  void reorder(const Index* order, Index n, Index* numbers);
  void append(const PackedHistory& arriving, Index owned);

  // Packed history of these particles, in this order, on the host; only between the two. Waits.
  PackedHistory rows(const Index* particles, Index n);
  // Packed history of all particles, in their order, at any time.
  PackedHistory contacts(const Listed& at);

  // Memory of the slots' records [B].
  std::size_t bytes() const {
    return neighbors_.bytes() + ground_.bytes() + bodies_.bytes() + ahead_.bytes();
  }

 private:
  // Packed rows of contacts on the device, laid out as in `PackedHistory`.
  struct Rows {
    DeviceArray<Index> offsets;  // [rows + 1]
    DeviceArray<std::int64_t> keys;
    DeviceArray<Real> values;
  };
  int width() const { return content_.values; }
  // Counts the contacts of `count` rows from `first` on into rows.offsets; the second one writes the
  // contacts, whose arrays must be sized.
  std::size_t count_rows(Rows& rows, const Listed& at, Index first, Index count);
  void fill_rows(const PackedHistoryViews& rows, const Listed& at, Index first, Index count);
  // Converts row lengths to offsets; returns the number of contacts. Waits.
  std::size_t add_up(Rows& rows, Index count);
  void reserve_entries(Rows& rows, std::size_t contacts) const;
  PackedHistory download(const Rows& rows, const PackedHistoryViews& parts) const;
  PackedHistoryViews packed_history_views();
  PackedHistoryViews lay_out_parts(std::size_t contacts);
  bool lay_out_in_records(std::size_t contacts);
  void clear_records();

  const HistoryContent content_;
  const PeriodicBox box_;
  const cudaStream_t stream_;
  const ScratchArrays scratch_arrays_;
  bool at_slots_ = false;
  DeviceArray<Vec4> neighbors_, ground_, bodies_, ahead_;  // the arrays of `HistoryViews`; empty if
                                                           // `kSidesOnly`
  DeviceArray<Index> features_, next_features_;
  Real step_ = 2, run_start_ = 2;  // number of the step; 1 is the state before the first
  DeviceArray<Real> first_step_;
  PinnedArray<Real> h_first_step_;
  // The packed history while a list is built, and the row in it of each particle. It uses the memory of the
  // slots' records or, while the records are read or written, parts of other arrays.
  Rows stored_;
  bool in_records_ = false;
  std::optional<PackedHistoryViews> parts_;
  DeviceArray<std::int64_t> rest_keys_;  // keys and values of the last part
  DeviceArray<Real> rest_values_;
  DeviceArray<Index> row_of_;
  Rows packed_;                       // on the way to the host
  DeviceArray<unsigned char> space_;  // scratch of library calls
  PinnedArray<Index> h_count_{1};
};

}  // namespace scree
