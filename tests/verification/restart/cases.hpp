// Short runs that together use every part of the state.
#pragma once

#include <string>
#include <vector>

#include "support/models.hpp"
#include "support/reference.hpp"

namespace scree {

struct RestartCase {
  std::string name;
  Model model;
  bool leaves;  // particles escape
};

// Discs that collide over a floor and escape through the open sides.
inline const std::string kLeavingDiscs = R"(
gravity = [0.0, -9.8066]
[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
y_min = "wall"
[time]
end = 0.2
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
damping = 10.0
[[particles]]
name = "discs"
kind = "random"
count = 60
min = [0.0, 0.0]
max = [1.0, 1.0]
radius = { kind = "uniform", min = 0.03, max = 0.04 }
mass = 1.0
random_velocity = 2.0
seed = 5
[output]
history_interval = 3.3e-3
)";

// A disc of 1 kg with a radius of 5 cm; position, velocity: as in a deck.
inline std::string disc(const std::string& name, const std::string& position, const std::string& velocity) {
  return "[[particles]]\nname = \"" + name + "\"\nkind = \"list\"\npositions = [" + position +
         "]\nvelocity = " + velocity + "\nradius = 0.05\nmass = 1.0\n";
}

// Periodic along x, with a side that is not a multiple of a quantum.
inline const std::string kPeriodicAlongX = R"(
[output]
history_interval = 0.05
[space]
dimension = 2
min = [0.17, 0.0]
max = [1.0, 1.0]
x_min = "periodic"
x_max = "periodic"
)";

// Two discs that escape at once and continue for some 150 periods along the periodic axis, where coordinates
// have lost the quanta in which a period can be subtracted exactly; and one that continues to bounce.
inline const std::string kFarDrifters = "gravity = [0.0, -9.8066]" + kPeriodicAlongX + R"(
y_min = "wall"
leaving = "ballistic"
[time]
end = 4.0
step = 1e-3
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
damping = 10.0
)" + disc("right", "[0.3, 0.9]", "[37.0123, 3.1]") +
                                        disc("left", "[0.7, 0.95]", "[-29.0456, 5.7]") +
                                        disc("bouncing", "[0.5, 0.2]", "[1.3, 0.0]");

// A body and two discs move around the periodic axis some 80 times in permanent contact: contacts and
// energies must not depend on how many periods were subtracted from which of them, and when.
inline const std::string kRoundAndRound = "gravity = [3.3, 0.0]" + kPeriodicAlongX + R"(
y_min = "wall"
y_max = "wall"
[time]
end = 3.0
step = 1e-3
control = "fixed"
[contact]
skin = 0.3
[[contact.pairs]]
stiffness = 1e4
[[bodies]]
name = "runner"
mass = 3.0
inertia = 0.01
position = [0.51, 0.25]
velocity = [19.0, 0.3]
shapes = [{ radius = 0.05, offset = [0.02, 0.01] }]
)" + disc("discs", "[0.5, 0.06], [0.5, 0.44]", "[19.0, 1.0]");

// Discs that escape, each with its energy, after many periods along the periodic axis.
inline const std::string kLateEscapes = "gravity = [3.3, 0.0]" + kPeriodicAlongX + R"(
leaving = "remove"
[time]
end = 3.0
step = 1e-3
control = "fixed"
[contact]
skin = 0.3
[[contact.pairs]]
stiffness = 1e5
)" + disc("right", "[0.3, 0.2]", "[37.0123, 0.41]") +
                                        disc("left", "[0.7, 0.4]", "[-29.0456, 0.41]") +
                                        disc("last", "[0.5, 0.6]", "[21.3, 0.1567]");

// Bodies that roll and slide on a floor, on a plate of triangles and on each other, around the periodic
// axis: their contact histories must survive.
inline const std::string kFrictionalShapes = R"(
gravity = [1.5, -9.8066, 0.3]
[output]
history_interval = 0.01
[space]
dimension = 3
min = [0.17, 0.0, 0.0]
max = [1.0, 1.0, 0.3]
x_min = "periodic"
x_max = "periodic"
y_min = "wall"
z_max = "wall"
[time]
end = 0.3
step = 2e-4
control = "fixed"
[contact]
skin = 0.02
[[contact.pairs]]
stiffness = 2e4
restitution = 0.4
friction = 0.4
tangential_damping_ratio = 0.1
[[meshes]]
name = "plate"
kind = "box"
size = [0.3, 0.02, 0.3]
refine = 0.08
offset = [0.65, 0.01, 0.15]
[[walls]]
name = "step"
mesh = "plate"
[[bodies]]
name = "ball"
count = 3
kind = "spatial"
position = [0.25, 0.0501, 0.24]
spacing = [0.105, 0.0, -0.01]
velocity = [4.0, -0.1, 0.0]
mass = 0.5
inertia_tensor = [5e-4, 5e-4, 5e-4, 0.0, 0.0, 0.0]
shapes = [{ radius = 0.05 }]
[[bodies]]
name = "block"
kind = "spatial"
position = [0.65, 0.0595, 0.15]
velocity = [-1.0, 0.0, 0.0]
mass = 1.0
inertia_tensor = [2e-3, 2e-3, 2e-3, 0.0, 0.0, 0.0]
shapes = [{ radius = 0.02, offset = [0.04, -0.02, 0.04] }, { radius = 0.02, offset = [-0.04, -0.02, 0.04] },
          { radius = 0.02, offset = [0.04, -0.02, -0.04] }, { radius = 0.02, offset = [-0.04, -0.02, -0.04] },
          { radius = 0.03, offset = [0.0, 0.03, 0.06] }]
)";

