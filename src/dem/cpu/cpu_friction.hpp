// Implicit step of the serial backend with friction and rotating particles.
#pragma once

#include <vector>

#include "dem/cpu/cpu_implicit.hpp"
#include "dem/implicit/rotation_items.hpp"

namespace scree {

// Workspace of implicit steps with friction, beside `CpuImplicitArrays`.
struct CpuFrictionArrays {
  // state at the start of the step
  std::vector<Vec4> start_spin;
  std::vector<Vec3> start_acceleration;
  std::vector<Vec4> mean_spin;  // iterate, all items
  // used by contact_force
  std::vector<Vec3> start_torque, step_torque, end_torque;
  std::vector<Real> phase_squared;
  std::vector<Index> surface_count;
  FrictionEntryArrays<std::vector> entries;
  std::vector<FrictionEntry> surface_entries;
  std::vector<RollingEntry> surface_rolling;  // for laws with rolling resistance
  std::vector<ScaledMass> mass;
  std::vector<float> inverse_block;  // BlockSlices
  std::vector<Twist> residual;
  std::vector<Real> neighbor_limits, surface_limits;  // lagged limits
  // used by particle_correct
  std::vector<Twistf> correction;
  std::vector<Twistf> direction;  // all items

  void resize(const CpuItems& items);
};

class CpuFrictionStep : public CpuImplicitStep {
 public:
  CpuFrictionStep(CpuItems& items, CpuImplicitArrays& motion, CpuFrictionArrays& arrays, Real h);

  void predict() override;
  ParticleNorms contact_force() override;
  GlobalId worst_particle() override;
  ParticleCorrection particle_correct() override;
  void shorten_correction() override;
  void lag_limits() override;
  Real error() override;
  void accept() override;
  void undo() override;

 private:
  RotationViews rotation_views();
  StepTorques step_torques();
  FrictionStart friction_start();
  FrictionMatrix matrix();
  void find_friction_steps();
  FrictionCorrectItem correct_item(Real share);
  void rotate_particles();
  FrictionNorms largest_norms();
  bool is_consistent() const;
  Real right_hand_side();
  void report_not_finite();  // throws, like that of the items
  int solve(Real tolerance);
  template <bool kRolls>
  int solve(Real tolerance);

  CpuFrictionArrays& friction_;
  bool lagged_ = false;
  ResidualSearch search_;                               // along friction_.correction
  Real scaled_residual_ = 0;                            // of the last contact_force
  Real largest_stiffness_ratio_ = 0, force_scale_ = 0;  // of the last contact_force
  Real phase_squared_ = 0;
  Real unit_ = 0;  // of friction_.correction [N]
  FrictionTolerance tolerance_;
};

}  // namespace scree
