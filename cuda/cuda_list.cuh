// The neighbour list of one rank on its GPU, and all that happens when one is built.
#pragma once

#include <cmath>
#include <vector>

#include "cell_sort.cuh"
#include "cuda_bodies.cuh"
#include "cuda_implicit.cuh"
#include "cuda_owners.cuh"
#include "dem/backend/rank_list.hpp"
#include "dem/search/list_frame.hpp"
#include "dem/search/skin_choice.hpp"

namespace scree {

class CudaList : public RankList {
 public:
  // step_arrays: those of implicit steps, which are resized with the list.
  CudaList(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& step_arrays);

  void set_body_motion(std::span<const BodyMotion> motion) override;
  Real displacement() override;
  void build(Real skin, StageTimers& timers) override;
  Real choose_skin() override;
  std::int64_t entries() const override { return items_.list.entries(); }
  std::int64_t builds() const override { return builds_; }
  LoadBalance balance() const override { return items_.balance; }
  Real skin() const override { return skin_; }

  // Whether the list is complete and was built for the present items.
  bool current() const { return current_; }
  void outdate() { current_ = false; }
  Real cutoff() const { return builder_.cutoff(skin_); }
  Real bound() const { return bound_; }  // upper bound of the displacement of any item since it was built [m]
  void set_bound(Real bound) { bound_ = bound, committed_ = false; }
  CudaOwners& owners() { return owners_; }
  // Packs the contact history before particles are added or the list is built.
  void pack_history();
  // The frame that displacement() refers to. open_run(): a run opens its first step of
  // length h [s]; follow(): steps were closed and others opened since then.
  const ListFrame& frame() const { return frame_; }
  void open_run(Real h) { frame_.move(h), followed_step_ = items_.history.step(), committed_ = false; }
  void follow(Real h) {
    frame_.move(h, items_.history.step() - followed_step_), followed_step_ = items_.history.step();
    committed_ = false;
  }

 private:
  std::int64_t steps() const { return std::llround(items_.history.step() - built_step_); }
  bool measure();
  void limit_skin();
  void choose_frame(Real skin);
  // Phases of build(), in order.
  void plan_surfaces(Real skin);
  void commit_open_step();
  void wrap_positions();
  void require_sound_positions();
  void sort_cells(Real skin, std::int64_t particles);
  void lay_out_items(Real skin);
  void collect_ghosts(Real width);
  void set_ghost_keys();
  void find_rows(Real skin);
  void reserve_for_steps();
  void index_ghosts();
  void index_levels(Real skin);
  void search(Real skin);

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaImplicitArrays& step_arrays_;
  NeighborBuilder builder_;  // grid and range of the search, which runs on the device
  CudaOwners owners_;
  CellSort particle_sort_, ghost_sort_;
  CellSort level_sort_;  // of all items, by level and cell, with particles of many sizes
  DeviceArray<LevelGrid> level_grids_;
  LevelIndex levels_;
  CellBlockGrid grid_;
  DeviceArray<Index> ghost_items_;
  DeviceArray<Vec3> built_at_;  // positions of the searched particles when the list was built
  bool current_ = false;
  bool committed_ = false;  // whether the open step is in the state, and none was taken since
  Real skin_ = 0, bound_ = 0;
  std::int64_t builds_ = 0;
  SkinChoice choice_;
  ListFrame frame_;
  DeviceArray<Real> falls_;  // what the frame is chosen from
  PinnedArray<Real> h_falls_;
  Real followed_step_ = 0;  // DeviceHistory::step() up to which the frame has moved
  Real built_step_ = 0;     // DeviceHistory::step() when the list was built
  Real measured_step_ = 0;  // and when `moved_` was measured
  Real moved_ = 0;          // largest displacement of a particle since the list was built [m]
};

}  // namespace scree
