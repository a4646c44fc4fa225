#include <thrust/iterator/counting_iterator.h>

#include <cub/device/device_select.cuh>

#include "base/countable.hpp"
#include "cuda_owners.cuh"
#include "dem/backend/rank_list.hpp"
#include "dem/particles/births.hpp"

namespace scree {
namespace {

struct DepartsItem {
  DomainGrid grid;
  const DomainCut* cuts;
  const Vec4* position;
  int rank;
  __device__ bool operator()(Index i) const { return owner_of(grid, cuts, xyz(position[i])) != rank; }
};

// Packs the k-th departing particle into its record.
struct MigrantItem {
  ParticleViews in;
  const Index* departing;
  Particle* out;

  SCREE_HD void operator()(Index k) const {
    const Index i = departing[k];
    out[k] = particle_at(in, i);
    in.drifting[i] = kMigrated;
  }
};

}  // namespace

// Approximate cost of a step: one for the particle and one for each entry of its row in the last list.
void CudaOwners::decompose() {
  const auto n = static_cast<std::size_t>(items_.owned);
  std::vector<Vec4> position(n);
  std::vector<Index> entries(row_length_.size() == n ? n : 0);
  copy_async(position.data(), items_.now.position.data(), n, items_.stream);
  copy_async(entries.data(), row_length_.data(), entries.size(), items_.stream);
  wait_for(items_.stream);
  std::vector<std::int64_t> weight(n, 1);
  for (std::size_t i = 0; i < entries.size(); ++i) weight[i] += entries[i];
  const DomainGrid grid = make_domain_grid(items_.model.space, builder_.cutoff(items_.model.contact.skin));
  Decomposition next(items_.ranks, grid, position, weight);
  items_.balance.rebalances += decomposition_.exists() && next.boxes() != decomposition_.boxes();
  decomposition_ = std::move(next);
  cuts_.upload(decomposition_.cuts(), items_.stream);
}

// Messages are of bounded size; all ranks take the same number of rounds.
void CudaOwners::migrate() {
  if (!decomposition_.exists() || items_.balance.imbalance > items_.model.parallel.imbalance) decompose();
  items_.other.grow(items_.now.position.size(), static_cast<std::size_t>(items_.owned));
  Index* departing = items_.list_scratch();  // valid until the sort
  const DepartsItem departs{decomposition_.grid(), cuts_.data(), items_.now.position.data(),
                            items_.ranks.rank()};
  with_space(items_.space, [&](void* at, std::size_t& bytes) {
    require_cuda(
        cub::DeviceSelect::If(at, bytes, thrust::counting_iterator<Index>(0), departing,
                              items_.results.at(&Results::index), items_.owned, departs, items_.stream),
        "select");
  });
  const Index count = items_.results.fetch(&Results::index);
  items_.balance.migrated += count;

  constexpr Index kAtOnce = 1 << 22;
  const auto parts = static_cast<Index>(items_.ranks.max(static_cast<Real>((count + kAtOnce - 1) / kAtOnce)));
  migrating_ = parts > 0;
  for (Index part = 0; part < parts; ++part) {
    const Index first = std::min(part * kAtOnce, count), n = std::min(kAtOnce, count - first);
    std::vector<std::vector<Particle>> to(static_cast<std::size_t>(items_.ranks.size()));
    const PackedHistory contacts = items_.history.rows(departing + first, n);
    std::vector<PackedHistory> contacts_to(to.size(), no_contacts(contacts.content, 0));
    std::int64_t k = 0;
    for (const Particle& p : pack_migrants(departing + first, n)) {
      const auto owner = static_cast<std::size_t>(decomposition_.owner(p.position));
      to[owner].push_back(p);
      if (items_.history.exists()) contacts_to[owner].add_row(contacts, k++);
    }
    const Index before = items_.owned;
    add_migrants(items_.ranks.all_to_all(to));
    if (items_.history.exists()) items_.history.append(all_to_all(items_.ranks, contacts_to), before);
  }
}

std::vector<Particle> CudaOwners::pack_migrants(Index* departing, Index count) {
  if (count == 0) return {};
  DeviceArray<Particle> packed;
  packed.resize_clean(static_cast<std::size_t>(count), items_.stream);
  for_each(items_.device(), count, MigrantItem{views_of(items_.now), departing, packed.data()});
  return packed.download(items_.stream);
}

void CudaOwners::add_migrants(const std::vector<Particle>& arriving) {
  if (arriving.empty()) return;
  DeviceArray<Particle> unpacked;
  unpacked.upload(arriving, items_.stream);
  const auto before = static_cast<std::size_t>(items_.owned), n = before + arriving.size();
  const Index owned = countable(n, kTooManyParticles);
  items_.now.grow(std::max(n, items_.now.position.size()), n, before, items_.stream);
  for_each(items_.device(), static_cast<Index>(arriving.size()),
           ArrivalItem{unpacked.data(), views_of(items_.now), items_.owned});
  items_.owned = owned;
  wait_for(items_.stream);  // the kernel reads `unpacked`
}

void CudaOwners::insert(const std::vector<Particle>& born) {
  const std::vector<Particle> own = owned_by(items_.ranks, decomposition_, born);
  const Index before = items_.owned;
  add_migrants(own);
  if (items_.history.exists())
    items_.history.append(no_contacts(items_.history.content(), std::ssize(own)), before);
  if (row_length_.size() == 0 || own.empty()) return;
  const std::size_t rows = row_length_.size();
  row_length_.grow(rows + own.size(), rows, items_.stream);
  require_cuda(cudaMemsetAsync(row_length_.data() + rows, 0, own.size() * sizeof(Index), items_.stream),
               "cudaMemsetAsync");
}

void CudaOwners::note_rows() {
  if (items_.ranks.alone()) return;
  row_length_.resize(static_cast<std::size_t>(items_.owned));
  copy_async(row_length_.data(), items_.list.rows().counts, row_length_.size(), items_.stream);
}

void CudaOwners::measure_balance() {
  HaloSize& size = items_.balance.halo;
  const DeviceHalo& halo = items_.halo_stream.halo;
  size.owned = items_.owned, size.ghosts = halo.size(), size.neighbors = halo.plan().receivers();
  size.bytes = std::int64_t{halo.plan().sent()} * 2 * static_cast<std::int64_t>(sizeof(Vec4));
  if (items_.ranks.alone()) return;
  items_.balance.imbalance = measure_imbalance(items_.ranks, items_.owned + items_.list.entries());
  items_.balance.largest = std::max(items_.balance.largest, items_.balance.imbalance);
}

}  // namespace scree
