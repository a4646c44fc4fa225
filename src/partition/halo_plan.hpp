// Which ranks exchange ghosts, and what of a rank's box they need: the part of the halo that is the same wherever the
// particles live.
#pragma once

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

// A rank that this one exchanges ghosts with. Entries [first_sent, first_sent + sent) of what is sent go there; what
// comes from there are the ghosts [first_received, first_received + received).
struct HaloNeighbor {
  int rank;
  Index first_sent = 0, sent = 0;
  Index first_received = 0, received = 0;
};

// Particles whose image by `shift` lies in the box are ghosts there.
struct HaloTarget {
  DomainBox box;      // grown by the halo's width
  Vec3 shift;         // [m]
  std::int8_t image;  // number of the shift
  int neighbor;       // index of the neighbour, kItself for images of the rank's own particles

  static constexpr int kItself = -1;
  SCREE_HD bool takes(Vec3 p) const { return box.contains(p + shift); }
};

class HaloPlan {
 public:
  HaloPlan() = default;
  // width: reach of the halo past the boxes [m]. All ranks come to plans that fit each other.
  HaloPlan(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain, Real width);

  // Those of the rank itself first, then those of one neighbour after the other.
  const std::vector<HaloTarget>& targets() const { return targets_; }
  // Particles in here are ghosts nowhere.
  const DomainBox& inner() const { return inner_; }
  const std::vector<HaloNeighbor>& neighbors() const { return neighbors_; }

  // Once the ghosts are known: tells the neighbours how many come, and learns how many come from them. own: ghosts
  // that are images of this rank's own particles; sent: entries per neighbour. Called by all ranks.
  void set_counts(Index own, std::span<const Index> sent);
  Index own() const { return own_; }
  Index sent() const { return sent_; }
  Index ghosts() const { return ghosts_; }  // own images and received ones

  // Sends `packed`, with `element` bytes per entry, and receives the ghosts behind the own images: `ghosts` points to
  // the first of all ghosts. Done on return.
  void transfer(const void* packed, void* ghosts, std::size_t element) const;

 private:
  class Messages;
  void find_neighbors(const Decomposition& decomposition, const Subdomain& subdomain, Real width);
  void find_targets(const Decomposition& decomposition, const Subdomain& subdomain, Real width);

  Ranks ranks_;
  std::vector<HaloNeighbor> neighbors_;
  std::vector<HaloTarget> targets_;
  DomainBox inner_;
  Index own_ = 0, sent_ = 0, ghosts_ = 0;
};

}  // namespace scree
