// Springs of friction, rolling and twisting are frame-invariant: a gas in a periodic box, with and without a
// uniform velocity; a cohesive clump at rest, in translation and in rigid rotation.
#include <map>

#include "dem/history/contact_key.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 0.05, kMass = 1, kStep = 1e-4;  // [m], [kg], [s]

struct AdhesiveLaw {
  const char* name;
  std::string law, materials;
  Real press;  // overlap at the start over the radius
};

// Laws whose history is a spring and a moment, and one with the state of JKR, too.
const std::vector<AdhesiveLaw>& adhesive_laws() {
  static const std::string rolls =
      "friction = 0.5\ntangential_damping_ratio = 0.3\nrolling_friction = 0.2\nrolling_damping_ratio = 0.3\n";
  static const std::vector<AdhesiveLaw> laws{
      {"linear", "stiffness = 1e5\nrestitution = 0.3\nattraction = 50.0\n" + rolls, "", 0.01},
      {"jkr", "restitution = 0.3\nwork_of_adhesion = 200.0\n" + rolls, hertz_materials(2e7, 0.3), 0.01}};
  return laws;
}

// A sphere and its twelve neighbours in the densest lattice, each with its own velocity and spin, so that
// the contacts slide and roll before they stick. Opposite ones have the same velocity and opposite spins:
// there is no angular momentum, and the clump comes to rest.
Model clump(const AdhesiveLaw& of) {
  GrainDeck deck{.law = of.law, .grains = {{.radius = kRadius, .mass = kMass}}, .step = kStep, .end = 10};
  deck.materials = of.materials, deck.plane = false;
  const Real place = std::sqrt(Real(2)) * kRadius * (1 - of.press / 2);
  for (int axis = 0; axis < 3; ++axis)
    for (const Real u : {-1, 1})
      for (const Real v : {-1, 1}) {
        const Real a[3] = {axis == 0 ? 0 : u, axis == 0 ? u : axis == 1 ? 0 : v, axis == 2 ? 0 : v};
        const Real k = 2 * axis + (u == v);  // of the two opposite ones
        deck.grains.push_back({.position = place * Vec3{a[0], a[1], a[2]},
                               .velocity = 0.1 * Vec3{std::sin(k), std::cos(2 * k), std::sin(3 * k)},
                               .spin = 4 * u * Vec3{std::cos(k), std::sin(2 * k), std::cos(3 * k)},
                               .radius = kRadius,
                               .mass = kMass});
      }
  return deck.model();
}

// Contact histories, in 3D two vectors each.
struct Springs {
  std::vector<std::int64_t> keys;
  std::vector<Vec3> forces, moments;

  explicit Springs(const State& state) : keys(state.contacts.keys) {
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const std::span<const Real> of = state.contacts.values_of(static_cast<std::int64_t>(k));
      forces.push_back({of[0], of[1], of[2]}), moments.push_back({of[3], of[4], of[5]});
    }
  }
};

Real largest(const std::vector<Vec3>& of) {
  Real out = 0;
  for (const Vec3 a : of) out = std::max(out, norm(a));
  return out;
}

// Springs rotated back.
Springs turned_back(Springs now, const Quaternion& turn) {
  const Quaternion back{turn.w, -turn.x, -turn.y, -turn.z};
  for (std::vector<Vec3>* all : {&now.forces, &now.moments})
    for (Vec3& one : *all) one = rotated(back, one);
  return now;
}

// Change relative to the largest spring.
Real change(const Springs& now, const Springs& before) {
  REQUIRE(now.keys == before.keys);
  const auto of = [&](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    Real out = 0;
    for (std::size_t k = 0; k < a.size(); ++k) out = std::max(out, norm(a[k] - b[k]));
    return out / largest(b);
  };
  return std::max(of(now.forces, before.forces), of(now.moments, before.moments));
}

Quaternion turn_by(Vec3 omega, Real t) {
  const Real angle = norm(omega) * t / 2, s = std::sin(angle) / norm(omega);
  return {std::cos(angle), s * omega.x, s * omega.y, s * omega.z};
}

// The clump at rest with its residual springs, about its centre, without its mean velocity.
State settled(const Model& model) {
  SimulationRun run(model);
  run.run_until(1);
  State state = run.complete_state();
  Vec3 centre{}, drift{};
  for (const Particle& p : state.particles)
    centre += (1.0 / 13) * p.position, drift += (1.0 / 13) * p.velocity;
  for (Particle& p : state.particles) p.position -= centre, p.velocity -= drift;
  return state;
}

// The state with the velocities of a rigid rotation about the origin plus a translation.
State moving(State state, Vec3 velocity, Vec3 omega) {
  for (Particle& p : state.particles)
    p.velocity += velocity + cross(omega, p.position), p.angular_velocity += omega;
  return state;
}

