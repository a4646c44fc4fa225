// Sums of the contacts of a surface on a GPU: a warp sums 32 of its entries, and the warp that ends last adds
// up what the others have summed. Both evaluations of a step beside bodies have the bits of the CPU's, for
// any number of entries.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/backend/device.hpp"
#include "unit/coupling/driven_box.hpp"

namespace scree {
namespace {

// Grains over a mesh and a conveyor, of which `along` x `across` touch.
Model grains(int along, int across) {
  std::string deck = kGrains + kPlane + kBelt + kMesh + kShaken;
  const std::string size = "size = [16, 16, 5]";
  deck.replace(deck.find(size), size.size(),
               "size = [" + std::to_string(along) + ", " + std::to_string(across) + ", 1]");
  return model_of(deck);
}

// Wrenches and numbers of contacts of all surfaces, one after the other.
struct Sums {
  std::vector<BodyWrench> wrenches;
  std::vector<std::int64_t> contacts;
};

// After each step, at the predicted poses and then at the corrected ones, which differ: those of the next
// step.
Sums sums_of(const Model& model, std::unique_ptr<Backend> (*make)(const Model&, const Ranks&)) {
  constexpr Index kTaken = 60;
  LoadedBox box(model, model.contact.skin, make);
  const std::vector<BodyMotion> motion = motion_ahead(model);
  const std::size_t walls = box.motion.size();
  const std::unique_ptr<ExplicitRun> run = box.backend->start_run(kStep);
  std::vector<BodyWrench> wrenches(walls);
  std::vector<std::int64_t> contacts;
  Sums all;
  const auto append = [&] {
    run->reduce_wrench(wrenches, contacts);
    all.wrenches.insert(all.wrenches.end(), wrenches.begin(), wrenches.end());
    all.contacts.insert(all.contacts.end(), contacts.begin(), contacts.end());
  };
  for (Index k = 0; k < kTaken; ++k) {
    const auto at_end = [&](Index step) { return std::span(motion).subspan(as_size(step) * walls, walls); };
    box.backend->list().set_body_motion(at_end(k));
    const bool open = run->take_steps(1, k + 1 < kTaken, box.timers).open;
    append();
    if (!open) break;
    box.backend->list().set_body_motion(at_end(k + 1));
    run->shape_contacts();
    append();
  }
  return all;
}

}  // namespace

TEST_CASE("sums of contacts with surfaces have the bits of the CPU's for any number of warps") {
  constexpr int kSizes[][2] = {{4, 2}, {8, 4}, {11, 3}, {13, 5}, {16, 16}};
  constexpr std::int64_t kEntriesOfWarp = 32;
  std::int64_t most = 0;
  for (const auto& [along, across] : kSizes) {
    CAPTURE(along, across);
    const Model model = grains(along, across);
    const Sums expected = sums_of(model, make_cpu_backend), found = sums_of(model, make_cuda_backend);
    CHECK(std::ranges::any_of(expected.wrenches, [](const BodyWrench& w) { return !(w.force == Vec3{}); }));
    CHECK(same_bits(expected.wrenches, found.wrenches));
    CHECK(expected.contacts == found.contacts);
    most = std::max(most, std::ranges::max(expected.contacts));
  }
  CHECK(most > kEntriesOfWarp);  // the sums of several warps are merged
}

}  // namespace scree
