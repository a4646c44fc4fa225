#include <algorithm>
#include <cub/device/device_select.cuh>
#include <numeric>
#include <stdexcept>

#include "cuda_particles.cuh"
#include "dem/backend/device.hpp"
#include "dem/backend/explicit_run.hpp"
#include "dem/particles/births.hpp"
#include "dem/particles/particle_store.hpp"

namespace scree {
namespace {

// Collects particles that leave and are not yet known to drift; counts all, stores as many as there
// is space for.
struct EscapedItem {
  ParticleViews in;
  RemainingSpace space;
  Vec3 gravity, period;
  Real verlet_step;  // [s]
  EscapedParticle* out;
  Index capacity;
  Index* count;

  __device__ void operator()(Index i) const {
    const Vec4 x = in.position[i];
    if (in.drifting[i] || space.holds(xyz(x))) return;
    const Index slot = atomicAdd(count, 1);
    if (slot >= capacity) return;
    const Real energy = energy_of_motion(in, i, gravity, period);
    const Real shift = verlet_energy_shift(verlet_step, in, i);
    out[slot] = {
        id_of(in.row_key[i]), i, xyz(x), false, energy, in.contact_loss[i], in.integrator_loss[i] - shift,
        losses_of(in, i)};
    out[slot].outlet = space.box.inside(xyz(x)) ? space.outlet_at(xyz(x)) : -1;
    out[slot].mass = in.velocity[i].w;
  }
};

// Wraps escaped particles for the last time and marks them.
struct MarkItem {
  const Index* particles;
  const std::uint8_t* marks;
  ParticleViews in;
  Vec3 box_min, period;
  SCREE_HD void operator()(Index k) const {
    const Index i = particles[k];
    const Vec4 x = in.position[i];
    in.position[i] = vec4(wrap(box_min, period, xyz(x), in.image[i]), x.w);
    in.drifting[i] = marks[k];
  }
};

struct RemainsItem {
  const std::uint8_t* drifting;
  std::uint8_t* remains;
  Index* iota;
  SCREE_HD void operator()(Index i) const { remains[i] = drifting[i] != kRemoved, iota[i] = i; }
};

struct GatherItem {
  const Index *values, *from;
  Index* out;
  SCREE_HD void operator()(Index i) const { out[i] = values[from[i]]; }
};

}  // namespace

CudaParticles::CudaParticles(CudaItems& items, CudaBodies& bodies, CudaList& list)
    : items_(items), bodies_(bodies), list_(list) {
  records_.resize_clean(kRecordsAtOnce, items.stream);
}

void CudaParticles::load(const std::vector<Particle>& records, const ShapeLosses& shapes) {
  const cudaStream_t stream = items_.stream;
  bodies_.side().load(shapes);
  items_.owned = count_on_rank(records.size(), items_.model.particles.totals);
  items_.now.grow(records.size(), records.size(), 0, stream);
  const auto at_once = static_cast<Index>(records_.size());
  for (Index first = 0; first < items_.owned; first += at_once) {
    const Index n = std::min(at_once, items_.owned - first);
    copy_async(records_.data(), records.data() + first, static_cast<std::size_t>(n), stream);
    for_each(items_.device(), n, ArrivalItem{records_.data(), views_of(items_.now), first});
  }
  wait_for(stream);
  items_.history.load({}, items_.owned), load_works({});
  list_.outdate();
  // records() must work where memory is exhausted, and the first launch of a kernel allocates some.
  for_each(items_.device(), std::min<Index>(items_.owned, 1), record_item(0));
}

RecordItem CudaParticles::record_item(Index first) {
  return {views_of(items_.now), first, items_.model.space.min, items_.subdomain.period(), records_.data()};
}

std::vector<Particle> CudaParticles::records() {
  if (list_.owners().migrating())
    throw DeviceError("the migration of particles between ranks was interrupted");
  if (items_.open_run != nullptr)
    throw std::logic_error("CudaParticles: the forces are not up to date within an explicit run");
  std::vector<Particle> out(static_cast<std::size_t>(items_.owned));
  const auto at_once = static_cast<Index>(records_.size());
  for (Index first = 0; first < items_.owned; first += at_once) {
    const Index n = std::min(at_once, items_.owned - first);
    for_each(items_.device(), n, record_item(first));
    copy_async(out.data() + first, records_.data(), static_cast<std::size_t>(n), items_.stream);
  }
  wait_for(items_.stream);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.global_id < b.global_id; });
  return out;
}

