#include "contact_kernels_impl.cuh"
#include "physics/cohesion.hpp"

namespace scree {

template std::unique_ptr<DeviceContactKernels> device_kernels(
    const std::vector<ContactLaw<CohesiveLaw<HertzLaw>>>&, int);

}  // namespace scree
