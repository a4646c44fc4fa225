// Items, list and bodies of the serial backend. The steps are in cpu_implicit.cpp and cpu_explicit.cpp.
#include "dem/cpu_backend.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"

namespace scree {

CpuBackend::CpuBackend(const Model& model)
    : model_(model),
      subdomain_(model.space),
      side_(model, subdomain_),
      builder_(model, side_.shapes()),
      kernels_(make_contact_kernels(model.contact)),
      planes_(wall_planes(model)),
      hht_(hht_coefficients(model.integrator.hht_alpha)) {}

void CpuBackend::load(const std::vector<ParticleRecord>& records, const ShapeLosses& shapes) {
  side_.losses() = shapes;
  store_.load(model_.particles, records);
  layout_changed_ = true;
}

std::vector<ParticleRecord> CpuBackend::records() const {
  std::vector<ParticleRecord> out = store_.records();
  for (ParticleRecord& r : out) r.position = subdomain_.wrap(r.position, r.image);
  return out;
}

CpuBackend::Views CpuBackend::views(const std::vector<Vec4>& position,
                                    const std::vector<Vec4>& velocity) const {
  return {position.data(),
          velocity.data(),
          store_.material.data(),
          {list_.offsets.data(), list_.neighbors.data()},
          list_.wall_offsets.data(),
          list_.walls.data(),
          planes_.data(),
          layout_.first_shape};
}

void CpuBackend::place_bodies(std::span<const BodyMotion> motion) {
  side_.set_motion(motion);
  if (!layout_changed_) place_shapes();
}

void CpuBackend::place_shapes() {
  shape_bound_ += side_.place(layout_);
  std::copy(side_.position().begin(), side_.position().end(), store_.position.begin() + layout_.first_shape);
  std::copy(side_.velocity().begin(), side_.velocity().end(), store_.velocity.begin() + layout_.first_shape);
}

void CpuBackend::find_shape_contacts(const Views& views) {
  kernels_->shapes(views, {side_.position().data(), side_.velocity().data()},
                   layout_.items - layout_.first_shape, side_.contacts().data());
}

void CpuBackend::report_not_finite(const std::vector<Vec3>& force) const {
  for (Index i = 0; i < layout_.owned; ++i)
    if (!is_finite(force[i]))
      throw SimulationError("stage contact_force: the force on particle " +
                            std::to_string(store_.global_id[i]) + " is not finite");
}

void CpuBackend::refresh_ghosts() {
  update_halo_positions(layout_.ghosts, store_.position, layout_.owned);
  update_halo(layout_.ghosts, store_.velocity, layout_.owned);
}

// Owned particles in the order of their cells; those outside at the end.
void CpuBackend::sort_cells(Real skin) {
  const CellGrid grid = builder_.grid(skin, store_.owned + side_.shapes().size());
  const Index outside = grid.count();
  std::vector<Index> cell(store_.owned), start(outside + 2, 0), from(store_.owned);
  store_.active = 0;
  for (Index i = 0; i < store_.owned; ++i) {
    store_.position[i] =
        vec4(subdomain_.wrap(xyz(store_.position[i]), store_.image[i]), store_.position[i].w);
    cell[i] = store_.drifting[i] ? outside : grid.cell(xyz(store_.position[i]));
    if (!is_finite(xyz(store_.position[i])))
      throw SimulationError("stage sort_cells: the position of particle " +
                            std::to_string(store_.global_id[i]) + " is not finite");
    if (cell[i] < 0) cell[i] = outside;  // has left; whether it may is asked at the end of the step
    store_.active += cell[i] != outside;
    ++start[cell[i] + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (Index i = 0; i < store_.owned; ++i) from[start[cell[i]]++] = i;
  store_.reorder(from);
}

void CpuBackend::lay_out_items(Real skin) {
  layout_.owned = store_.owned, layout_.active = store_.active;
  const Real width = builder_.cutoff(skin);
  layout_.ghosts = exchange_halo(subdomain_, model_.space,
                                 {store_.position.data(), static_cast<std::size_t>(store_.active)}, width);
  layout_.first_shape = layout_.owned + static_cast<Index>(layout_.ghosts.size());

  side_.lay_out(model_.space, width, layout_);

  store_.position.resize(layout_.items), store_.velocity.resize(layout_.items);
  store_.material.resize(layout_.items), store_.global_id.resize(layout_.items);
  for (std::size_t g = 0; g < layout_.ghosts.size(); ++g) {
    store_.material[layout_.owned + g] = store_.material[layout_.ghosts[g].source];
    store_.global_id[layout_.owned + g] = store_.global_id[layout_.ghosts[g].source];
  }
  for (Index item = layout_.first_shape; item < layout_.items; ++item) {
    const ShapeItem& shape = side_.shapes().items()[layout_.shape_of(item)];
    store_.material[item] = shape.material, store_.global_id[item] = shape.global_id;
  }
}

void CpuBackend::build_list(Real skin, StageTimers& timers) {
  {
    const auto scope = timers.time(Stage::sort_cells);
    sort_cells(skin);
  }
  {
    const auto scope = timers.time(Stage::exchange_halo);
    lay_out_items(skin);
    refresh_ghosts();
    place_shapes();
  }
  const auto scope = timers.time(Stage::neighbors);
  builder_.build(store_, layout_, skin, list_);
  list_position_ = store_.position;
  spare_position_ = store_.position, spare_velocity_ = store_.velocity;
  displacement_bound_ = step_bound_ = shape_bound_ = 0;
  layout_changed_ = false;
  ++list_builds_;

  const std::size_t slots = list_.neighbors.size(), owned = static_cast<std::size_t>(layout_.owned);
  if (model_.integrator.particles != ParticleIntegrator::hht) return;
  matrix_entries_.resize(slots), direction_.resize(layout_.items);
  step_force_.resize(owned), end_force_.resize(owned), step_loss_.resize(owned), end_loss_.resize(owned);
  force_magnitude_.resize(owned), stiffening_.resize(owned), matrix_count_.resize(owned);
  residual_.resize(owned), right_hand_side_.resize(owned), correction_.resize(owned),
      matrix_diagonal_.resize(owned), inverse_block_.resize(owned);
}

Real CpuBackend::list_displacement() {
  if (layout_changed_) return 2;
  const Real half_skin = list_.skin / 2;
  if (!in_implicit_step_) {  // the sum of the steps' largest displacements is cheap; the exact value follows
                             // past it
    displacement_bound_ += std::max(step_bound_, shape_bound_);
    step_bound_ = shape_bound_ = 0;
    if (displacement_bound_ < half_skin) return displacement_bound_ / half_skin;
  }
  Real squared = 0;
  const auto add = [&](Index i) {
    const Vec3 d = xyz(store_.position[i]) - xyz(list_position_[i]);
    const Real value = dot(d, d);
    if (!(value <= squared)) squared = value;  // a NaN counts as expired
  };
  for (Index i = 0; i < layout_.active; ++i) add(i);
  for (Index i = layout_.first_shape; i < layout_.items; ++i) add(i);
  if (!std::isfinite(squared)) return 2;
  displacement_bound_ = std::sqrt(squared);
  return displacement_bound_ / half_skin;
}

std::unique_ptr<Backend> make_cpu_backend(const Model& model) { return std::make_unique<CpuBackend>(model); }

}  // namespace scree
