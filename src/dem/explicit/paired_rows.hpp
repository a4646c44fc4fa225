// Rows of the serial backend's explicit steps: a contact of two owned particles is evaluated once for both.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "dem/explicit/pair_batch.hpp"
#include "dem/search/pair_list.hpp"

namespace scree {

// Loads on the particle of a row, stored per slot from their evaluation until the row is summed. Freed
// entries are reused last-in, first-out: rows that are close to each other need few.
template <class Packed>
class PendingResults {
 public:
  PendingResults() = default;
  PendingResults(const PendingResults&) = delete;
  PendingResults& operator=(const PendingResults&) = delete;

  // Resets all slots to no load.
  void resize(std::size_t slots) { indices_.resize(slots + kAhead); }
  // Prefetches the place of the load at the slot.
  void prepare(std::ptrdiff_t slot) const { __builtin_prefetch(indices_.data() + slot, 1); }
  // Ensures that `more` entries are free.
  void reserve(Index more) {
    auto count = static_cast<Index>(end_free_ - free_.data());
    for (; count < more; ++count) {
      free_.push_back(0);
      free_[count] = static_cast<Index>(results_.size());
      results_.push_back(nothing());
    }
    end_free_ = free_.data() + count;
  }
  Packed& put(Index slot) { return results_[indices_[slot] = *--end_free_]; }
  // Adds the loads at these slots to the sum, in this order, and frees their entries.
  void take(Index slot, Index end_slot, Packed& sum) {
    Index* end_free = end_free_;  // in a register: a count in memory would take longer than the sum
    for (; slot < end_slot; ++slot) {
      __builtin_prefetch(&results_[indices_[slot + kAhead]]);
      const Index index = std::exchange(indices_[slot], kNothing);
      sum += results_[index];
      *end_free = index, end_free += index != kNothing;
    }
    end_free_ = end_free;
  }

 private:
  static Packed nothing() { return Packed::of(Packed::Total::nothing()); }
  static constexpr Index kNothing = 0;  // index of a load that changes no sum
  static constexpr Index kAhead = 12;  // slots, about one or two rows: loads prefetched before they are taken
  std::vector<Index> indices_;         // index of the load per slot
  std::vector<Packed> results_{nothing()};
  std::vector<Index> free_{0};  // those before end_free_ are free; one more is written
  Index* end_free_ = free_.data();
};

// The contacts of one step, evaluated some rows ahead of the row that is summed.
template <class Laws>
class PairSweep {
 public:
  // Called before a step.
  void begin(PairList& pairs) {
    pairs_ = &pairs, evaluated_rows_ = next_ = 0;
    results_.resize(pairs.slots);
  }

  // For i = 0, 1, ...: adds the loads on i of the contacts at these slots of row i, in this order.
  template <class Contact, class Sum>
  void add_row(Index i, Index slot, Index end_slot, const Contact& contact, Sum& sum) {
    while (i >= evaluated_rows_) evaluate_ahead(contact);
    Packed packed = Packed::of(sum);
    results_.take(slot, end_slot, packed);
    sum = packed.total();
  }

 private:
  using Batch = PairBatch<Laws>;
  using Packed = typename Batch::Loads::Packed;
  static constexpr Index kGroup = Batch::Loads::kGroup;
  using Law = typename Batch::Law;

  // A contact of i; mirror: its slot in the row of j, if j may get the mirrored result.
  struct Found {
    Index i, j, slot, mirror;
    Vec4* records;
  };

  // Evaluates the next contacts of all rows: one batch, which may end within a row.
  template <class Contact>
  [[gnu::noinline, gnu::flatten]] void evaluate_ahead(const Contact& contact) {
    Index found = 0;
    for (; evaluated_rows_ < pairs_->rows(); ++evaluated_rows_) {
      const auto test = contact.test(contact.walk.self(evaluated_rows_));
      for (const Index end = pairs_->offsets[evaluated_rows_ + 1]; next_ < end; ++next_) {
        if (found == Batch::kCapacity) return evaluate(contact.walk, found);
        const ListedPair& pair = pairs_->pairs[next_];
        Vec4* const records = records_of_pair(next_);
        prefetch_record(records);
        prefetch(contact.walk.in, pair);
        found_[found] = {evaluated_rows_, pair.j, pair.slot, pair.mirror, records};
        found += test(pair.j);
      }
    }
    evaluate(contact.walk, found);
  }

