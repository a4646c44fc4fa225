// Which ranks exchange ghosts, and what of a rank's box they need: the part of the halo that is the same
// wherever the particles live.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/decomposition.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Number of no shift among the 27 by whole periods.
inline constexpr std::int8_t kNoShift = 13;
// The shift itself [m].
SCREE_HD Vec3 image_shift(std::int8_t image, Vec3 period) {
  return {(image % 3 - 1) * period.x, (image / 3 % 3 - 1) * period.y, (image / 9 - 1) * period.z};
}
// Calls visit(shift [m], image) for the shifts by at most one period along each periodic axis, none included.
SCREE_HD_CALLER template <class Visit>
SCREE_HD void for_each_shift(Vec3 period, const Visit& visit) {
  const int x1 = period.x != 0, y1 = period.y != 0, z1 = period.z != 0;
  for (int z = -z1; z <= z1; ++z)
    for (int y = -y1; y <= y1; ++y)
      for (int x = -x1; x <= x1; ++x)
        visit(Vec3{x * period.x, y * period.y, z * period.z},
              static_cast<std::int8_t>((z + 1) * 9 + (y + 1) * 3 + x + 1));
}

// A rank that this one exchanges ghosts with. Entries [first_sent, first_sent + sent) of what is sent go
// there; what comes from there are the ghosts [first_received, first_received + received).
struct HaloNeighbor {
  int rank;
  Index first_sent = 0, sent = 0;
  Index first_received = 0, received = 0;
};

// Particles whose image by `shift` comes within reach of the box are ghosts there.
struct HaloTarget {
  DomainBox box;
  Vec3 shift;         // [m]
  std::int8_t image;  // number of the shift
  int neighbor;       // index of the neighbour, or kItself: images of the rank's own particles

  static constexpr int kItself = -1;
};

// A field of the ghosts on its way: one entry of `element` bytes per entry that is sent, and per ghost. The
// first ghosts, images of own particles, are not received.
struct HaloMessage {
  const void* packed;
  void* ghosts;
  std::size_t element;
};

// Calls visit(target) for the targets that a particle at p is a ghost of. box: of this rank; reach: of the
// halo past the boxes [m].
template <class Visit>
SCREE_HD void for_each_target(const DomainBox& box, Real reach, const HaloTarget* targets, int count, Vec3 p,
                              const Visit& visit) {
  if (box.inside(p, reach)) return;  // too far from every side to be a ghost
  for (int t = 0; t < count; ++t)
    if (targets[t].box.reaches(p + targets[t].shift, reach)) visit(targets[t]);
}

class HaloPlan {
 public:
  HaloPlan() = default;
  // decomposition: of the space over the ranks; a rank alone needs none, its only neighbour is itself across
  // periodic sides. width: how far the halo reaches past the boxes [m]. All ranks come to plans that fit each
  // other.
  HaloPlan(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain, Real width);

  // Those of the rank itself first, then those of one neighbour after the other.
  const std::vector<HaloTarget>& targets() const { return targets_; }
  const DomainBox& box() const { return box_; }  // of this rank
  Real reach() const { return reach_; }          // the width, and what covers its round-off [m]
  // Those of a particle at p.
  template <class Visit>
  void for_each_target(Vec3 p, const Visit& visit) const {
    ::scree::for_each_target(box_, reach_, targets_.data(), static_cast<int>(targets_.size()), p, visit);
  }
  const std::vector<HaloNeighbor>& neighbors() const { return neighbors_; }

  // Once the ghosts are known, tells the neighbours how many come, and learns how many come from them. own:
  // ghosts that are images of this rank's own particles; sent: entries per neighbour. Called by all ranks.
  // Throws SimulationError where they are more than an Index can count.
  void set_counts(std::size_t own, std::span<const std::size_t> sent);
  Index own() const { return own_; }
  Index sent() const { return sent_; }
  Index ghosts() const { return ghosts_; }  // own images and received ones
  Index receivers() const;                  // neighbours that something is sent to

  // Sends and receives all of the messages; done on return. In memory that MPI can read and write.
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
