// Energy that contacts have lost at the triangles of meshes since t = 0, on the device: the part of
// `TriangleWorks` of one rank.
#pragma once

#include <cstdint>
#include <vector>

#include "contact_kernels.cuh"
#include "dem/reports/triangle_works.hpp"
#include "device.cuh"
#include "model/data/model.hpp"

namespace scree {

class DeviceTriangleWorks {
 public:
  DeviceTriangleWorks(const Model& model, cudaStream_t stream);
  bool exist() const { return works_.exist(); }

  // Sizes the arrays before that many contacts are added.
  void reserve_entries(Device device, std::int64_t contacts);
  // Queues the losses over a closed step, of the contacts of these groups as they were evaluated last.
  template <class Works>
  void accumulate(Device device, const SurfaceViews& in, Index groups, const Works& works);
  // The same for the explicit step that is open when the kernel runs; the next kernel of the run closes it.
  void accumulate_in_run(Device device, const SurfaceViews& in, Index groups, const ExplicitWorks& works,
                         const VerletControl* control);

  // In the format of `RankParticles`; both wait.
  void load(const std::vector<std::int64_t>& words, cudaStream_t stream);
  std::vector<std::int64_t> limbs(cudaStream_t stream) const;

 private:
  TriangleWorkTable table() const {
    return {first_.data(), works_.wear().empty() ? nullptr : wear_.data(), works_.materials()};
  }

  TriangleWorks works_;
  DeviceArray<std::int64_t> first_;
  DeviceArray<Real> wear_;
  DeviceArray<TriangleWork> sums_;
  TermCount terms_;
};

}  // namespace scree
