// What the GPU's backend tells about its particles: leavers, sums, packs for output.
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_select.cuh>

#include "backend_parts.cuh"

namespace scree {
namespace {

// Collects the particles outside that are not known to drift; counts all, keeps as many as there is room for.
struct LeaverItem {
  ParticleViews in;
  OpenBox box;
  Vec3 gravity, period;
  Real verlet_step;  // [s]
  Leaver* out;
  Index room;
  Index* count;

  __device__ void operator()(Index i) const {
    const Vec4 x = in.position[i];
    if (in.drifting[i] || box.inside(xyz(x))) return;
    const Index slot = atomicAdd(count, 1);
    if (slot >= room) return;
    const Real energy = energy_of_motion(x, in.velocity[i], in.image[i], gravity, period);
    const Real shift = verlet_energy_shift(verlet_step, in.velocity[i].w, in.acceleration[i]);
    out[slot] = {id_of(in.row_key[i]),         i, xyz(x), false, energy, in.contact_loss[i],
                 in.integrator_loss[i] - shift};
  }
};

// Wraps the leavers a last time and marks them.
struct MarkItem {
  const Index* particles;
  ParticleViews in;
  Vec3 box_min, period;
  SCREE_HD void operator()(Index k) const {
    const Index i = particles[k];
    const Vec4 x = in.position[i];
    in.position[i] = vec4(wrap(box_min, period, xyz(x), in.image[i]), x.w);
    in.drifting[i] = 1;
  }
};

struct StaysItem {
  const std::uint8_t* drifting;
  std::uint8_t* stays;
  Index* iota;
  SCREE_HD void operator()(Index i) const { stays[i] = !drifting[i], iota[i] = i; }
};

struct GatherItem {
  const Index *values, *from;
  Index* out;
  SCREE_HD void operator()(Index i) const { out[i] = values[from[i]]; }
};

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

std::vector<Leaver> CudaBackend::outside() {
  constexpr std::size_t kFirstRoom = 1024;
  if (leavers_.size() == 0) leavers_.resize_clean(kFirstRoom, stream_);
  const auto find = [&] {
    require_cuda(cudaMemsetAsync(result(&Results::leavers), 0, sizeof(Index), stream_), "cudaMemsetAsync");
    for_each(
        device(), owned_,
        LeaverItem{views_of(now_), subdomain_.box(), model_.gravity, subdomain_.period(), verlet_step(model_),
                   leavers_.data(), static_cast<Index>(leavers_.size()), result(&Results::leavers)});
    return static_cast<std::size_t>(fetch(&Results::leavers));
  };
  std::vector<Leaver> leavers(find());
  if (!ranks_.any(!leavers.empty())) return leavers;
  if (leavers.size() > leavers_.size()) {  // not all were kept; now there is room for them
    leavers_.resize_clean(leavers.size(), stream_);
    find();
  }
  kernels_->leavers(device(), views(), subdomain_.box(), static_cast<Index>(leavers.size()), leavers_.data());
  copy_async(leavers.data(), leavers_.data(), leavers.size(), stream_);
  wait_for(stream_);
  for (Leaver& leaver : leavers)
    leaver.lost = subdomain_.beyond_wall(leaver.position), leaver.rank = ranks_.rank();
  leavers = ranks_.gather_everywhere(std::move(leavers));
  std::sort(leavers.begin(), leavers.end(),
            [](const Leaver& a, const Leaver& b) { return a.global_id < b.global_id; });
  return leavers;
}

void CudaBackend::take_out(const std::vector<Leaver>& leavers) {
  if (leavers.empty()) return;
  std::vector<Index> particles;
  for (const Leaver& leaver : leavers)
    if (leaver.rank == ranks_.rank()) particles.push_back(leaver.local_index);
  const bool remove = model_.space.leaving == Leaving::remove;
  const auto n = remove ? static_cast<std::size_t>(owned_) : 0;
  // The arrays come first: where there is no memory for them, nothing has changed yet.
  DeviceArray<Index> d_particles, iota(n), staying(n), row_length(ranks_.alone() ? 0 : n);
  DeviceArray<std::uint8_t> stays(n);
  d_particles.upload(particles, stream_);
  take_contacts_out();
  for_each(device(), static_cast<Index>(particles.size()),
           MarkItem{d_particles.data(), views_of(now_), model_.space.min, subdomain_.period()});
  layout_changed_ = true;
  if (!remove) return;

  for_each(device(), owned_, StaysItem{now_.drifting.data(), stays.data(), iota.data()});
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceSelect::Flagged(at, bytes, iota.data(), stays.data(), staying.data(),
                                            result(&Results::index), owned_, stream_),
                 "select");
  });
  reorder(staying.data(), fetch(&Results::index));
  if (!ranks_.alone()) {
    row_length.resize(static_cast<std::size_t>(owned_));
    for_each(device(), owned_, GatherItem{row_length_.data(), staying.data(), row_length.data()});
  }
  wait_for(stream_);  // before the arrays above go
  row_length_.swap(row_length);
}

// Before the leavers are wrapped and marked.
void CudaBackend::take_contacts_out() {
  const bool verlet = is_verlet(model_);
  const Vec4* seen = (level_ == Level::finished ? other_ : now_).velocity.data();  // by the law
  kernels_->departures(device(), views(now_.position.data(), seen), model_.gravity, subdomain_.box(), owned_,
                       {now_.force.data(), now_.acceleration.data(),
                        verlet ? now_.loss_power.data() : nullptr, now_.integrator_loss.data(),
                        now_.drifting.data(), verlet ? hht_coefficients(0) : hht_, verlet_step(model_)});
}

