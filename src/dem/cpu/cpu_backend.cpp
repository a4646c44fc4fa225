#include "dem/cpu/cpu_backend.hpp"

namespace scree {

std::string CpuBackend::description() const {
  const Ranks& ranks = items_.ranks;
  return ranks.alone() ? "cpu (serial)" : "cpu (" + std::to_string(ranks.size()) + " ranks)";
}

std::unique_ptr<Backend> make_cpu_backend(const Model& model, const Ranks& ranks) {
  return std::make_unique<CpuBackend>(model, ranks);
}

}  // namespace scree
