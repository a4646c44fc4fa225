// Halo exchange on the device: src/partition/halo.hpp for ghosts of any number of ranks, packed by kernels.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>

#include "dem/particles/particle_fields.hpp"
#include "for_each.cuh"
#include "halo_transport.cuh"
#include "partition/halo.hpp"

namespace scree {

// Destination of a ghost's copy of a field: its position after the owned items, or the send buffer.
template <class T>
struct GhostField {
  T *field, *packed;
  // own: number of the entries, the first ones, that are periodic images of the rank's own particles.
  Index own, first_ghost;

  SCREE_HD void put(Index entry, const T& value) const {
    if (entry < own)
      field[first_ghost + entry] = value;
    else
      packed[entry - own] = value;
  }
  HaloMessage message() const { return {packed, field + first_ghost, sizeof(T)}; }
};

struct MotionGhostItem {
  const Ghost* ghosts;
  GhostField<Vec4> position, velocity;
  SCREE_HD void operator()(Index entry) const {
    const Ghost ghost = ghosts[entry];
    position.put(entry, moved(ghost, position.field[ghost.source]));
    velocity.put(entry, velocity.field[ghost.source]);
  }
};

// A field that ghosts have unchanged.
template <class T>
struct GhostCopyItem {
  const Ghost* ghosts;
  GhostField<T> of;
  SCREE_HD void operator()(Index entry) const { of.put(entry, of.field[ghosts[entry].source]); }
};

// Times a sample of the halo exchanges of positions and velocities: one per batch of explicit steps, and
// those of implicit forces. Measures how long each took, and how long it was still under way after the
// interior was done.
class HaloClock {
 public:
  void begin(cudaStream_t halo) { begin_.record(halo); }
  void end(cudaStream_t halo) { end_.record(halo); }
  void interior_done(cudaStream_t rows) { interior_done_.record(rows), running_ = true; }
  // Reads the times, once both streams are done.
  void read(HaloSize& halo) {
    if (!running_) return;
    running_ = false, ++samples_;
    const auto mean = [&](double& of, double value) { of += (value - of) / samples_; };
    mean(halo.seconds, end_.seconds_since(begin_));
    mean(halo.exposed_seconds, std::max(0.0, end_.seconds_since(interior_done_)));
  }

 private:
  TimedEvent begin_, end_, interior_done_;
  bool running_ = false;
  int samples_ = 0;
};

class DeviceHalo {
 public:
  DeviceHalo(const Ranks& ranks, Transport transport);

  // Empty for one rank.
  std::string transport() const;
  // Whether every exchange of explicit steps waits for the device on the host.
  bool waits() const { return peers() == nullptr && messages() != nullptr && messages()->waits(); }
  // How explicit steps exchange ghosts and what they found; null unless the ranks write into each other's
  // memory. A plan for it is set by count().
  const Peers* peers() const { return transports_.peers.get(); }

  // Stage exchange_halo: counts the ghosts among the items at position[0 ... n-1], and tells the neighbouring
  // ranks. Waits for the stream. Collective.
  void count(Device device, const HaloPlan& plan, const Vec4* position, Index n);
  // Then lists the ghosts that were counted.
  void list(Device device, const Vec4* position, Index n);
  Index size() const { return plan_.ghosts(); }
  const HaloPlan& plan() const { return plan_; }
  // How the fields of ghosts are filled: for_each over entries() with an item that writes into fields, then
  // exchange.
  Index entries() const { return plan_.own() + plan_.sent(); }
  const Ghost* ghosts() const { return ghost_.data(); }
  // buffer: below `kBuffers`, distinct for the fields of one exchange. T: at most as large as `Vec4`.
  template <class T>
  GhostField<T> field(int buffer, T* field, Index first_ghost) {
    static_assert(sizeof(T) <= sizeof(Vec4));
    return {field, reinterpret_cast<T*>(packed_[buffer].data()), plan_.own(), first_ghost};
  }
  // Sends what was written into fields, and receives the ghosts. messages: those of these fields.
  void exchange(Device device, std::span<const HaloMessage> messages) {
    if (transports_.messages) transports_.messages->exchange(plan_, messages, device.stream);
  }
  template <class... T>
  void exchange(Device device, const GhostField<T>&... fields) {
    exchange(device, std::array{fields.message()...});
  }
  // Exchanges positions, velocities and, where particles rotate, angular velocities. Either all ranks pass a
  // spin or none; it may be null on a rank without items.
  void update_motion(Device device, Vec4* position, Vec4* velocity, std::optional<Vec4*> spin,
                     Index first_ghost);

  // Copies another field of the originals to the ghosts.
  template <class T>
  void update(Device device, T* of, Index first_ghost) {
    const GhostCopyItem<T> item{ghosts(), field(0, of, first_ghost)};
    for_each(device, entries(), item);
    exchange(device, item.of);
  }

  // Queues the maxima over all ranks of n values >= 0 in device memory. Collective.
  void max(Device device, Real* values, Index n) {
    if (messages() != nullptr) messages()->max(values, n, device.stream);
  }

 private:
  HaloTransport* messages() const { return transports_.messages.get(); }
  void count_entries(Device device, const Vec4* position, Index n);
  void visit_targets(Device device, const Vec4* position, Index n, Ghost* ghosts);

  HaloTransports transports_;
  HaloPlan plan_;
  DeviceArray<Ghost> ghost_;
  DeviceArray<HaloTarget> targets_;
  DeviceArray<unsigned long long> counts_;
  PinnedArray<unsigned long long> h_counts_;
  // Messages of the motion, and of what ghosts get once per list.
  static constexpr std::size_t kBuffers =
      std::max(count_arrays<kMotion | kSpins>(), count_arrays<kKeys | kGhostCopies>());
  DeviceArray<Vec4> packed_[kBuffers];
};

}  // namespace scree
