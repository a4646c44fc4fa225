// Kernels of laws with other exponents, and the choice between the two.
#include "contact_kernels_impl.cuh"

namespace scree {

std::unique_ptr<DeviceContactKernels> make_linear_kernels(const Contact& contact, const KelvinVoigt* d_laws);

std::unique_ptr<DeviceContactKernels> make_device_contact_kernels(const Contact& contact,
                                                                  const KelvinVoigt* d_laws) {
  return is_linear(contact) ? make_linear_kernels(contact, d_laws)
                            : kernels_with<PowerElastic>(contact, d_laws);
}

}  // namespace scree
