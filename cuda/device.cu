// The GPU of this machine, and what a model needs of its memory.
#include <algorithm>
#include <iterator>

#include "dem/backend/device.hpp"
#include "device.cuh"

namespace scree {

std::size_t& device_bytes_in_use() {
  static std::size_t bytes = 0;
  return bytes;
}

namespace {

cudaError_t chosen = cudaSuccess;  // result of choose_device

int this_device() {
  int device = 0;
  require_cuda(cudaGetDevice(&device), "cudaGetDevice");
  return device;
}

cudaDeviceProp this_properties() {
  cudaDeviceProp properties{};
  require_cuda(cudaGetDeviceProperties(&properties, this_device()), "cudaGetDeviceProperties");
  return properties;
}

}  // namespace

void choose_device(const Ranks& ranks) {
  const int number = ranks.local_rank();
  int devices = 0;
  if (!ranks.alone() && cudaGetDeviceCount(&devices) == cudaSuccess && devices > 0)
    chosen = cudaSetDevice(number % devices);
}

std::size_t multiprocessors() {
  int count = 0;
  require_cuda(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, this_device()),
               "cudaDeviceGetAttribute");
  return static_cast<std::size_t>(count);
}

namespace {

__global__ void trial_kernel() {}

std::string convergence_error(cudaError_t status) {
  int driver = 0, runtime = 0;
  cudaDriverGetVersion(&driver), cudaRuntimeGetVersion(&runtime);
  const auto version = [](int v) { return std::to_string(v / 1000) + "." + std::to_string(v % 1000 / 10); };
  switch (status) {
    case cudaErrorNoDevice:
      return "there is no GPU that CUDA can use";
    case cudaErrorInsufficientDriver:
    case cudaErrorUnsupportedPtxVersion:  // no machine code for this GPU, and a driver too old to compile it
      return driver == 0 ? "there is no NVIDIA driver here"
                         : "the NVIDIA driver supports CUDA " + version(driver) + ", this program needs " +
                               version(runtime);
    case cudaErrorNoKernelImageForDevice: {
      int major = 0, minor = 0;
      cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, this_device());
      cudaDeviceGetAttribute(&minor, cudaDevAttrComputeCapabilityMinor, this_device());
      return "the GPU is of generation " + std::to_string(major) + "." + std::to_string(minor) +
             ", this program was built for " SCREE_CUDA_ARCHITECTURES " (CMAKE_CUDA_ARCHITECTURES)";
    }
    case cudaErrorMemoryAllocation:
      return "the GPU's memory is used by other programs";
    default:
      return cudaGetErrorString(status);
  }
}

}  // namespace

std::string device_error() {
  int devices = 0;
  cudaError_t status = chosen;
  if (status == cudaSuccess) status = cudaGetDeviceCount(&devices);
  if (status == cudaSuccess && devices == 0) status = cudaErrorNoDevice;
  if (status == cudaSuccess) {
    trial_kernel<<<1, 1>>>();
    status = cudaGetLastError();
    if (status == cudaSuccess) status = cudaDeviceSynchronize();
  }
  return status == cudaSuccess ? "" : convergence_error(status);
}

std::string device_name() { return this_properties().name; }

std::array<char, 16> device_uuid() {
  const cudaDeviceProp properties = this_properties();
  std::array<char, 16> uuid{};
  static_assert(sizeof properties.uuid.bytes == sizeof uuid);
  std::copy(std::begin(properties.uuid.bytes), std::end(properties.uuid.bytes), uuid.begin());
  return uuid;
}

std::size_t device_memory_in_use() { return device_bytes_in_use(); }

std::size_t free_device_memory() {
  std::size_t free = 0, total = 0;
  require_cuda(cudaMemGetInfo(&free, &total), "cudaMemGetInfo");
  return free;
}

}  // namespace scree
