// Grains over walls with prescribed motion and conveyors, for tests that compare explicit steps taken at once
// with steps taken one by one.
#pragma once

#include <algorithm>
#include <string>

#include "coupling/wall_motion.hpp"
#include "output/checkpoint.hpp"
#include "run/state/state.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/state_bits.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

inline constexpr Real kStep = 1e-4;
inline constexpr Index kSteps = 400;

// Layers of agitated particles, the lowest of which touch the walls. Friction: with contact history.
inline const std::string kGrains = R"(
gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [0.0, 0.0, -0.1]
max = [0.357, 0.357, 0.5]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
leaving = "remove"
[time]
end = 1.0
step = 1e-4
[integrator]
particles = "velocity-verlet"
[contact]
skin = 2e-3
[[materials]]
name = "grain"
density = 2500.0
[[contact.pairs]]
stiffness = 1e4
damping = 1.0
friction = 0.4
tangential_damping_ratio = 0.1
[[particles]]
name = "grains"
kind = "lattice"
origin = [0.015, 0.015, 0.011]
spacing = [0.021, 0.021, 0.021]
size = [16, 16, 5]
radius = 0.01
random_velocity = 0.5
material = "grain"
)";

inline const std::string kMesh = R"(
[[meshes]]
name = "floor"
kind = "rectangle"
size = [1.2, 1.2]
refine = 0.05
[[walls]]
name = "floor"
mesh = "floor"
)";
inline const std::string kShaken = R"(
motions = [
  { type = "translation", direction = [0.3, 0.0, 1.0], displacement = { kind = "sine", amplitude = 2e-3, frequency = 40.0 } },
  { type = "rotation", axis = [0.0, 1.0, 0.2], point = [0.18, 0.18, 0.0], angle = { kind = "sine", amplitude = 0.02, frequency = 30.0 } },
]
)";
inline const std::string kPlane = R"(
[[walls]]
name = "belt"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
)";
inline const std::string kBelt = "surface_velocity = [0.5, 0.1, 0.0]\n";

struct DrivenCase {
  std::string name, deck;
};
inline const DrivenCase kDrivenCases[] = {{"mesh", kGrains + kMesh + kShaken},
                                          {"plane", kGrains + kPlane + kShaken},
                                          {"conveyor", kGrains + kPlane + kBelt},
                                          {"conveyor and mesh", kGrains + kPlane + kBelt + kMesh + kShaken}};

// A particle reaches the open upper side in about the 200th step.
inline Model escaping_model(int substeps) {
  Model model = model_of(kGrains + kMesh + kShaken);
  model.integrator.substeps = substeps;
  model.particles.position.back() = {0.1, 0.1, 0.48};
  model.particles.velocity.back() = {0, 0, 1};
  return model;
}

// The list expires by the motion of the wall, which may move by 3 mm, more often than by that of the grains.
inline Model fast_wall_model() {
  return model_of(kGrains + kMesh + R"(
motions = [
  { type = "translation", direction = [1.0, 0.0, 0.0], displacement = { kind = "ramp", rate = 2.0 } },
]
)");
}

// State and wrenches after explicit steps, the latter of every step.
struct DrivenOutcome {
  Checkpoint state;
  std::vector<BodyWrench> wrenches;
  Index closed = 0;
  std::int64_t builds = 0;
};

// Motion of all walls at the ends of the steps, [step][wall].
inline std::vector<BodyMotion> motion_ahead(const Model& model) {
  const WallMotions walls(model);
  std::vector<BodyMotion> motion(as_size(kSteps) * walls.size());
  for (Index k = 0; k < kSteps; ++k)
    walls.at(kStep * (k + 1), std::span(motion).subspan(as_size(k) * walls.size(), walls.size()));
  return motion;
}

// Takes the steps, `at_once` of them per call, up to one after which a particle is outside; 0: one by one
// without a table.
inline DrivenOutcome driven_steps(const Model& model,
                                  std::unique_ptr<Backend> (*make)(const Model&, const Ranks&),
                                  Index at_once) {
  LoadedBox box(model, model.contact.skin, make);
  DrivenOutcome out;
  {
    const std::vector<BodyMotion> motion = motion_ahead(model);
    const std::size_t walls = box.motion.size();
    const std::unique_ptr<ExplicitRun> run = box.backend->start_run(kStep);
    std::vector<BodyWrench> wrenches(walls);
    std::vector<std::int64_t> contacts;
    for (bool open = true; open;) {
      const Index most = std::min(std::max<Index>(at_once, 1), kSteps - out.closed);
      const bool more = out.closed + most < kSteps;
      const auto ahead = std::span(motion).subspan(as_size(out.closed) * walls, as_size(most) * walls);
      StepsTaken taken;
      if (at_once > 0) {
        taken = run->take_driven_steps(ahead, more, wrenches, box.timers);
      } else {
        box.backend->list().set_body_motion(ahead);
        taken = run->take_steps(1, more, box.timers);
        run->reduce_wrench(wrenches, contacts);
      }
      CHECK(wrenches.size() == as_size(taken.closed) * walls);
      out.closed += taken.closed, open = taken.open;
      out.wrenches.insert(out.wrenches.end(), wrenches.begin(), wrenches.end());
    }
  }
  out.builds = box.backend->list().builds();
  State state;
  state.particles = box.backend->particles().records();
  state.contacts = box.backend->particles().contacts();
  state.works = box.backend->particles().works();
  out.state = with_rows_as_arrays(pack(state));
  return out;
}

inline void check_same(const DrivenOutcome& a, const DrivenOutcome& b) {
  CHECK(differing_arrays(a.state, b.state) == "");
  CHECK(same_bits(a.wrenches, b.wrenches));
  CHECK(a.closed == b.closed);
}

inline bool any_force(const DrivenOutcome& of) {
  return std::ranges::any_of(of.wrenches, [](const BodyWrench& w) { return !(w.force == Vec3{}); });
}

// Numbers of steps per call: fewer than the table's rows, and more.
inline constexpr Index kAtOnce[] = {1, 7, 50, kSteps};

}  // namespace scree