// Spheres with friction in an open domain. flight: velocity of all of them [m/s].
Model gas(Vec3 uniform_velocity, const std::vector<std::string>& settings) {
  std::string sides;
  for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    sides += fmt::format("{} = \"periodic\"\n", side);
  Model model = model_of("[space]\ndimension = 3\nmin = [0.0, 0.0, 0.0]\nmax = [0.5, 0.5, 0.5]\n" + sides +
                             R"(
[time]
end = 0.02
step = 2e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
damping = 10.0
friction = 0.4
tangential_damping_ratio = 0.1
[[particles]]
name = "gas"
kind = "random"
count = 250
min = [0.0, 0.0, 0.0]
max = [0.5, 0.5, 0.5]
radius = 0.03
mass = 0.3
random_velocity = 2.0
angular_velocity = [30.0, -20.0, 10.0]
seed = 5
)",
                         settings);
  for (Vec3& v : model.particles.velocity) v += uniform_velocity;
  return model;
}

// Springs by particle and partner; the partner's image depends on the frame.
std::map<std::pair<GlobalId, GlobalId>, Vec3> springs_by_pair(const State& state) {
  std::map<std::pair<GlobalId, GlobalId>, Vec3> out;
  const PackedHistory& contacts = state.contacts;
  for (std::int64_t i = 0; i < contacts.particles(); ++i)
    for (std::int64_t k = contacts.offsets[static_cast<std::size_t>(i)];
         k < contacts.offsets[static_cast<std::size_t>(i) + 1]; ++k) {
      const std::span<const Real> of = contacts.values_of(k);
      out[{state.particles[static_cast<std::size_t>(i)].global_id,
           id_of(contacts.keys[static_cast<std::size_t>(k)])}] = {of[0], of[1], of[2]};
    }
  return out;
}

}  // namespace

// Only round-off distinguishes the two, until collisions amplify it.
TEST_CASE("the springs of a gas in a periodic box are the same under a uniform velocity") {
  for (const std::vector<std::string>& method : {std::vector<std::string>{}, implicit_steps(0)}) {
    CAPTURE(method.empty());
    SimulationRun resting(gas({}, method)), translating(gas({7, -5, 3}, method));
    for (SimulationRun* run : {&resting, &translating}) run->run();
    const auto before = springs_by_pair(resting.complete_state()),
               after = springs_by_pair(translating.complete_state());
    REQUIRE(before.size() > 20);
    REQUIRE(after.size() == before.size());
    Real scale = 0, error = 0;
    for (const auto& [pair, spring] : before) {
      REQUIRE(after.count(pair) == 1);
      scale = std::max(scale, norm(spring)), error = std::max(error, norm(after.at(pair) - spring));
    }
    CHECK(scale > 1);  // [N]
    CHECK(keeps(error / scale, {.promise = 1e-7, .measured = 2.4e-9}));
  }
}

TEST_CASE("a translating clump keeps its springs as a static one does") {
  for (const AdhesiveLaw& law : adhesive_laws()) {
    CAPTURE(law.name);
    const Model model = clump(law);
    const State start = settled(model);
    REQUIRE(largest(Springs(start).forces) > 1);  // [N]
    SimulationRun translating(model, moving(start, {0.3, -0.2, 0.1}, {}));
    translating.run_until(2);
    CAPTURE(largest(Springs(start).forces), largest(Springs(start).moments), start.contacts.keys.size());
    CHECK(keeps(change(Springs(translating.complete_state()), Springs(start)),
                {.promise = 1e-6, .measured = 1e-9}));
  }
}

// Held together against m omega^2 r: the springs change by that load, four times as much at twice the rate;
// the remainder is the order of the method. Springs that are not rotated would be wrong by more than their
// own length.
TEST_CASE("a clump that rotates rigidly rotates its springs with it") {
  const Vec3 axis = (1 / std::sqrt(Real(14))) * Vec3{1, -2, 3};
  for (const AdhesiveLaw& law : adhesive_laws()) {
    CAPTURE(law.name);
    const Model model = clump(law);
    const State start = settled(model);
    const Springs before(start);
    std::vector<Springs> after;
    for (const Real rate : {1, 2}) {
      const Real angle = 2.5;
      SimulationRun run(model, moving(start, {}, rate * axis));
      run.run_until(start.clock.time + angle / rate);
      const Quaternion turn = turn_by(rate * axis, run.time() - start.clock.time);
      const Springs now(run.complete_state());
      CHECK(change(now, before) > 1);
      after.push_back(turned_back(now, turn));
      for (const Particle& p : run.particles()) {
        const auto k = static_cast<std::size_t>(p.global_id);
        CHECK(near(p.position, rotated(turn, start.particles[k].position), {.absolute = 1e-3 * kRadius}));
      }
    }
    const Real slow = change(after[0], before), fast = change(after[1], before);
    Springs unloaded = after[0];
    for (std::size_t k = 0; k < unloaded.keys.size(); ++k) {
      unloaded.forces[k] = Real(1) / 3 * (4 * after[0].forces[k] - after[1].forces[k]);
      unloaded.moments[k] = Real(1) / 3 * (4 * after[0].moments[k] - after[1].moments[k]);
    }
    CAPTURE(slow, fast, change(unloaded, before));
    CHECK(keeps(slow, {.promise = 2e-2, .measured = 1.1e-2}));
    CHECK((fast / slow > 3.9 && fast / slow < 4.1));
    CHECK(keeps(change(unloaded, before), {.promise = 1e-3, .measured = 2.6e-4}));
  }
}

}  // namespace scree
