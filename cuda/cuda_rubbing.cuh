// The implicit step of the GPU backend for laws with friction, where particles rotate.
#pragma once

#include "cuda_implicit.cuh"

namespace scree {

class CudaRubbingStep : public CudaImplicitStep {
 public:
  CudaRubbingStep(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h);

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
  RubbingCorrectItem correct_item(Real share);
  void turn_particles();
  void refresh_ghosts(Device on);
  void queue_system();
  RubbingNorms largest_norms();
  bool is_consistent() const;
  Real right_hand_side();
  void report_not_finite();  // throws where a residual is not finite, as the item of the same name does
  int solve(Real tolerance);

  CudaRubbingArrays& rubbing_;
  bool frozen_ = false;
  ResidualSearch search_;                          // line search along rubbing_.correction
  Real scaled_residual_ = 0;                       // of the last contact force stage
  Real largest_stiffening_ = 0, force_scale_ = 0;  // of the last contact force stage
  Real sharpness_ = 0;
  Real unit_ = 0;  // of rubbing_.correction, `direction_unit` [N]
  RubbingTolerance tolerance_;
};

}  // namespace scree
