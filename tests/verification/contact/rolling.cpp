// Rolling and twisting resistance of a sphere on a plane.
#include <algorithm>

#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/hertz_impacts.hpp"
#include "verification/contact/on_plane.hpp"

namespace scree {

namespace {

using Rolling = ContactLaw<LinearLaw, LinearSlider, RollingAndTwisting<ElasticPlasticRolling>>;

// Cases epsd_a and epsd_b, which differ in the dashpot.
struct EpsdCase {
  const char* table;
  Real damping_ratio;
};

constexpr Real kMass = 0.1, kRadius = 0.02, kSpeed = 0.3, kSlipStiffness = 8e4, kRollingFriction = 0.1;
constexpr Real kLargestMoment = kRollingFriction * kRadius * kMass * 9.81;

Errors epsd_errors(const EpsdCase& c, Real parts) {
  const ReferenceTable table(c.table);
  const Rolling law{LinearLaw(kRestStiffness, 0, false),
                    {kSlipStiffness, 0.5, 0.3},
                    {{kRollingFriction, c.damping_ratio, 2.25, 0}, {}}};
  Errors errors;
  for (const auto& rows : {std::pair<std::size_t, std::size_t>{0, 60}, {60, table.rows().size()}}) {
    const Grain grain{
        .velocity = {kSpeed, 0, 0}, .spin = {0, kSpeed / kRadius, 0}, .radius = kRadius, .mass = kMass};
    auto run =
        resting_run(law, grain, inclined_gravity(0), swing_period(2 * kMass / 7, kSlipStiffness) / parts);
    visit_rows(run, table, rows, [&](const OnPlane& at, const auto& row) {
      errors.add((at.x - row["x"]) / 0.064);  // displacement until it stops
      errors.add((at.v - row["v"]) / kSpeed);
      errors.add(kRadius * (at.w - row["w"]) / kSpeed);
      errors.add((at.held - row["Mk"]) / kLargestMoment);
      errors.add((at.moment - row["M"]) / kLargestMoment);
    });
  }
  return errors;
}

}  // namespace

TEST_CASE("rolling stops, then rocks about its spring") {
  SECTION("with a dashpot") {
    const EpsdCase c{"contact/epsd_a.csv", 0.3};
    const Errors coarse = epsd_errors(c, 50), fine = epsd_errors(c, 100);
    CHECK(keeps(coarse.worst(), {.promise = 2e-2, .measured = 5.4e-3}));
    CHECK(keeps(fine.worst(), {.promise = 1e-2, .measured = 2.7e-3}));
    CHECK(order_between(coarse, fine) > 0.9);
  }
  SECTION("without") {
    const EpsdCase c{"contact/epsd_b.csv", 0};
    const Errors coarse = epsd_errors(c, 50), fine = epsd_errors(c, 100);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 1.4e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-4, .measured = 6.6e-5}));
    CHECK(order_between(coarse, fine) > 0.9);
  }
}

TEST_CASE("a sphere held on an incline by rolling resistance comes to rest there and does not creep") {
  const ReferenceTable table("contact/incline_rest.csv");
  for (const auto& row : table.rows()) {
    const Rolling law{
        LinearLaw(row["kn"], 0, false), {row["kt"], row["mu"], 0.5}, {{row["mur"], 1, 2.25, 0}, {}}};
    const Grain grain{.radius = row["R"], .mass = row["m"]};
    const Vec3 gravity = inclined_gravity(row["deg"] * std::numbers::pi_v<Real> / 180);
    auto run = resting_run(law, grain, gravity, swing_period(2 * row["m"] / 7, row["kt"]) / 50);
    for (int k = 0; k < 20000; ++k) run.step();
    const OnPlane rest = on_plane(run, 0);
    CHECK(near(rest.x, row["x"], {.relative = 1e-12}));
    CHECK(near(rest.force, row["F"], {.relative = 1e-12}));
    CHECK(near(rest.moment, row["M"], {.relative = 1e-12}));
    for (int k = 0; k < 100000; ++k) run.step();
    CHECK(near(on_plane(run, 0).x, rest.x, {.absolute = 1e-9 * 2 * row["R"]}));
  }
}

TEST_CASE("a sphere that spins about the vertical slows down evenly, then swings") {
  const ReferenceTable table("contact/twisting.csv");
  const auto errors_at = [&](Real parts) {
    Errors errors;
    for (const auto& row : table.rows()) {
      const Material material(row, 0);  // the mass is given
      const ContactLaw<HertzLaw, MindlinSlider, RollingAndTwisting<FreeRolling, MarshallTwisting>> law{
          HertzLaw(material.hertz_modulus(), 0, false),
          {material.shear_modulus(), row["mu"], 0},
          {{}, {row["mu"]}}};
      const Real R = row["R"], period = row["period"], w0 = row["w0"], t2 = row["t2"];
      const Real steps = std::ceil(t2 / period * parts);
      PlaneRun<decltype(law)> run{
          .law = law,
          .grain = {.position = {0, 0, R - row["d"]}, .spin = {0, 0, w0}, .radius = R, .mass = row["m"]},
          .gravity = inclined_gravity(0),
          .h = t2 / steps};
      run.start();
      for (int k = 0; k < steps; ++k) {
        run.step();
        const Real t = (k + 1) * run.h;
        const Real even = row["w1"] * (t2 - t) / (t2 - row["t1"]);
        if (t > row["t1"]) errors.add((run.spin().z - even) / w0);
      }
      for (int k = 0; k * run.h < 3 * period; ++k, run.step()) {
        const Real swing = -row["w_ampl"] * std::sin(2 * std::numbers::pi_v<Real> * k * run.h / period);
        errors.add((run.spin().z - swing) / w0);
      }
    }
    return errors;
  };
  const Errors coarse = errors_at(100), fine = errors_at(200);
  CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 3.3e-4}));
  CHECK(keeps(fine.worst(), {.promise = 1e-3, .measured = 1.2e-4}));
  CHECK(order_between(coarse, fine) > 1.3);  // 2, but for where in a step sliding begins and ends
}

}  // namespace scree
