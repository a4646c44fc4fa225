#include "run/loop/choose_backend.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "dem/backend/device.hpp"
#include "dem/history/packed_history.hpp"
#include "model/checks/memory.hpp"
#include "model/derived/choose_law.hpp"
#include "partition/shared_model.hpp"

namespace scree {
namespace {

// --backend auto: a GPU is faster from this number on (table4.py).
constexpr std::int64_t kGpuParticles = 2000;

std::unique_ptr<Backend> make_gpu(const Model& model, const Ranks& ranks, const std::string& why, Log& log) {
  std::unique_ptr<Backend> backend = make_cuda_backend(model, ranks);
  log.info("backend cuda: " + why + "; " + device_name());
  return backend;
}

std::unique_ptr<Backend> make_cpu(const Model& model, const Ranks& ranks, const std::string& why, Log& log) {
  log.info("backend cpu: " + why);
  const Real unknowns = ranks.is_root() ? 3 * static_cast<Real>(model.bodies.size()) : 0;
  const Real per_particle = bytes_per_particle(model) + history_bytes_with_pairs(history_of(model.contact));
  const ModelSize size = size_of(model);
  const Real all = per_particle * static_cast<Real>(model.particles.size()) + kBytesPerUnknown * unknowns +
                   bytes_of_shapes(size) + bytes_of_meshes(model, ranks.is_root());
  check_memory(size, all - bytes_of_model(model), "running it on the CPU", RankShare(ranks));
  if (model.integrator.precision == Precision::mixed)
    log.info(setting("integrator.precision", model.integrator.precision) +
             " is for a GPU: the CPU computes in " + word_of(Precision::full));
  if (model.parallel.transport != Transport::automatic)
    log.info(setting("parallel.transport", model.parallel.transport) +
             " is for GPUs: ranks on the CPU exchange halos by MPI");
  return make_cpu_backend(model, ranks);
}

}  // namespace

std::unique_ptr<Backend> choose_backend(const Model& model, const Ranks& ranks, const std::string& name,
                                        Log& log) {
  const std::int64_t particles = model.particles.totals.count / ranks.size();
  const bool few = particles < kGpuParticles;
  const auto choice = value_of<BackendChoice>(name);
  const bool free = choice == BackendChoice::automatic;
  const std::string why =
      !free ? "chosen by --backend"
            : fmt::format("{} particles{} are {} {}, from which a GPU is faster", particles,
                          ranks.alone() ? "" : " per rank", few ? "fewer than" : "at least", kGpuParticles);
  if (choice == BackendChoice::cpu || (free && few)) return make_cpu(model, ranks, why, log);
  try {
    return make_gpu(model, ranks, why, log);
  } catch (const TransportError&) {
    throw;
  } catch (const InputError& error) {
    if (choice == BackendChoice::cuda)
      throw InputError(fmt::format("--backend cuda: {}; allowed here: auto, cpu", error.what()));
    if (model.parallel.transport != Transport::automatic && !ranks.alone())
      throw InputError(fmt::format("{} is for GPUs: {}; allowed here: \"{}\", or --backend {}",
                                   setting("parallel.transport", model.parallel.transport), error.what(),
                                   word_of(Transport::automatic), word_of(BackendChoice::cpu)));
    return make_cpu(model, ranks, error.what(), log);
  }
}

}  // namespace scree
