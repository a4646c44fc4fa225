#include "contact_kernels_impl.cuh"

namespace scree {

template std::unique_ptr<DeviceContactKernels> device_kernels(
    const std::vector<ContactLaw<LinearRestitutionLaw, LinearSlider>>&, int);

}  // namespace scree
