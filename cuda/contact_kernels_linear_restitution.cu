#include "contact_kernels_impl.cuh"
#include "physics/normal_laws.hpp"

namespace scree {

template std::unique_ptr<DeviceContactKernels> device_kernels(
    const std::vector<ContactLaw<LinearRestitutionLaw>>&, int);

}  // namespace scree
