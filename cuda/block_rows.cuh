// Rows of a thread block whose contacts are distributed over its threads, and where a contact of two of these
// rows is evaluated once for both: for laws whose evaluation takes longer than the exchange of its result.
#pragma once

#include <cstdint>

#include "dem/contact/contact_items.hpp"
#include "row_search.cuh"

namespace scree {

// Load of a contact on both partners.
template <int kKinds>
struct PairLoad {
  ContactLoadOf<Real, Vec3> load;
  LossesByKind<kKinds> losses;
};

// Shared memory of a block: the contacts that its threads have found, and the results of their evaluations.
template <int kKinds, int kThreads>
struct BlockContacts {
  static constexpr Index kRows = kThreads;
  static constexpr Index kCapacity = 12;  // contacts of a row that are evaluated at a time
  static constexpr Index kMost = 496;     // evaluations at a time; for spheres in a bed nearly four per row
  PairLoad<kKinds> result[kMost];         // an odd number of words, so that threads fall into different banks
  // Contacts of a row are contiguous, and rows an odd number of banks apart. neighbor: ~place where the
  // contact is also that of a later row of the block, at this place. entry_index: index of the entry in its
  // row, and after the evaluation the number of the result.
  Index neighbor[kRows][kCapacity | 1];
  RowIndex entry_index[kRows][kCapacity + (kCapacity % 4 == 0 ? 2 : 0)];
  Index first_entry[kRows];  // number of a row's first entry
  std::uint8_t found[kRows];
  Index evaluations, again_count;
  std::uint16_t evaluation[kMost];  // places
  std::uint32_t again[kMost];       // places, and entry_index << 16
};

// Each thread searches its row for touching entries. A contact of two rows of the block is evaluated by the
// earlier row, which writes the history of both; all other contacts are evaluated by their row. The results
// of all evaluations wait in shared memory until each thread adds those of its row, in the order of the row.
// All threads of a block take part in every call; their rows are consecutive. The call stores new histories:
// it is for items that accept a step, and for laws whose contacts are closed where the entries touch.
template <int kKinds, int kThreads>
struct BlockRows {
  using Contacts = BlockContacts<kKinds, kThreads>;
  static constexpr bool kShared = true;
  PrunedRows<0> rows;
  Contacts* shared;  // one per block
  bool idle;         // the thread has no row

  // Adds the loads of the contacts of row i, as evaluated by `contact`, to sum. Ends with a barrier.
  template <class Test, class Contact, class Sum>
  __device__ void sum_contacts(Index i, const Test& test, const Contact& contact, Sum& sum) const {
    const Index row = thread(), first = i - row;
    const Index first_entry = idle ? 0 : rows.rows.first_entry[i];
    shared->first_entry[row] = first_entry;
    RowSearch<Test> search(rows, i, idle);
    do {
      unsigned own = 0;  // a bit for each contact that this row evaluates
      const Index found = search.find(test, Contacts::kCapacity, [&](Index k, Index j, RowIndex entry_index) {
        shared->neighbor[row][k] = j, shared->entry_index[row][k] = entry_index;
        if (j >= first && j < i) return;
        own |= 1u << k;
        contact.prepare(std::int64_t{first_entry} + entry_index);
      });
      shared->found[row] = static_cast<std::uint8_t>(found);
      if (row == 0) shared->evaluations = shared->again_count = 0;
      __syncthreads();
      own |= join_earlier_rows(first, found, own);
      list_evaluations(own);
      __syncthreads();
      evaluate_and_add(first, found, contact, sum);
    } while (__syncthreads_or(!search.done()));
    search.store_count(idle);
  }

 private:
  // A contact of a row: row and its place there.
  static constexpr Index kPlaces = 16;
  static_assert(Contacts::kCapacity <= kPlaces);
  __device__ static Index place(Index row, Index k) { return row * kPlaces + k; }
  __device__ static Index row_of(Index place) { return place / kPlaces; }
  __device__ static Index number_of(Index place) { return place % kPlaces; }
  static constexpr unsigned kOfLater = 0x8000;  // of a result that the later row gets: exchanged

  __device__ static Index thread() { return static_cast<Index>(threadIdx.x); }

  // Tells earlier rows at which place this row has the contacts with them. Returns bits of contacts that they
  // have not found in this round.
  __device__ unsigned join_earlier_rows(Index first, Index found, unsigned own) const {
    const Index row = thread();
    unsigned missing = 0;
    for (unsigned left = ((1u << found) - 1) & ~own; left != 0; left &= left - 1) {
      const Index k = __ffs(static_cast<int>(left)) - 1, earlier = shared->neighbor[row][k] - first;
      const Index end = shared->found[earlier];
      Index at = 0;
      while (at < end && shared->neighbor[earlier][at] != first + row) ++at;
      if (at < end)
        shared->neighbor[earlier][at] = ~place(row, k);
      else
        missing |= 1u << k;
    }
    return missing;
  }

