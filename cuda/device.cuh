// Where the loops over items run on a GPU, and how its errors become ours.
#pragma once

#include <cuda_runtime.h>

#include <string>

#include "base/error.hpp"

namespace scree {

// The counterpart of Serial: work is queued on the stream and this returns before it is done.
struct Device {
  cudaStream_t stream = nullptr;
};

// Throws SimulationError with the runtime's text. what: the call that failed, for the message.
inline void require_cuda(cudaError_t status, const char* what) {
  if (status != cudaSuccess) throw SimulationError(std::string("cuda: ") + what + ": " + cudaGetErrorString(status));
}

}  // namespace scree
