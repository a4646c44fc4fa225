// The rotational parts of the ledger, computed independently from the particles' positions, spins and
// contact histories.
#include <fmt/format.h>

#include "dem/history/contact_key.hpp"
#include "physics/energy.hpp"
#include "physics/spring_slider.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

constexpr Real kNormal = 2e5, kTangential = 6e4, kRolling = 0.5;  // [N/m], [N/m], [N m]
constexpr Real kHalf = 0.15;                                      // of the box [m]

const std::string kFrictionKeys = fmt::format(
    "friction = 0.4\ntangential_stiffness = {}\nrolling_friction = 0.2\nrolling_stiffness = {}\n"
    "twisting_friction = 0.0\n",
    kTangential, kRolling);
const std::string kSpinKeys = "angular_velocity = [30.0, -20.0, 10.0]\n";

// Spheres between walls; friction_keys, spins: keys of the pair and of the particles.
Model box(const std::string& friction_keys, const std::string& spins,
          const std::vector<std::string>& settings = {}) {
  return model_of(fmt::format(R"(
[space]
dimension = 3
min = [-{half}, -{half}, -{half}]
max = [{half}, {half}, {half}]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[time]
end = 0.02
step = 2e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = {normal}
{friction_keys}
[[particles]]
name = "box"
kind = "random"
count = 80
min = [-{half}, -{half}, -{half}]
max = [{half}, {half}, {half}]
radius = {{ kind = "uniform", min = 0.02, max = 0.03 }}
density = 2500.0
random_velocity = 2.0
seed = 11
{spins}
)",
                              fmt::arg("half", kHalf), fmt::arg("normal", kNormal),
                              fmt::arg("friction_keys", friction_keys), fmt::arg("spins", spins)),
                  settings);
}

struct Parts {
  Real translation = 0, rotation = 0;          // kinetic [J]
  Real normal = 0, friction = 0, rolling = 0;  // elastic [J]
};

Real elastic(Real overlap) { return overlap > 0 ? kNormal / 2 * overlap * overlap : 0; }

Real wall_energy(const Particle& p) {
  Real sum = 0;
  for (const Real x : {p.position.x, p.position.y, p.position.z})
    sum += elastic(x - (kHalf - p.radius)) + elastic(-x - (kHalf - p.radius));
  return sum;
}

// contacts: those of the particles, with two entries for each pair of particles.
Parts parts_of(const std::vector<Particle>& particles, const PackedHistory& contacts) {
  Parts sum;
  for (const Particle& p : particles) {
    sum.translation += kinetic_energy(p.mass, p.velocity);
    sum.rotation += rotational_energy(p.moment_of_inertia, p.angular_velocity);
    sum.normal += wall_energy(p);
    for (const Particle& q : particles)
      if (q.global_id > p.global_id)
        sum.normal += elastic(p.radius + q.radius - norm(p.position - q.position));
  }
  for (std::size_t k = 0; k < contacts.keys.size(); ++k) {
    const Real share = is_surface(contacts.keys[k]) ? 1 : 0.5;
    const std::span<const Real> of = contacts.values_of(static_cast<std::int64_t>(k));
    sum.friction += share * spring_energy({of[0], of[1], of[2]}, kTangential);
    sum.rolling += share * spring_energy({of[3], of[4], of[5]}, kRolling);
  }
  return sum;
}

// Orbital angular momentum of the particles about the origin [kg m^2/s].
Vec3 orbital(const std::vector<Particle>& particles) {
  Vec3 sum;
  for (const Particle& p : particles) sum += p.mass * cross(p.position, p.velocity);
  return sum;
}

}  // namespace

