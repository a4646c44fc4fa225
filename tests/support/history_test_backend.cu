#include "contact_kernels_impl.cuh"
#include "cuda_backend.cuh"
#include "dem/backend/device.hpp"
#include "support/history_test_backend.hpp"

namespace scree {

template <int kNumbers>
std::unique_ptr<Backend> make_history_test_cuda_backend(const Model& model, const Ranks& ranks) {
  choose_device(ranks);
  DeviceArray<HistoryTestLaw<kNumbers>> laws;
  laws.upload(history_test_laws<kNumbers>(model), nullptr);
  return std::make_unique<CudaBackend>(
      model, ranks,
      std::make_unique<TableKernels<HistoryTestLaw<kNumbers>>>(std::move(laws), model.contact.materials()));
}

template std::unique_ptr<Backend> make_history_test_cuda_backend<3>(const Model&, const Ranks&);
template std::unique_ptr<Backend> make_history_test_cuda_backend<8>(const Model&, const Ranks&);

}  // namespace scree
