// The implicit step of the serial backend.
#pragma once

#include <vector>

#include "dem/backend/implicit_step.hpp"
#include "dem/cpu/cpu_items.hpp"
#include "dem/implicit/block_solver.hpp"
#include "dem/implicit/line_search.hpp"

namespace scree {

// Workspace of implicit steps, reused by the next one.
struct CpuImplicitArrays {
  // state at the start of the step
  std::vector<Vec4> start_position, start_velocity;
  std::vector<Vec3> start_acceleration, start_force;
  // used by contact_force
  std::vector<Vec3> step_force, end_force;
  std::vector<Real> force_magnitude, stiffness_ratio;
  std::vector<Index> matrix_count;
  std::vector<ContactEntry> matrix_entries;
  std::vector<Sym3> matrix_diagonal, inverse_block;
  std::vector<Vec3> residual;
  // used by particle_correct
  std::vector<Vec3> right_hand_side, correction;
  std::vector<Vec4> direction;

  void resize(const ItemLayout& layout, std::size_t list_entries);
};

class CpuImplicitStep : public ImplicitStep {
 public:
  CpuImplicitStep(CpuItems& items, CpuImplicitArrays& arrays, Real h);

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
  void move_particles();
  StepViews step_views();
  StepForces step_forces();
  StepStart step_start() const;
  NewtonWeights newton_weights() const;

  CpuItems& items_;
  CpuImplicitArrays& arrays_;
  const Real h_;

 private:
  void find_steps();
  ContactMatrix matrix();
  CorrectItem correct_item(Real share);
  StepNorms largest_norms();
  void subtract_surface_steps();
  Real along_correction(const std::vector<Vec3>& residual) const;

  LineSearch line_search_;                              // along arrays_.correction
  Real largest_stiffness_ratio_ = 0, force_scale_ = 0;  // of the last contact_force
};

}  // namespace scree
