// The part of the halo that does not depend on where particles are stored: the ranks that exchange ghosts,
// and the parts of a rank's box that they need.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/hd.hpp"
#include "base/index.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/decomposition.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Number of the zero shift among the 27 shifts by whole periods.
inline constexpr std::int8_t kZeroShift = 13;
// Shift of an image by its number [m].
SCREE_HD Vec3 image_shift(std::int8_t image, Vec3 period) {
  return {(image % 3 - 1) * period.x, (image / 3 % 3 - 1) * period.y, (image / 9 - 1) * period.z};
}
// Calls visit(shift [m], image) for the shifts by at most one period along each periodic axis, including the
// zero shift.
SCREE_HD_CALLER template <class Visit>
SCREE_HD void for_each_shift(Vec3 period, const Visit& visit) {
  const int x1 = period.x != 0, y1 = period.y != 0, z1 = period.z != 0;
  for (int z = -z1; z <= z1; ++z)
    for (int y = -y1; y <= y1; ++y)
      for (int x = -x1; x <= x1; ++x)
        visit(Vec3{x * period.x, y * period.y, z * period.z},
              static_cast<std::int8_t>((z + 1) * 9 + (y + 1) * 3 + x + 1));
}

// A rank with which this one exchanges ghosts. Entries [first_sent, first_sent + sent) of the sent ones go to
// that rank; ghosts [first_received, first_received + received) come from it.
struct HaloNeighbor {
  int rank;
  Index first_sent = 0, sent = 0;
  Index first_received = 0, received = 0;
};

// A box in which particles are ghosts if their image by `shift` is within the halo's width of it.
struct HaloTarget {
  DomainBox box;
  Vec3 shift;         // [m]
  std::int8_t image;  // number of the shift
  int neighbor;       // index of the neighbour, or kItself: images of the rank's own particles

  static constexpr int kItself = -1;
};

// A field of the ghosts in an exchange: `element` bytes per sent entry and per ghost. The first ghosts,
// images of own particles, are not received.
struct HaloMessage {
  const void* packed;
  void* ghosts;
  std::size_t element;
};

// Calls visit(target) for the targets in which a particle at p is a ghost. box: of this rank; reach: width of
// the halo [m].
template <class Visit>
SCREE_HD void for_each_target(const DomainBox& box, Real reach, const HaloTarget* targets, int count, Vec3 p,
                              const Visit& visit) {
  if (box.inside(p, reach)) return;  // farther from every side than the halo's width
  for (int t = 0; t < count; ++t)
    if (targets[t].box.is_within(p + targets[t].shift, reach)) visit(targets[t]);
}

class HaloPlan {
 public:
  HaloPlan() = default;
  // decomposition: of the domain over the ranks; not needed by a single rank, whose only neighbour is itself
  // across periodic sides. width: of the halo beyond the boxes [m]. The plans of all ranks are consistent.
  HaloPlan(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain, Real width);

  // The targets of the rank itself first, then those of each neighbour.
  const std::vector<HaloTarget>& targets() const { return targets_; }
  const DomainBox& box() const { return box_; }  // of this rank
  Real reach() const { return reach_; }          // width plus an allowance for its round-off [m]
  // Calls visit(target) for the targets in which a particle at p is a ghost.
  template <class Visit>
  void for_each_target(Vec3 p, const Visit& visit) const {
    ::scree::for_each_target(box_, reach_, targets_.data(), as_index(targets_.size()), p, visit);
  }
  const std::vector<HaloNeighbor>& neighbors() const { return neighbors_; }

  // Exchanges the numbers of ghosts with the neighbours. own: number of ghosts that are images of this rank's
  // own particles; sent: entries per neighbour. Throws SimulationError if there are more ghosts than an Index
  // can count. Collective.
  void set_counts(std::size_t own, std::span<const std::size_t> sent);
  Index own() const { return own_; }
  Index sent() const { return sent_; }
  Index ghosts() const { return ghosts_; }  // own images and received ghosts
  Index receivers() const;                  // neighbours to which something is sent

  // Sends and receives all messages, and returns when they are complete. The memory must be accessible to
  // MPI.
  void transfer(std::span<const HaloMessage> messages) const;

 private:
  class Transfers;
  void find_neighbors(const Decomposition& decomposition, const Subdomain& subdomain, Real width);
  void find_targets(const Decomposition& decomposition, const Subdomain& subdomain);

  Ranks ranks_;
  std::vector<HaloNeighbor> neighbors_;
  std::vector<HaloTarget> targets_;
  DomainBox box_{};
  Real reach_ = 0;
  Index own_ = 0, sent_ = 0, ghosts_ = 0;
};

}  // namespace scree
