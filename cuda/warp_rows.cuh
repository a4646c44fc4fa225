// Rows of a warp whose contacts are distributed over its lanes: for laws so expensive that lanes with few
// contacts must not wait for those with many.
#pragma once

#include <type_traits>

#include "device_list.cuh"

namespace scree {

// Shared memory of a warp: the contacts that its lanes have found, their results, and the sums of each lane's
// row. Words: of a result.
template <class Word, int kWords>
struct WarpContacts {
  static constexpr int kCapacity = 12;        // entries of a row that are distributed at a time
  static constexpr int kStride = kWords | 1;  // odd, so that results stored by different lanes fall into
                                              // different banks
  // Entries of a lane are contiguous, and lanes an odd number of banks apart.
  Index neighbor[kSlice][kCapacity | 1];
  RowIndex entry_index[kSlice][kCapacity + (kCapacity % 4 == 0 ? 2 : 0)];
  Word result[kSlice][kStride];
  double sum[kSlice][kStride];
};

// Each lane searches its row for touching entries; the contacts of all lanes are then evaluated, one per
// lane, whichever row they belong to; and the results are summed row by row, in the order of the row. All
// lanes of a warp take part in every call; their rows form a slice.
template <class Word, int kWords>
struct WarpRows {
  using Contacts = WarpContacts<Word, kWords>;
  static constexpr bool kShared = true;
  PrunedRows<0> rows;
  Contacts* shared;  // one per warp
  bool idle;         // the lane has no row

  // Offsets and stride of the whole rows, as in `SlicedRows`.
  __device__ std::int64_t first(Index i) const { return rows.rows.first(i); }
  __device__ static constexpr int stride() { return SlicedRows::stride(); }

  // Adds evaluate(i, j, slot), a structure of kWords `Word`s, to sum, a structure of as many doubles, for the
  // entries j of row i with test(j); slot is the entry's number. Any lane may make the call for a contact; an
  // evaluate with a fourth parameter also gets the contact's index among the touching ones. Returns their
  // number. test: as in `PrunedRows`; a test without near() is for whole rows.
  template <class Test, class Evaluate, class Sum>
  __device__ Index sum_contacts(Index i, const Test& test, const Evaluate& evaluate, Sum& sum) const {
    static_assert(sizeof(Sum) == kWords * sizeof(double));
    const Index lane = lane_of_warp();
    reinterpret_cast<Sum&>(shared->sum[lane]) = sum;
    const std::int64_t start = rows.rows.slice_start[i / kSlice] + lane;
    const Index number = idle ? 0 : rows.rows.first_entry[i];
    constexpr bool kPrunes = requires { test.near(Index{}, Real{}); };
    const RowUse use = kPrunes ? rows.use : RowUse::all;
    const bool whole = use != RowUse::pruned;
    const Index* const row = (whole ? rows.rows.neighbors : rows.neighbors) + start;
    const Index count = idle ? 0 : (whole ? rows.rows.counts : rows.counts)[i];
    Index next = 0, pruned_count = 0, earlier = 0;
    do {
      Index found = 0;
      // A few entries at once while the next are loaded: independent loads hide latency.
      constexpr Index kAtOnce = 4;
      struct Entries {
        Index j[kAtOnce];
        RowIndex entry_index[kAtOnce];
      };
      const auto entries = [&](Index first) {
        Entries at;
        for (Index k = 0; k < kAtOnce; ++k) {
          const bool is_entry = first + k < count;
          at.j[k] = is_entry ? row[(first + k) * kSlice] : i;
          at.entry_index[k] = whole || !is_entry ? static_cast<RowIndex>(first + k)
                                                 : rows.entry_indices[start + (first + k) * kSlice];
        }
        return at;
      };
      Entries at = entries(next);
      for (; next < count && found + kAtOnce <= Contacts::kCapacity; next += kAtOnce) {
        const Entries ahead = entries(next + kAtOnce);
        bool touches[kAtOnce];
        for (Index k = 0; k < kAtOnce; ++k) touches[k] = test(at.j[k]) & (next + k < count);
        if constexpr (kPrunes)
          if (use == RowUse::prune)
            for (Index k = 0; k < kAtOnce && next + k < count; ++k)
              if (test.near(at.j[k], rows.margin))
                store_pruned(start + pruned_count++ * kSlice, at.j[k], next + k);
        for (Index k = 0; k < kAtOnce; ++k) {
          if (!touches[k]) continue;
          shared->neighbor[lane][found] = at.j[k];
          evaluate.prepare(std::int64_t{number} + at.entry_index[k]);
          shared->entry_index[lane][found] = at.entry_index[k];
          ++found;
        }
        at = ahead;
      }
      share({found, earlier}, i - lane, number, evaluate);
      earlier += found;
    } while (__any_sync(~0u, next < count));
    if (use == RowUse::prune && !idle) rows.counts[i] = pruned_count;
    sum = reinterpret_cast<const Sum&>(shared->sum[lane]);
    return earlier;
  }

