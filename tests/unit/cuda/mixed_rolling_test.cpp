// Explicit runs in mixed precision with rolling and twisting resistance.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>

#include "dem/backend/device.hpp"
#include "support/catch.hpp"
#include "support/colliding_spheres.hpp"
#include "support/frictional_box.hpp"
#include "support/near.hpp"
#include "support/particle_bits.hpp"
#include "unit/cuda/mixed_run.hpp"

namespace scree {
namespace {

std::unique_ptr<Backend> make_cuda(const Model& model, const Ranks& ranks) {
  return make_cuda_backend(model, ranks);
}

// Particles with all resistances in a periodic box, with some ten neighbours each.
Model rolling_crowd(Precision precision) {
  Model model =
      rolling(with_friction(dense_box(kFrictionalBoxes[2], ParticleIntegrator::velocity_verlet, 20000)));
  model.contact.skin = 0.02, model.integrator.precision = precision;
  return model;
}

using Contacts =
    std::map<std::pair<std::int64_t, std::int64_t>, std::span<const Real>>;  // by particle and key
Contacts by_key(const PackedHistory& history) {
  Contacts contacts;
  for (std::int64_t i = 0; i < history.particles(); ++i)
    for (std::int64_t k = history.offsets[as_size(i)]; k < history.offsets[as_size(i) + 1]; ++k)
      contacts[{i, history.keys[as_size(k)]}] = history.values_of(k);
  return contacts;
}

}  // namespace

TEST_CASE(
    "mixed precision: rolling and twisting resistance give the velocities, spins and losses of double") {
  for (const NormalLawParameters& law : kCollisionLaws) {
    Model model = colliding_spheres(law);
    model.integrator.precision = Precision::mixed;
    MixedTestRun mixed(model, true), exact(model, false);
    CHECK(mixed.backend->is_mixed());
    for (MixedTestRun* run : {&mixed, &exact})
      run->advance(kCollisionStep, 150), run->advance(kCollisionStep, kCollisionSteps - 150);
    const std::vector<Particle> a = mixed.backend->particles().records(),
                                b = exact.backend->particles().records();
    Real velocity = 0, spin = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      velocity = std::max(velocity, norm(a[i].velocity - b[i].velocity));
      spin = std::max(spin, norm(a[i].angular_velocity - b[i].angular_velocity));
    }
    CHECK(velocity <= 1e-4);
    CHECK(spin <= 4e-4);
    const ParticleLedger ours = mixed.backend->reports().ledger(kCollisionStep),
                         exactly = exact.backend->reports().ledger(kCollisionStep);
    CHECK(near(ours.contact_loss, exactly.contact_loss, {.relative = 1e-3}));
    for (int kind = 0; kind < kLossKinds; ++kind) {
      CAPTURE(kind);
      CHECK(exactly.rotation.losses.of[kind] > 0);
      CHECK(near(ours.rotation.losses.of[kind], exactly.rotation.losses.of[kind], {.relative = 1e-3}));
    }
    std::printf("exponent %g and rolling: velocities within %.1e m/s, spins within %.1e rad/s\n",
                law.effective_modulus > 0 ? 1.5 : law.exponent, velocity, spin);
  }
}

TEST_CASE("mixed precision: springs and moments of many contacts are near those of double") {
  HistoryTestBox mixed(rolling_crowd(Precision::mixed), {}, make_cuda),
      exact(rolling_crowd(Precision::full), {}, make_cuda);
  for (HistoryTestBox* box : {&mixed, &exact}) box->start(), box->take_steps(60, 1e-5);
  CHECK(mixed.backend->is_mixed());
  const State a = mixed.state(), b = exact.state();
  CHECK(a.contacts.content == HistoryContent::of_law(6));
  const Contacts ours = by_key(a.contacts), exactly = by_key(b.contacts);
  Real largest[2] = {}, scale[2] = {};  // of springs and moments
  // Contacts of one run alone, which open or close at another step.
  std::size_t missing = 0;
  for (const auto& [key, values] : ours) missing += exactly.contains(key) ? 0 : 1;
  for (const auto& [key, values] : exactly) {
    const auto found = ours.find(key);
    if (found == ours.end()) ++missing;
    for (std::size_t k = 0; k < 6; ++k) {
      scale[k / 3] = std::max(scale[k / 3], std::abs(values[k]));
      if (found != ours.end())
        largest[k / 3] = std::max(largest[k / 3], std::abs(found->second[k] - values[k]));
    }
  }
  CHECK(exactly.size() > 20000);
  CHECK(1000 * missing <= exactly.size());
  for (int part : {0, 1}) CHECK((scale[part] > 0 && largest[part] < 1e-3 * scale[part]));
}

TEST_CASE("mixed precision: with rolling resistance a run continues from its state, with its histories") {
  const Model model = rolling_crowd(Precision::mixed);
  HistoryTestBox onward(model, {}, make_cuda), again(model, {}, make_cuda), once_more(model, {}, make_cuda);
  onward.start(), onward.take_steps(100, 1e-5);
  const State state = onward.state();
  for (HistoryTestBox* box : {&again, &once_more}) {
    box->start(state);
    CHECK(difference(box->state().contacts, state.contacts) == "");
  }
  for (HistoryTestBox* box : {&onward, &again, &once_more}) box->take_steps(60, 1e-5);
  const State a = onward.state(), b = again.state(), c = once_more.state();
  CHECK(differing_fields(b.particles, c.particles) == "");
  CHECK(difference(b.contacts, c.contacts) == "");
  Real velocity = 0, spin = 0;
  for (std::size_t i = 0; i < a.particles.size(); ++i) {
    velocity = std::max(velocity, norm(a.particles[i].velocity - b.particles[i].velocity));
    spin = std::max(spin, norm(a.particles[i].angular_velocity - b.particles[i].angular_velocity));
  }
  const auto moved_on = [&](auto Particle::*member) {
    Real largest = 0;
    for (std::size_t i = 0; i < a.particles.size(); ++i)
      largest = std::max(largest, norm(a.particles[i].*member - state.particles[i].*member));
    return largest;
  };
  // Beside these changes over the same steps the differences are small.
  CHECK(velocity < 1e-2 * moved_on(&Particle::velocity));
  CHECK(spin < 1e-2 * moved_on(&Particle::angular_velocity));
}

// Without the moment at their contact the upper sphere would roll off.
TEST_CASE("mixed precision: a column that rolling resistance holds stays where it is", "[long]") {
  Model model = box_model(12, Precision::mixed);
  model.gravity = {0, 0, -1};
  model.walls = {{"floor", {0, 0, 0}, {0, 0, 1}, 0}};
  model.contact.friction = {{0.5, Real(2) / 7 * 2e5, 0, 0.2}};
  model.contact.rolling = {
      {.friction = 0.3, .stiffness_factor = 2.25, .damping_ratio = 0.3, .twisting_friction = 0.3}};
  add_sphere(model, {6, 6, 0.5}, {}), add_sphere(model, {6.05, 6.02, 1.4985}, {});
  MixedTestRun run(model, true);
  run.advance(1e-4, 300000);
  const std::vector<Particle> settled = run.backend->particles().records();
  run.advance(1e-4, 1000000);
  const std::vector<Particle> after = run.backend->particles().records();
  Real moved = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    moved = std::max(moved, norm(after[i].position - settled[i].position));
  CHECK(after[1].position.z > 1.4);  // it stands
  CHECK(after[1].position.x - after[0].position.x > 0.03);
  CHECK(moved < 1e-5);  // diameters
  std::printf("column held by rolling resistance after 1e6 steps: moved by %.1e diameters\n", moved);
}

}  // namespace scree
