// A run of explicit steps on the GPU. Steps are queued ahead of the host: each checks on the device whether
// the list still covers it, and does nothing if not.
#pragma once

#include "cuda_step_queue.cuh"
#include "dem/backend/explicit_run.hpp"

namespace scree {

class CudaExplicitRun : public ExplicitRun {
 public:
  CudaExplicitRun(CudaItems& items, CudaBodies& bodies, CudaList& list, RunWorkspace& workspace, Real h);
  ~CudaExplicitRun() override;
  CudaExplicitRun(const CudaExplicitRun&) = delete;  // `CudaItems` holds a pointer to it
  CudaExplicitRun& operator=(const CudaExplicitRun&) = delete;

  StepsTaken take_steps(Index most, bool keep_open, StageTimers& timers) override;
  // This and its parts are defined in cuda_driven.cu.
  StepsTaken take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                               std::vector<BodyWrench>& wrenches, StageTimers& timers) override;
  void shape_contacts() override;
  void reduce_wrench(std::vector<BodyWrench>& wrench, std::vector<std::int64_t>& contacts) override {
    bodies_.side().reduce(wrench, contacts);
  }

  // Copies the open step into the arrays of the state, from which the run continues.
  void commit_open_step();

 private:
  StepsTaken take_steps_without_bodies(Index most, bool keep_open, StageTimers& timers);
  bool renew_list(StageTimers& timers);
  Index steps_ahead(const VerletControl& control) const;
  void finish();
  bool renew_list_beside_walls(StageTimers& timers);
  void queue_driven(std::span<const BodyMotion> motion, Index most);
  bool take_ahead(std::span<const BodyMotion> motion, Index last, std::vector<StepLoads>& loads,
                  StageTimers& timers);
  // Defined in cuda_coupled.cu.
  StepsTaken take_steps_with_bodies(Index most, bool keep_open, StageTimers& timers);
  bool step_with_bodies(bool keep_open, StageTimers& timers);
  bool contacts_in_order() const;
  bool queue_loads();

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaList& list_;
  RunWorkspace& workspace_;
  RunControl control_;
  StepQueue queue_;
  const Real h_;
  Index closed_ = 0;             // beside surfaces that move: closed steps since the start of the run
  bool boundary_apart_ = false;  // with bodies: the previous step's boundary rows were queued apart
  // Positions as the last closed step left them, with the velocities at which its law was evaluated.
  struct {
    const Vec4 *position, *velocity, *spin;
  } closed_step_{};
};

}  // namespace scree
