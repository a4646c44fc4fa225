// Kernels of laws with exponent 1.
#include "contact_kernels_impl.cuh"

namespace scree {

std::unique_ptr<DeviceContactKernels> make_linear_kernels(const Contact& contact, const KelvinVoigt* d_laws) {
  return kernels_with<LinearElastic>(contact, d_laws);
}

}  // namespace scree
