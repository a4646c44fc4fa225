// The control block of a run of explicit steps: the device keeps it, the host looks at it.
#pragma once

#include <limits>

#include "cuda_list.cuh"

namespace scree {

class RunControl {
 public:
  static constexpr Index kEndless = std::numeric_limits<Index>::max();

  RunControl(CudaItems& items, CudaList& list) : items_(items), list_(list) {}

  VerletControl* on_device() { return items_.results.at(&Results::control); }
  // As last copied to the host.
  const VerletControl& seen() { return items_.results.host().control; }

  // Opens the first step of a run, from the state; step: its request. Waits.
  void start(const VerletRequest& step);
  // Waits for all that is queued and looks.
  const VerletControl& wait();
  // Queued after a stop: the run goes on until `last` steps are closed, with the list as it is now.
  void resume(Index last = kEndless);
  // Queued where there are several ranks, once they have shared what a step found: closes it.
  void close(Device on);

  // Which arrays hold the open step's position and velocity: 0 the state's, 1 the others.
  int position_parity() const { return parity_[0]; }
  int velocity_parity() const { return parity_[1]; }
  Vec4* open_position() { return (parity_[0] == 0 ? items_.now.position : items_.other.position).data(); }
  Vec4* open_velocity() { return (parity_[1] == 0 ? items_.now.velocity : items_.other.velocity).data(); }
  Vec4* open_spin() {
    return (parity_[1] == 0 ? items_.now.angular_velocity : items_.other.angular_velocity).data();
  }
  void turn() { parity_[0] ^= 1, parity_[1] ^= 1; }  // one step further, before the host has looked
  void at_home() { parity_[0] = parity_[1] = 0; }    // they have been brought into the state's

 private:
  CudaItems& items_;
  CudaList& list_;
  int parity_[2] = {0, 0};
  std::int64_t known_list_ = 0;  // the list that the control was told of last, by its number
};

}  // namespace scree