  // Appends the contacts with these bits to the evaluations.
  __device__ void list_evaluations(unsigned own) const {
    const Index lane = thread() % kSlice, mine = __popc(own);
    Index after = mine;
    for (int step = 1; step < kSlice; step *= 2) {
      const Index other = __shfl_up_sync(~0u, after, step);
      if (lane >= step) after += other;
    }
    Index start = 0;
    if (lane == kSlice - 1) start = atomicAdd(&shared->evaluations, after);
    Index next = __shfl_sync(~0u, start, kSlice - 1) + after - mine;
    for (; own != 0; own &= own - 1, ++next)
      if (next < Contacts::kMost)
        shared->evaluation[next] =
            static_cast<std::uint16_t>(place(thread(), __ffs(static_cast<int>(own)) - 1));
  }

  // With too many evaluations each thread evaluates all contacts of its own row, one by one.
  template <class Contact, class Sum>
  __device__ void evaluate_and_add(Index first, Index found, const Contact& contact, Sum& sum) const {
    const Index row = thread(), all = shared->evaluations;
    const bool once = all <= Contacts::kMost;
#pragma unroll 1
    for (Index round = 0; round < (once ? 1 : Contacts::kCapacity); ++round) {
      Index count = all;
      if (!once) {
        __syncthreads();
        count = round < found ? Contacts::kRows : 0;
        if (count > 0) shared->evaluation[row] = static_cast<std::uint16_t>(place(row, round));
      }
#pragma unroll 1
      for (int pass = 0; pass < 2; ++pass) {
#pragma unroll 1
        for (Index n = row; n < count; n += Contacts::kRows) evaluate(first, n, pass > 0, once, contact);
        if (pass == 0) __syncthreads();
        count = shared->again_count;
      }
      const Index begin = once ? 0 : round, end = once ? found : min(found, round + 1);
      for (Index k = begin; k < end; ++k) {
        const unsigned number = shared->entry_index[row][k];
        const bool of_later = (number & kOfLater) != 0;
        const PairLoad<kKinds>& result = shared->result[number & ~kOfLater];
        auto load = result.load;
        if (of_later) load = load.exchanged();
        sum += Sum::of(load, result.losses);
      }
    }
  }

  // Evaluates the n-th contact of the list and stores its history. again: of those whose history at the other
  // partner does not follow from this one's; their loads are known.
  template <class Contact>
  __device__ void evaluate(Index first, Index n, bool again, bool once, const Contact& contact) const {
    const auto& walk = contact.walk;
    const auto& in = walk.in;
    using Law = typename std::remove_cvref_t<decltype(walk)>::Law;
    const std::uint32_t listed = again ? shared->again[n] : shared->evaluation[n];
    const auto at = static_cast<Index>(listed & 0xffff);
    const Index row = row_of(at), k = number_of(at), neighbor = shared->neighbor[row][k];
    const bool is_shared = neighbor < 0;
    const Index other = is_shared ? ~neighbor : 0, other_row = row_of(other), other_k = number_of(other);
    const Index i = first + row, j = is_shared ? first + other_row : neighbor;
    const Index slot = shared->first_entry[row] + (again ? static_cast<Index>(listed >> 16)
                                                         : static_cast<Index>(shared->entry_index[row][k]));

    const auto owner = walk.self(i);
    const Law& law = walk.laws.get(owner.material, in.material[j]);
    const auto history = in.history.template read<Law>(in.history.neighbors, slot);
    const auto outcome = law.load(walk.kinematics.pair(in, owner, j), history);
    in.history.template write<Law>(in.history.neighbors, slot, outcome.history);
    if (again) return;

    PairLoad<kKinds>& result = shared->result[n];
    result.load = outcome.load, result.losses = {};
    result.losses.add(outcome.losses());
    shared->entry_index[row][k] = static_cast<RowIndex>(n);
    if (!is_shared || !once) return;
    RowIndex& of_other = shared->entry_index[other_row][other_k];
    if (Law::is_mirrored(outcome.history))
      in.history.template write<Law>(in.history.neighbors, shared->first_entry[other_row] + of_other,
                                     outcome.history.mirrored());
    else
      shared->again[atomicAdd(&shared->again_count, 1)] =
          static_cast<std::uint32_t>(other) | std::uint32_t{of_other} << 16;
    of_other = static_cast<RowIndex>(n | kOfLater);
  }
};

}  // namespace scree
