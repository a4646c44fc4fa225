// The serial backend of one rank: the paper's CMAP.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dem/backend.hpp"
#include "dem/block_solver.hpp"
#include "dem/contact_kernels.hpp"
#include "dem/line_search.hpp"
#include "dem/neighbor_list.hpp"
#include "dem/particle_store.hpp"
#include "dem/step_items.hpp"
#include "physics/energy.hpp"

namespace scree {

class CpuBackend : public Backend {
 public:
  explicit CpuBackend(const Model& model, const Ranks& ranks = {});
  std::string description() const override;

  void load(const std::vector<Particle>& records, const ShapeLosses& shapes) override;
  std::vector<Particle> records() const override;
  ShapeLosses shape_losses() const override { return side_.losses(); }

  void place_bodies(std::span<const BodyMotion> motion) override;
  Real list_displacement() override;
  void build_list(Real skin, StageTimers& timers) override;
  std::int64_t list_entries() const override { return static_cast<std::int64_t>(list_.neighbors.size()); }
  std::int64_t list_builds() const override { return list_builds_; }
  LoadBalance balance() const override { return balance_; }
  void initial_forces() override;

  void begin_step(Real h) override;
  void rollback() override;
  Real step_displacement() override;
  ParticleNorms contact_force() override;
  GlobalId worst_particle() const override;
  void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) override;
  void reduce_wrench(std::vector<BodyWrench>& end) override;
  ParticleCorrection particle_correct() override;
  void shorten_correction() override;
  Real error() override;
  void accept() override;

  void verlet_start(Real h) override;
  VerletRun verlet_run(Real h, Index most, bool keep_open, StageTimers& timers) override;
  void shape_contacts() override;

  std::vector<Leaver> outside() const override;
  void take_out(const std::vector<Leaver>& leavers) override;
  ParticleLedger ledger(Real verlet_step) override;
  void start_pack() override;
  ParticlePack pack_particles() override { return std::move(pack_); }
  ShapePack pack_shapes() override;
  std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) const override;
  std::vector<ContactSum> body_contacts() override;
  std::vector<ContactSum> wall_contacts(std::span<const int> walls) override;

 private:
  using Views = ContactViews<PackedRows>;
  Views views() const { return views(store_.position, store_.velocity); }
  Views views(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity) const;
  StepViews step_views();
  void verlet_advance(Real h);
  void verlet_finish(Real h);
  bool ends_step() const { return (closed_ + 1) % model_.integrator.substeps == 0; }
  VerletViews verlet_views(Real h, std::vector<Vec4>& position, std::vector<Vec4>& velocity);
  StepForces step_forces();
  StepStart step_start() const;
  CorrectItem correct_item(Real share);
  Real along_correction(const std::vector<Vec3>& residual) const;
  void share_step();
  bool any_outside() const;
  void take_contacts_out();
  // Parts of build_list, in their order.
  void wrap_positions();
  void migrate();
  void decompose();
  void sort_cells(Real skin);
  // Sizes all item arrays, fills in ghosts and shapes.
  void lay_out_items(Real skin);
  void size_step_arrays();
  void measure_balance();
  void refresh_ghosts() { halo_.update_motion(store_.position, store_.velocity, layout_.owned); }
  // Throws SimulationError naming the first particle, on all ranks, whose force is not finite.
  void report_not_finite(const std::vector<Vec3>& force) const;
  // The same of a particle that only some ranks know of; id: kNone without one.
  void fail_if_any(GlobalId id, const char* before, const char* after) const;
  static constexpr GlobalId kNone = std::numeric_limits<GlobalId>::max();
  void place_shapes();
  void find_shape_contacts(const Views& views);

  const Model& model_;
  Ranks ranks_;
  Subdomain subdomain_;
  ShapeSide side_;
  NeighborBuilder builder_;
  std::unique_ptr<ContactKernels> kernels_;
  std::vector<WallPlane> planes_;
  HhtCoefficients hht_;

  ParticleStore store_;
  Decomposition decomposition_;  // with several ranks, from the first list on
  LoadBalance balance_;
  std::vector<Index> row_length_;  // of the particles when the list was built, with several ranks
  Halo halo_;
  SearchCells cells_;
  NeighborList list_;
  ItemLayout layout_;
  std::vector<Vec4> list_position_;  // of all items when the list was built
  bool layout_changed_ = true;       // particles left since the list was built
  std::int64_t list_builds_ = 0;

  // Workspace of the implicit step: start of the step (begin_step), then contact_force, then
  // particle_correct.
  Real h_ = 0;
  std::vector<Vec4> start_position_, start_velocity_;
  std::vector<Vec3> start_acceleration_, start_force_;
  std::vector<Vec3> step_force_, end_force_;
  std::vector<Real> force_magnitude_, stiffening_;
  std::vector<Index> matrix_count_;
  std::vector<ContactEntry> matrix_entries_;
  std::vector<Vec3> residual_, right_hand_side_, correction_;
  std::vector<Sym3> matrix_diagonal_, inverse_block_;
  std::vector<Vec4> direction_;
  std::vector<Vec4> spare_position_, spare_velocity_;  // explicit steps write here while neighbours are read
  Index closed_ = 0;                                   // explicit steps since verlet_start
  bool outside_ = false;  // whether a particle is outside the space where the open step ends, if one of the
                          // bodies ends there
  bool opened_ = false;   // whether the last of them was closed by opening the next
  Real largest_stiffening_ = 0, force_scale_ = 0;
  LineSearch line_search_;  // along correction_
  bool in_implicit_step_ = false;
  ParticlePack pack_;            // of start_pack
  Real displacement_bound_ = 0;  // of any item since the list was built, at most [m]
  Real step_bound_ = 0;          // of any particle in the open explicit step [m]
  Real shape_bound_ = 0;         // of any shape since list_displacement was last asked, at most [m]
  BlockSolver solver_;
};

}  // namespace scree
