// Chung and Ooi, tests 7 and 8: impacts of pairs of spinning spheres.
#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/hertz_impacts.hpp"
#include "verification/contact/pair_impacts.hpp"

namespace scree {

namespace {

using Law = ContactLaw<HertzLaw, MindlinSlider>;

// Test 8: impact on a resting sphere five times as large, a thousand times as dense and as stiff; in case B
// its shear modulus is not.
struct OntoLarge {
  Grain small, large;
  Law law;
  Vec3 velocity, spin;  // of the small sphere after the impact
  Real contact_time;

  explicit OntoLarge(const ReferenceTable::Row& row) {
    const Real E = row["E"], nu = row["nu"];
    small = {.velocity = {row["V"], 0, 0},
             .spin = {0, 0, row["w0"]},
             .radius = row["R1"],
             .mass = sphere_mass(row["R1"], row["rho"])};
    large = {.radius = row["R2"], .mass = sphere_mass(row["R2"], 1000 * row["rho"])};
    const PairSize size{small.radius, large.radius, small.mass, large.mass};
    const Real modulus = Real(4) / 3 / ((1 - nu * nu) / E + (1 - nu * nu) / (1000 * E));
    const Real shear = effective_shear_modulus(E, nu, row.word("case") == "A" ? 1000 * E : E, nu);
    law = {HertzLaw(modulus, std::sqrt(5.0) * damping_ratio_of(row["e"], false), false),
           {shear, row["mu"], 0}};
    contact_time = hertz_time(modulus * std::sqrt(size.effective_radius()), size.effective_mass(), row["V"]);
    velocity = vector(row, "v"), spin = vector(row, "w");
  }
};

Real error_of(const OntoLarge& impact, Real parts, Real phase) {
  PairRun<Law> run{.law = impact.law, .i = impact.small, .j = impact.large, .h = impact.contact_time / parts};
  run.i.position = {-(run.i.radius + run.j.radius) - phase * run.h * run.i.velocity.x, 0, 0};
  REQUIRE(run_impact(run, static_cast<int>(100 * parts)));
  return std::max(norm(run.i.velocity - impact.velocity), run.i.radius * norm(run.i.spin - impact.spin)) /
         norm(impact.small.velocity - impact.small.radius * cross(impact.small.spin, {1, 0, 0}));
}

}  // namespace

TEST_CASE("test 7: spins that roll on each other stay, and nothing goes sideways") {
  const ReferenceTable table("contact/chung_ooi_7.csv");
  for (const auto& row : table.rows()) {
    const Real R = row["R1"], mass = sphere_mass(R, 2700);
    PairRun<Law> run{
        .law = {HertzLaw(5e10, std::sqrt(5.0) * damping_ratio_of(0.5, false), false), {1.5e10, 0.4, 0.2}},
        .i = {.position = {R, 0, 0},
              .velocity = {-row["V"], 0, 0},
              .spin = {0, 0, row["w1"]},
              .radius = R,
              .mass = mass},
        .j = {.position = {-R, 0, 0},
              .velocity = {row["V"], 0, 0},
              .spin = {0, 0, row["w2"]},
              .radius = row["R2"],
              .mass = mass},
        .h = 5e-6};
    REQUIRE(run_impact(run, 10000));
    CHECK(run.i.velocity.x > 0.4 * row["V"]);
    CHECK((run.i.velocity.y == row["vt_after"] && run.j.velocity.y == row["vt_after"]));
    CHECK((run.i.spin == Vec3{0, 0, row["w1_after"]} && run.j.spin == Vec3{0, 0, row["w2_after"]}));
  }
}

TEST_CASE("test 8: a spinning sphere onto a large one") {
  const ReferenceTable table("contact/chung_ooi_8.csv");
  const auto errors_at = [&](Real parts) {
    Errors errors;
    for (const auto& row : table.rows())
      if (row.word("unload") == "rescale")
        for (const Real phase : {0.0, 0.25, 0.5, 0.75}) errors.add(error_of(OntoLarge(row), parts, phase));
    return errors;
  };
  const Errors coarse = errors_at(100), fine = errors_at(200);
  CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 1.5e-3}));
  CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 6.1e-4}));
  CHECK(order_between(coarse, fine) > 1.15);
}

}  // namespace scree
