// The one place that knows whether a compiler builds for host only or for host and device.
#pragma once

// SCREE_HD_CALLER: before a template for both that calls what it is given, and may be given a function of the
// host alone where only the host calls it.
#ifdef __CUDACC__
#define SCREE_HD __host__ __device__ inline
#define SCREE_HD_CALLER _Pragma("nv_exec_check_disable")
#else
#define SCREE_HD inline
#define SCREE_HD_CALLER
#endif
