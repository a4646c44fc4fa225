#include <algorithm>
#include <cstring>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "cuda_reports.cuh"
#include "dem/backend/inside_energies.hpp"
#include "dem/reports/region_items.hpp"

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

CudaReports::CudaReports(CudaItems& items, CudaBodies& bodies) : items_(items), bodies_(bodies) {
  const std::vector<OutputField> fields = computed_fields(items.model.output);
  std::vector<FieldColumn> columns(fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k) columns[k].field = fields[k];
  output_.columns.swap(columns);
}

void CudaReports::queue_energies() {
  const auto n = static_cast<std::size_t>(items_.owned);
  const bool rotates = items_.now.rotates;
  const bool is_cohesive = items_.model.is_cohesive();
  cohesion_.resize(is_cohesive ? n : 0);
  elastic_.resize(n), pairs_.resize(n), contacts_.resize(n), springs_.resize(rotates ? n : 0);
  items_.kernels->run(
      items_.device(), items_.views(), items_.owned,
      EnergyOutputs{elastic_.data(), contacts_.data(), pairs_.data(), rotates ? springs_.data() : nullptr,
                    is_cohesive ? cohesion_.data() : nullptr});
}

ParticleLedger CudaReports::ledger(Real verlet_step) {
  ParticleArrays& now = items_.now;
  DeviceResults& results = items_.results;
  need_loads();
  queue_energies();
  const LedgerItem item{views_of(items_.now), elastic_.data(),           pairs_.data(),
                        items_.model.gravity, items_.subdomain.period(), verlet_step};
  items_.queue_sums(item, &Results::ledger);
  items_.queue_sums(InsideItem{item.in, item.gravity, item.period, verlet_step}, &Results::inside);
  if (now.rotates) items_.queue_sums(RotationItem{views_of(now), springs_.data()}, &Results::rotation);
  if (items_.model.is_cohesive()) items_.queue_sums(CohesionItem{cohesion_.data()}, &Results::cohesion);
  Index* drifting = results.at(&Results::index);
  require_cuda(cudaMemsetAsync(drifting, 0, sizeof(Index), items_.stream), "cudaMemsetAsync");
  for_each(items_.device(), items_.owned, CountDriftingItem{now.drifting.data(), drifting});
  results.copy(&Results::index);
  const std::array<Real, kLedgerTerms> sums = results.totals(results.fetch(&Results::ledger));
  ParticleLedger out = make_particle_ledger(sums.data(), bodies_.side());
  out.inside = make_inside_energies(results.totals(results.fetch(&Results::inside)).data(), bodies_.side());
  if (now.rotates)
    out.rotation =
        make_rotation_energies(results.totals(results.fetch(&Results::rotation)).data(), bodies_.side());
  if (items_.model.is_cohesive()) out.cohesion += results.totals(results.fetch(&Results::cohesion))[0];
  out.drifting = items_.ranks.sum(std::int64_t{results.host().index});
  return out;
}

Real CudaReports::inside_kinetic() {
  DeviceResults& results = items_.results;
  items_.queue_sums(InsideKineticItem{views_of(items_.now)}, &Results::inside_kinetic);
  return results.totals(results.fetch(&Results::inside_kinetic))[0];
}

void CudaReports::start_output() {
  OutputArrays& o = output_;
  const auto n = static_cast<std::size_t>(items_.owned);
  o.ready.wait();  // of the last output, whose arrays are overwritten now
  o.n = n;
  o.h_ids.resize(n), o.position.resize(n), o.h_position.resize(n);
  for (FieldColumn& column : o.columns) {
    const std::size_t bytes = n * column.field.bytes;
    column.values.resize(bytes), column.h_values.resize(bytes);
  }
  o.ids.resize(n), o.sorted_ids.resize(n), o.order.resize(n), o.sorted_order.resize(n);
  need_loads();
  queue_order();
  queue_values();
  o.filled.record(items_.stream);
  o.filled.hold(copy_stream_);
  copy_async(o.h_ids.data(), o.sorted_ids.data(), n, copy_stream_);
  copy_async(o.h_position.data(), o.position.data(), n, copy_stream_);
  for (FieldColumn& column : o.columns)
    copy_async(column.h_values.data(), column.values.data(), n * column.field.bytes, copy_stream_);
  o.ready.record(copy_stream_);
}

// Sorted by global id.
void CudaReports::queue_order() {
  OutputArrays& o = output_;
  for_each(items_.device(), items_.owned, IdItem{items_.now.row_key.data(), o.ids.data(), o.order.data()});
  const auto sort = [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceRadixSort::SortPairs(at, bytes, o.ids.data(), o.sorted_ids.data(), o.order.data(),
                                                 o.sorted_order.data(), items_.owned, 0, 8 * sizeof(GlobalId),
                                                 items_.stream),
                 "sort");
  };
  if (o.n > 0) with_space(items_.space, sort);
}

