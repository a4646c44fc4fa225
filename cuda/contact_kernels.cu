#include "contact_kernels.cuh"
#include "model/derived/choose_law.hpp"

namespace scree {

std::unique_ptr<DeviceContactKernels> make_device_contact_kernels(const Contact& contact) {
  return with_contact_laws(contact,
                           [&](const auto& laws) { return device_kernels(laws, contact.materials()); });
}

}  // namespace scree
