// The implicit step of the GPU backend for laws with friction, where particles rotate.
#pragma once

#include "cuda_implicit.cuh"

namespace scree {

class CudaFrictionStep : public CudaImplicitStep {
 public:
  CudaFrictionStep(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h);

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
  FrictionCorrectItem correct_item(Real share);
  void rotate_particles();
  void refresh_ghosts(Device on);
  void queue_system();
  FrictionNorms largest_norms();
  bool is_consistent() const;
  Real right_hand_side();
  void report_not_finite();  // throws where a residual is not finite, as the item of the same name does
  template <bool kRolls>
  void queue_residual();
  int solve(Real tolerance);
  template <bool kRolls>
  int solve(Real tolerance);

  CudaFrictionArrays& friction_;
  bool lagged_ = false;
  ResidualSearch search_;                               // line search along friction_.correction
  Real scaled_residual_ = 0;                            // of the last contact force stage
  Real largest_stiffness_ratio_ = 0, force_scale_ = 0;  // of the last contact force stage
  Real phase_squared_ = 0;
  Real unit_ = 0;  // of friction_.correction, `direction_unit` [N]
  FrictionTolerance tolerance_;
};

}  // namespace scree
