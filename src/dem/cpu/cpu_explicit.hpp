// Explicit steps of the serial backend.
#pragma once

#include "dem/backend/explicit_run.hpp"
#include "dem/cpu/cpu_list.hpp"

namespace scree {

class CpuExplicitRun : public ExplicitRun {
 public:
  CpuExplicitRun(CpuItems& items, CpuList& list, Real h);

  StepsTaken take_steps(Index most, bool keep_open, StageTimers& timers) override;
  StepsTaken take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                               std::vector<BodyWrench>& wrenches, StageTimers& timers) override;
  void shape_contacts() override;
  void reduce_wrench(std::vector<BodyWrench>& wrench, std::vector<std::int64_t>& contacts) override {
    items_.side.reduce(wrench, contacts);
  }

 private:
  VerletViews views_of(std::vector<Vec4>& position, std::vector<Vec4>& velocity, std::vector<Vec4>& spin);
  void share_step();
  void close_loads();
  void advance();
  void finish();

  CpuItems& items_;
  CpuList& list_;
  const Real h_;
  Index closed_ = 0;      // steps since the start of the run
  bool open_ = true;      // whether a step is open
  Real step_bound_ = 0;   // largest displacement of a particle in the open step; 0 once added to the list's
                          // [m]
  bool outside_ = false;  // whether a particle is outside the domain at the end of the open step, if a step
                          // of the bodies ends there
};

}  // namespace scree
