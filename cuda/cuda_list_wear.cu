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

// Speed along a direction, and its difference from `most`.
struct FallItem {
  const Vec4* velocity;
  Vec3 down;
  SCREE_HD Real operator()(Index i) const { return dot(xyz(velocity[i]), down); }
};
struct SlowerItem {
  FallItem fall;
  Real most;
  SCREE_HD Real operator()(Index i) const { return most - fall(i); }
};
// Square of the speed relative to a frame.
struct SpeedItem {
  const Vec4* velocity;
  Vec3 frame;
  SCREE_HD Real operator()(Index i) const {
    const Vec3 v = xyz(velocity[i]) - frame;
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

// Over the particles of all ranks that are searched, at least 0.
template <class Item>
Real CudaList::largest_of(const Item& item) {
  max_over(items_.device(), items_.layout.active, item, items_.results.at(&Results::largest));
  return items_.ranks.max(items_.results.fetch(&Results::largest));
}

// The frame moves only where some particles fall.
void CudaList::choose_frame(Real skin) {
  frame_ = {};
  const Model& model = items_.model;
  if (!lists_leave_no_trace(model) || model.gravity == Vec3{}) return;
  const Vec4* const velocity = items_.now.velocity.data();
  const FallItem fall{velocity, (1 / norm(model.gravity)) * model.gravity};
  const Real most = largest_of(fall);
  if (!(most > 0)) return;
  const Real least = most - largest_of(SlowerItem{fall, most}),
             speed = std::sqrt(largest_of(SpeedItem{velocity, {}})),
             in_frame =
                 std::sqrt(largest_of(SpeedItem{velocity, ListFrame::mean_fall(model.gravity, least, most)}));
  frame_ = {model.gravity,
            least,
            most,
            speed,
            in_frame,
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
