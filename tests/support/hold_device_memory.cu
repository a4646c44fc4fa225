// Takes all free memory of a GPU, and what others free there, until it is ended: for tests of runs that find
// none. Usage: hold_device_memory GPU. Says "held" once it has it, and exits with 4 where there is no such
// GPU.
#include <cuda_runtime.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

int main(int count, char** values) {
  constexpr int kNoGpu = 4, kBadUsage = 2;
  if (count != 2) return kBadUsage;
  if (cudaSetDevice(std::atoi(values[1])) != cudaSuccess) return kNoGpu;
  constexpr std::size_t kLargest = std::size_t{1} << 30, kSmallest = std::size_t{1} << 20;  // of a piece [B]
  for (bool told = false;;) {
    void* piece = nullptr;  // stays taken
    for (std::size_t bytes = kLargest; bytes >= kSmallest; bytes /= 2)
      while (cudaMalloc(&piece, bytes) == cudaSuccess) continue;
    if (!told) std::puts("held"), std::fflush(stdout);
    told = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}
