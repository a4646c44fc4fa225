// Contact keys: lossless packing up to the bounds of the members, and the order of packed keys.
#include "dem/history/contact_key.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "support/catch.hpp"

namespace scree {
namespace {

constexpr GlobalId kLastParticle = kFirstSurfaceId - 1;
constexpr Index kLastSurface = (1 << kSurfaceBits) - 1, kLastFeature = (1 << kFeatureBits) - 1;
constexpr std::int8_t kLastImage = kImages - 1;

// Keys of all kinds with the bounds of all members, in the order of the packed keys.
std::vector<ContactKey> ordered_keys() {
  std::vector<ContactKey> keys;
  for (const GlobalId id : {GlobalId{0}, GlobalId{1}, GlobalId{123456789}, kLastParticle})
    for (std::int8_t image = 0; image < kImages; ++image) keys.push_back(ContactKey::particle(id, image));
  for (const bool penetrated : {false, true})
    for (const Index feature : {0, 1, 54321, kLastFeature})
      for (const Index surface : {0, 1, 777, kLastSurface})
        for (std::int8_t image = 0; image < kImages; ++image)
          keys.push_back(ContactKey::surface(surface, image, feature, penetrated));
  return keys;
}

}  // namespace

TEST_CASE("contact keys of all kinds fit and are unpacked without loss") {
  for (const ContactKey& key : ordered_keys()) {
    const std::int64_t packed = key.pack();
    const bool same = ContactKey::unpack(packed) == key;
    CAPTURE(static_cast<int>(key.kind), key.id, static_cast<int>(key.image), key.feature, key.penetrated);
    REQUIRE(same);
    REQUIRE(key.fits());
    REQUIRE(packed >= 0);
    REQUIRE(id_of(packed) == key.partner());
    REQUIRE(id_of(packed) < kPartnersEnd);
    REQUIRE(image_of(packed) == key.image);
    REQUIRE(is_surface(packed) == (key.kind == PartnerKind::surface));
    REQUIRE(is_penetrated(packed) == key.penetrated);
  }
}

TEST_CASE("packed contact keys have the bits of existing checkpoints and hashes") {
  CHECK(ContactKey::particle(7, 2).pack() == 7 * 27 + 2);
  CHECK(ContactKey::particle(7).pack() == row_key(7));
  CHECK(ContactKey::particle(7).pack() == 7 * 27 + 13);
  const GlobalId of_feature = GlobalId{9} << 20;
  CHECK(ContactKey::surface(5, 12).pack() == ((GlobalId{1} << 48) + 5) * 27 + 12);
  CHECK(ContactKey::surface(5, 12, 9).pack() == ((GlobalId{1} << 48) + 5 + of_feature) * 27 + 12);
  CHECK(ContactKey::surface(5, 12, 9, true).pack() == ((GlobalId{1} << 49) + 5 + of_feature) * 27 + 12);
  CHECK(ContactKey::surface(5, 12, 9, true).partner() == (GlobalId{1} << 49) + 5 + of_feature);
}

TEST_CASE("packed contact keys sort particles first, then surfaces, then penetrated surfaces") {
  std::vector<std::int64_t> packed;
  for (const ContactKey& key : ordered_keys()) packed.push_back(key.pack());
  CHECK(std::ranges::is_sorted(packed));
  CHECK(std::ranges::adjacent_find(packed) == packed.end());
  std::vector<std::int64_t> reversed(packed.rbegin(), packed.rend());
  sort_by_key(
      std::size_t{3}, reversed.size() - 2, [&](std::size_t k) { return reversed[k]; },
      [&](std::size_t a, std::size_t b) { std::swap(reversed[a], reversed[b]); });
  CHECK(std::is_sorted(reversed.begin() + 3, reversed.end() - 2));
  CHECK(std::equal(packed.rbegin(), packed.rbegin() + 3, reversed.begin()));
  CHECK(std::equal(packed.begin(), packed.begin() + 2, reversed.rbegin()));
}

TEST_CASE(
    "a contact key with a member beyond its bound does not fit: it packs to the key of another contact") {
  const auto packs_as = [](const ContactKey& key, const ContactKey& other) {
    return !key.fits() && key.pack() == other.pack() && other.fits();
  };
  CHECK(packs_as(ContactKey::particle(4, kLastImage + 1), ContactKey::particle(5, 0)));
  CHECK(packs_as(ContactKey::particle(5, -1), ContactKey::particle(4, kLastImage)));
  CHECK(packs_as(ContactKey::particle(kLastParticle + 1), ContactKey::surface(0)));
  CHECK(packs_as(ContactKey::surface(-1), ContactKey::particle(kLastParticle)));
  CHECK(packs_as(ContactKey::surface(2, kZeroShift, kLastFeature + 1),
                 ContactKey::surface(2, kZeroShift, 0, true)));
  CHECK(!ContactKey::particle(-1).fits());
  CHECK(!ContactKey::surface(2, kZeroShift, -1).fits());
  CHECK(!ContactKey{PartnerKind::particle, 1, kZeroShift, 1, false}.fits());
  CHECK(!ContactKey{PartnerKind::particle, 1, kZeroShift, 0, true}.fits());
  // Models without meshes may have more surfaces: their keys differ, and unpacking and packing keeps the
  // bits.
  const ContactKey many = ContactKey::surface(kLastSurface + 1, 4);
  CHECK(packs_as(many, ContactKey::surface(0, 4, 1)));
  CHECK(ContactKey::unpack(many.pack()).pack() == many.pack());
  CHECK(surface_with_id(many.partner()) == kLastSurface + 1);
}

TEST_CASE("surface and image are read from packed contact keys with any feature and side") {
  for (const bool penetrated : {false, true})
    for (const Index feature : {0, 1, kLastFeature})
      for (const Index surface : {0, 3, kLastSurface}) {
        CAPTURE(penetrated, feature, surface);
        const std::int64_t key = ContactKey::surface(surface, 5, feature, penetrated).pack();
        CHECK(surface_of(key) == surface);
        CHECK(feature_of(key) == feature);
        CHECK(is_with_surface(key, surface));
        CHECK(!is_with_surface(key, surface ^ 1));
        CHECK(is_with_image(key, ContactKey::surface(surface, 5).pack()));
        CHECK(!is_with_image(key, ContactKey::surface(surface, 6).pack()));
        CHECK(!is_with_image(key, ContactKey::surface(surface ^ 1, 5).pack()));
      }
  CHECK(!is_with_surface(ContactKey::particle(3).pack(), 3));
  CHECK(!is_with_image(ContactKey::particle(3).pack(), ContactKey::surface(3).pack()));
}

TEST_CASE("numbers of surfaces follow from their ids, and ids of particles give -1") {
  for (const Index surface : {0, 1, kLastSurface, std::numeric_limits<Index>::max()}) {
    CHECK(surface_with_id(surface_id(surface)) == surface);
    CHECK(surface_id(surface) == ContactKey::surface(surface).partner());
  }
  for (const GlobalId particle : {GlobalId{0}, kLastParticle}) CHECK(surface_with_id(particle) == -1);
}

}  // namespace scree