ParticleLedger CudaBackend::ledger(Real verlet_step) {
  const auto n = static_cast<std::size_t>(owned_);
  DeviceArray<Real>&elastic = pack_->elastic, &pairs = pack_->pairs;
  DeviceArray<Index>& contacts = pack_->contacts;
  elastic.resize(n), pairs.resize(n), contacts.resize(n);
  kernels_->energies(device(), views(), owned_, {elastic.data(), contacts.data(), pairs.data()});
  find_shape_contacts();
  const LedgerItem item{now_.position.data(),
                        now_.velocity.data(),
                        now_.acceleration.data(),
                        now_.image.data(),
                        now_.contact_loss.data(),
                        now_.integrator_loss.data(),
                        elastic.data(),
                        pairs.data(),
                        model_.gravity,
                        subdomain_.period(),
                        verlet_step};
  queue_sums(item, &Results::ledger);
  require_cuda(cudaMemsetAsync(result(&Results::index), 0, sizeof(Index), stream_), "cudaMemsetAsync");
  for_each(device(), owned_, CountDriftingItem{now_.drifting.data(), result(&Results::index)});
  copy_async(&h_results_.data()->index, result(&Results::index), 1, stream_);
  const std::array<Real, kLedgerTerms> sums = totals(fetch(&Results::ledger));
  ParticleLedger out = make_particle_ledger(sums.data(), side_);
  out.drifting = ranks_.sum(std::int64_t{h_results_[0].index});
  return out;
}

void CudaBackend::start_pack() {
  PackArrays& p = *pack_;
  const auto n = static_cast<std::size_t>(owned_);
  p.ready.wait();  // for the last pack, whose arrays are written now
  p.n = n;
  for_each_column([&](auto& on_device, auto& on_host) { on_device.resize(n), on_host.resize(n); }, p.packed,
                  p.h_packed);
  p.h_ids.resize(n);
  p.elastic.resize(n), p.pairs.resize(n), p.contacts.resize(n);
  p.ids.resize(n), p.sorted_ids.resize(n), p.order.resize(n), p.sorted_order.resize(n);
  kernels_->energies(device(), views(), owned_, {p.elastic.data(), p.contacts.data(), p.pairs.data()});
  for_each(device(), owned_, IdItem{now_.row_key.data(), p.ids.data(), p.order.data()});
  const auto sort = [&](void* at, std::size_t& bytes) {
    require_cuda(
        cub::DeviceRadixSort::SortPairs(at, bytes, p.ids.data(), p.sorted_ids.data(), p.order.data(),
                                        p.sorted_order.data(), owned_, 0, 8 * sizeof(GlobalId), stream_),
        "sort");
  };
  if (n > 0) with_space(space_, sort);
  PackItem item{views_of(now_),
                p.sorted_order.data(),
                p.contacts.data(),
                model_.gravity,
                model_.space.min,
                subdomain_.period(),
                {}};
  for_each_column([](auto*& to, auto& array) { to = array.data(); }, item.out, p.packed);
  for_each(device(), owned_, item);
  step_queued_.record(stream_);
  step_queued_.hold(copy_stream_);
  copy_async(p.h_ids.data(), p.sorted_ids.data(), n, copy_stream_);
  for_each_column([&](auto& to, auto& from) { copy_async(to.data(), from.data(), n, copy_stream_); },
                  p.h_packed, p.packed);
  p.ready.record(copy_stream_);
}

ParticlePack CudaBackend::pack_particles() {
  PackArrays& p = *pack_;
  p.ready.wait();
  ParticlePack pack;
  pack.global_id.assign(p.h_ids.data(), p.h_ids.data() + p.n);
  for_each_column([&](auto& values, auto& array) { values.assign(array.data(), array.data() + p.n); }, pack,
                  p.h_packed);
  return pack;
}

ShapePack CudaBackend::pack_shapes() {
  find_shape_contacts();
  return side_.pack(layout_, ranks_);
}

std::vector<TracedParticle> CudaBackend::traced(std::span<const GlobalId> wanted) {
  if (wanted.empty()) return {};
  std::vector<GlobalId> ids(wanted.begin(), wanted.end());
  std::sort(ids.begin(), ids.end());
  traced_ids_.upload(ids, stream_);
  // An id that no particle has stands where none of this rank's was found.
  traced_.resize(ids.size());
  require_cuda(cudaMemsetAsync(traced_.data(), 0xff, ids.size() * sizeof(TracedParticle), stream_),
               "cudaMemsetAsync");
  for_each(device(), owned_,
           TraceItem{views_of(now_), traced_ids_.data(), static_cast<Index>(ids.size()), model_.space.min,
                     subdomain_.period(), traced_.data()});
  std::vector<TracedParticle> found = traced_.download(stream_);
  std::erase_if(found, [](const TracedParticle& t) { return t.global_id < 0; });
  return found;
}

std::vector<ContactSum> CudaBackend::body_contacts() {
  find_shape_contacts();
  return side_.body_contacts(layout_, ranks_);
}

std::vector<ContactSum> CudaBackend::wall_contacts(std::span<const int> walls) {
  std::vector<ContactSum> contacts;
  for (const int wall : walls) {
    kernels_->wall_sums(device(), views(), owned_ + shape_items(),
                        {wall, owned_, model_.space.min, subdomain_.period()}, result(&Results::wall),
                        [&](Real* largest) { halo_.max(device(), largest, kWallTerms); });
    contacts.push_back(make_wall_contact(totals(fetch(&Results::wall)).data()));
  }
  return contacts;
}

}  // namespace scree