// Row numbers in that order.
void CudaReports::queue_values() {
  OutputArrays& o = output_;
  const OutputSource source = output_source(views_of(items_.now), items_.model, items_.subdomain.period());
  const Index* const order = o.sorted_order.data();
  for_each(items_.device(), items_.owned, OwnOutputItem<PositionOutput>{source, order, o.position.data()});
  for (FieldColumn& column : o.columns) {
    const OutputRequest request{source, order, items_.owned, column.field.head.name, column.values.data()};
    if (column.field.reads_contacts)
      items_.kernels->run(items_.device(), items_.views(), items_.owned, request);
    else
      with_own_output(request, [&](const auto& item) { for_each(items_.device(), items_.owned, item); });
  }
}

ParticleOutput CudaReports::output() {
  OutputArrays& o = output_;
  o.ready.wait();
  ParticleOutput out;
  out.global_id.assign(o.h_ids.data(), o.h_ids.data() + o.n);
  out.position.assign(o.h_position.data(), o.h_position.data() + o.n);
  for (const FieldColumn& column : o.columns) {
    const auto copy = [&](auto& values) {
      std::memcpy(values.data(), column.h_values.data(), o.n * column.field.bytes);
    };
    std::visit(copy, out.fields.emplace_back(column.field.values(o.n)));
  }
  return out;
}

ShapePack CudaReports::pack_shapes() {
  need_loads();
  return bodies_.side().pack();
}

// Queues the numbers of contact lines per particle and their offsets. The scan also reads the number past the
// end of contacts_, although no offset depends on it.
LineRequest CudaReports::count_lines() {
  const auto n = static_cast<std::size_t>(items_.owned);
  contacts_.resize(n + 1), line_offsets_.resize(n + 1);
  require_cuda(cudaMemsetAsync(contacts_.data() + n, 0, sizeof(Index), items_.stream), "cudaMemsetAsync");
  LineRequest request{items_.now.row_key.data(), bodies_.find_shown(), items_.model.space.min,
                      items_.subdomain.period()};
  request.counts = contacts_.data();
  items_.kernels->run(items_.device(), items_.views(), items_.owned, request);
  with_space(items_.space, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceScan::ExclusiveSum(at, bytes, contacts_.data(), line_offsets_.data(),
                                               items_.owned + 1, items_.stream),
                 "scan");
  });
  request.offsets = line_offsets_.data();
  return request;
}

// In batches of particles, so that few lines are on the device at a time.
ContactLines CudaReports::contact_lines() {
  need_loads();
  LineRequest request = count_lines();
  const std::vector<Index> offsets = line_offsets_.download(items_.stream);
  const Index n = items_.owned;
  std::vector<std::int64_t> row_key(static_cast<std::size_t>(n));
  copy_async(row_key.data(), items_.now.row_key.data(), row_key.size(), items_.stream);
  ContactLines out;
  out.lines.resize(static_cast<std::size_t>(offsets.back()));
  for (Index first = 0; first < n;) {
    const auto next_offset = std::upper_bound(offsets.begin() + first + 1, offsets.end(),
                                              offsets[first] + static_cast<Index>(kLinesAtOnce));
    const Index end = std::max(first + 1, static_cast<Index>(next_offset - offsets.begin()) - 1);
    const auto count = static_cast<std::size_t>(offsets[end] - offsets[first]);
    lines_.resize_with_spare(count);
    request.lines = lines_.data(), request.first_line = offsets[first], request.first = first;
    if (count > 0) items_.kernels->run(items_.device(), items_.views(), end - first, request);
    copy_async(out.lines.data() + offsets[first], lines_.data(), count, items_.stream);
    first = end;
  }
  wait_for(items_.stream);
  for (Index i = 0; i < n; ++i) {
    out.global_id.push_back(id_of(row_key[i]));
    out.counts.push_back(offsets[i + 1] - offsets[i]);
  }
  out.of_bodies = bodies_.side().contact_lines();
  return out;
}

RegionSums CudaReports::in_region(const RegionBounds& region) {
  items_.queue_sums(
      RegionItem{views_of(items_.now), region, items_.model.space.min, items_.subdomain.period()},
      &Results::region);
  const std::array<Real, kRegionTerms> sums = items_.results.totals(items_.results.fetch(&Results::region));
  return {sums[kRegionNumber], sums[kRegionMass]};
}

std::vector<TracedParticle> CudaReports::traced(std::span<const GlobalId> requested) {
  if (requested.empty()) return {};
  std::vector<GlobalId> ids(requested.begin(), requested.end());
  std::sort(ids.begin(), ids.end());
  traced_ids_.upload(ids, items_.stream);
  // Where this rank found no particle, the result is an id that none has.
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

std::vector<ContactSum> CudaReports::parent_contacts() {
  need_loads();
  return bodies_.side().parent_contacts();
}

std::vector<ContactSum> CudaReports::surface_contacts() {
  need_loads();
  return bodies_.side().surface_contacts();
}

std::vector<TriangleLoad> CudaReports::triangle_loads() {
  need_loads();
  const std::vector<WallPlane> planes = wall_planes(items_.model);
  return bodies_.side().triangle_loads(items_.surfaces.triangle_sums(items_.device(), planes));
}

std::vector<ContactSum> CudaReports::wall_contacts(std::span<const int> walls) {
  const auto share = [&](Real* largest) {
    items_.halo_stream.halo.max(items_.device(), largest, kWallTerms);
  };
  std::vector<ContactSum> contacts;
  need_loads();
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
