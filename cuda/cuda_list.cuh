// The neighbour list of one rank on its GPU, and all that happens when one is built.
#pragma once

#include <vector>

#include "cell_sort.cuh"
#include "cuda_bodies.cuh"
#include "cuda_implicit.cuh"
#include "cuda_owners.cuh"
#include "dem/backend/rank_list.hpp"

namespace scree {

class CudaList : public RankList {
 public:
  // step_arrays: those of implicit steps, which are resized with the list.
  CudaList(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& step_arrays)
      : items_(items),
        bodies_(bodies),
        step_arrays_(step_arrays),
        builder_(items.model),
        owners_(items, builder_) {}

  void set_body_motion(std::span<const BodyMotion> motion) override;
  Real displacement() override;
  void build(Real skin, StageTimers& timers) override;
  std::int64_t entries() const override { return items_.list.entries(); }
  std::int64_t builds() const override { return builds_; }
  LoadBalance balance() const override { return items_.balance; }

  // Whether the list is complete and was built for the present items.
  bool current() const { return current_; }
  void outdate() { current_ = false; }
  Real skin() const { return skin_; }  // that the list covers [m]
  Real cutoff() const { return builder_.cutoff(skin_); }
  Real bound() const { return bound_; }  // upper bound of the displacement of any item since it was built [m]
  void set_bound(Real bound) { bound_ = bound; }
  CudaOwners& owners() { return owners_; }

 private:
  // Phases of build(), in order.
  void commit_open_step();
  void pack_history();
  void wrap_positions();
  void sort_cells(Real skin, std::int64_t particles);
  void lay_out_items(Real skin);
  void collect_ghosts(Real width);
  void set_ghost_keys();
  void find_rows(Real skin);
  void reserve_for_steps();
  void index_ghosts();
  void search(Real skin);

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaImplicitArrays& step_arrays_;
  NeighborBuilder builder_;  // grid and range of the search, which runs on the device
  CudaOwners owners_;
  CellSort particle_sort_, ghost_sort_;
  CellBlockGrid grid_;
  DeviceArray<Index> ghost_items_;
  DeviceArray<Vec3> built_at_;  // positions of the searched particles when the list was built
  bool current_ = false;
  Real skin_ = 0, bound_ = 0;
  std::int64_t builds_ = 0;
};

}  // namespace scree
