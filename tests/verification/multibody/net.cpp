// Case 5.1 of Jung, Jun, Sohn (2013): the discrete HHT solution, the truth, and the static chain.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"
#include "support/reference.hpp"

using namespace scree;

namespace {

// Largest difference in x or y of bodies 4 and 5 from a reference with columns t, x4, y4, vx4, vy4, x5, y5,
// ... every 1 ms.
Real largest_error(Real hht_alpha, int steps_per_sample, const std::vector<std::vector<Real>>& reference) {
  Model model = paper_net();
  model.integrator.hht_alpha = hht_alpha;
  MultibodyRun run(model);
  Real largest = 0;
  for (const std::vector<Real>& row : reference) {
    for (const int body : {4, 5}) {
      const std::size_t column = body == 4 ? 1 : 5;
      largest =
          std::max({largest, std::abs(run.x(body) - row[column]), std::abs(run.y(body) - row[column + 1])});
    }
    if (&row != &reference.back()) run.steps(steps_per_sample, 1e-3 / steps_per_sample);
  }
  return largest;
}

}  // namespace

TEST_CASE("the net follows the discrete HHT solution") {
  CHECK(measured("net/discrete", "m",
                 keeps(largest_error(0, 1, reference_rows("hht51_h1e-3_alpha_0.csv")),
                       {.promise = 1e-10, .measured = 3e-14})));
  CHECK(measured("net/discrete", "m",
                 keeps(largest_error(-0.3, 1, reference_rows("hht51_h1e-3_alpha_m030.csv")),
                       {.promise = 1e-10, .measured = 5e-14})));
}

TEST_CASE("the net's error against the truth is the method's, and of second order") {
  const auto truth = reference_rows("chain51_bodies4_5.csv");
  constexpr Real kDigits = 1e-7;  // [m]
  // alpha and the error of two independent implementations at h = 1e-3 [m], known to four digits.
  const std::array<std::array<Real, 2>, 6> known = {{{0, 1.691e-4},
                                                     {-0.05, 1.931e-4},
                                                     {-0.1, 2.131e-4},
                                                     {-0.2, 2.416e-4},
                                                     {-0.3, 2.545e-4},
                                                     {-1.0 / 3, 2.554e-4}}};
  for (const auto& [hht_alpha, error] : known) {
    const Real coarse = largest_error(hht_alpha, 1, truth), fine = largest_error(hht_alpha, 2, truth);
    const Real order = std::log2(coarse / fine);
    CAPTURE(hht_alpha, coarse, fine, order);
    CHECK(measured("net/error", "m", near(coarse, error, {.absolute = kDigits})));
    CHECK(measured("net/order", "", in_range(order, 1.98, 2.02)));
  }
}

TEST_CASE("the net comes to rest in the static shape") {
  // The springs' own dampers hardly slow the oscillations. Dampers to far points of the ground do, and exert
  // nothing on a static chain.
  Model model = paper_net();
  for (int body = 1; body < 19; ++body) {
    for (const Vec3 far : {Vec3{100, -0.6, 0}, Vec3{0, 100, 0}}) {
      SpringDamper damper;
      damper.name = "far." + std::to_string(model.spring_dampers.size());
      damper.body[1] = body;
      damper.point[0] = far;
      damper.damping = 10;
      model.spring_dampers.push_back(damper);
    }
  }
  MultibodyRun run(model);
  run.steps(4000, 5e-3);
  for (const std::vector<Real>& row : reference_rows("chain_static.csv")) {
    const int body = static_cast<int>(row[0]);
    CAPTURE(body);
    CHECK(measured("net/rest", "m", keeps(run.x(body) - row[1], {.promise = 1e-8, .measured = 1e-15})));
    CHECK(measured("net/rest", "m", keeps(run.y(body) - row[2], {.promise = 1e-8, .measured = 1e-15})));
  }
  CHECK(measured("net/rest", "m",
                 keeps(-0.6 - run.y(9) - 0.1830828390810137, {.promise = 1e-8, .measured = 1e-15})));
  const auto reactions = run.multibody.reactions(run.state, run.time);
  REQUIRE(reactions.size() == 2);
  constexpr Real kPull = 238.226060665;  // [N]
  CHECK(reactions[0].joint == "pin.0");
  CHECK(measured("net/pull", "",
                 keeps(reactions[0].force.x / kPull + 1, {.promise = 1e-8, .measured = 2e-14})));
  CHECK(measured("net/pull", "",
                 keeps(reactions[1].force.x / kPull - 1, {.promise = 1e-8, .measured = 4e-15})));
  // Each pin carries half of the weight.
  CHECK(keeps((reactions[0].force.y - 10 * kGravity) / kPull, {.promise = 1e-8, .measured = 1e-15}));
}
