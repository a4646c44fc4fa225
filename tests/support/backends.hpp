// The backend for the tests of this process: an argument of the test run, not of the test. The environment
// variable SCREE_TEST_BACKEND is cpu (the default) or cuda; ctest has an entry for each.
#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include "dem/backend/device.hpp"
#include "support/measured.hpp"

namespace scree {

inline bool tests_on_gpu() {
  const char* name = std::getenv("SCREE_TEST_BACKEND");
  return name != nullptr && std::string(name) == "cuda";
}

inline std::unique_ptr<Backend> make_test_backend(const Model& model, const Ranks& ranks = {}) {
  if (!tests_on_gpu()) return make_cpu_backend(model, ranks);
  measured_on_gpu(device_name());
  return make_cuda_backend(model, ranks);
}

}  // namespace scree
