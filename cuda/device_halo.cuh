// Halo on the device: src/partition/halo.hpp for ghosts of any number of ranks, whose packing are kernels.
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

// Where the ghosts' copies of a field go: to their places behind the owned items, or into what is sent.
template <class T>
struct GhostField {
  T *field, *packed;
  Index own, first_ghost;  // own: entries that are images of the rank's own particles, and come first

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

struct SpinGhostItem {
  const Ghost* ghosts;
  GhostField<Vec4> spin;
  SCREE_HD void operator()(Index entry) const { spin.put(entry, spin.field[ghosts[entry].source]); }
};

// Looks at some halos of positions and velocities: one of every batch of explicit steps, those of implicit
// forces. How long each took, and how long the rows that need none left it waited for.
class HaloClock {
 public:
  void begin(cudaStream_t halo) { begin_.record(halo); }
  void end(cudaStream_t halo) { end_.record(halo); }
  void interior_done(cudaStream_t rows) { interior_done_.record(rows), running_ = true; }
  // Once both streams are done.
  void read(HaloSize& halo) {
    if (!running_) return;
    running_ = false, ++looks_;
    const auto mean = [&](double& of, double value) { of += (value - of) / looks_; };
    mean(halo.seconds, end_.seconds_since(begin_));
    mean(halo.exposed_seconds, std::max(0.0, end_.seconds_since(interior_done_)));
  }

 private:
  TimedEvent begin_, end_, interior_done_;
  bool running_ = false;
  int looks_ = 0;
};

class DeviceHalo {
 public:
  DeviceHalo(const Ranks& ranks, Transport transport);

  // Empty for one rank.
  std::string transport() const { return transport_ ? transport_->name() : ""; }
  // Whether the host waits for the device in every exchange.
  bool waits() const { return transport_ && transport_->waits(); }

  // exchange_halo: counts the ghosts among items at position[0 ... n-1], and tells the neighbours. Waits for
  // the stream. Collective.
  void count(Device device, const HaloPlan& plan, const Vec4* position, Index n);
  // Then lists the same.
  void list(Device device, const Vec4* position, Index n);
  Index size() const { return plan_.ghosts(); }
  const HaloPlan& plan() const { return plan_; }
  // What the ghosts' fields are filled from: for_each over entries() with an item that puts into fields, then
  // exchange.
  Index entries() const { return plan_.own() + plan_.sent(); }
  const Ghost* ghosts() const { return ghost_.data(); }
  // buffer: below kBuffers, for fields in the same exchange. T: at most as large as Vec4.
  template <class T>
  GhostField<T> field(int buffer, T* field, Index first_ghost) {
    static_assert(sizeof(T) <= sizeof(Vec4));
    return {field, reinterpret_cast<T*>(packed_[buffer].data()), plan_.own(), first_ghost};
  }
  // Sends what was put into fields, and receives the ghosts. messages: of these fields.
  void exchange(Device device, std::span<const HaloMessage> messages) {
    if (transport_) transport_->exchange(plan_, messages, device.stream);
  }
  template <class... T>
  void exchange(Device device, const GhostField<T>&... fields) {
    exchange(device, std::array{fields.message()...});
  }
  // update_halo of positions, velocities, and angular velocities where particles rotate. All ranks give a
  // spin or none: that of a rank without items may be null.
  void update_motion(Device device, Vec4* position, Vec4* velocity, std::optional<Vec4*> spin,
                     Index first_ghost);

  // Maxima over all ranks of n values >= 0 in device memory, queued. Collective.
  void max(Device device, Real* values, Index n) {
    if (transport_) transport_->max(values, n, device.stream);
  }

 private:
  void visit_targets(Device device, const Vec4* position, Index n, Ghost* ghosts);

  std::unique_ptr<HaloTransport> transport_;  // none for one rank
  HaloPlan plan_;
  DeviceArray<Ghost> ghost_;
  DeviceArray<HaloTarget> targets_;
  DeviceArray<unsigned long long> counts_;
  // For motion, and for what ghosts get once.
  static constexpr std::size_t kBuffers =
      std::max(count_arrays<kMotion | kSpins>(), count_arrays<kNames | kGhostCopies>());
  DeviceArray<Vec4> packed_[kBuffers];
};

}  // namespace scree
