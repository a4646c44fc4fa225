// Who owns which particles where there are several ranks: src/dem/cpu_list.cpp for the GPU's backend.
// Particles that change their rank, few after the first list, go through the host.
#include <thrust/iterator/counting_iterator.h>

#include <cub/device/device_select.cuh>

#include "backend_parts.cuh"
#include "base/countable.hpp"
#include "dem/device.hpp"

namespace scree {
namespace {

struct LeavesItem {
  DomainGrid grid;
  const DomainCut* cuts;
  const Vec4* position;
  int rank;
  __device__ bool operator()(Index i) const { return owner_of(grid, cuts, xyz(position[i])) != rank; }
};

// Particle leaving[k] on its way.
struct MigrantItem {
  ParticleViews in;
  const Index* leaving;
  Particle* out;

  SCREE_HD void operator()(Index k) const {
    const Index i = leaving[k];
    out[k] = particle_at(in, i);
    in.drifting[i] = kGone;
  }
};

}  // namespace

long long CudaBackend::smallest_id() const { return ranks_.min(fetch(&Results::worst_id)); }

// Weights are what a step costs about: one for the particle, one for each entry of its row in the last list.
void CudaBackend::decompose() {
  const auto n = static_cast<std::size_t>(owned_);
  std::vector<Vec4> position(n);
  std::vector<Index> entries(row_length_.size() == n ? n : 0);
  copy_async(position.data(), now_.position.data(), n, stream_);
  copy_async(entries.data(), row_length_.data(), entries.size(), stream_);
  wait_for(stream_);
  std::vector<std::int64_t> weight(n, 1);
  for (std::size_t i = 0; i < entries.size(); ++i) weight[i] += entries[i];
  const DomainGrid grid = make_domain_grid(model_.space, builder_.cutoff(model_.contact.skin));
  Decomposition next(ranks_, grid, position, weight);
  balance_.rebalances += decomposition_.exists() && next.boxes() != decomposition_.boxes();
  decomposition_ = std::move(next);
  cuts_.upload(decomposition_.cuts(), stream_);
}

// In parts of bounded size; all ranks take as many. Those that go stay in the arrays, marked, until the sort
// leaves them behind.
void CudaBackend::migrate() {
  if (!decomposition_.exists() || balance_.imbalance > model_.parallel.imbalance) decompose();
  other_.grow(now_.position.size(), static_cast<std::size_t>(owned_), 0, stream_);
  Index* leaving = other_.material.data();  // free until the sort
  const LeavesItem leaves{decomposition_.grid(), cuts_.data(), now_.position.data(), ranks_.rank()};
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceSelect::If(at, bytes, thrust::counting_iterator<Index>(0), leaving,
                                       result(&Results::index), owned_, leaves, stream_),
                 "select");
  });
  const Index count = fetch(&Results::index);
  balance_.migrated += count;

  constexpr Index kAtOnce = 1 << 22;
  const auto parts = static_cast<Index>(ranks_.max(static_cast<Real>((count + kAtOnce - 1) / kAtOnce)));
  migrating_ = parts > 0;
  for (Index part = 0; part < parts; ++part) {
    const Index first = std::min(part * kAtOnce, count), n = std::min(kAtOnce, count - first);
    std::vector<std::vector<Particle>> to(static_cast<std::size_t>(ranks_.size()));
    for (const Particle& p : pack_migrants(leaving + first, n))
      to[static_cast<std::size_t>(decomposition_.owner(p.position))].push_back(p);
    add_migrants(ranks_.deal_out(to));
  }
}

std::vector<Particle> CudaBackend::pack_migrants(Index* leaving, Index count) {
  if (count == 0) return {};
  DeviceArray<Particle> packed;
  packed.resize_clean(static_cast<std::size_t>(count), stream_);
  for_each(device(), count, MigrantItem{views_of(now_), leaving, packed.data()});
  return packed.download(stream_);
}

void CudaBackend::add_migrants(const std::vector<Particle>& arriving) {
  if (arriving.empty()) return;
  DeviceArray<Particle> unpacked;
  unpacked.upload(arriving, stream_);
  const auto before = static_cast<std::size_t>(owned_), n = before + arriving.size();
  const Index owned = countable(n, kTooManyParticles);
  now_.grow(std::max(n, now_.position.size()), n, before, stream_);
  for_each(device(), static_cast<Index>(arriving.size()),
           ArrivalItem{unpacked.data(), views_of(now_), owned_});
  owned_ = owned;
  wait_for(stream_);  // before the array above goes
}

void CudaBackend::measure_balance() {
  HaloSize& halo = balance_.halo;
  halo.owned = owned_, halo.ghosts = halo_.size(), halo.neighbors = halo_.plan().receivers();
  halo.bytes = std::int64_t{halo_.plan().sent()} * 2 * static_cast<std::int64_t>(sizeof(Vec4));
  if (ranks_.alone()) return;
  balance_.imbalance = measure_imbalance(ranks_, owned_ + list_.entries());
  balance_.largest = std::max(balance_.largest, balance_.imbalance);
}

DeviceClaim claim_device(const Model& model) {
  return {device_uuid(), device_memory(model), free_device_memory()};
}

std::unique_ptr<Backend> make_cuda_backend(const Model& model, const Ranks& ranks) {
  choose_device(ranks);
  const auto refuse = [&](const std::string& trouble) {
    ranks.together([&] {
      if (!trouble.empty()) throw InputError(trouble);
    });
  };
  refuse(device_trouble());
  // All ranks use their GPUs by now: what the driver takes for each is no longer free.
  const std::vector<DeviceClaim> claims = ranks.gather_everywhere(std::vector{claim_device(model)});
  refuse(device_memory_trouble(claims, ranks.rank(), device_name()));
  return std::make_unique<CudaBackend>(model, ranks);
}

}  // namespace scree
