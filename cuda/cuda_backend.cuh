// The backend of one GPU, called GMAP in the paper. It follows the schedule of src/dem/cpu/cpu_backend.hpp
// with kernels; the arithmetic is in src/physics, the items of the loops in src/dem.
#pragma once

#include <memory>
#include <string>

#include "cuda_explicit.cuh"
#include "cuda_implicit.cuh"
#include "cuda_particles.cuh"
#include "cuda_reports.cuh"
#include "dem/backend/backend.hpp"
#include "kernel_trace.cuh"

namespace scree {

class CudaBackend : public Backend {
 public:
  CudaBackend(const Model& model, const Ranks& ranks)
      : CudaBackend(model, ranks, make_device_contact_kernels(model.contact)) {}
  CudaBackend(const Model& model, const Ranks& ranks, std::unique_ptr<DeviceContactKernels> law);

  std::string description() const override;
  RankParticles& particles() override { return particles_; }
  RankList& list() override { return list_; }
  Reports& reports() override { return reports_; }
  std::unique_ptr<ImplicitStep> open_step(Real h) override;
  std::unique_ptr<ExplicitRun> start_run(Real h) override;
  bool computes_asynchronously() const override { return true; }
  bool is_mixed() const override { return items_.in_mixed; }
  std::unique_ptr<DeviceTrace> device_trace() override { return make_kernel_trace(); }

  std::vector<DeviceShare> device_shares() const;

 private:
  std::string double_reason() const;

  CudaItems items_;
  CudaBodies bodies_;
  CudaImplicitArrays implicit_arrays_;
  CudaList list_;
  CudaParticles particles_;
  CudaReports reports_;
  RunWorkspace run_workspace_;
};

}  // namespace scree
