// Implicit steps on the serial backend: memory, loops and communication for `ImplicitSchedule`.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "base/for_each.hpp"
#include "base/reproducible_sum.hpp"
#include "dem/backend/implicit_step.hpp"
#include "dem/cpu/cpu_items.hpp"
#include "dem/cpu/cpu_solver.hpp"
#include "dem/implicit/rotation_items.hpp"
#include "dem/schedule/step_arrays.hpp"

namespace scree {

// State at the start of a step. Of all items, for contacts with ghosts, but for accelerations.
struct CpuStepStart {
  std::vector<Vec4> position, velocity, angular_velocity;
  std::vector<Vec3> acceleration, angular_acceleration;
};

// Workspace of implicit steps, reused by the next one.
struct CpuImplicitArrays {
  CpuStepStart start;
  StepArrays<std::vector> step;
};

// See `ImplicitSchedule` for the functions.
class CpuImplicitOperations {
 public:
  using Rows = PackedRows;
  using Arrays = StepArrays<std::vector>;

  CpuImplicitOperations(CpuItems& items, CpuImplicitArrays& arrays, Real h);

  CpuItems& items() { return items_; }
  ParticleStore& now() { return items_.store; }
  CpuStepStart& start() { return arrays_.start; }
  Arrays& arrays() { return arrays_.step; }
  Real h() const { return h_; }
  CpuItems::Views views() { return items_.views(); }
  PackedRows rows() const { return {items_.list.offsets.data(), items_.list.neighbors.data()}; }
  const Index* surface_offsets() const { return items_.list.surfaces.offsets.data(); }
  const Index* surface_entries() const { return items_.list.surfaces.surfaces.data(); }
  SurfaceMoves surface_moves() { return {side().step().data(), side().step_rotation().data()}; }
  HostSurfaces& side() { return items_.side; }
  bool has_surfaces() const { return items_.side.size() > 0; }

  template <class Item>
  void for_each(const Item& item) {
    scree::for_each(Serial{}, owned(), item);
  }
  template <class Item>
  Real max(const Item& item) {
    return items_.ranks.max(max_over(Serial{}, owned(), item));
  }
  template <class Item>
  void queue_max(const Item& item) {
    max_ = max(item);
  }
  Real queued_max() const { return max_; }
  template <class Item>
  void queue_sum(const Item& item) {
    reproducible_sums(owned(), item, sum_, items_.ranks);
  }
  Real queued_sum() const { return sum_[0]; }
  Real largest_displacement();
  void copy(const std::vector<Vec3>& from, std::vector<Vec3>& to) { to = from; }

  void iterate_changed();
  void find_surface_steps(const FrictionStart& start);
  void take_surface_steps();
  template <class Residual, class Norms>
  void form_system(const StepSystem& system, const Residual& residual, const Norms& norms) {
    items_.kernels->run(items_.views(), owned(), system);
    for_each(residual);
    largest_ = {};
    for (Index i = 0; i < owned(); ++i) take_larger(norms(i));
  }
  FrictionNorms norms();
  template <class System>
  int solve(System& of, Real largest_stiffness_ratio, Real tolerance) {
    return solve_on_host(items_.halo, items_.ranks, owned(), of, largest_stiffness_ratio, tolerance);
  }
  void lag_limits(const FrictionStart& start);
  void account_contacts(const FrictionStart& start);
  template <class Item>
  GlobalId worst(const Item& item);
  void report_not_finite() { items_.report_not_finite(arrays().residual); }
  void undo();

 private:
  Index owned() const { return items_.layout.owned; }
  void take_larger(const StepNorms& one);
  void take_larger(const FrictionNorms& one);

  CpuItems& items_;
  CpuImplicitArrays& arrays_;
  const Real h_;
  FrictionNorms largest_{};  // of form_system, on this rank
  Real max_ = 0, sum_[1] = {};
};

template <class Item>
GlobalId CpuImplicitOperations::worst(const Item& item) {
  const Real largest = max(item);
  GlobalId worst = CpuItems::kNone;
  for (Index i = 0; i < owned(); ++i)
    if (item(i) == largest) worst = std::min(worst, id_of(now().row_key[i]));
  worst = items_.ranks.min(worst);
  return worst == CpuItems::kNone ? -1 : worst;
}

std::unique_ptr<ImplicitStep> open_cpu_step(CpuItems& items, CpuImplicitArrays& arrays, Real h);

}  // namespace scree
