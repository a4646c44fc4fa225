// Markers of functions for host and device; empty unless CUDA compiles the file.
#pragma once

// SCREE_HD_CALLER precedes a template for host and device whose callable may be a host function if only the
// host calls the template.
#ifdef __CUDACC__
#define SCREE_HD __host__ __device__ inline
#define SCREE_HD_CALLER _Pragma("nv_exec_check_disable")
#else
#define SCREE_HD inline
#define SCREE_HD_CALLER
#endif
