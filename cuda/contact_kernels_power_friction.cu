#include "contact_kernels_impl.cuh"
#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

template std::unique_ptr<DeviceContactKernels> device_kernels(
    const std::vector<ContactLaw<PowerLaw, LinearSlider>>&, int);

}  // namespace scree