PackedHistory CudaParticles::contacts() {
  if (!items_.history.exists()) return {};
  std::vector<std::int64_t> key(static_cast<std::size_t>(items_.owned));
  copy_async(key.data(), items_.now.row_key.data(), key.size(), items_.stream);
  wait_for(items_.stream);
  std::vector<Index> order(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key[a] < key[b]; });
  return items_.history.contacts(items_.listed()).rows(order);
}

void CudaParticles::initial_forces() {
  ParticleArrays& now = items_.now;
  items_.refresh_ghosts();
  bodies_.find_loads();
  items_.kernels->run(items_.device(), items_.views(), items_.owned,
                      ForceRequest{items_.model.gravity, now.force.data(), now.loss_power.data(),
                                   now.angular_acceleration.data()});
  for_each(items_.device(), items_.owned,
           StartAccelerationItem{now.force.data(), now.velocity.data(), now.acceleration.data()});
  if (is_verlet(items_.model))
    bodies_.side().accumulate_losses(0);
  else
    now.loss_power.zero(items_.stream);
}

// Stores particles that have just escaped in escaped_particles_, as many as there is space for; returns their
// number.
std::size_t CudaParticles::find_escaped_particles() {
  Index* count = items_.results.at(&Results::escaped_particles);
  require_cuda(cudaMemsetAsync(count, 0, sizeof(Index), items_.stream), "cudaMemsetAsync");
  for_each(items_.device(), items_.owned,
           EscapedItem{views_of(items_.now), space_, items_.model.gravity, items_.subdomain.period(),
                       verlet_step(items_.model), escaped_particles_.data(),
                       static_cast<Index>(escaped_particles_.size()), count});
  return static_cast<std::size_t>(items_.results.fetch(&Results::escaped_particles));
}

std::vector<std::uint8_t> CudaParticles::overlapped(const CandidateGrid& candidates) {
  const cudaStream_t stream = items_.stream;
  DeviceArray<Index> starts, numbers;
  DeviceArray<Vec4> spheres;
  DeviceArray<std::uint8_t> found(static_cast<std::size_t>(candidates.size()));
  starts.upload(candidates.starts(), stream), numbers.upload(candidates.numbers(), stream);
  spheres.upload(candidates.spheres(), stream);
  found.zero(stream);
  for_each(items_.device(), items_.owned,
           CandidateItem{candidates.views(starts.data(), spheres.data(), numbers.data()),
                         items_.now.position.data(), items_.now.drifting.data(), found.data()});
  return on_any_rank(items_.ranks, found.download(stream));
}

void CudaParticles::insert(const std::vector<Particle>& born) {
  list_.pack_history();
  items_.ranks.collectively([&] { list_.owners().insert(born); });
  list_.outdate();
}

