#include "dem/backend/device.hpp"
#include "support/history_test_backend.hpp"

namespace scree {

template <int kNumbers>
std::unique_ptr<Backend> make_history_test_cuda_backend(const Model&, const Ranks&) {
  throw InputError(device_error());
}

template std::unique_ptr<Backend> make_history_test_cuda_backend<3>(const Model&, const Ranks&);
template std::unique_ptr<Backend> make_history_test_cuda_backend<8>(const Model&, const Ranks&);

}  // namespace scree
