// Contact keys, which identify the partner of each contact of a particle independently of lists, ranks and
// steps. Packed into one integer, the key orders the rows of the neighbour list and of the packed contact
// history, also in checkpoints, messages and state hashes. Shared by the CPU and CUDA backends.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "dem/particles/row_key.hpp"
#include "mesh/surface_numbers.hpp"

namespace scree {

// Ids of partners: particles come first, then surfaces, then penetrated open surfaces, which the particle's
// centre has passed.
inline constexpr GlobalId kFirstSurfaceId = GlobalId{1} << 48, kFirstPenetratedId = 2 * kFirstSurfaceId,
                          kPartnersEnd = 3 * kFirstSurfaceId;
static_assert(kSurfaceBits + kFeatureBits <= 48 && kPartnersEnd < INT64_MAX / kImages);

// Id of a surface as a partner; and the number of the surface from the id, -1 for the id of a particle.
SCREE_HD GlobalId surface_id(Index surface) { return kFirstSurfaceId + surface; }
SCREE_HD Index surface_with_id(GlobalId partner) {
  return static_cast<Index>(partner >= kFirstSurfaceId ? partner - kFirstSurfaceId : -1);
}

// Functions of packed keys. feature_of() and surface_of() are for contacts with surfaces in models with
// meshes, which have at most 2^kSurfaceBits surfaces.
SCREE_HD bool is_surface(std::int64_t key) { return key >= kImages * kFirstSurfaceId; }
SCREE_HD bool is_penetrated(std::int64_t key) { return key >= kImages * kFirstPenetratedId; }
SCREE_HD Index feature_of(std::int64_t key) {
  return static_cast<Index>((id_of(key) % kFirstSurfaceId) >> kSurfaceBits);
}
SCREE_HD Index surface_of(std::int64_t key) {
  return static_cast<Index>(id_of(key) % kFirstSurfaceId & ((GlobalId{1} << kSurfaceBits) - 1));
}
SCREE_HD bool is_with_surface(std::int64_t key, Index surface) {
  return is_surface(key) && surface_of(key) == surface;
}
// Whether a contact has the surface and image of another one, on any feature and side. with: packed key of
// the other contact, with feature 0 and not penetrated.
SCREE_HD bool is_with_image(std::int64_t key, std::int64_t with) {
  if (!is_surface(key)) return false;
  const GlobalId of_feature = GlobalId{feature_of(key)} << kSurfaceBits;
  return key - kImages * (is_penetrated(key) ? of_feature + kFirstSurfaceId : of_feature) == with;
}

enum class PartnerKind : std::uint8_t { particle, surface };

// Unpacked contact key.
struct ContactKey {
  PartnerKind kind = PartnerKind::particle;
  GlobalId id = 0;  // global id of the particle, or number of the surface
  // Image of the partner relative to the particle with both in the periodic box, so that no key depends on
  // when positions were last wrapped.
  std::int8_t image = kZeroShift;
  Index feature = 0;        // feature of a mesh in contact; 0 for other surfaces
  bool penetrated = false;  // whether the particle's centre is past the open surface

  SCREE_HD static ContactKey particle(GlobalId id, std::int8_t image = kZeroShift) {
    return {PartnerKind::particle, id, image, 0, false};
  }
  SCREE_HD static ContactKey surface(Index number, std::int8_t image = kZeroShift, Index feature = 0,
                                     bool penetrated = false) {
    return {PartnerKind::surface, number, image, feature, penetrated};
  }

  // Models without meshes may have more than 2^kSurfaceBits surfaces. The upper bits of such a number are
  // unpacked as a feature, and packed again to the same integer.
  SCREE_HD static ContactKey unpack(std::int64_t key) {
    if (!is_surface(key)) return particle(id_of(key), image_of(key));
    return surface(surface_of(key), image_of(key), feature_of(key), is_penetrated(key));
  }
  SCREE_HD std::int64_t pack() const { return row_key(partner(), image); }
  // Id of the partner, which is the key without the image, as in checkpoints and contact lines.
  SCREE_HD GlobalId partner() const {
    if (kind == PartnerKind::particle) return id;
    return (penetrated ? kFirstPenetratedId : kFirstSurfaceId) + id + (GlobalId{feature} << kSurfaceBits);
  }
  // Whether unpack(pack()) gives the same key. Keys that do not fit pack to the key of another contact.
  SCREE_HD bool fits() const {
    if (id < 0 || image < 0 || image >= kImages || feature < 0) return false;
    if (kind == PartnerKind::particle) return id < kFirstSurfaceId && feature == 0 && !penetrated;
    return id < GlobalId{1} << kSurfaceBits && feature < Index{1} << kFeatureBits;
  }
  friend bool operator==(const ContactKey&, const ContactKey&) = default;
};

// Sorts the contacts from `first` to `end` by key(k); exchange(a, b) swaps two contacts. Insertion sort, as
// rows are nearly sorted.
SCREE_HD_CALLER
template <class Offset, class Key, class Exchange>
SCREE_HD void sort_by_key(Offset first, Offset end, const Key& key, const Exchange& exchange) {
  for (Offset k = first + 1; k < end; ++k)
    for (Offset at = k; at > first && key(at - 1) > key(at); --at) exchange(at - 1, at);
}

}  // namespace scree