 private:
  static constexpr int kLanes = kWords <= 8 ? 8 : 16;  // lanes that sum the results of one row
  __device__ static Index lane_of_warp() { return static_cast<Index>(threadIdx.x) % kSlice; }
  template <class Result>
  __device__ static void put(Word (&words)[Contacts::kStride], const Result& result) {
    static_assert(sizeof(Result) == kWords * sizeof(Word));
    reinterpret_cast<Result&>(words) = result;
  }
  __device__ void store_pruned(std::int64_t slot, Index j, Index row_index) const {
    rows.entry_indices[slot] = static_cast<RowIndex>(row_index), rows.neighbors[slot] = j;
  }

  // Contacts that a lane has found in this round, and in earlier ones.
  struct Found {
    Index now, earlier;
  };

  // first: the warp's first row. first_entry: number of the first entry of this lane's row.
  template <class Evaluate>
  __device__ void share(Found found, Index first, Index first_entry, const Evaluate& evaluate) const {
    const Index lane = lane_of_warp();
    Index after = found.now;  // contacts of the lanes up to and including this one
    for (int step = 1; step < kSlice; step *= 2) {
      const Index other = __shfl_up_sync(~0u, after, step);
      if (lane >= step) after += other;
    }
    const Index all = __shfl_sync(~0u, after, kSlice - 1), before = after - found.now;
    __syncwarp();
#pragma unroll 1
    for (Index begin = 0; begin < all; begin += kSlice) {
      const Index index = begin + lane;
      int owner = 0;  // the last lane whose first contact is not after this one
      for (int step = kSlice / 2; step > 0; step /= 2)
        if (__shfl_sync(~0u, before, owner + step) <= index) owner += step;
      const Index k = index - __shfl_sync(~0u, before, owner);
      const std::int64_t number_of_first = __shfl_sync(~0u, first_entry, owner);
      const auto slot = [&] { return number_of_first + shared->entry_index[owner][k]; };
      if constexpr (std::is_invocable_v<const Evaluate&, Index, Index, std::int64_t, Index>) {
        const Index among = k + __shfl_sync(~0u, found.earlier, owner);
        if (index < all)
          put(shared->result[lane], evaluate(first + owner, shared->neighbor[owner][k], slot(), among));
      } else {
        if (index < all)
          put(shared->result[lane], evaluate(first + owner, shared->neighbor[owner][k], slot()));
      }
      __syncwarp();
      const int first_owner = __shfl_sync(~0u, owner, 0),
                owners = __shfl_sync(~0u, owner, min(all - begin, kSlice) - 1) - first_owner + 1;
      add_up(first_owner, owners, begin, min(all, begin + kSlice), before, after);
      __syncwarp();
    }
  }

  // Sums the results begin ... end - 1 of this round, which belong to `owners` rows, a few rows at a time:
  // each lane sums one of the words.
  __device__ void add_up(int first_owner, int owners, Index begin, Index end, Index before,
                         Index after) const {
#pragma unroll 1
    for (int next = 0; next < owners; next += kSlice / kLanes) {
      const int owner = first_owner + next + lane_of_warp() / kLanes, component = lane_of_warp() % kLanes;
      const Index from = max(__shfl_sync(~0u, before, owner), begin),
                  to = min(__shfl_sync(~0u, after, owner), end);
      if (from >= to || component >= kWords) continue;
      double sum = shared->sum[owner][component];
      const Word* result = shared->result[from - begin] + component;
#pragma unroll 2
      for (Index left = to - from; left > 0; --left, result += Contacts::kStride) sum += *result;
      shared->sum[owner][component] = sum;
    }
  }
};

}  // namespace scree