// Crates that fall on a shaking floor and on a slope, tumble and slide around the periodic axis, among
// particles: contacts of their meshes' corners come and go.
inline const std::string kCrates = R"(
gravity = [1.5, 0.5, -9.8066]
[output]
history_interval = 0.01
[space]
dimension = 3
min = [0.17, 0.0, -0.1]
max = [1.0, 0.6, 0.8]
x_min = "periodic"
x_max = "periodic"
y_max = "wall"
[time]
end = 0.3
step = 2e-4
control = "fixed"
[contact]
skin = 0.01
[[contact.pairs]]
stiffness = 2e4
restitution = 0.4
friction = 0.4
tangential_damping_ratio = 0.1
[[meshes]]
name = "crate"
kind = "box"
size = [0.12, 0.1, 0.08]
refine = 0.05
[[walls]]
name = "floor"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
[[walls.motions]]
type = "translation"
direction = [1.0, 0.0, 0.3]
displacement = { kind = "sine", amplitude = 0.004, frequency = 12.0 }
[[walls]]
name = "slope"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 1.5]
[[bodies]]
name = "crate"
count = 3
kind = "spatial"
position = [0.25, 0.25, 0.1]
spacing = [0.25, 0.02, 0.005]
quaternion = [0.98, 0.1, 0.15, 0.08426149773176359]
velocity = [3.0, -0.2, -1.0]
body_angular_velocity = [1.0, 5.0, 2.0]
solids = [{ kind = "mesh", mesh = "crate", density = 600.0 }]
meshes = [{ mesh = "crate" }]
[[particles]]
name = "grains"
kind = "row"
count = 8
origin = [0.2, 0.4, 0.03]
spacing = [0.1, 0.0, 0.0]
radius = 0.02
mass = 0.05
)";

inline const std::vector<std::vector<std::string>> kWays = {
    {"integrator.particles=hht"},
    {"integrator.particles=hht", "integrator.hht_alpha=-0.1"},
    {"integrator.particles=hht", "time.control=adaptive"},
    {"integrator.particles=velocity-verlet", "integrator.substeps=3"}};

// Each case with each integrator and step control that it supports.
inline std::vector<RestartCase> restart_cases() {
  std::vector<RestartCase> cases;
  for (const std::vector<std::string>& way : kWays) {
    const auto with = [&](std::vector<std::string> overrides) {
      overrides.insert(overrides.end(), way.begin(), way.end());
      return overrides;
    };
    const std::string how = ", " + way.front() + (way.size() > 1 ? ", " + way[1] : "");
    cases.push_back(
        {"net and particles" + how, input_model("paper/net_9.toml", with({"time.end=0.42"})), false});
    cases.push_back({"valley" + how,
                     input_model("paper/valley.toml", with({"time.end=0.68", "time.control=fixed"})), false});
    for (const std::string policy : {"remove", "ballistic"})
      cases.push_back({policy + how, model_of(kLeavingDiscs, with({"space.leaving=" + policy})), true});
    cases.push_back({"shapes with friction" + how, model_of(kFrictionalShapes, with({})), false});
    cases.push_back({"crates" + how, model_of(kCrates, with({})), false});
    // Long runs, and so fast that the list limits adaptive steps.
    if (way == kWays.front() || way == kWays.back()) {
      cases.push_back({"far drifters" + how, model_of(kFarDrifters, with({})), true});
      cases.push_back(
          {"round and round" + how, model_of(kRoundAndRound, with({"space.max=[1.0, 0.5]"})), false});
      cases.push_back({"late escaped particles" + how, model_of(kLateEscapes, with({})), true});
    }
    cases.push_back(
        {"periodic gas" + how,
         input_model("examples/gas_periodic.toml", with({"time.end=0.02", "particles.gas.count=1000"})),
         false});
  }
  return cases;
}

}  // namespace scree
