#include "partition/halo_plan.hpp"

#include <mpi.h>

#include <algorithm>

#include "base/countable.hpp"
#include "base/index.hpp"
#include "partition/entry_type.hpp"

namespace scree {
namespace {

constexpr int kCountTag = 21, kFieldTag = 22;

// Whether `box`, shifted by whole periods, is within the width of `other`.
bool comes_near(const DomainBox& box, Vec3 shift, const DomainBox& other, Real width) {
  const auto along = [&](Real Vec3::*axis) {
    return box.min.*axis + shift.*axis <= other.max.*axis + width &&
           box.max.*axis + shift.*axis >= other.min.*axis - width;
  };
  return along(&Vec3::x) && along(&Vec3::y) && along(&Vec3::z);
}

Index countable_ghosts(std::size_t count) { return countable(count, "stage exchange_halo: more ghosts"); }

}  // namespace

// Messages in progress; the destructor waits for all of them. Nothing may throw during its lifetime: other
// ranks would wait for messages that are never sent.
class HaloPlan::Transfers {
 public:
  // most: largest number of messages.
  Transfers(const Ranks& ranks, std::size_t most) : communicator_(MPI_Comm_f2c(ranks.communicator())) {
    requests_.reserve(most);
  }
  ~Transfers() { MPI_Waitall(as_index(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE); }
  Transfers(const Transfers&) = delete;
  Transfers& operator=(const Transfers&) = delete;

  void receive(void* data, Index entries, const EntryType& type, int rank, int tag) {
    MPI_Irecv(data, entries, type, rank, tag, communicator_, &requests_.emplace_back());
  }
  void send(const void* data, Index entries, const EntryType& type, int rank, int tag) {
    MPI_Isend(data, entries, type, rank, tag, communicator_, &requests_.emplace_back());
  }

 private:
  MPI_Comm communicator_;
  std::vector<MPI_Request> requests_;
};

HaloPlan::HaloPlan(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                   Real width)
    : ranks_(ranks), box_(decomposition.box(ranks.rank(), subdomain)), reach_(width * (1 + kBoxRoundOff)) {
  find_neighbors(decomposition, subdomain, width);
  find_targets(decomposition, subdomain);
}

// Both ranks of a pair reach the same result, because the box of the lower rank is the one that is shifted.
void HaloPlan::find_neighbors(const Decomposition& decomposition, const Subdomain& subdomain, Real width) {
  const int self = ranks_.rank();
  for (int other = 0; other < ranks_.size(); ++other) {
    if (other == self) continue;
    const DomainBox low = decomposition.box(std::min(self, other), subdomain),
                    high = decomposition.box(std::max(self, other), subdomain);
    bool near = false;
    for_each_shift(subdomain.period(), [&](Vec3 shift, std::int8_t) {
      near = near || comes_near(low, shift, high, width * (1 + 4 * kBoxRoundOff));
    });
    if (near) neighbors_.push_back({other});
  }
}

void HaloPlan::find_targets(const Decomposition& decomposition, const Subdomain& subdomain) {
  const auto add = [&](int rank, int neighbor) {
    const DomainBox box = decomposition.box(rank, subdomain);
    for_each_shift(subdomain.period(), [&](Vec3 shift, std::int8_t image) {
      const bool itself = neighbor == HaloTarget::kItself && image == kZeroShift;
      if (!itself && comes_near(box_, shift, box, 2 * reach_))
        targets_.push_back({box, shift, image, neighbor});
    });
  };
  add(ranks_.rank(), HaloTarget::kItself);
  for (std::size_t k = 0; k < neighbors_.size(); ++k) add(neighbors_[k].rank, as_index(k));
}

void HaloPlan::set_counts(std::size_t own, std::span<const std::size_t> sent) {
  std::size_t all = 0;
  for (std::size_t k = 0; k < neighbors_.size(); ++k) {
    neighbors_[k].first_sent = countable_ghosts(all);
    neighbors_[k].sent = countable_ghosts(sent[k]);
    all += sent[k];
  }
  sent_ = countable_ghosts(all);
  if (!neighbors_.empty()) {
    const EntryType type(sizeof(Index));
    Transfers transfers(ranks_, 2 * neighbors_.size());
    for (HaloNeighbor& n : neighbors_) transfers.receive(&n.received, 1, type, n.rank, kCountTag);
    for (const HaloNeighbor& n : neighbors_) transfers.send(&n.sent, 1, type, n.rank, kCountTag);
  }
  std::size_t ghosts = own;
  for (HaloNeighbor& n : neighbors_) {
    n.first_received = countable_ghosts(ghosts);
    ghosts += as_size(n.received);
  }
  own_ = countable_ghosts(own), ghosts_ = countable_ghosts(ghosts);
}

Index HaloPlan::receivers() const {
  return static_cast<Index>(
      std::count_if(neighbors_.begin(), neighbors_.end(), [](const HaloNeighbor& n) { return n.sent > 0; }));
}

void HaloPlan::transfer(std::span<const HaloMessage> messages) const {
  if (neighbors_.empty()) return;
  std::vector<EntryType> types;
  types.reserve(messages.size());
  for (const HaloMessage& m : messages) types.emplace_back(m.element);
  Transfers transfers(ranks_, 2 * messages.size() * neighbors_.size());
  for (std::size_t k = 0; k < messages.size(); ++k)
    for (const HaloNeighbor& n : neighbors_)
      transfers.receive(
          static_cast<char*>(messages[k].ghosts) + as_size(n.first_received) * messages[k].element,
          n.received, types[k], n.rank, kFieldTag + as_index(k));
  for (std::size_t k = 0; k < messages.size(); ++k)
    for (const HaloNeighbor& n : neighbors_)
      transfers.send(
          static_cast<const char*>(messages[k].packed) + as_size(n.first_sent) * messages[k].element, n.sent,
          types[k], n.rank, kFieldTag + as_index(k));
}

}  // namespace scree