  // Prefetches what the evaluation of the pair uses; most listed pairs touch.
  template <class Views>
  void prefetch(const Views& in, const ListedPair& pair) const {
    __builtin_prefetch(in.velocity + pair.j), __builtin_prefetch(in.spin + pair.j);
    results_.prepare(pair.mirror);
  }

  template <class Walk>
  [[gnu::noinline]] void evaluate(const Walk& walk, Index found) {
    const HistoryViews& history = walk.in.history;
    sort_by_law(walk, found);
    for (Index k = 0; k < found; ++k)
      batch_.put(k, walk.self(found_[k].i), walk.self(found_[k].j), found_[k].records, history.step);
    batch_.evaluate(found, walk.laws, walk.kinematics.h);
    results_.reserve(2 * found);
    Index again = 0;
    for (Index first = 0; first < found; first += kGroup) {
      Packed *of_i[kGroup], *of_j[kGroup];
      Vec4* records[kGroup];
      for (Index n = 0; n < kGroup; ++n) {
        const Index k = first + n;
        of_i[n] = of_j[n] = &unused_load_, records[n] = unused_records_;
        if (k >= found) continue;
        const Found pair = found_[k];
        if (batch_.closed(k)) records[n] = pair.records;
        if (!batch_.acts(k)) continue;
        of_i[n] = &results_.put(pair.slot);
        if (pair.mirror == ListedPair::kNone) continue;
        if (batch_.is_mirrored(k))
          of_j[n] = &results_.put(pair.mirror);
        else
          found_[again++] = {pair.j, pair.i, pair.mirror, ListedPair::kNone, mirror_records(k, history)};
      }
      batch_.loads().store(first, of_i, of_j), batch_.store_records(first, records);
    }
    if (again > 0) evaluate(walk, again);
  }

  // Puts pairs of the same law side by side, to be evaluated together; a result does not depend on the order.
  template <class Walk>
  void sort_by_law(const Walk& walk, Index found) {
    const auto law_of = [&](const Found& pair) {
      return &walk.laws.get(walk.in.material[pair.i], walk.in.material[pair.j]);
    };
    const auto in_order = [&](const Found& a, const Found& b) { return std::less{}(law_of(a), law_of(b)); };
    if (!std::is_sorted(found_, found_ + found, in_order)) std::sort(found_, found_ + found, in_order);
  }

  Vec4* records_of_pair(Index pair) { return pairs_->records.data() + Batch::first_record(pair); }
  // History record of the k-th contact on its other side.
  Vec4* mirror_records(Index k, const HistoryViews& history) {
    Vec4* const records = history.neighbors + Batch::first_record(found_[k].mirror);
    if (records->w != history.step) {
      HistoryViews::mirror<Law>(batch_.old_records(k), records);
      records->w = history.step;
    }
    return records;
  }

  PairList* pairs_ = nullptr;
  Index evaluated_rows_ = 0;  // rows whose contacts were evaluated
  Index next_ = 0;            // next pair to evaluate
  PendingResults<Packed> results_;
  Batch batch_;
  Packed unused_load_;  // written in place of loads and records that are not stored
  Vec4 unused_records_[Batch::kRecords];
  Found found_[Batch::kCapacity];
};

// Writes the history of pairs back to the slots.
template <class Law>
void return_records(PairList& pairs, const HistoryViews& history) {
  constexpr Index kRecords = records_of(Law::kHistory);
  const Vec4* records = pairs.records.data();
  for (const ListedPair& pair : pairs.pairs) {
    std::copy_n(records, kRecords, history.neighbors + std::int64_t{pair.slot} * kRecords);
    if (pair.has_mirror())
      if (Vec4* const mirror = history.neighbors + std::int64_t{pair.mirror} * kRecords;
          mirror->w != history.step)
        HistoryViews::mirror<Law>(records, mirror);
    records += kRecords;
  }
  pairs.has_records = false;
}

template <class Laws>
struct PairedRows {
  static constexpr bool kShared = true;
  const Index* offsets;  // as in PackedRows
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
