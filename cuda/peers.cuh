// Exchanges between the GPUs of one host in which neither the host nor a library takes part: kernels write
// into the memory of the other ranks, and wait for what those have written.
#pragma once

#include <cuda/atomic>
#include <memory>
#include <string>
#include <vector>

#include "for_each.cuh"
#include "partition/halo_plan.hpp"
#include "partition/ranks.hpp"

namespace scree {

inline constexpr int kMostPeers = 8;  // ranks
using PeerWord = unsigned long long;

// What the other ranks tell this one, and what it counts itself. Exchanges and reductions are numbered from
// the start of the program; every rank takes part in each of them, so that all have the same numbers. No
// number is ever set back: a rank may be told of an exchange before it has begun to wait for it.
struct PeerFlags {
  // By sender: number of the last exchange whose ghosts are in this rank's mailbox.
  alignas(128) PeerWord arrived[kMostPeers];
  // By parity of a reduction and sender: the lower half of the reduction's number, and the value.
  alignas(128) PeerWord values[2][kMostPeers];
  alignas(128) PeerWord greeted[kMostPeers];
  // Of this rank alone. finished_blocks: those of an exchange that have written their ghosts.
  alignas(128) PeerWord exchanges, reductions;
  unsigned finished_blocks;
};

// The flags of all ranks, as the kernels of this rank reach them.
struct PeerLinks {
  PeerFlags* flags[kMostPeers];
  int rank, size;
};

struct PeerNeighbors {
  int count = 0;
  int rank[kMostPeers - 1] = {};
};

// A field of the ghosts in an exchange. Ghosts reach the neighbour's mailbox, from which it takes them: its
// arrays may be moved or exchanged at any time without the other ranks' knowledge, the mailbox may not.
template <class T>
struct PeerField {
  T* field;
  // own: number of the entries, the first ones, that are periodic images of the rank's own particles.
  Index own, first_ghost;
  const T* mailbox;
  Index end[kMostPeers];      // by neighbour: end of its entries, not counting own ones
  T* remote[kMostPeers - 1];  // entry k of a neighbour, not counting own ones, belongs at remote[...][k]

  __device__ void put(Index entry, const T& value) const {
    if (entry < own) {
      field[first_ghost + entry] = value;
      return;
    }
    const Index k = entry - own;
    int neighbor = 0;
    while (k >= end[neighbor]) ++neighbor;
    remote[neighbor][k] = value;
  }
  // Moves received ghost k to its place. The first-level cache is not asked: other GPUs write the mailbox.
  __device__ void take(Index k) const {
    constexpr int kWords = sizeof(T) / sizeof(uint4);
    static_assert(sizeof(T) % sizeof(uint4) == 0 && alignof(T) >= alignof(uint4));
    auto* const to = reinterpret_cast<uint4*>(field + first_ghost + own + k);
    const auto* const from = reinterpret_cast<const uint4*>(mailbox + k);
    for (int word = 0; word < kWords; ++word) to[word] = __ldcg(from + word);
  }
};

__device__ inline PeerWord nanoseconds() {
  PeerWord now;
  asm volatile("mov.u64 %0, %%globaltimer;" : "=l"(now));
  return now;
}

// Waits until arrived(word), and returns the word. The thread then sees what its writer had written or seen
// before. A rank may be late by the time in which its host writes a file; only a rank that will never come
// ends the wait, with an error of the device.
template <class Arrived>
__device__ PeerWord await_peer(PeerWord& word, const Arrived& arrived) {
  constexpr unsigned kPolls = 1u << 12;  // before the thread leaves the memory alone
  constexpr PeerWord kPatience = 30ull * 60 * 1000 * 1000 * 1000;  // [ns]
  const cuda::atomic_ref<PeerWord, cuda::thread_scope_system> shared(word);
  PeerWord value = 0;
  for (unsigned poll = 0; poll < kPolls; ++poll)
    if (arrived(value = shared.load(cuda::memory_order_acquire))) return value;
  for (const PeerWord start = nanoseconds(); !arrived(value = shared.load(cuda::memory_order_acquire));) {
    if (nanoseconds() - start > kPatience) __trap();
    __nanosleep(500);
  }
  return value;
}

// Called by one thread of every block once its threads have written their ghosts and met at a barrier: the
// last block tells the neighbours. The fences order what any thread of any block has written before the
// flags.
__device__ inline void announce_ghosts(const PeerLinks& peers, const PeerNeighbors& neighbors,
                                       PeerWord number) {
  PeerFlags& own = *peers.flags[peers.rank];
  cuda::atomic_thread_fence(cuda::memory_order_acq_rel, cuda::thread_scope_system);
  if (!is_last_block(&own.finished_blocks, gridDim.x)) return;
  own.exchanges = number;  // every block has read the old number
  cuda::atomic_thread_fence(cuda::memory_order_acq_rel, cuda::thread_scope_system);
  for (int n = 0; n < neighbors.count; ++n) {
    const cuda::atomic_ref<PeerWord, cuda::thread_scope_system> arrived(
        peers.flags[neighbors.rank[n]]->arrived[peers.rank]);
    arrived.store(number, cuda::memory_order_relaxed);
  }
}

// Writes the ghosts of the other ranks, waits for those of this rank, and takes them out of the mailbox.
// item.put(entry) and item.take(k) do so for one of them. Blocks wait for other ranks while later ones of the
// same launch may not have begun to write: `Peers::exchange` launches no more than are resident at once.
//
// A mailbox is written anew only after its owner has taken the ghosts: they are written after the reduction
// that ends a step, which the owner joins after it has taken those of that step. A rank past a stop does
// nothing here, and all ranks stop at the same step.
template <class Item>
__global__ void __launch_bounds__(256)
    exchange_kernel(const __grid_constant__ Item item, const __grid_constant__ PeerLinks peers,
                    const __grid_constant__ PeerNeighbors neighbors, Index entries, Index received,
                    const int* stop) {
  if (*stop) return;
  PeerFlags& own = *peers.flags[peers.rank];
  const PeerWord number = own.exchanges + 1;
  const Index first = thread_index(), stride = static_cast<Index>(gridDim.x * blockDim.x);
  for (Index entry = first; entry < entries; entry += stride) item.put(entry);
  __syncthreads();
  if (threadIdx.x == 0) announce_ghosts(peers, neighbors, number);
  if (static_cast<int>(threadIdx.x) < neighbors.count)
    await_peer(own.arrived[neighbors.rank[threadIdx.x]], [=](PeerWord seen) { return seen >= number; });
  __syncthreads();
  for (Index k = first; k < received; k += stride) item.take(k);
}

// Called by one whole warp: gives every rank a value and returns to lane r that of rank r, 0 to the lanes
// beyond. A word holds both the value and the number of the reduction, so that one store suffices. The values
// of the next reduction go to the other half of the array, because a rank may write them while this one still
// reads; those of the one after follow only once this rank has given its value to the next.
__device__ inline unsigned exchange_values(const PeerLinks& peers, unsigned value) {
  const int lane = static_cast<int>(threadIdx.x) % warpSize;
  PeerFlags& own = *peers.flags[peers.rank];
  const PeerWord number = own.reductions + 1, tag = number & 0xffffffffu;
  PeerWord word = tag << 32 | value;
  if (lane < peers.size && lane != peers.rank) {
    const cuda::atomic_ref<PeerWord, cuda::thread_scope_system> there(
        peers.flags[lane]->values[number % 2][peers.rank]);
    there.store(word, cuda::memory_order_release);
    word = await_peer(own.values[number % 2][lane], [=](PeerWord seen) { return seen >> 32 == tag; });
  }
  __syncwarp();
  if (lane == 0) own.reductions = number;
  return lane < peers.size ? static_cast<unsigned>(word) : 0;
}

// Memory of another rank's GPU as this process reaches it.
class PeerMemory {
 public:
  PeerMemory() = default;
  explicit PeerMemory(const cudaIpcMemHandle_t& handle) {
    require_cuda(cudaIpcOpenMemHandle(&at_, handle, cudaIpcMemLazyEnablePeerAccess), "cudaIpcOpenMemHandle");
  }
  ~PeerMemory() {
    if (at_ != nullptr) cudaIpcCloseMemHandle(at_);
  }
  PeerMemory(PeerMemory&& other) noexcept { std::swap(at_, other.at_); }
  PeerMemory& operator=(PeerMemory&& other) noexcept {
    std::swap(at_, other.at_);
    return *this;
  }
  void* at() const { return at_; }

