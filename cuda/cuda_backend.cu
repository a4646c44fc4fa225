#include "cuda_backend.cuh"
#include "dem/backend/device.hpp"

namespace scree {

CudaBackend::CudaBackend(const Model& model, const Ranks& ranks, std::unique_ptr<DeviceContactKernels> law)
    : items_(model, ranks, idle_work_, std::move(law)),
      bodies_(items_),
      list_(items_, bodies_, implicit_arrays_),
      particles_(items_, bodies_, list_),
      reports_(items_, bodies_) {
  items_.in_mixed = model.integrator.precision == Precision::mixed && double_reason().empty();
}

// Why a run is in double precision although the deck asks for mixed.
std::string CudaBackend::double_reason() const {
  const LawTraits law = items_.kernels->traits();
  return bodies_.have_surfaces() ? "bodies have shapes or meshes, or walls are meshes or move"
         : law.has_range         ? "particles attract each other"
         : !law.is_mixed         ? "this contact law has no form in single precision"
                                 : "";
}

std::string CudaBackend::description() const {
  const bool requested = items_.model.integrator.precision == Precision::mixed;
  const std::string precision = is_mixed()  ? "mixed"
                                : requested ? "double, because " + double_reason()
                                            : "double";
  const Ranks& all = items_.ranks;
  const std::string ranks = all.alone() ? ""
                                        : ", " + std::to_string(all.size()) + " ranks, halo by " +
                                              items_.halo_stream.halo.transport();
  return "cuda (" + device_name() + ", precision " + precision + ranks + ")";
}

std::unique_ptr<ImplicitStep> CudaBackend::open_step(Real h) {
  return open_cuda_step(items_, bodies_, implicit_arrays_, h);
}

std::unique_ptr<ExplicitRun> CudaBackend::start_run(Real h) {
  return std::make_unique<CudaExplicitRun>(items_, bodies_, list_, run_workspace_, h);
}

std::vector<DeviceShare> CudaBackend::device_shares() const {
  std::vector<DeviceShare> shares{{"state", items_.now.bytes()},
                                  {"second arrays", items_.other.bytes()},
                                  {"list", items_.list.bytes()},
                                  {"contact history", items_.history.bytes()},
                                  {"explicit steps or packed history", items_.arena.bytes()}};
  std::size_t rest = device_bytes_in_use();
  for (const DeviceShare& share : shares) rest -= share.bytes;
  shares.push_back({"other", rest});
  return shares;
}

std::vector<DeviceShare> device_shares(const Backend& backend) {
  const auto* on_device = dynamic_cast<const CudaBackend*>(&backend);
  return on_device != nullptr ? on_device->device_shares() : std::vector<DeviceShare>{};
}

DeviceClaim claim_device(const Model& model) {
  return {device_uuid(), device_memory(model), free_device_memory()};
}

std::unique_ptr<Backend> make_cuda_backend(const Model& model, const Ranks& ranks) {
  choose_device(ranks);
  const auto refuse = [&](const std::string& trouble) {
    ranks.collectively([&] {
      if (!trouble.empty()) throw InputError(trouble);
    });
  };
  refuse(device_error());
  // All ranks have initialised their GPUs by now, so that the free memory no longer includes what the driver
  // takes for each.
  const std::vector<DeviceClaim> claims = ranks.all_gather(std::vector{claim_device(model)});
  refuse(device_memory_trouble(claims, ranks.rank(), device_name()));
  return std::make_unique<CudaBackend>(model, ranks);
}

}  // namespace scree
