// Freely rotating spheres: spins are constant to the bit, and orientations follow them.
#include <array>
#include <numbers>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

constexpr Vec3 kFreeSpins[] = {{3, 0, 0}, {0, -20, 5}, {1, 2, 3}, {100, -70, 200}};
constexpr Real kEnd = 0.5;  // [s]

SimulationRun& run_of(std::unique_ptr<SimulationRun>& run, Real h) {
  GrainDeck deck{.law = "stiffness = 1e4\nfriction = 0.5\n", .grains = {}, .step = h, .end = kEnd};
  deck.plane = false, deck.gravity = {0, 0, -1};
  for (std::size_t k = 0; k < std::size(kFreeSpins); ++k)
    deck.grains.push_back({.position = {0.3 * static_cast<Real>(k), 0, 0},
                           .velocity = {0, 0.1, 0},
                           .spin = kFreeSpins[k],
                           .radius = 0.1,
                           .mass = 1});
  run = std::make_unique<SimulationRun>(deck.model());
  run->run();
  return *run;
}

// Angle between the orientation and the rotation by spin * t [rad].
Real angle_error(const Quaternion& q, Vec3 spin, Real t) {
  const Real angle = norm(spin) * t / 2, s = std::sin(angle) / norm(spin);
  const Quaternion exact{std::cos(angle), s * spin.x, s * spin.y, s * spin.z};
  return 2 * std::acos(std::min(Real(1), std::abs(dot(q, exact))));
}

}  // namespace

// A step rotates by 2 atan(h w / 2) or the like: (h w)^3 / 48 too little, of second order over a time.
TEST_CASE("free spheres keep their spins, and their orientations follow them to second order") {
  Errors errors[2];
  for (int fine = 0; fine < 2; ++fine) {
    const Real h = fine == 0 ? 2e-4 : 1e-4;
    std::unique_ptr<SimulationRun> run;
    const std::vector<Particle> after = run_of(run, h).particles();
    for (std::size_t k = 0; k < std::size(kFreeSpins); ++k) {
      CHECK((after[k].angular_velocity == kFreeSpins[k]));
      CHECK(near(dot(after[k].orientation, after[k].orientation), 1, {.absolute = 4 * kUlp}));
      const Real w = norm(kFreeSpins[k]), promised = kEnd * w * (h * w) * (h * w) / 48;
      const Real error = angle_error(after[k].orientation, kFreeSpins[k], kEnd);
      CAPTURE(k, fine, error, promised);
      CHECK(error < 1.01 * promised + 1e-7);  // acos() near 1
      if (w > 100) errors[fine].add(error);
    }
  }
  CHECK(order_between(errors[0], errors[1]) > 1.95);
}

}  // namespace scree
