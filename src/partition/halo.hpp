// Halo: copies of the particles near a rank's box, from other ranks and across periodic sides.
#pragma once

#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "base/for_each.hpp"
#include "base/index.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/decomposition.hpp"
#include "partition/halo_plan.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// One ghost: a copy of an owned item, shifted by whole periods. It has no uninitialized bytes, because a
// kernel reads several at once.
struct Ghost {
  Index source;           // local index of the original
  std::int8_t image;      // number of the shift among the 27; 13: no shift
  std::int8_t unused[3];  // 0
  Vec3 shift;             // ghost position less original position [m]
};
static_assert(sizeof(Ghost) == sizeof(Index) + 4 + sizeof(Vec3));

// Copies one field of a ghost from its original; ghosts are at field[first_ghost ...].
template <class T>
struct HaloItem {
  const Ghost* ghosts;
  T* field;
  Index first_ghost;

  SCREE_HD void operator()(Index g) const { field[first_ghost + g] = field[ghosts[g].source]; }
};

// Position of a ghost whose original is at p.
SCREE_HD Vec4 moved(const Ghost& ghost, Vec4 p) { return vec4(xyz(p) + ghost.shift, p.w); }

// Copies the position of a ghost from its original, with the shift.
struct HaloPositionItem {
  const Ghost* ghosts;
  Vec4* position;
  Index first_ghost;

  SCREE_HD void operator()(Index g) const {
    position[first_ghost + g] = moved(ghosts[g], position[ghosts[g].source]);
  }
};

struct SizeLevels;
struct LevelSpace;

// The ghosts of a rank, and their updates. Ghosts follow the owned items: first the images of this rank's own
// particles, then the ghosts from each neighbour, contiguous per neighbour.
class Halo {
 public:
  // exchange_halo: determines the ghosts on all ranks for originals at `position` (the first of the owned
  // items), and informs the neighbours. decomposition: as for HaloPlan; width: of the halo beyond the box
  // [m]. Collective.
  void exchange(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                std::span<const Vec4> position, Real width);
  // The same for particles of many sizes, in two rounds, with those ghosts only that rows need. First the
  // particles within search distance of particles of their level or a lower one become ghosts, then those
  // that are near a ghost of a higher level. position: x, y, z, radius. space: of the domain.
  void exchange(const Ranks& ranks, const Decomposition& decomposition, const Subdomain& subdomain,
                std::span<const Vec4> position, const SizeLevels& levels, const LevelSpace& space);

  Index size() const { return as_index(images_.size()); }
  // Number of entries sent per update, and of ranks that receive some.
  Index sent() const { return as_index(sent_.size()); }
  Index receivers() const { return plan_.receivers(); }
  // Number of the shift of each ghost.
  const std::vector<std::int8_t>& images() const { return images_; }
  // Images of this rank's own particles across periodic sides.
  const std::vector<Ghost>& own() const { return own_; }

  // update_halo: copies a field of the originals to the ghosts, which are at field[first_ghost ...].
  template <class T>
  void update(std::span<T> field, Index first_ghost) const;
  // update_halo for positions, which get the ghosts' shifts, for velocities and, with rotating particles, for
  // angular velocities, in one exchange. All ranks pass a spin or none; on a rank without items it is empty.
  void update_motion(std::span<Vec4> position, std::span<Vec4> velocity, std::optional<std::span<Vec4>> spin,
                     Index first_ghost) const;

 private:
  // Ghosts for this rank itself, then for each neighbour.
  using GhostLists = std::vector<std::vector<Ghost>>;
  void set_ghosts(const GhostLists& ghosts);
  std::vector<Vec4> ghost_positions(std::span<const Vec4> position) const;

  HaloPlan plan_;
  std::vector<Ghost> own_, sent_;
  std::vector<std::int8_t> images_;
  // Packed motion, or another field, in the order of sent_. Allocated by exchange(): a later allocation that
  // failed would leave the other ranks waiting.
  mutable std::vector<Vec4> buffer_[3];
};

template <class T>
void Halo::update(std::span<T> field, Index first_ghost) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(Vec4));
  for_each(Serial{}, as_index(own_.size()), HaloItem<T>{own_.data(), field.data(), first_ghost});
  T* packed = reinterpret_cast<T*>(buffer_[0].data());
  for (std::size_t k = 0; k < sent_.size(); ++k) packed[k] = field[as_size(sent_[k].source)];
  const HaloMessage message{packed, field.data() + first_ghost, sizeof(T)};
  plan_.transfer({&message, 1});
}

}  // namespace scree
