// The implicit step of the GPU's backend.
#pragma once

#include "cuda_items.cuh"
#include "dem/implicit_step.hpp"
#include "dem/line_search.hpp"

namespace scree {

class CudaBodies;

// Progress of a linear solve: written by the last block of each product.
struct SolverControl {
  Real tolerance;  // on the largest |residual| [N]
  Real largest;    // squared, of this product
  unsigned finished_blocks;
  int products;
  int stop;
  int alone;  // the last block decides; else the ranks do, together, after the product
};

// Workspace of implicit steps, kept from one to the next.
struct CudaImplicitArrays {
  // contact_force
  DeviceArray<Vec3> step_force, end_force, residual;
  DeviceArray<Real> force_magnitude, stiffening;
  DeviceArray<Index> matrix_count;
  DeviceArray<ContactEntry> matrix_entries;
  DeviceArray<Sym3> matrix_diagonal, inverse_block;
  // particle_correct
  DeviceArray<Vec3> right_hand_side, correction;
  DeviceArray<Vec4> direction[2];
  DeviceArray<SolverControl> solver{1};
  PinnedArray<SolverControl> h_solver{1};

  // For the items and their list, when that is built.
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

 private:
  StepViews step_views();
  StepForces step_forces();
  StepStart step_start() const;
  NewtonWeights newton_weights() const;
  ContactMatrix matrix();
  CorrectItem correct_item(Real share);
  void queue_forces();
  StepNorms largest_norms();
  void subtract_surface_steps();
  int solve(const SubtractMatrixItem<SlicedRows>& matrix, Real tolerance);

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaImplicitArrays& arrays_;
  const Real h_;
  bool ghosts_stale_ = false;  // the next contact_force refreshes them
  // Of the last contact_force.
  Real largest_stiffening_ = 0, force_scale_ = 0, right_hand_side_norm_ = 0;
  LineSearch line_search_;  // along arrays_.correction
};

}  // namespace scree
