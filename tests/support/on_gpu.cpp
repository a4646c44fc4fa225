// Runs a test program with the CUDA backend; without a usable GPU it prints the reason and exits with the
// code that ctest shows as skipped. Usage: on_gpu PROGRAM [ARGUMENTS]
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "dem/backend/device.hpp"

namespace {

constexpr int kSkipped = 4, kBadUsage = 2;

}  // namespace

int main(int count, char** values) {
  if (count < 2) return kBadUsage;
  const std::string trouble = scree::device_error();
  if (!trouble.empty()) {
    std::printf("skipped: %s\n", trouble.c_str());
    return kSkipped;
  }
  setenv("SCREE_TEST_BACKEND", "cuda", 1);
  execv(values[1], values + 1);
  std::perror(values[1]);
  return kBadUsage;
}
