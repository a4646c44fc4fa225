// Angles of spatial joints in checkpoints, and in those of a version that did not count revolutions.
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "unit/output/scratch.hpp"
#include "unit/run/restart_case.hpp"

namespace scree {

namespace {

// A wheel rotates at 100 rad/s.
const std::string kDeck = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 0.02
control = "fixed"
step = 1e-3
[integrator]
hht_alpha = -0.1
[[bodies]]
name = "wheel"
kind = "spatial"
position = [0.0, 0.0, 0.0]
mass = 1.0
inertia_tensor = [0.01, 0.02, 0.01, 0.0, 0.0, 0.0]
body_angular_velocity = [0.0, 100.0, 0.0]
[[joints]]
name = "axle"
type = "revolute"
bodies = ["ground", "wheel"]
axis = [0.0, 1.0, 0.0]
)";

struct Case : RestartCase {
  explicit Case(const std::vector<std::string>& overrides = {}) : RestartCase(kDeck, overrides) {}
};

}  // namespace

TEST_CASE("a restart without counted angles continues, and counts from its pose") {
  const ScratchDirectory folder;
  Case old;
  REQUIRE(old.run(folder.path()) == "");
  Checkpoint checkpoint = read_checkpoint(folder / "checkpoint_end.h5");
  const std::vector<Real> counted = checkpoint.reals.at("bodies/counted_angles");
  REQUIRE(counted.size() == 1);
  CHECK(counted[0] == Approx(2).epsilon(1e-12));
  checkpoint.reals.erase("bodies/counted_angles");
  write_checkpoint(folder / "old.h5", checkpoint);
  const MultibodyState read = old.read(folder / "old.h5").state.bodies;
  CHECK(read.counted_angles == 1);
  CHECK(read.position.size() == 8);
  const ScratchDirectory whole, parts;
  Case longer({"time.end=0.03"});
  REQUIRE(longer.run(whole.path()) == "");
  REQUIRE(longer.run(parts.path(), folder / "old.h5") == "");
  const auto last = [](const ScratchDirectory& results) {
    return read_checkpoint(results / "checkpoint_end.h5").reals.at("bodies/counted_angles");
  };
  CHECK(last(parts) == last(whole));
  checkpoint.reals["bodies/counted_angles"] = {1, 2};
  write_checkpoint(folder / "old.h5", checkpoint);
  CHECK(contains(old.refusal(folder / "old.h5"),
                 "/reals/bodies/counted_angles has 2 values; the deck's model has 1"));
}

}  // namespace scree
