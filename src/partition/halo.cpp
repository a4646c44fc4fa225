#include "partition/halo.hpp"

#include <mpi.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/for_each.hpp"
#include "partition/entry_type.hpp"

namespace scree {
namespace {

constexpr int kCountTag = 21, kFieldTag = 22, kPositionTag = 23, kVelocityTag = 24;

// Whether `box`, moved by s periods, comes within the width of `other`.
bool comes_near(const DomainBox& box, Vec3 shift, const DomainBox& other, Real width) {
  const auto along = [&](Real Vec3::*axis) {
    return box.min.*axis + shift.*axis <= other.max.*axis + width &&
           box.max.*axis + shift.*axis >= other.min.*axis - width;
  };
  return along(&Vec3::x) && along(&Vec3::y) && along(&Vec3::z);
}

// Calls visit(shift [m], image) for the shifts by whole periods, none included.
template <class Visit>
void for_each_shift(Vec3 period, const Visit& visit) {
  const auto most = [](Real length) { return length == 0 ? 0 : 1; };
  for (int z = -most(period.z); z <= most(period.z); ++z)
    for (int y = -most(period.y); y <= most(period.y); ++y)
      for (int x = -most(period.x); x <= most(period.x); ++x)
        visit(Vec3{x * period.x, y * period.y, z * period.z},
              static_cast<std::int8_t>((z + 1) * 9 + (y + 1) * 3 + x + 1));
}

void check_countable(std::size_t ghosts) {
  if (ghosts > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw SimulationError(
        "stage exchange_halo: more ghosts than one rank can count; more ranks have fewer each");
}

}  // namespace

std::vector<Ghost> periodic_images(const Subdomain& subdomain, const Space& space,
                                   std::span<const Vec4> position, Real width) {
  std::vector<Ghost> ghosts;
  const Vec3 period = subdomain.period();
  if (period == Vec3{}) return ghosts;
  const HaloBox box{space.min, space.max, period, width};
  for (Index i = 0; i < static_cast<Index>(position.size()); ++i)
    for_each_ghost(box, xyz(position[static_cast<std::size_t>(i)]), [&](Vec3 shift, std::int8_t image) {
      ghosts.push_back({i, shift, image});
    });
  return ghosts;
}

// Messages of entries of one size [B] under way; all of them are done when it goes. Nothing may throw while
// it is there: the others would wait for messages that are never sent.
class Halo::Messages {
 public:
  // most: number of messages.
  Messages(const Ranks& ranks, std::size_t element, std::size_t most)
      : communicator_(MPI_Comm_f2c(ranks.communicator())), type_(element) {
    requests_.reserve(most);
  }
  ~Messages() { MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void receive(void* data, Index entries, int rank, int tag) {
    MPI_Irecv(data, entries, type_, rank, tag, communicator_, &requests_.emplace_back());
  }
  void send(const void* data, Index entries, int rank, int tag) {
    MPI_Isend(data, entries, type_, rank, tag, communicator_, &requests_.emplace_back());
  }

 private:
  MPI_Comm communicator_;
  EntryType type_;
  std::vector<MPI_Request> requests_;
};

Halo::Halo(std::vector<Ghost> own) : own_(std::move(own)) {
  for (const Ghost& ghost : own_) images_.push_back(ghost.image);
}

void Halo::exchange(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                    const Space& space, std::span<const Vec4> position, Real width) {
  ranks_ = ranks;
  neighbors_.clear(), sent_.clear();
  if (ranks.alone()) {
    own_ = periodic_images(subdomain, space, position, width);
  } else {
    find_neighbors(decomposition, subdomain, width);
    find_sent(decomposition, subdomain, position, width);
  }
  images_.clear();
  for (const Ghost& ghost : own_) images_.push_back(ghost.image);
  if (!ranks.alone()) tell_neighbors();
}

Index Halo::receivers() const {
  return static_cast<Index>(
      std::count_if(neighbors_.begin(), neighbors_.end(), [](const Neighbor& n) { return n.sent > 0; }));
}

// Both of two ranks come to the same answer: the lower one's box is moved.
void Halo::find_neighbors(const Decomposition& decomposition, const Subdomain& subdomain, Real width) {
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

void Halo::find_sent(const Decomposition& decomposition, const Subdomain& subdomain,
                     std::span<const Vec4> position, Real width) {
  struct Target {
    DomainBox box;
    Vec3 shift;
    std::int8_t image;
    std::vector<Ghost>* ghosts;
  };
  const Real reach = width * (1 + kBoxRoundOff);
  const DomainBox own = decomposition.box(ranks_.rank(), subdomain);
  std::vector<std::vector<Ghost>> ghosts(neighbors_.size());
  std::vector<Target> targets;
  const auto add_targets = [&](int rank, std::vector<Ghost>& list) {
    const DomainBox box = decomposition.box(rank, subdomain);
    for_each_shift(subdomain.period(), [&](Vec3 shift, std::int8_t image) {
      const bool itself = rank == ranks_.rank() && image == kNoShift;
      if (!itself && comes_near(own, shift, box, 2 * reach)) targets.push_back({box, shift, image, &list});
    });
  };
  own_.clear();
  add_targets(ranks_.rank(), own_);
  for (std::size_t k = 0; k < neighbors_.size(); ++k) add_targets(neighbors_[k].rank, ghosts[k]);
  for (Index i = 0; i < static_cast<Index>(position.size()); ++i) {
    const Vec3 p = xyz(position[static_cast<std::size_t>(i)]);
    if (own.reaches(p, -reach)) continue;  // too far from every side to be a ghost
    for (const Target& t : targets)
      if (t.box.reaches(p + t.shift, reach)) t.ghosts->push_back({i, t.shift, t.image});
  }
  std::size_t all = 0;
  for (const std::vector<Ghost>& list : ghosts) all += list.size();
  check_countable(all);
  for (std::size_t k = 0; k < neighbors_.size(); ++k) {
    neighbors_[k].first_sent = static_cast<Index>(sent_.size());
    neighbors_[k].sent = static_cast<Index>(ghosts[k].size());
    sent_.insert(sent_.end(), ghosts[k].begin(), ghosts[k].end());
  }
}

void Halo::tell_neighbors() {
  {
    Messages messages(ranks_, sizeof(Index), 2 * neighbors_.size());
    for (Neighbor& n : neighbors_) messages.receive(&n.received, 1, n.rank, kCountTag);
    for (const Neighbor& n : neighbors_) messages.send(&n.sent, 1, n.rank, kCountTag);
  }
  std::size_t ghosts = own_.size();
  for (const Neighbor& n : neighbors_) ghosts += static_cast<std::size_t>(n.received);
  check_countable(ghosts);
  auto next = static_cast<Index>(own_.size());
  for (Neighbor& n : neighbors_) n.first_received = next, next += n.received;
  images_.resize(ghosts);
  for (std::vector<Vec4>& buffer : buffer_) buffer.resize(sent_.size());
  std::vector<std::int8_t> sent(sent_.size());
  std::transform(sent_.begin(), sent_.end(), sent.begin(), [](const Ghost& g) { return g.image; });
  transfer(sent.data(), images_.data(), sizeof(std::int8_t));
}

void Halo::transfer(const void* packed, void* ghosts, std::size_t element) const {
  const auto bytes = [&](Index entries) { return static_cast<std::size_t>(entries) * element; };
  Messages messages(ranks_, element, 2 * neighbors_.size());
  for (const Neighbor& n : neighbors_)
    messages.receive(static_cast<char*>(ghosts) + bytes(n.first_received), n.received, n.rank, kFieldTag);
  for (const Neighbor& n : neighbors_)
    messages.send(static_cast<const char*>(packed) + bytes(n.first_sent), n.sent, n.rank, kFieldTag);
}

void Halo::update_motion(std::span<Vec4> position, std::span<Vec4> velocity, Index first_ghost) const {
  const auto copy_own = [&] {
    const auto n = static_cast<Index>(own_.size());
    for_each(Serial{}, n, HaloPositionItem{own_.data(), position.data(), first_ghost});
    for_each(Serial{}, n, HaloItem<Vec4>{own_.data(), velocity.data(), first_ghost});
  };
  if (ranks_.alone()) return copy_own();
  Messages messages(ranks_, sizeof(Vec4), 4 * neighbors_.size());
  for (const Neighbor& n : neighbors_) {
    messages.receive(position.data() + first_ghost + n.first_received, n.received, n.rank, kPositionTag);
    messages.receive(velocity.data() + first_ghost + n.first_received, n.received, n.rank, kVelocityTag);
  }
  for (std::size_t k = 0; k < sent_.size(); ++k) {
    const auto source = static_cast<std::size_t>(sent_[k].source);
    buffer_[0][k] = moved(sent_[k], position[source]), buffer_[1][k] = velocity[source];
  }
  for (const Neighbor& n : neighbors_) {
    messages.send(buffer_[0].data() + n.first_sent, n.sent, n.rank, kPositionTag);
    messages.send(buffer_[1].data() + n.first_sent, n.sent, n.rank, kVelocityTag);
  }
  copy_own();
}

}  // namespace scree
