// How long lists last: the largest displacement since a list was built, the frame that it is measured in, and
// the skin of the next list.
#include <algorithm>
#include <cmath>

#include "cuda_list.cuh"
#include "model/derived/choose_law.hpp"

namespace scree {
namespace {

// Square of the distance of a particle from its position at the list build [m^2].
struct MovedItem {
  const Vec3* from;
  const Vec4* to;
  Vec3 frame;  // its displacement [m]
  SCREE_HD Real operator()(Index i) const {
    const Vec3 d = xyz(to[i]) - from[i] - frame;
    return dot(d, d);
  }
};

// Largest values over the particles, of which each is found with those before.
enum Fall { kMostFall, kSlower, kSpeed, kInFrame, kFalls };

// Speed along a direction, and how much slower than the fastest.
struct FallItem {
  const Vec4* velocity;
  Vec3 down;
  SCREE_HD Real operator()(Index i) const { return dot(xyz(velocity[i]), down); }
};
struct SlowerItem {
  FallItem fall;
  const Real* falls;
  SCREE_HD Real operator()(Index i) const { return falls[kMostFall] - fall(i); }
};
// Squares of the speed, and of that relative to the mean of the slowest and the fastest fall.
struct SpeedItem {
  const Vec4* velocity;
  SCREE_HD Real operator()(Index i) const {
    const Vec3 v = xyz(velocity[i]);
    return dot(v, v);
  }
};
struct InFrameItem {
  const Vec4* velocity;
  Vec3 gravity;
  const Real* falls;
  SCREE_HD Real operator()(Index i) const {
    const Real most = falls[kMostFall];
    const Vec3 v = xyz(velocity[i]) - ListFrame::mean_fall(gravity, most - falls[kSlower], most);
    return dot(v, v);
  }
};

// Share of the free device memory that wider lists may take.
constexpr Real kMemoryShare = 0.5;

}  // namespace

// Whether the displacements since the list was built are known.
bool CudaList::measure() {
  if (!current_ || steps() <= 0) return false;
  return items_.history.step() == measured_step_ || displacement() < kInfinity;
}

// The frame moves only where some particles fall. All that it follows from is found by kernels before the
// host waits.
void CudaList::choose_frame(Real skin) {
  frame_ = {};
  const Model& model = items_.model;
  if (!lists_leave_no_trace(model) || model.gravity == Vec3{}) return;
  falls_.resize(kFalls), h_falls_.resize(kFalls);
  const auto find = [&](Fall which, const auto& item) {
    max_over(items_.device(), items_.layout.active, item, falls_.data() + which);
    items_.halo_stream.halo.max(items_.device(), falls_.data() + which, 1);
  };
  const Vec4* const velocity = items_.now.velocity.data();
  const FallItem fall{velocity, (1 / norm(model.gravity)) * model.gravity};
  find(kMostFall, fall);
  find(kSlower, SlowerItem{fall, falls_.data()});
  find(kSpeed, SpeedItem{velocity});
  find(kInFrame, InFrameItem{velocity, model.gravity, falls_.data()});
  copy_async(h_falls_.data(), falls_.data(), kFalls, items_.stream);
  wait_for(items_.stream);
  const Real most = h_falls_[kMostFall];
  if (!(most > 0)) return;
  frame_ = {model.gravity,
            most - h_falls_[kSlower],
            most,
            std::sqrt(h_falls_[kSpeed]),
            std::sqrt(h_falls_[kInFrame]),
            skin,
            kMostFrameReach * model.particles.totals.largest_radius};
}

void CudaList::plan_surfaces(Real skin) {
  const bool known = lists_leave_no_trace(items_.model) && bodies_.have_surfaces() && measure();
  bodies_.side().plan_list(skin, known ? moved_ : HostSurfaces::kNoMotion);
}

Real CudaList::choose_skin() {
  if (choice_.is_open() && measure()) choice_.note(bound_, steps());
  return choice_.next();
}

// An entry has its slots in whole and in pruned rows, its place in a pruned row, and its history.
void CudaList::limit_skin() {
  const Model& model = items_.model;
  const Real per_entry =
      2 * sizeof(Index) + sizeof(RowIndex) + records_of(history_of(model.contact)) * sizeof(Vec4);
  const Real slots = std::max(static_cast<Real>(entries()), slots_per_particle(model) * items_.owned);
  const Real free = kMemoryShare * static_cast<Real>(free_device_memory()) / items_.ranks.size();
  const Real limit = choice_.limit_in_memory(free, slots, per_entry);
  choice_.limit_to(1 / items_.ranks.max(1 / limit));  // the smallest limit of all ranks
}

Real CudaList::displacement() {
  if (!current_) return 2;
  commit_open_step();
  committed_ = true;
  const MovedItem moved{built_at_.data(), items_.now.position.data(), frame_.displacement()};
  DeviceResults& results = items_.results;
  max_over(items_.device(), items_.layout.active, moved, results.at(&Results::largest));
  Real largest[2] = {std::sqrt(results.fetch(&Results::largest)), bodies_.side().list_displacement()};
  items_.ranks.max(largest);
  if (!std::isfinite(largest[0]) || !std::isfinite(largest[1])) return 2;
  moved_ = largest[0], measured_step_ = items_.history.step();
  bound_ = std::max(largest[0], largest[1]);
  return bound_ / (skin_ / 2);
}

}  // namespace scree
