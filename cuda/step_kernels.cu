#include "step_kernels.cuh"

#include "for_each.cuh"

namespace scree {

void newmark(Device device, Index n, const NewmarkItem& item) { for_each(device, n, item); }

void residual(Device device, Index n, const ResidualItem& item) { for_each(device, n, item); }

void subtract_matrix(Device device, Index n, const SubtractMatrixItem& item) { for_each(device, n, item); }

void accept(Device device, Index n, const AcceptItem& item) { for_each(device, n, item); }

void verlet_start(Device device, Index n, const VerletStartItem& item, Real* d_squared) {
  max_over(device, n, item, d_squared);
}

}  // namespace scree
