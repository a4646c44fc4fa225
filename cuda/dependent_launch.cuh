// Programmatic dependent launch: a kernel starts while the one queued before it on the same stream ends, and
// waits for it.
#pragma once

#include "device.cuh"

namespace scree {

// Called first by every thread of a kernel that launch_dependent() starts: blocks of the next kernel may
// start from now on.
__device__ inline void admit_next_kernel() {
#if __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
#endif
}
// Also called by every thread: waits until the kernel before is done, and with it all that it waited for.
__device__ inline void await_kernel_before() {
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}

// What is queued on the stream before a kernel.
enum class Follows { kernel, anything };

template <class... Parameters, class... Arguments>
void launch_dependent(Device device, Follows follows, void (*kernel)(Parameters...), unsigned blocks,
                      unsigned threads, const Arguments&... arguments) {
  // Kernels compiled for older generations do not wait for the kernel before.
  static const bool waits = generation_of(kernel) >= 90;
  cudaLaunchAttribute overlap{};
  overlap.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  overlap.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = blocks, config.blockDim = threads;
  config.stream = device.stream, config.attrs = &overlap;
  config.numAttrs = waits && follows == Follows::kernel ? 1 : 0;
  require_cuda(cudaLaunchKernelEx(&config, kernel, Parameters(arguments)...), "contacts with surfaces");
}

}  // namespace scree
