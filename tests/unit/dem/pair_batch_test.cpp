// Contacts in batches: bit for bit those of the law for each contact alone.
#include "dem/explicit/pair_batch.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/catch.hpp"

namespace scree {
namespace {

constexpr Real kStep = 1e-5;  // length [s]
constexpr Real kNumber = 7;   // of the last accepted step
constexpr Index kMaterials = 2;

using Self = OverExplicitStep::Self;
using Rolling = ContactLaw<HertzLaw, MindlinSlider, AnyRolling>;

// Laws of two materials, of which the second has viscous rolling or dashpots beside its sliders.
std::vector<Rolling> laws_with_rolling() {
  std::vector<Rolling> laws(kMaterials * kMaterials);
  for (std::size_t n = 0; n < laws.size(); ++n) {
    Rolling& law = laws[n];
    law.normal = HertzLaw(1e7, 0.3, false);
    law.tangential = {2e6, 0.5, n == 1 ? 0.1 : 0};
    law.rolling = AnyRolling::of({});
    law.rolling.rolling.spring = {n == 2 ? 0 : 0.15, 0.3, 2.25, 0};
    law.rolling.rolling.viscous.damping = n == 3 ? 1e-6 : 0;
    law.rolling.twisting.friction = n == 0 ? 0.4 : 0;
  }
  return laws;
}

struct Contact {
  Self i, j;
  Vec4 records[2];
};

// Two spheres that touch or nearly do, with a history that is alive or not.
Contact random_contact(std::mt19937& random, Index materials) {
  std::uniform_real_distribution<Real> unit(-1, 1);
  const auto vector = [&](Real size) {
    return Vec3{size * unit(random), size * unit(random), size * unit(random)};
  };
  const auto material = [&] { return static_cast<int>(random() % static_cast<unsigned>(materials)); };
  const Vec3 direction = vector(1),
             r = (0.02 * (1 - 0.01 * (unit(random) + 0.9)) / norm(direction)) * direction;
  Contact out{{0, material(), {0, 0, 0, 0.0099}, vec4(vector(1), 0.01), vec4(vector(30), 4e-7)},
              {1, material(), vec4(r, 0.0101), vec4(vector(1), 0.012), vec4(vector(30), 5e-7)},
              {}};
  out.records[0] = vec4(vector(1), random() % 3 == 0 ? kNumber - 1 : kNumber);
  out.records[1] = vec4(vector(1e-3), 0);
  return out;
}

bool same_bits(const Vec4& a, const Vec4& b) {
  using Bits = std::array<std::uint64_t, 4>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}
template <int kKinds>
bool same_bits(const PackedForce<kKinds>& a, const PackedForce<kKinds>& b) {
  bool same = true;
  for (int n = 0; n < PackedForce<kKinds>::kParts; ++n)
    same = same && same_bits(unpacked(a.part[n]), unpacked(b.part[n]));
  return same;
}

// Evaluates n contacts in a batch and each alone.
template <class Law>
void compare(const std::vector<Law>& laws, Index materials, Index n, std::mt19937& random) {
  using Batch = PairBatch<LawTable<Law>>;
  using Packed = typename Batch::Loads::Packed;
  constexpr std::size_t kSize = Batch::kSize;
  const LawTable<Law> table{laws.data(), materials};
  std::vector<Contact> contacts;
  for (Index k = 0; k < n; ++k) contacts.push_back(random_contact(random, materials));
  static Batch batch;  // keeps results of earlier calls
  for (Index k = 0; k < n; ++k) batch.put(k, contacts[k].i, contacts[k].j, contacts[k].records, kNumber);
  batch.evaluate(n, table, kStep);
  std::vector<Packed> of_i(kSize), of_j(kSize);
  std::vector<std::array<Vec4, 2>> stored(kSize);
  for (std::size_t k = 0; k < contacts.size(); k += 4) {
    batch.loads().store(static_cast<Index>(k), {&of_i[k], &of_i[k + 1], &of_i[k + 2], &of_i[k + 3]},
                        {&of_j[k], &of_j[k + 1], &of_j[k + 2], &of_j[k + 3]});
    batch.store_records(static_cast<Index>(k),
                        {stored[k].data(), stored[k + 1].data(), stored[k + 2].data(), stored[k + 3].data()});
  }
  HistoryViews history;
  history.step = kNumber;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const auto& [i, j, records] = contacts[k];
    const PairState state = AtInstant::pair(i.p, i.u, j.p, j.u);
    const MovingPair pair{state, OverExplicitStep{kStep}.motion(state, OverExplicitStep::partner(i.p, i.spin),
                                                                OverExplicitStep::partner(j.p, j.spin))};
    const auto outcome = table.get(i.material, j.material).respond(pair, history.read<Law>(records, 0));
    bool same = same_bits(of_i[k], Packed::of(Packed::Total::of(outcome.load, outcome.losses()))) &&
                same_bits(of_j[k], Packed::of(Packed::Total::of(outcome.load.exchanged(), outcome.losses())));
    Vec4 expected[2];
    history.write<Law>(expected, 0, outcome.history);
    for (Index r = 0; r < Batch::kRecords; ++r) same = same && same_bits(stored[k][r], expected[r]);
    same = same && batch.is_mirrored(static_cast<Index>(k)) == Law::is_mirrored(outcome.history);
    CAPTURE(k, n);
    REQUIRE(same);
  }
}

}  // namespace

TEST_CASE("a batch of contacts has the bits of each contact alone") {
  std::mt19937 random(5);
  for (const Index n : {1, 7, 8, 9, 63, 64}) {
    compare(laws_with_rolling(), kMaterials, n, random);
    compare(std::vector<Rolling>{laws_with_rolling().front()}, 1, n, random);
    using Linear = ContactLaw<LinearLaw, LinearSlider>;
    compare(std::vector<Linear>{{LinearLaw(1e5, 2, false), {5e4, 0.5, 0}}}, 1, n, random);
    compare(std::vector<Linear>{{LinearLaw(1e5, 2, false), {5e4, 0.5, 0.2}}}, 1, n, random);
  }
}

}  // namespace scree
