// Head-on impacts: restitution, largest overlap and force, duration, of every law whose restitution is
// independent of speed.
#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/hertz_impacts.hpp"
#include "verification/contact/pair_impacts.hpp"

namespace scree {

namespace {

constexpr Real kOneStep = 1 + 1e-9;  // error of a time that is counted in steps

// Errors of the rebound's speed, over the approach's; of the others, relative.
struct HeadOnErrors {
  Errors rebound, overlap, force, time;
};

struct Known {
  Real restitution, overlap, force, time;
};

// overlap(): of the run, which starts at touch.
template <class Run, class Overlap, class Rate>
void add_head_on(Run& run, const Known& known, int limit, const Overlap& overlap, const Rate& rate,
                 HeadOnErrors& errors) {
  const Real speed = rate();
  Real largest = 0, force = 0;
  int acting = 0;  // steps in which the force acts
  for (int k = 1; k <= limit && (k < 3 || run.closed); ++k) {
    run.step();
    acting += norm(run.outcome.load.force) > 0;
    largest = std::max(largest, overlap()), force = std::max(force, norm(run.outcome.load.force));
  }
  CHECK_FALSE(run.closed);
  errors.rebound.add(-rate() / speed - known.restitution);
  errors.overlap.add(largest / known.overlap - 1);
  errors.force.add(force / known.force - 1);
  errors.time.add(acting * run.h / known.time - 1);
}

// On a plane a sphere of mass m* and radius R* has the relative motion of two spheres.
template <class Normal>
void add_on_plane(const Normal& law, const Grain& grain, const Known& known, Real parts,
                  HeadOnErrors& errors) {
  PlaneRun<ContactLaw<Normal, LinearSlider>> run{
      .law = {law, {1, 0, 0}}, .grain = grain, .h = known.time / parts};
  run.grain.position = {0, 0, grain.radius};
  add_head_on(
      run, known, static_cast<int>(20 * parts), [&] { return run.geometry().overlap; },
      [&] { return -run.velocity().z; }, errors);
}

}  // namespace

TEST_CASE("head-on impacts under the linear law and Hertz's, cut and with tension") {
  const ReferenceTable table("contact/normal_impact.csv");
  const auto errors_at = [&](Real parts, Real exponent, bool damped) {
    HeadOnErrors errors;
    for (const auto& row : table.rows()) {
      if (row["n"] != exponent || (row["e"] < 1) != damped) continue;
      const bool tension = row.word("variant") == "tension";
      const Known known{row["e"], row["d_max"], row["F_max"], row["force_time"]};
      const Grain grain{.velocity = {0, 0, -row["v"]}, .radius = 1, .mass = row["m"]};
      if (exponent == 1)
        add_on_plane(LinearLaw(row["K"], row["c"], tension), grain, known, parts, errors);
      else
        add_on_plane(HertzLaw(row["K"], std::sqrt(5.0) * row["z"], tension), grain, known, parts, errors);
    }
    return errors;
  };
  SECTION("linear, whose dashpot jumps at touch: of first order") {
    const HeadOnErrors coarse = errors_at(100, 1, true), fine = errors_at(200, 1, true);
    CHECK(keeps(fine.rebound.worst(), {.promise = 1e-2, .measured = 1.7e-3}));
    CHECK(keeps(fine.overlap.worst(), {.promise = 1e-2, .measured = 3.5e-3}));
    CHECK(keeps(fine.force.worst(), {.promise = 2e-2, .measured = 3.5e-3}));
    CHECK(fine.time.worst() <= kOneStep / 200);
    CHECK(order_between(coarse.rebound, fine.rebound) > 0.9);
  }
  SECTION("Hertz, whose dashpot grows from touch on") {
    const HeadOnErrors coarse = errors_at(100, 1.5, true), fine = errors_at(200, 1.5, true);
    CHECK(keeps(fine.rebound.worst(), {.promise = 1e-2, .measured = 7.4e-4}));
    CHECK(keeps(fine.overlap.worst(), {.promise = 1e-2, .measured = 2.1e-3}));
    CHECK(keeps(fine.force.worst(), {.promise = 1e-2, .measured = 3.0e-3}));
    CHECK(fine.time.worst() <= kOneStep / 200);
    CHECK(order_between(coarse.rebound, fine.rebound) > 1.15);
  }
  SECTION("Hertz without damping") {
    const HeadOnErrors coarse = errors_at(100, 1.5, false), fine = errors_at(200, 1.5, false);
    CHECK(keeps(fine.rebound.worst(), {.promise = 1e-4, .measured = 2.7e-8}));
    CHECK(keeps(fine.overlap.worst(), {.promise = 1e-3, .measured = 1.2e-5}));
    CHECK(keeps(fine.force.worst(), {.promise = 1e-3, .measured = 1.8e-5}));
    CHECK(fine.time.worst() <= kOneStep / 200);
    CHECK(order_between(coarse.overlap, fine.overlap) > 1.8);
  }
}

TEST_CASE("Chung and Ooi, tests 1 to 3: elastic impacts of two spheres and on a plane, and damped ones") {
  SECTION("1 and 2") {
    const ReferenceTable table("contact/chung_ooi_1_2.csv");
    const auto errors_at = [&](Real parts) {
      HeadOnErrors errors;
      for (const auto& row : table.rows()) {
        const bool pair = row["test"] == 1;
        const Real mass = sphere_mass(row["R"], row["rho"]) / (pair ? 2 : 1),
                   radius = row["R"] / (pair ? 2 : 1);
        const Grain grain{.velocity = {0, 0, -row["v"] * (pair ? 2 : 1)}, .radius = radius, .mass = mass};
        add_on_plane(HertzLaw(4 * row["E_star"] / 3, 0, false), grain,
                     {1, row["d_max"], row["F_max"], row["contact_time"]}, parts, errors);
      }
      return errors;
    };
    const HeadOnErrors coarse = errors_at(100), fine = errors_at(200);
    CHECK(keeps(fine.rebound.worst(), {.promise = 1e-4, .measured = 2.7e-8}));
    CHECK(keeps(fine.overlap.worst(), {.promise = 1e-3, .measured = 1.2e-5}));
    CHECK(keeps(fine.force.worst(), {.promise = 1e-3, .measured = 1.8e-5}));
    CHECK(fine.time.worst() <= kOneStep / 200);
    CHECK(order_between(coarse.overlap, fine.overlap) > 1.8);
  }
  SECTION("3") {
    const ReferenceTable table("contact/chung_ooi_3.csv");
    const auto errors_at = [&](Real parts) {
      HeadOnErrors errors;
      for (const auto& row : table.rows()) {
        const Material material(row);
        const bool tension = row.word("variant") == "tension";
        const Grain grain{
            .velocity = {0, 0, -row["v"]}, .radius = row["R"], .mass = sphere_mass(row["R"], row["rho"])};
        const Real ratio = damping_ratio_of(row["e_in"], tension);
        add_on_plane(HertzLaw(material.hertz_modulus(), std::sqrt(5.0) * ratio, tension), grain,
                     {row["e_out"], row["d_max"], row["F_max"], row["force_time"]}, parts, errors);
      }
      return errors;
    };
    const HeadOnErrors coarse = errors_at(100), fine = errors_at(200);
    CHECK(keeps(fine.rebound.worst(), {.promise = 1e-2, .measured = 8.7e-4}));
    CHECK(keeps(fine.overlap.worst(), {.promise = 1e-2, .measured = 2.1e-3}));
    CHECK(keeps(fine.force.worst(), {.promise = 1e-2, .measured = 3.0e-3}));
    CHECK(fine.time.worst() <= kOneStep / 200);
    CHECK(order_between(coarse.rebound, fine.rebound) > 1.15);
  }
}

}  // namespace scree
