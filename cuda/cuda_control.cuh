// The control block of a run of explicit steps: it is kept on the device, and the host reads copies of it.
#pragma once

#include <limits>

#include "cuda_list.cuh"

namespace scree {

class RunControl {
 public:
  static constexpr Index kEndless = std::numeric_limits<Index>::max();

  RunControl(CudaItems& items, CudaList& list) : items_(items), list_(list) {}

  VerletControl* on_device() { return items_.results.at(&Results::control); }
  // The last copy on the host.
  const VerletControl& seen() { return items_.results.host().control; }

  // Opens the first step of a run from the state; step: the request of that step. Waits.
  void start(const VerletRequest& step);
  // Waits for everything that is queued and copies the control block.
  const VerletControl& wait();
  // Queued after a stop: continues the run until `last` steps are closed, with the present list.
  void resume(Index last = kEndless);
  // Queued with several ranks after both parts of a step: reduces what the ranks found, and closes the step.
  void close(Device on);

  // Which arrays hold the open step's position and velocity: 0 those of the state, 1 the second ones.
  int position_parity() const { return parity_[0]; }
  int velocity_parity() const { return parity_[1]; }
  Vec4* open_position() { return (parity_[0] == 0 ? items_.now.position : items_.other.position).data(); }
  Vec4* open_velocity() { return (parity_[1] == 0 ? items_.now.velocity : items_.other.velocity).data(); }
  Vec4* open_spin() {
    return (parity_[1] == 0 ? items_.now.angular_velocity : items_.other.angular_velocity).data();
  }
  // After a step was queued whose control block has not been read yet.
  void turn() { parity_[0] ^= 1, parity_[1] ^= 1; }
  // After the open step was copied into the arrays of the state.
  void reset_parity() { parity_[0] = parity_[1] = 0; }

 private:
  CudaItems& items_;
  CudaList& list_;
  int parity_[2] = {0, 0};
  Real h_ = 0;                   // of the run [s]
  std::int64_t known_list_ = 0;  // number of the list that the control block was last set for
};

}  // namespace scree