std::vector<EscapedParticle> CudaParticles::find_leaving(std::span<const OutletRegion> outlets) {
  constexpr std::size_t kInitialCapacity = 1024;
  if (escaped_particles_.size() == 0) escaped_particles_.resize_clean(kInitialCapacity, items_.stream);
  space_ = RemainingSpace(items_.subdomain, items_.model.space.min, outlets);
  std::vector<EscapedParticle> escaped(find_escaped_particles());
  if (!items_.ranks.any(!escaped.empty())) return escaped;
  if (escaped.size() > escaped_particles_.size()) {  // not all were stored; there is space for all now
    escaped_particles_.resize_clean(escaped.size(), items_.stream);
    find_escaped_particles();
  }
  bodies_.find_loads();
  items_.kernels->run(items_.device(), items_.views(), static_cast<Index>(escaped.size()),
                      EscapeRequest{space_, escaped_particles_.data()});
  copy_async(escaped.data(), escaped_particles_.data(), escaped.size(), items_.stream);
  wait_for(items_.stream);
  for (EscapedParticle& particle : escaped)
    particle.lost = items_.subdomain.is_beyond_wall(particle.position), particle.rank = items_.ranks.rank();
  escaped = items_.ranks.all_gather(std::move(escaped));
  std::sort(escaped.begin(), escaped.end(),
            [](const EscapedParticle& a, const EscapedParticle& b) { return a.global_id < b.global_id; });
  return escaped;
}

void CudaParticles::remove_escaped(const std::vector<EscapedParticle>& escaped) {
  if (escaped.empty()) return;
  std::vector<Index> particles;
  std::vector<std::uint8_t> marks;
  bool remove = false;  // on any rank
  for (const EscapedParticle& particle : escaped) {
    const bool removed = particle.is_removed(items_.model.space.leaving);
    remove |= removed;
    if (particle.rank != items_.ranks.rank()) continue;
    particles.push_back(particle.local_index), marks.push_back(removed ? kRemoved : 1);
  }
  const auto n = remove ? static_cast<std::size_t>(items_.owned) : 0;
  // The arrays are sized first: if memory does not suffice, nothing has changed yet.
  DeviceArray<Index> d_particles, iota(n), remaining(n), row_length(items_.ranks.alone() ? 0 : n);
  DeviceArray<std::uint8_t> remains(n), d_marks;
  d_particles.upload(particles, items_.stream), d_marks.upload(marks, items_.stream);
  remove_escaped_contacts();
  items_.history.pack_history(items_.listed());
  for_each(items_.device(), static_cast<Index>(particles.size()),
           MarkItem{d_particles.data(), d_marks.data(), views_of(items_.now), items_.model.space.min,
                    items_.subdomain.period()});
  list_.outdate();
  if (!remove) return;

  for_each(items_.device(), items_.owned,
           RemainsItem{items_.now.drifting.data(), remains.data(), iota.data()});
  with_space(items_.space, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceSelect::Flagged(at, bytes, iota.data(), remains.data(), remaining.data(),
                                            items_.results.at(&Results::index), items_.owned, items_.stream),
                 "select");
  });
  items_.reorder(remaining.data(), items_.results.fetch(&Results::index));
  DeviceArray<Index>& old_length = list_.owners().row_length();
  if (!items_.ranks.alone()) {
    row_length.resize(static_cast<std::size_t>(items_.owned));
    for_each(items_.device(), items_.owned,
             GatherItem{old_length.data(), remaining.data(), row_length.data()});
  }
  wait_for(items_.stream);  // the copies above read host arrays of this scope
  old_length.swap(row_length);
}

// Before the escaped particles are wrapped and marked.
void CudaParticles::remove_escaped_contacts() {
  ParticleArrays& now = items_.now;
  const bool verlet = is_verlet(items_.model);
  const Vec4* law_velocity = items_.law_velocity != nullptr ? items_.law_velocity : now.velocity.data();
  const Vec4* law_spin = items_.law_spin != nullptr ? items_.law_spin : now.angular_velocity.data();
  const DepartureRequest request{
      items_.model.gravity,
      space_,
      {now.force.data(), now.acceleration.data(), verlet ? now.loss_power.data() : nullptr,
       now.integrator_loss.data(), now.drifting.data(), verlet ? hht_coefficients(0) : items_.hht,
       verlet_step(items_.model), now.angular_acceleration.data()}};
  items_.kernels->run(items_.device(), items_.views(now.position.data(), law_velocity, law_spin),
                      items_.owned, request);
}

}  // namespace scree
