// Functions of device.hpp in a build without CUDA.
#include "base/error.hpp"
#include "dem/backend/device.hpp"

namespace scree {

void choose_device(const Ranks&) {}

std::string device_error() {
  return "this program was built without CUDA (cmake --preset cuda builds it with)";
}

std::string device_name() { return "none"; }

std::size_t free_device_memory() { return 0; }

std::size_t device_memory_in_use() { return 0; }

std::vector<DeviceShare> device_shares(const Backend&) { return {}; }

DeviceClaim claim_device(const Model&) { throw InputError(device_error()); }

std::unique_ptr<Backend> make_cuda_backend(const Model&, const Ranks&) { throw InputError(device_error()); }

}  // namespace scree