TEST_CASE("the ledger's parts of rotation and springs are those counted one by one, and add up") {
  SimulationRun run(box(kFrictionKeys, kSpinKeys));
  Parts largest;
  for (int part = 0; part < 40; ++part) {
    for (int step = 0; step < 20; ++step) run.step();
    const ParticleLedger ledger = run.particle_ledger();
    const Parts by_hand = parts_of(run.particles(), run.complete_state().contacts);
    const RotationEnergies& rotation = ledger.rotation;
    CHECK(near(rotation.kinetic, by_hand.rotation, {.relative = 1e-13}));
    CHECK(near(rotation.friction_springs, by_hand.friction, {.relative = 1e-13}));
    CHECK(near(rotation.rolling_springs, by_hand.rolling, {.relative = 1e-12}));
    CHECK(near(ledger.kinetic - rotation.kinetic, by_hand.translation, {.relative = 1e-13}));
    CHECK(near(ledger.contact_elastic - rotation.friction_springs - rotation.rolling_springs, by_hand.normal,
               {.relative = 1e-12}));
    largest.rotation = std::max(largest.rotation, rotation.kinetic / ledger.kinetic);
    largest.friction = std::max(largest.friction, rotation.friction_springs / ledger.contact_elastic);
    largest.rolling = std::max(largest.rolling, rotation.rolling_springs / ledger.contact_elastic);
  }
  // Each part is significant.
  CHECK(largest.rotation > 1e-2);
  CHECK(largest.friction > 1e-2);
  CHECK(largest.rolling > 1e-3);
}

TEST_CASE("energy of frictional and rolling springs is dissipated or returned: the energies balance") {
  const auto error_at = [](const std::string& step) {
    SimulationRun run(box(kFrictionKeys, kSpinKeys, {"time.step=" + step}));
    run.run();
    CHECK(run.particle_ledger().contact_loss > 0.1 * run.exchanged());
    return std::abs(run.balance_error()) / run.exchanged();
  };
  const Real coarse = error_at("2e-5"), fine = error_at("5e-6");
  CHECK(keeps(coarse, {.promise = 1e-2, .measured = 9.1e-4}));
  CHECK(keeps(fine, {.promise = 2e-3, .measured = 8e-5}));
  CHECK(coarse > 4 * fine);
}

TEST_CASE(
    "a free collision converts orbital momentum into spins, and the ledger's angular momentum has both") {
  Grain i{.velocity = {1, 0.5, 0}, .spin = {5, -20, 30}, .radius = 0.02, .mass = 0.1};
  Grain j{.velocity = {-1, 0, 0.3}, .spin = {-10, 0, 8}, .radius = 0.03, .mass = 0.2};
  i.position = {-0.03, 0, 0}, j.position = {0.021, 0.005, 0.01};
  GrainDeck deck{
      .law = "stiffness = 1e5\ndamping = 5.0\nfriction = 0.5\n", .grains = {i, j}, .step = 1e-5, .end = 0.02};
  deck.plane = false;
  SimulationRun run(deck.model());
  const ParticleLedger start = run.particle_ledger();
  const Vec3 spins = i.inertia * i.spin + j.inertia * j.spin, before = orbital(run.particles());
  CHECK(near(start.rotation.kinetic,
             rotational_energy(i.inertia, i.spin) + rotational_energy(j.inertia, j.spin),
             {.relative = kUlp * 4}));
  CHECK(near(start.angular_momentum, before + spins, {.relative = kUlp * 8}));
  run.run();
  const ParticleLedger end = run.particle_ledger();
  CHECK(end.contacts == 0);
  CHECK(norm(orbital(run.particles()) - before) > 0.1 * norm(before));
  CHECK(near(end.angular_momentum, start.angular_momentum, {.relative = 1e-13}));
  CHECK((end.rotation.friction_springs == 0 && end.rotation.rolling_springs == 0));
}

TEST_CASE("particles that do not rotate have no energies of rotation") {
  SimulationRun run(box("", ""));
  run.run();
  const ParticleLedger ledger = run.particle_ledger();
  CHECK(ledger.contact_elastic > 0);
  CHECK(ledger.rotation == RotationEnergies{});
}

}  // namespace scree
