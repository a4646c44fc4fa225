#include "device_halo.cuh"

namespace scree {
namespace {

// Visits the ranks and images that need a particle as a ghost: counts its entries per target, or writes them.
// Entries of a target are in any order; nothing depends on it, because rows are sorted by global id and
// image.
struct TargetItem {
  const Vec4* position;
  DomainBox box;
  Real reach;
  const HaloTarget* targets;
  int count;
  unsigned long long* next;  // per target: end of its entries
  Ghost* ghosts;             // null: only count

  __device__ void operator()(Index i) const {
    for_each_target(box, reach, targets, count, xyz(position[i]), [&](const HaloTarget& target) {
      const unsigned long long entry = atomicAdd(&next[&target - targets], 1ull);
      if (ghosts != nullptr) ghosts[entry] = {i, target.image, {}, target.shift};
    });
  }
};

}  // namespace

DeviceHalo::DeviceHalo(const Ranks& ranks, Transport transport)
    : transports_(make_halo_transports(ranks, transport)) {}

std::string DeviceHalo::transport() const {
  if (messages() == nullptr) return "";
  return (peers() != nullptr ? "peer memory and " : "") + messages()->name();
}

void DeviceHalo::count(Device device, const HaloPlan& plan, const Vec4* position, Index n) {
  plan_ = plan;
  count_entries(device, position, n);
  if (transports_.peers) transports_.peers->set_plan(plan_);
}

void DeviceHalo::count_entries(Device device, const Vec4* position, Index n) {
  const std::vector<HaloTarget>& targets = plan_.targets();
  std::vector<std::size_t> sent(plan_.neighbors().size());
  if (targets.empty()) return plan_.set_counts(0, sent);
  targets_.resize(targets.size());
  copy_async(targets_.data(), targets.data(), targets.size(), device.stream);
  counts_.resize(targets.size());
  counts_.zero(device.stream);
  visit_targets(device, position, n, nullptr);
  h_counts_.resize(targets.size());
  copy_async(h_counts_.data(), counts_.data(), targets.size(), device.stream);
  wait_for(device.stream);
  std::size_t own = 0, all = 0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const std::size_t count = h_counts_[t];
    (targets[t].neighbor == HaloTarget::kItself ? own
                                                : sent[static_cast<std::size_t>(targets[t].neighbor)]) +=
        count;
    h_counts_[t] = all, all += count;
  }
  plan_.set_counts(own, sent);
  copy_async(counts_.data(), h_counts_.data(), targets.size(), device.stream);
}

void DeviceHalo::list(Device device, const Vec4* position, Index n) {
  if (entries() == 0) return;
  ghost_.resize_with_spare(static_cast<std::size_t>(entries()));
  for (DeviceArray<Vec4>& buffer : packed_) buffer.resize_with_spare(static_cast<std::size_t>(plan_.sent()));
  visit_targets(device, position, n, ghost_.data());
}

void DeviceHalo::visit_targets(Device device, const Vec4* position, Index n, Ghost* ghosts) {
  for_each(device, n,
           TargetItem{position, plan_.box(), plan_.reach(), targets_.data(),
                      static_cast<int>(plan_.targets().size()), counts_.data(), ghosts});
}

void DeviceHalo::update_motion(Device device, Vec4* position, Vec4* velocity, std::optional<Vec4*> spin,
                               Index first_ghost) {
  const MotionGhostItem item{ghosts(), field(0, position, first_ghost), field(1, velocity, first_ghost)};
  for_each(device, entries(), item);
  if (!spin) return exchange(device, item.position, item.velocity);
  const GhostCopyItem<Vec4> spins{ghosts(), field(2, *spin, first_ghost)};
  for_each(device, entries(), spins);
  exchange(device, item.position, item.velocity, spins.of);
}

}  // namespace scree
