// Instants of outlets, where they are then, and what they count.
#include "run/population/outlets.hpp"

#include "support/catch.hpp"
#include "support/decks.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kDeck = R"(
[space]
dimension = 3
min = [0, 0, 0]
max = [1, 1, 1]
[time]
end = 1.0
step = 1e-3
[[contact.pairs]]
stiffness = 1e4
[[bodies]]
name = "gate"
kind = "spatial"
position = [0.5, 0.5, 0.5]
solids = [{ kind = "sphere", radius = 0.05, density = 1000 }]
[[outlets]]
name = "first"
kind = "box"
min = [0, 0, 0]
max = [1, 1, 0.1]
interval = 0.1
start = 0.2
end = 0.6
[[outlets]]
name = "second"
kind = "sphere"
on = "gate"
center = [0.5, 0.5, 0.8]
region_radius = 0.1
interval = 0.25
)";

EscapedParticle removed_by(int outlet, Real mass) {
  EscapedParticle out{};
  out.outlet = outlet, out.mass = mass;
  return out;
}

}  // namespace

TEST_CASE("outlets are open at their instants, each of which counts once") {
  const Model model = model_of(kDeck);
  const Outlets outlets(model);
  OutletState state = outlets.start();
  const std::vector<BodyMotion> motion = {start_motion(model.bodies.front())};
  const auto open_at = [&](Real t) { return outlets.open_at(t, motion, state).numbers; };
  CHECK(outlets.next(state) <= 0);
  CHECK(open_at(0) == std::vector<int>{1});
  CHECK(near(outlets.next(state), 0.2, {.relative = 1e-8}));
  CHECK(open_at(0.19).empty());
  CHECK(open_at(0.2) == std::vector<int>{0});
  CHECK(open_at(0.25) == std::vector<int>{1});
  CHECK(open_at(0.26).empty());
  CHECK(open_at(0.55) == std::vector<int>{0, 1});  // several instants in one step are one
  CHECK(open_at(0.56).empty());
  CHECK(open_at(0.6 - 1e-12) == std::vector<int>{0});
  CHECK(open_at(0.7).empty());
  CHECK(near(outlets.next(state), 0.75, {.relative = 1e-8}));
}

TEST_CASE("an outlet moves with its body") {
  const Model model = model_of(kDeck);
  const Outlets outlets(model);
  OutletState state = outlets.start();
  std::vector<BodyMotion> motion = {start_motion(model.bodies.front())};
  motion.front().position = {0.3, 0.5, 0.5};
  const Outlets::Open open = outlets.open_at(0, motion, state);
  REQUIRE(open.regions.size() == 1);
  CHECK(open.regions.front().contains({0.3, 0.5, 0.85}));
  CHECK_FALSE(open.regions.front().contains({0.5, 0.5, 0.85}));
}

TEST_CASE("outlets count the particles and masses that they remove, in any order with the same bits") {
  const Model model = model_of(kDeck);
  const Outlets outlets(model);
  OutletState state = outlets.start(), reversed = outlets.start();
  Outlets::Open open;
  open.numbers = {1};
  outlets.account({removed_by(0, 0.1), removed_by(-1, 5), removed_by(0, 1e-9)}, open, state);
  outlets.account({removed_by(0, 1e-9)}, open, reversed);
  outlets.account({removed_by(0, 0.1)}, open, reversed);
  CHECK(state.removed == std::vector<std::int64_t>{0, 2});
  CHECK(state.removed_of_all() == 2);
  CHECK((state.mass_of(0) == 0 && near(state.mass_of(1), 0.1 + 1e-9, {.relative = 1e-15})));
  CHECK(state.mass == reversed.mass);
}

}  // namespace scree
