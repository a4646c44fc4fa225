// Head-on impacts of surfaces with cohesion.
#include "physics/cohesion.hpp"

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/leapfrog.hpp"

namespace scree {

namespace {

// A sphere of radius R* and mass m* on a plane has the relative motion of two spheres.
template <class Normal>
PlaneRun<ContactLaw<Normal>> head_on(const Normal& law, const ReferenceTable::Row& row, Real h) {
  const Real R = row["R_star"];
  return {.law = {law},
          .grain = {.position = {0, 0, R + 0.5 * row["v"] * h},
                    .velocity = {0, 0, -row["v"]},
                    .radius = R,
                    .mass = row["m_star"]},
          .h = h};
}

// Approximate duration of the impact without cohesion.
Real impact_time(const ReferenceTable::Row& row) { return 3 * row["d_max"] / row["v"]; }

struct JkrErrors {
  Errors energy, overlap, force;  // of the rebound, relative to the impact; largest overlap, and force there
  Errors balance;                 // relative to the impact's energy
};

void add_jkr(const ReferenceTable::Row& row, Real parts, JkrErrors& errors) {
  const Real v = row["v"];
  const JkrLaw law{4 * row["E_star"] / 3, std::sqrt(5.0) * row["z"], row["w"]};
  auto run = head_on(law, row, impact_time(row) / parts);
  Real largest = 0, force = 0;
  bool met = false;
  for (int k = 0; k < 40 * parts && !(met && !run.closed); ++k) {
    run.step();
    met = met || run.closed;
    const Real d = run.geometry().overlap;
    if (d > largest) largest = d, force = run.law.normal.of_pair(run.pair().size).elastic(d);
  }
  const Real rebound = run.closed ? 0 : run.grain.velocity.z / v;
  CHECK(run.closed == (row["e"] == 0));
  const Real start = kinetic_energy(run.grain.mass, {0, 0, v}),
             end = kinetic_energy(run.grain.mass, run.velocity());
  const Real left = run.closed ? law.of_pair(run.pair().size).energy(run.geometry().overlap) : 0;
  errors.balance.add((start - end - left - run.sums.normal) / start);
  errors.energy.add(rebound * rebound - row["e"] * row["e"]);
  errors.overlap.add(largest / row["d_max"] - 1);
  errors.force.add(force / row["F_at_d_max"] - 1);
}

}  // namespace

TEST_CASE("JKR impacts: rebound and sticking") {
  const ReferenceTable table("contact/jkr_impact.csv");
  JkrErrors coarse, fine;
  for (const auto& row : table.rows()) {
    CAPTURE(row.word("set"), row["z"], row["v"]);
    add_jkr(row, 200, coarse);
    add_jkr(row, 400, fine);
  }
  CHECK(keeps(coarse.energy.worst(), {.promise = 2e-2, .measured = 3.1e-3}));
  CHECK(keeps(fine.energy.worst(), {.promise = 1e-2, .measured = 1.1e-3}));
  CHECK(keeps(fine.overlap.worst(), {.promise = 1e-4, .measured = 1.2e-5}));
  CHECK(keeps(fine.force.worst(), {.promise = 2e-4, .measured = 2.3e-5}));
  CHECK(keeps(fine.balance.worst(), {.promise = 1e-2, .measured = 1.1e-3}));
  CHECK(order_between(coarse.energy, fine.energy) > 0.9);
}

TEST_CASE("DMT attraction: nothing is dissipated where it appears and ends") {
  const ReferenceTable table("contact/dmt.csv");
  const auto errors_at = [&](Real parts) {
    JkrErrors errors;
    for (const auto& row : table.rows()) {
      const CohesiveLaw<HertzLaw> law{HertzLaw(4 * row["E_star"] / 3, 0, true), 0,
                                      2 * std::numbers::pi_v<Real> * row["w"], 0};
      auto run = head_on(law, row, impact_time(row) / parts);
      const auto pair = law.of_pair(run.pair().size);
      CHECK(near(pair.attraction, row["Fc"], {.relative = 1e-13}));
      CHECK(std::abs(pair.elastic(row["d_rest"])) <= 1e-13 * row["Fc"]);
      CHECK(near(pair.elastic(row["d_max"]), row["F_at_d_max"], {.relative = 1e-12}));
      Real largest = 0;
      for (int k = 0; k < 3 || run.closed; ++k)
        run.step(), largest = std::max(largest, run.geometry().overlap);
      errors.energy.add(run.grain.velocity.z * run.grain.velocity.z / (row["v"] * row["v"]) - 1);
      errors.overlap.add(largest / row["d_max"] - 1);
    }
    return errors;
  };
  const JkrErrors coarse = errors_at(100), fine = errors_at(200);
  CHECK(keeps(fine.energy.worst(), {.promise = 5e-2, .measured = 1.3e-2}));
  CHECK(keeps(fine.overlap.worst(), {.promise = 1e-3, .measured = 3.3e-5}));
  CHECK(order_between(coarse.overlap, fine.overlap) > 0.9);
}

}  // namespace scree
