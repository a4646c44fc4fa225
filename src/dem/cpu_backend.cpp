// Items and bodies of the serial backend. The list is in cpu_list.cpp, the steps are in cpu_implicit.cpp and
// cpu_explicit.cpp.
#include "dem/cpu_backend.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace scree {

CpuBackend::CpuBackend(const Model& model, const Ranks& ranks)
    : model_(model),
      ranks_(ranks),
      subdomain_(model.space),
      side_(model, subdomain_),
      builder_(model, side_.shapes()),
      kernels_(make_contact_kernels(model.contact)),
      planes_(wall_planes(model)),
      hht_(hht_coefficients(model.integrator.hht_alpha)) {}

std::string CpuBackend::description() const {
  return ranks_.alone() ? "cpu (serial)" : "cpu (" + std::to_string(ranks_.size()) + " ranks)";
}

void CpuBackend::load(const std::vector<Particle>& records, const ShapeLosses& shapes) {
  side_.losses() = ranks_.is_root() ? shapes : ShapeLosses{};
  count_on_rank(records.size(), model_.particles.totals);
  store_.load(records);
  layout_changed_ = true;
}

std::vector<Particle> CpuBackend::records() const {
  std::vector<Particle> out = store_.records();
  for (Particle& r : out)
    if (!r.drifting) r.position = subdomain_.wrap(r.position, r.image);
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

void CpuBackend::fail_if_any(GlobalId id, const char* before, const char* after) const {
  const GlobalId first = ranks_.min(id);
  if (first != kNone) throw SimulationError(before + std::to_string(first) + after);
}

void CpuBackend::report_not_finite(const std::vector<Vec3>& force) const {
  GlobalId bad = kNone;
  for (Index i = 0; i < layout_.owned; ++i)
    if (!is_finite(force[i])) bad = std::min(bad, id_of(store_.row_key[i]));
  fail_if_any(bad, "stage contact_force: the force on particle ", " is not finite");
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
    if (!(value <= squared) && !std::isnan(squared)) squared = value;  // a NaN counts as expired
  };
  for (Index i = 0; i < layout_.active; ++i) add(i);
  for (Index i = layout_.first_shape; i < layout_.items; ++i) add(i);
  squared = ranks_.max(squared);
  if (!std::isfinite(squared)) return 2;
  displacement_bound_ = std::sqrt(squared);
  return displacement_bound_ / half_skin;
}

std::unique_ptr<Backend> make_cpu_backend(const Model& model, const Ranks& ranks) {
  return std::make_unique<CpuBackend>(model, ranks);
}

}  // namespace scree
