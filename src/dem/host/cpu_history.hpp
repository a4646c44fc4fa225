// Contact history of the serial backend's particles: at the slots of the list while there is one, else packed
// by contact keys.
#pragma once

#include <vector>

#include "dem/history/history_slots.hpp"
#include "dem/history/packed_history.hpp"
#include "dem/history/sheet_keys.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/neighbor_list.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {

class CpuHistory {
 public:
  // numbers: per contact, or `kSidesOnly`; 0: no history, and all functions below do nothing.
  CpuHistory(int numbers, const PeriodicBox& box) : numbers_(numbers), box_(box) {}

  bool exists() const { return numbers_ != 0; }
  int numbers() const { return numbers_; }
  int records() const { return records_of(numbers_); }
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
  PackedHistory contacts(const Listed& at) const;

  // Packs the history before a list is discarded; unpacks it after another one was built.
  void pack_history(const Listed& at);
  void unpack_history(const Listed& at);
  // While packed: the number of contacts of a particle with a surface.
  StoredContactCount stored_contacts() const;
  // While packed, the history follows the particles: loading, reordering, migration to other ranks.
  void load(const PackedHistory& contacts, Index owned);
  void reorder(const std::vector<Index>& from);
  // leaving[r]: particles for rank r; `staying` keep their order, and arriving ones are appended. Collective.
  void migrate(const Ranks& ranks, const std::vector<std::vector<Index>>& departing,
               const std::vector<Index>& remaining);

 private:
  static HistoryViews sides_only(std::vector<Index>& of, std::vector<Index>& ahead);
  // Contact key at a slot, or at an entry of the surfaces, of a particle at p.
  std::int64_t neighbor_key(const Listed& at, Vec3 p, Index slot) const;
  std::int64_t surface_key(const Listed& at, Vec3 p, Index entry) const;
  std::int64_t mesh_key(const Listed& at, Vec3 p, Index entry, GlobalId name) const;
  bool is_mesh(const Listed& at, Index entry) const;
  InMeshFrame in_mesh_frame(const Listed& at, Vec3 p, Index entry) const;
  bool sides_only() const { return numbers_ == kSidesOnly; }
  // Whether the contact at a slot of these records, or at an entry of a mesh, is closed.
  bool is_closed(const std::vector<Vec4>& records, Index slot) const {
    return sides_only() ? features_[slot] != kNoFeature : records[first_record(slot)].w == step_;
  }
  void unpack_row(const Listed& at, Index i);
  void unpack_mesh(const Listed& at, Index i, Index entry);
  std::size_t first_record(std::int64_t slot) const {
    return static_cast<std::size_t>(slot * records_of(numbers_));
  }
  void put(std::vector<Vec4>& records, Index slot, std::int64_t contact) const;

  int numbers_;
  PeriodicBox box_;
  bool at_slots_ = false;
  PackedHistory packed_;                                   // packed history of the owned particles, unless it
                                                           // is at the slots
  std::vector<Vec4> neighbors_, ground_, bodies_, ahead_;  // see `HistoryViews`; empty if `kSidesOnly`
  std::vector<Index> features_, next_features_;
  Real step_ = 2;  // number of the last accepted step; begins at 2, so that the one before it is above 0
};

}  // namespace scree
