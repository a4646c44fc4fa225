#include <algorithm>
#include <cub/device/device_radix_sort.cuh>

#include "cuda_reports.cuh"

namespace scree {
namespace {

struct IdItem {
  const std::int64_t* row_key;
  unsigned long long* ids;
  Index* iota;
  SCREE_HD void operator()(Index i) const {
    ids[i] = static_cast<unsigned long long>(id_of(row_key[i]));
    iota[i] = i;
  }
};

struct CountDriftingItem {
  const std::uint8_t* drifting;
  Index* count;
  __device__ void operator()(Index i) const {
    if (drifting[i]) atomicAdd(count, 1);
  }
};

}  // namespace

void CudaReports::queue_energies() {
  const auto n = static_cast<std::size_t>(items_.owned);
  elastic_.resize(n), pairs_.resize(n), contacts_.resize(n);
  items_.kernels->energies(items_.device(), items_.views(), items_.owned,
                           {elastic_.data(), contacts_.data(), pairs_.data()});
}

ParticleLedger CudaReports::ledger(Real verlet_step) {
  ParticleArrays& now = items_.now;
  DeviceResults& results = items_.results;
  bodies_.find_loads();
  queue_energies();
  const LedgerItem item{now.position.data(),
                        now.velocity.data(),
                        now.acceleration.data(),
                        now.image.data(),
                        now.contact_loss.data(),
                        now.integrator_loss.data(),
                        elastic_.data(),
                        pairs_.data(),
                        items_.model.gravity,
                        items_.subdomain.period(),
                        verlet_step};
  items_.queue_sums(item, &Results::ledger);
  Index* drifting = results.at(&Results::index);
  require_cuda(cudaMemsetAsync(drifting, 0, sizeof(Index), items_.stream), "cudaMemsetAsync");
  for_each(items_.device(), items_.owned, CountDriftingItem{now.drifting.data(), drifting});
  results.copy(&Results::index);
  const std::array<Real, kLedgerTerms> sums = results.totals(results.fetch(&Results::ledger));
  ParticleLedger out = make_particle_ledger(sums.data(), bodies_.side());
  out.drifting = items_.ranks.sum(std::int64_t{results.host().index});
  return out;
}

void CudaReports::start_pack() {
  PackArrays& p = pack_;
  const auto n = static_cast<std::size_t>(items_.owned);
  p.ready.wait();  // for the last pack, whose arrays are written now
  p.n = n;
  for_each_column([&](auto& on_device, auto& on_host) { on_device.resize(n), on_host.resize(n); }, p.packed,
                  p.h_packed);
  p.h_ids.resize(n);
  p.ids.resize(n), p.sorted_ids.resize(n), p.order.resize(n), p.sorted_order.resize(n);
  bodies_.find_loads();
  queue_energies();
  queue_pack();
  p.packed_now.record(items_.stream);
  p.packed_now.hold(copy_stream_);
  copy_async(p.h_ids.data(), p.sorted_ids.data(), n, copy_stream_);
  for_each_column([&](auto& to, auto& from) { copy_async(to.data(), from.data(), n, copy_stream_); },
                  p.h_packed, p.packed);
  p.ready.record(copy_stream_);
}

// In the order of the global ids.
void CudaReports::queue_pack() {
  PackArrays& p = pack_;
  for_each(items_.device(), items_.owned, IdItem{items_.now.row_key.data(), p.ids.data(), p.order.data()});
  const auto sort = [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceRadixSort::SortPairs(at, bytes, p.ids.data(), p.sorted_ids.data(), p.order.data(),
                                                 p.sorted_order.data(), items_.owned, 0, 8 * sizeof(GlobalId),
                                                 items_.stream),
                 "sort");
  };
  if (p.n > 0) with_space(items_.space, sort);
  PackItem item{views_of(items_.now),
                p.sorted_order.data(),
                contacts_.data(),
                items_.model.gravity,
                items_.model.space.min,
                items_.subdomain.period(),
                {}};
  for_each_column([](auto*& to, auto& array) { to = array.data(); }, item.out, p.packed);
  for_each(items_.device(), items_.owned, item);
}

ParticlePack CudaReports::pack_particles() {
  PackArrays& p = pack_;
  p.ready.wait();
  ParticlePack pack;
  pack.global_id.assign(p.h_ids.data(), p.h_ids.data() + p.n);
  for_each_column([&](auto& values, auto& array) { values.assign(array.data(), array.data() + p.n); }, pack,
                  p.h_packed);
  return pack;
}

ShapePack CudaReports::pack_shapes() {
  bodies_.find_loads();
  return bodies_.side().pack();
}

std::vector<TracedParticle> CudaReports::traced(std::span<const GlobalId> wanted) {
  if (wanted.empty()) return {};
  std::vector<GlobalId> ids(wanted.begin(), wanted.end());
  std::sort(ids.begin(), ids.end());
  traced_ids_.upload(ids, items_.stream);
  // An id that no particle has stands where none of this rank's was found.
  traced_.resize(ids.size());
  require_cuda(cudaMemsetAsync(traced_.data(), 0xff, ids.size() * sizeof(TracedParticle), items_.stream),
               "cudaMemsetAsync");
  for_each(items_.device(), items_.owned,
           TraceItem{views_of(items_.now), traced_ids_.data(), static_cast<Index>(ids.size()),
                     items_.model.space.min, items_.subdomain.period(), traced_.data()});
  std::vector<TracedParticle> found = traced_.download(items_.stream);
  std::erase_if(found, [](const TracedParticle& t) { return t.global_id < 0; });
  return found;
}

std::vector<ContactSum> CudaReports::body_contacts() {
  bodies_.find_loads();
  return bodies_.side().body_contacts();
}

std::vector<ContactSum> CudaReports::wall_contacts(std::span<const int> walls) {
  const auto share = [&](Real* largest) { items_.lane.halo.max(items_.device(), largest, kWallTerms); };
  std::vector<ContactSum> contacts;
  bodies_.find_loads();
  for (const int wall : walls) {
    items_.kernels->wall_sums(items_.device(), items_.views(), items_.owned,
                              {wall, items_.model.space.min, items_.subdomain.period()},
                              items_.results.at(&Results::wall), share);
    contacts.push_back(make_wall_contact(items_.results.totals(items_.results.fetch(&Results::wall)).data()));
    if (items_.ranks.is_root()) contacts.back() += bodies_.side().on_wall(wall);
  }
  return contacts;
}

}  // namespace scree
