// The explicit step of the serial backend.
#include <cmath>
#include <utility>

#include "base/for_each.hpp"
#include "dem/cpu_backend.hpp"

namespace scree {

VerletViews CpuBackend::verlet_views(Real h, std::vector<Vec4>& position, std::vector<Vec4>& velocity) {
  return {position.data(),
          velocity.data(),
          store_.acceleration.data(),
          store_.contact_loss.data(),
          store_.loss_power.data(),
          h,
          subdomain_.snap_constant()};
}

void CpuBackend::verlet_start(Real h) {
  const VerletStartItem item{verlet_views(h, store_.position, store_.velocity)};
  step_bound_ = std::sqrt(max_over(Serial{}, layout_.owned, item));
}

void CpuBackend::shape_contacts() {
  kernels_->shapes(views(), layout_.items - layout_.first_shape, shape_contacts_.data());
}

void CpuBackend::verlet_advance(Real h) {
  refresh_ghosts();
  shape_contacts();
  book_shape_losses(h);
  step_bound_ = std::sqrt(kernels_->verlet_advance(views(), model_.gravity, layout_.owned,
                                                   verlet_views(h, spare_position_, spare_velocity_)));
  std::swap(store_.position, spare_position_);
  std::swap(store_.velocity, spare_velocity_);
}

void CpuBackend::verlet_finish(Real h) {
  refresh_ghosts();
  shape_contacts();
  book_shape_losses(h);
  const Real squared =
      kernels_->verlet_finish(views(), model_.gravity, layout_.owned,
                              verlet_views(h, spare_position_, spare_velocity_), store_.force.data());
  if (!std::isfinite(squared)) report_not_finite(store_.force);
  std::swap(store_.velocity, spare_velocity_);
  refresh_ghosts();
}

}  // namespace scree
