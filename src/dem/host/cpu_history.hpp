// Contact history of the serial backend's particles: at the slots of the list while there is one, else packed
// by contact keys.
#pragma once

#include <vector>

#include "dem/contact/contact_views.hpp"
#include "dem/history/history_slots.hpp"
#include "dem/history/keyed_rows.hpp"
#include "dem/history/packed_history.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/list_rows.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {

class CpuHistory {
 public:
  // If `content` has no history, all functions below do nothing.
  CpuHistory(HistoryContent content, const PeriodicBox& box) : content_(content), box_(box) {}

  bool exists() const { return content_.exists(); }
  HistoryContent content() const { return content_; }
  int records() const { return records_of(content_.values); }
  bool at_slots() const { return at_slots_; }
  // Views for walks on the list.
  HistoryViews views();
  // Commits the step that a walk has accepted.
  void accepted() { step_ += 1, bodies_.swap(ahead_), features_.swap(next_features_); }
  // Views for a repeated evaluation of the contacts with bodies over the step that was accepted last: they
  // read the history before that step and replace the one after it.
  HistoryViews views_before();

  // The list with the current positions of all items, ghosts included.
  struct Listed {
    const ParticleStore& store;
    const NeighborList& list;
    SurfacePoses poses;
    SurfaceNumbers numbers;
  };
  // Packed history of the owned particles, in their order.
  PackedHistory contacts(const Listed& at);

  // Packs the history before a list is discarded; unpacks it after another one was built.
  void pack_history(const Listed& at);
  void unpack_history(const Listed& at);
  // While packed: the number of contacts of a particle with a surface.
  StoredContactCount stored_contacts() const;
  // While packed, the history follows the particles: loading, reordering, migration to other ranks.
  void load(const PackedHistory& contacts, Index owned);
  void reorder(const std::vector<Index>& from);
  void append_empty(std::int64_t particles);  // without contacts
  // departing[r]: particles for rank r; `remaining` ones keep their order, and arriving ones are appended.
  // Collective.
  void migrate(const Ranks& ranks, const std::vector<std::vector<Index>>& departing,
               const std::vector<Index>& remaining);

 private:
  static HistoryViews sides_only(std::vector<Index>& of, std::vector<Index>& ahead);
  KeyedRows<PackedRows> keyed_rows(const Listed& at);

  HistoryContent content_;
  PeriodicBox box_;
  bool at_slots_ = false;
  PackedHistory packed_;                                   // packed history of the owned particles, unless it
                                                           // is at the slots
  std::vector<Vec4> neighbors_, ground_, bodies_, ahead_;  // see `HistoryViews`; empty if `kSidesOnly`
  std::vector<Index> features_, next_features_;
  Real step_ = 2;  // number of the last accepted step; begins at 2, so that the one before it is above 0
};

}  // namespace scree
