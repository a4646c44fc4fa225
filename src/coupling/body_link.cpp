#include "coupling/body_link.hpp"

#include <mpi.h>

#include <type_traits>

namespace scree {
namespace {

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

}  // namespace

BodyLink::BodyLink(const Model& model)
    : motion_(model.bodies.size()), step_wrench_(model.bodies.size()), end_wrench_(model.bodies.size()) {
  if (!model.bodies.empty() && is_root()) multibody_ = std::make_unique<Multibody>(model);
}

void BodyLink::broadcast(Backend& backend) {
  static_assert(std::is_trivially_copyable_v<BodyMotion>);
  MPI_Bcast(motion_.data(), static_cast<int>(motion_.size() * sizeof(BodyMotion)), MPI_BYTE, 0,
            MPI_COMM_WORLD);
  backend.place_bodies(motion_);
}

void BodyLink::broadcast_motion(Backend& backend) {
  if (!has_bodies()) return;
  if (multibody_) motion_ = multibody_->motion();
  broadcast(backend);
}

void BodyLink::broadcast_motion(Backend& backend, const MultibodyState& state, Real tau) {
  if (!has_bodies()) return;
  if (multibody_) motion_ = multibody_->motion(state, tau);
  broadcast(backend);
}

void BodyLink::reduce_wrench(Backend& backend) {
  if (has_bodies()) backend.reduce_wrench(step_wrench_, end_wrench_);
}

void BodyLink::set_mean_wrench(const std::vector<BodyWrench>& start, const std::vector<BodyWrench>& sum,
                               int substeps) {
  for (std::size_t b = 0; b < step_wrench_.size(); ++b) {
    step_wrench_[b] = {};
    step_wrench_[b].force = (Real(2) / substeps) * sum[b].force - start[b].force;
    step_wrench_[b].torque = (Real(2) / substeps) * sum[b].torque - start[b].torque;
  }
}

}  // namespace scree
