// The implicit step of the GPU backend.
#pragma once

#include "cuda_solver.cuh"
#include "dem/backend/implicit_step.hpp"
#include "dem/implicit/line_search.hpp"
#include "dem/implicit/rotation_items.hpp"

namespace scree {

class CudaBodies;

// Additional arrays for laws with friction, where particles rotate.
struct CudaFrictionArrays {
  DeviceArray<Vec4> mean_spin;  // iterate, of all items
  // written by the contact force stage
  DeviceArray<Vec3> start_torque, step_torque, end_torque;
  DeviceArray<Real> phase_squared;
  DeviceArray<Index> surface_count;
  FrictionEntryArrays<DeviceArray> entries;
  DeviceArray<FrictionEntry> surface_entries;
  DeviceArray<RollingEntry> surface_rolling;  // for laws with rolling resistance
  DeviceArray<ScaledMass> mass;
  DeviceArray<float> inverse_block;  // laid out as `BlockSlices`
  DeviceArray<Twist> residual;
  DeviceArray<Twistf> correction;
  DeviceArray<Real> neighbor_limits, surface_limits;  // while the limits are lagged
  DeviceArray<FrictionNorms> norms{1};
  PinnedArray<FrictionNorms> h_norms{1};
  DeviceArray<Twistf> direction[2];  // all items

  void resize(const CudaItems& items);
};

// Workspace of implicit steps, kept from one to the next.
struct CudaImplicitArrays {
  // Stage `contact_force` of the implicit step.
  DeviceArray<Vec3> step_force, end_force, residual;
  DeviceArray<Real> force_magnitude, stiffness_ratio;
  DeviceArray<Index> matrix_count;
  DeviceArray<ContactEntry> matrix_entries;
  DeviceArray<Sym3> matrix_diagonal, inverse_block;
  // Stage `particle_correct`.
  DeviceArray<Vec3> right_hand_side, correction;
  DeviceArray<Vec4> direction[2];
  SolverProgress solver;
  CudaFrictionArrays friction;

  // Sizes the arrays for the items and their list after it is built.
  void resize(const CudaItems& items);
};

class CudaImplicitStep : public ImplicitStep {
 public:
  CudaImplicitStep(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h);

  void predict() override;
  Real step_displacement() override;
  ParticleNorms contact_force() override;
  GlobalId worst_particle() override;
  void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) override;
  ParticleCorrection particle_correct() override;
  void shorten_correction() override;
  Real error() override;
  void accept() override;
  void undo() override;

 protected:
  StepViews step_views();
  StepForces step_forces();
  StepStart step_start() const;
  NewtonWeights newton_weights() const;

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaImplicitArrays& arrays_;
  const Real h_;
  bool ghosts_stale_ = false;  // the next contact force stage refreshes them

 private:
  ContactMatrix matrix();
  CorrectItem correct_item(Real share);
  void queue_forces();
  StepNorms largest_norms();
  void subtract_surface_steps();
  int solve(const SubtractMatrixItem<SlicedRows>& matrix, Real tolerance);

  // Of the last contact force stage.
  Real largest_stiffness_ratio_ = 0, force_scale_ = 0, right_hand_side_norm_ = 0;
  LineSearch line_search_;  // along arrays_.correction
};

}  // namespace scree
