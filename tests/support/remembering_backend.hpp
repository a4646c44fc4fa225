// The backends with a law that remembers.
#pragma once

#include <memory>
#include <vector>

#include "dem/contact_kernels_impl.hpp"
#include "dem/cpu_backend.hpp"
#include "support/backends.hpp"
#include "support/remembering_law.hpp"

namespace scree {

template <int kNumbers>
std::unique_ptr<Backend> make_remembering_cpu_backend(const Model& model, const Ranks& ranks) {
  std::vector<RememberingLaw<kNumbers>> laws;
  for (const KelvinVoigt& pair : model.contact.laws) laws.emplace_back(pair);
  return std::make_unique<CpuBackend>(
      model, ranks,
      std::make_unique<CpuTableKernels<RememberingLaw<kNumbers>>>(laws, model.contact.materials()));
}

template <int kNumbers>
std::unique_ptr<Backend> make_remembering_backend(const Model& model, const Ranks& ranks) {
  return make_remembering_cpu_backend<kNumbers>(model, ranks);
}

}  // namespace scree
