// Backends with a law with history.
#pragma once

#include <memory>
#include <vector>

#include "dem/cpu/cpu_backend.hpp"
#include "dem/laws/contact_kernels_impl.hpp"
#include "support/backends.hpp"
#include "support/history_test_law.hpp"

namespace scree {

template <int kNumbers>
std::vector<HistoryTestLaw<kNumbers>> history_test_laws(const Model& model) {
  return {model.contact.laws.begin(), model.contact.laws.end()};
}

template <int kNumbers>
std::unique_ptr<Backend> make_history_test_cpu_backend(const Model& model, const Ranks& ranks) {
  return std::make_unique<CpuBackend>(model, ranks,
                                      std::make_unique<CpuTableKernels<HistoryTestLaw<kNumbers>>>(
                                          history_test_laws<kNumbers>(model), model.contact.materials()));
}

// Defined in history_test_backend.cu, for 3 numbers and for 8; without CUDA in no_history_test_backend.cpp.
template <int kNumbers>
std::unique_ptr<Backend> make_history_test_cuda_backend(const Model& model, const Ranks& ranks);

template <int kNumbers>
std::unique_ptr<Backend> make_history_test_backend(const Model& model, const Ranks& ranks) {
  return tests_on_gpu() ? make_history_test_cuda_backend<kNumbers>(model, ranks)
                        : make_history_test_cpu_backend<kNumbers>(model, ranks);
}

}  // namespace scree
