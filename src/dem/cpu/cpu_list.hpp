// Ownership of particles and neighbour list of the serial backend.
#pragma once

#include <vector>

#include "dem/backend/rank_list.hpp"
#include "dem/cpu/cpu_items.hpp"
#include "dem/search/list_frame.hpp"
#include "dem/search/skin_choice.hpp"

namespace scree {

class CpuList : public RankList {
 public:
  explicit CpuList(CpuItems& items);

  void set_body_motion(std::span<const BodyMotion> motion) override;
  Real displacement() override;
  void build(Real skin, StageTimers& timers) override;
  Real choose_skin() override;
  Real skin() const override { return items_.list.skin; }
  std::int64_t entries() const override { return static_cast<std::int64_t>(items_.list.neighbors.size()); }
  std::int64_t builds() const override { return builds_; }
  LoadBalance balance() const override { return balance_; }

  // Whether the list covers all possible contacts after explicit steps that moved particles by at most
  // another `step` [m] in a step of length h [s]. Collective.
  bool covers(Real step, Real h);
  // Particles were added or removed: the list is invalid.
  void outdate() { current_ = false; }
  // Keeps the row lengths of these owned particles, in this order.
  void retain_rows(const std::vector<Index>& remaining);
  // Follows particles that are appended to the owned ones.
  void append_rows(std::size_t particles);
  // Those of these particles that this rank owns.
  std::vector<Particle> owned(const std::vector<Particle>& particles) const;
  // Packs the contact history before particles are added or the list is built.
  void pack_history();

 private:
  // Parts of build, in this order.
  void wrap_positions();
  void migrate();
  void decompose();
  void sort_cells(Real skin);
  // Resizes all item arrays and fills in the ghosts.
  void lay_out_items(Real skin);
  void measure_balance();
  void limit_skin();
  void choose_frame(Real skin);

  CpuItems& items_;
  NeighborBuilder builder_;
  Decomposition decomposition_;  // with several ranks, from the first list on
  LoadBalance balance_;
  std::vector<Index> row_length_;  // row lengths of the particles when the list was built, with several ranks
  SearchCells cells_;
  std::vector<Vec4> built_at_;  // positions of all items when the list was built
  bool current_ = false;        // whether the list was built from the current items
  std::int64_t builds_ = 0;
  SkinChoice choice_;
  std::int64_t steps_ = 0;  // explicit steps since the list was built
  // Largest displacement of a particle since the list was built, at the last call of displacement() [m].
  Real moved_ = 0;
  ListFrame frame_;
  Real bound_ = 0;          // upper bound of the displacement of any item since the list was built [m]
  Real surface_bound_ = 0;  // upper bound of the displacement of any surface since `bound_` was updated [m]
};

}  // namespace scree
