// Bandwidth of copies within the GPU's memory, bytes read and written: the yardstick of the profile tables.
#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr std::size_t kBytes = std::size_t{4} << 30;
constexpr int kRepeats = 20;

void require(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  std::fprintf(stderr, "error: %s: %s\n", what, cudaGetErrorString(status));
  std::exit(1);
}

}  // namespace

int main() {
  cudaDeviceProp device{};
  require(cudaGetDeviceProperties(&device, 0), "device 0");
  void *from = nullptr, *to = nullptr;
  require(cudaMalloc(&from, kBytes), "4 GiB of device memory");
  require(cudaMalloc(&to, kBytes), "another 4 GiB of device memory");
  require(cudaMemset(from, 1, kBytes), "memset");
  cudaEvent_t start, end;
  require(cudaEventCreate(&start), "event"), require(cudaEventCreate(&end), "event");
  std::array<double, kRepeats> rates{};  // [GB/s]
  for (int r = -2; r < kRepeats; ++r) {  // the first two warm up
    float milliseconds = 0;
    require(cudaEventRecord(start), "event");
    require(cudaMemcpyAsync(to, from, kBytes, cudaMemcpyDeviceToDevice), "copy");
    require(cudaEventRecord(end), "event");
    require(cudaEventSynchronize(end), "copy");
    require(cudaEventElapsedTime(&milliseconds, start, end), "event");
    if (r >= 0) rates[static_cast<std::size_t>(r)] = 2e-6 * static_cast<double>(kBytes) / milliseconds;
  }
  std::sort(rates.begin(), rates.end());
  std::printf("%s: copies of 4 GiB, read and written: %.0f GB/s (%.0f to %.0f, %d copies)\n", device.name,
              rates[kRepeats / 2], rates.front(), rates.back(), kRepeats);
}
