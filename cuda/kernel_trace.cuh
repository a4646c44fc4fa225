// Records the kernels and copies of this rank's GPU, for the timeline of --trace.
#pragma once

#include <memory>

#include "base/device_trace.hpp"

namespace scree {

// Uses CUPTI of the CUDA toolkit, which is loaded when this is called. Null where there is none, or where it
// does not work.
std::unique_ptr<DeviceTrace> make_kernel_trace();

}  // namespace scree
