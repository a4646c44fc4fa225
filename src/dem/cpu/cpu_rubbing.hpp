// Implicit step of the serial backend with friction and rotating particles.
#pragma once

#include <vector>

#include "dem/cpu/cpu_implicit.hpp"
#include "dem/implicit/turning_items.hpp"

namespace scree {

// Workspace of implicit steps with friction, beside `CpuImplicitArrays`.
struct CpuRubbingArrays {
  // state at the start of the step
  std::vector<Vec4> start_spin;
  std::vector<Vec3> start_acceleration;
  std::vector<Vec4> mean_spin;  // iterate, all items
  // used by contact_force
  std::vector<Vec3> start_torque, step_torque, end_torque;
  std::vector<Real> sharpness;
  std::vector<Index> surface_count;
  RubbingEntryArrays<std::vector> entries;
  std::vector<RubbingEntry> surface_entries;
  std::vector<ScaledMass> mass;
  std::vector<float> inverse_block;  // BlockSlices
  std::vector<Twist> residual;
  std::vector<Real> neighbor_limits, surface_limits;  // lagged limits
  // used by particle_correct
  std::vector<Twistf> correction;
  std::vector<Twistf> direction;  // all items

  void resize(const CpuItems& items);
};

class CpuRubbingStep : public CpuImplicitStep {
 public:
  CpuRubbingStep(CpuItems& items, CpuImplicitArrays& motion, CpuRubbingArrays& arrays, Real h);

  void predict() override;
  ParticleNorms contact_force() override;
  GlobalId worst_particle() override;
  ParticleCorrection particle_correct() override;
  void shorten_correction() override;
  void freeze_limits() override;
  Real error() override;
  void accept() override;
  void undo() override;

 private:
  TurningViews turning_views();
  StepTorques step_torques();
  RubbingStart rubbing_start();
  RubbingMatrix matrix();
  void find_rubs();
  RubbingCorrectItem correct_item(Real share);
  void turn_particles();
  RubbingNorms largest_norms();
  bool is_consistent() const;
  Real right_hand_side();
  void report_not_finite();  // throws, like that of the items
  int solve(Real tolerance);

  CpuRubbingArrays& rubbing_;
  bool frozen_ = false;
  ResidualSearch search_;                          // along rubbing_.correction
  Real scaled_residual_ = 0;                       // of the last contact_force
  Real largest_stiffening_ = 0, force_scale_ = 0;  // of the last contact_force
  Real sharpness_ = 0;
  Real unit_ = 0;  // of rubbing_.correction [N]
  RubbingTolerance tolerance_;
};

}  // namespace scree
