// Rows of the serial backend's explicit steps: a contact of two owned particles is evaluated once, for both.
#pragma once

#include <utility>
#include <vector>

#include "dem/pair_batch.hpp"
#include "dem/pair_list.hpp"

namespace scree {

// What contacts do to the partner in whose row a slot is, from when they are evaluated until the row is
// summed. Places are used again, the last first: rows that are near each other need few.
template <class Result>
class KeptResults {
 public:
  void resize(std::size_t slots) { places_.resize(slots); }
  // Makes room for `more`.
  void reserve(Index more) {
    while (free_count_ < more) {
      free_.push_back(0);
      free_[free_count_++] = static_cast<Index>(results_.size());
      results_.push_back(Result::nothing());
    }
  }
  void put_nothing(Index slot) { places_[slot] = kNothing; }
  Result& put(Index slot) { return results_[places_[slot] = free_[--free_count_]]; }
  // Adds what was put to the slot, and forgets it.
  template <class Sum>
  void take(Index slot, Sum& sum) {
    const Index place = places_[slot];
    sum += results_[place];
    free_[free_count_] = place, free_count_ += place != kNothing;
  }

 private:
  static constexpr Index kNothing = 0;  // whose result changes no sum
  std::vector<Index> places_;           // per slot
  std::vector<Result> results_{Result::nothing()};
  std::vector<Index> free_{0};  // the first free_count_ of them
  Index free_count_ = 0;
};

// The contacts of one step, evaluated some rows ahead of the one that is summed.
template <class Laws>
class PairSweep {
 public:
  // Before a step.
  void begin(const PairList& pairs) {
    pairs_ = &pairs, reached_ = 0;
    results_.resize(pairs.slots);
  }

  // For i = 0, 1, ...: adds what the contacts at these slots, those of row i, do to i, in this order.
  template <class Contact, class Sum>
  void add_row(Index i, Index slot, Index past_slots, const Contact& contact, Sum& sum) {
    if (i >= reached_) reach(contact);
    for (; slot < past_slots; ++slot) results_.take(slot, sum);
  }

 private:
  using Batch = PairBatch<Laws>;
  static constexpr Index kFull = Batch::kRoom - 8;  // pairs after which no more rows are searched

  template <class Contact>
  [[gnu::noinline, gnu::flatten]] void reach(const Contact& contact) {
    Index found = 0;
    for (; reached_ < pairs_->rows() && found < kFull; ++reached_) {
      const auto test = contact.test(contact.walk.self(reached_));
      const ListedPair* const end = pairs_->pairs.data() + pairs_->offsets[reached_ + 1];
      for (const ListedPair* pair = pairs_->pairs.data() + pairs_->offsets[reached_]; pair != end; ++pair) {
        results_.put_nothing(pair->slot), contact.prepare(pair->slot);
        if (pair->has_mirror()) results_.put_nothing(pair->mirror), contact.prepare(pair->mirror);
        found_[found] = {reached_, *pair};
        found += test(pair->j);
        if (found == Batch::kRoom) evaluate(contact.walk, std::exchange(found, 0));
      }
    }
    evaluate(contact.walk, found);
  }

  template <class Walk>
  [[gnu::noinline]] void evaluate(const Walk& walk, Index found) {
    const HistoryViews& history = walk.in.history;
    for (Index k = 0; k < found; ++k) {
      const auto& [i, pair] = found_[k];
      batch_.put(k, walk.self(i), walk.self(pair.j), history.neighbors + Batch::first_record(pair.slot));
    }
    batch_.evaluate(found, walk.laws, walk.look, history);
    results_.reserve(2 * found);
    Index again = 0;
    for (Index k = 0; k < found; ++k) {
      const auto [i, pair] = found_[k];
      keep(k, batch_.of_i(), pair.slot, history.neighbors);
      if (!pair.has_mirror() || !batch_.acts(k)) continue;
      if (batch_.is_mirrored(k))
        keep(k, batch_.of_j(), pair.mirror, history.neighbors);
      else
        found_[again++] = {pair.j, {i, pair.mirror, ListedPair::kNone}};
    }
    if (again > 0) evaluate(walk, again);
  }

  // Of the k-th contact, what one side has of it.
  void keep(Index k, const typename Batch::Side& side, Index slot, Vec4* records) {
    if (batch_.acts(k)) results_.put(slot) = side.result[k];
    if (!batch_.closed(k)) return;
    for (Index r = 0; r < Batch::kRecords; ++r)
      records[Batch::first_record(slot) + r] = side.records[Batch::first_record(k) + r];
  }

  struct Found {
    Index i;
    ListedPair pair;
  };

  const PairList* pairs_ = nullptr;
  Index reached_ = 0;  // rows whose contacts were evaluated
  KeptResults<typename Batch::Result> results_;
  Batch batch_;
  Found found_[Batch::kRoom];
};

template <class Laws>
struct PairedRows {
  static constexpr bool kShared = true;
  const Index* offsets;  // as of PackedRows
  PairSweep<Laws>* sweep;

  template <class Test, class Contact, class Sum>
  void sum_contacts(Index i, const Test&, const Contact& contact, Sum& sum) const {
    sweep->add_row(i, offsets[i], offsets[i + 1], contact, sum);
  }
};

template <class Laws>
ContactViews<PairedRows<Laws>> paired_views(const ContactViews<PackedRows>& in, PairSweep<Laws>& sweep) {
  return with_rows(in, PairedRows<Laws>{in.rows.offsets, &sweep});
}

}  // namespace scree
