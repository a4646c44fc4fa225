// The one place that knows whether a compiler builds for host only or for host and device.
#pragma once

#ifdef __CUDACC__
#define SCREE_HD __host__ __device__ inline
#else
#define SCREE_HD inline
#endif