 private:
  void* at_ = nullptr;
};

// What this rank shares with the others of its host: flags for as long as it exists, and a mailbox, which
// grows only while no rank writes to another.
class Peers {
 public:
  static constexpr int kFields = 3;  // of an exchange, each at most as large as `Vec4`

  // Collective. Throws `DeviceError` on every rank where one cannot write another's memory. There are at most
  // `kMostPeers` ranks, on one host, each with a GPU of its own.
  explicit Peers(const Ranks& ranks);

  // For a plan whose counts are set. Collective; no exchange of the former plan is under way.
  void set_plan(const HaloPlan& plan);
  const PeerLinks& links() const { return links_; }

  // number: below `kFields`, distinct for the fields of one exchange.
  template <class T>
  PeerField<T> field(int number, T* field, Index first_ghost) const {
    static_assert(sizeof(T) <= sizeof(Vec4));
    const auto mailbox = [&](int rank) {
      return reinterpret_cast<T*>(mailbox_of_[rank] + number * field_bytes());
    };
    PeerField<T> to{field, own_, first_ghost, mailbox(links_.rank), {}, {}};
    for (int n = 0; n < neighbors_.count; ++n)
      to.end[n] = end_[n], to.remote[n] = mailbox(neighbors_.rank[n]) + first_[n];
    return to;
  }
  // Queues an exchange of the fields that the item holds, unless *stop is set on the device. Collective.
  template <class Item>
  void exchange(Device device, const Item& item, const int* stop) const {
    const unsigned blocks = std::max(1u, blocks_for(std::max(entries_, received_), kThreads));
    exchange_kernel<<<std::min(blocks, most_blocks_), kThreads, 0, device.stream>>>(
        item, links_, neighbors_, entries_, received_, stop);
    require_cuda(cudaGetLastError(), "exchange of ghosts");
  }

 private:
  static constexpr int kThreads = 256;

  void greet();
  void reserve(Index ghosts);
  std::size_t field_bytes() const { return static_cast<std::size_t>(capacity_) * sizeof(Vec4); }

  Ranks ranks_;
  DeviceArray<std::byte> own_flags_, own_mailbox_;
  std::vector<PeerMemory> flags_, mailboxes_;  // by rank; released before the memory of this rank
  PeerLinks links_{};
  std::byte* mailbox_of_[kMostPeers] = {};
  Index capacity_ = 0;  // ghosts that each rank's mailbox holds
  PeerNeighbors neighbors_;
  Index end_[kMostPeers - 1] = {};
  Index first_[kMostPeers - 1] = {};  // entry k belongs at first_[n] + k in the mailbox of neighbour n
  Index own_ = 0, entries_ = 0, received_ = 0;
  unsigned most_blocks_ = static_cast<unsigned>(multiprocessors());
};

}  // namespace scree
