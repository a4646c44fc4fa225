// What the contacts of a rank's particles remember, on its GPU: src/dem/host/cpu_history.hpp for device
// memory.
#pragma once

#include <optional>
#include <vector>

#include "dem/history/history_slots.hpp"
#include "dem/history/kept_contacts.hpp"
#include "device.cuh"
#include "device_list.cuh"
#include "device_surfaces.cuh"
#include "kept_rows.cuh"
#include "particle_arrays.cuh"

namespace scree {

class DeviceHistory {
 public:
  // Memory that is free while a list is built: the second arrays but for the sort, the room of explicit steps
  // all the time.
  struct Rooms {
    SecondArrays& second;
    DeviceRoom& of_steps;
  };
  // numbers: per contact, or kSidesAlone; 0: nothing below does anything. What is queued without a device
  // goes to the stream.
  DeviceHistory(int numbers, const PeriodicBox& box, cudaStream_t stream, const Rooms& rooms);

  bool exists() const { return numbers_ != 0; }
  bool at_slots() const { return at_slots_; }
  // For walks on the list, outside a run of explicit steps. ahead: what contacts with placed surfaces
  // remember is in the arrays of what was evaluated ahead.
  HistoryViews views(bool ahead = false);

  // In such a run steps are numbered on the device from where it began.
  void begin_run();
  const Real* first_step() const { return first_step_.data(); }
  HistoryViews views_in_run();
  HistoryViews surface_views_in_run(bool ahead);            // of placed surfaces alone
  void closed(Index steps) { step_ = run_start_ + steps; }  // since the run began
  void accepted() { closed_last(), take_ahead(); }
  void closed_last() { step_ += 1; }  // one more than closed() has said
  // What was evaluated ahead of contacts with placed surfaces is what they remember; in a run that is so when
  // the step's velocities are brought into the state's arrays.
  void take_ahead() { bodies_.swap(ahead_), features_.swap(features_ahead_); }
  // For another look at the contacts with bodies over the step that was closed last: from before it, to be
  // held in place of what the step left. ahead: where that is.
  HistoryViews views_before(bool ahead);

  // The list as it is with the items where they are now, ghosts and surfaces on bodies included.
  struct Listed {
    const Vec4* position;
    const std::int64_t* row_key;
    Index owned;
    const DeviceList& list;
    const DeviceSurfaces& surfaces;
  };
  // Before a list goes, for which it waits, and after another was built.
  void leave_slots(const Listed& at);
  void take_slots(const Listed& at);
  // In between, of the particles in their order; for kernels that run before take_slots().
  RememberedRows remembered();
  // Then, like the particles: new ones, another order of them, some more behind. numbers: room for one
  // per particle.
  void load(const KeptContacts& contacts, Index owned);
  void reorder(const Index* order, Index n, Index* numbers);
  void append(const KeptContacts& arriving, Index owned);

  // Of these particles, in this order, on the host; not at the slots. Waits.
  KeptContacts rows(const Index* particles, Index n);
  // Of all, in the order of the particles.
  KeptContacts contacts(const Listed& at);

  // Of the records at the slots.
  std::size_t bytes() const {
    return neighbors_.bytes() + ground_.bytes() + bodies_.bytes() + ahead_.bytes();
  }

 private:
  // Rows of contacts on the device, as KeptContacts has them.
  struct Rows {
    DeviceArray<Index> offsets;  // [rows + 1]
    DeviceArray<std::int64_t> keys;
    DeviceArray<Real> values;
  };
  bool is_alone() const { return numbers_ == kSidesAlone; }
  int width() const { return is_alone() ? 0 : numbers_; }
  // What rows of so many particles from the first on hold: the offsets; with room for them, the contacts.
  std::size_t count_rows(Rows& rows, const Listed& at, Index first, Index count);
  void fill_rows(const KeptViews& rows, const Listed& at, Index first, Index count);
  // Lengths of rows become their offsets; returns how many contacts there are. Waits.
  std::size_t add_up(Rows& rows, Index count);
  void make_room(Rows& rows, std::size_t contacts) const;
  KeptContacts download(const Rows& rows, const KeptViews& parts) const;
  KeptViews kept_views();
  KeptViews lay_out_parts(std::size_t contacts);
  bool lay_out_in_records(std::size_t contacts);
  void clear_records();

  const int numbers_;
  const PeriodicBox box_;
  const cudaStream_t stream_;
  const Rooms rooms_;
  bool at_slots_ = false;
  DeviceArray<Vec4> neighbors_, ground_, bodies_, ahead_;  // HistoryViews; empty if kSidesAlone
  DeviceArray<Index> features_, features_ahead_;
  Real step_ = 2, run_start_ = 2;  // there is one before the first
  DeviceArray<Real> first_step_;
  PinnedArray<Real> h_first_step_;
  // Unless at the slots: what is kept, and which row of it is that of each particle. It stands in the memory
  // of the records, or, while they are made of it, in parts.
  Rows kept_;
  bool in_records_ = false;
  std::optional<KeptViews> parts_;
  DeviceArray<std::int64_t> rest_keys_;  // of the last part
  DeviceArray<Real> rest_values_;
  DeviceArray<Index> row_of_;
  Rows packed_;                       // on its way to the host
  DeviceArray<unsigned char> space_;  // of library calls
  PinnedArray<Index> h_count_{1};
};

}  // namespace scree
