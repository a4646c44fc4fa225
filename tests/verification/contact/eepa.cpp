// Head-on impacts by the elasto-plastic adhesion law against closed forms: rebound, sticking, pull-off, and
// the path of a contact that is loaded twice.
#include "physics/eepa.hpp"

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
PlaneRun<ContactLaw<Normal>> head_on(const NormalLawParameters& p, Real radius, Real mass, Real v, Real h) {
  return {.law = {Normal(p)},
          .grain = {.position = {0, 0, radius + 0.5 * v * h},
                    .velocity = {0, 0, -v},
                    .radius = radius,
                    .mass = mass},
          .h = h};
}

// Duration of the loading at stiffness k1, which ends at d_max, approximately.
Real loading_time(Real d_max, Real v) { return 1.5 * d_max / v; }

struct ImpactErrors {
  Errors restitution, overlap, balance;
};

// Result of an impact in steps of the 1/parts part of the loading.
struct Impact {
  Real restitution;  // 0 where the contact has not opened
  Real d_max;        // [m]
  EepaState loaded;  // after d_max
  Real balance;      // energy error over the energy of the impact
};
template <class Normal>
Impact impact(PlaneRun<ContactLaw<Normal>> run, int most) {
  const Real v = -run.grain.velocity.z, start = kinetic_energy(run.grain.mass, run.grain.velocity);
  Impact out{};
  bool met = false;
  for (int k = 0; k < most && !(met && !run.closed); ++k) {
    run.step();
    met = met || run.closed;
    const Real d = run.geometry().overlap;
    if (d > out.d_max) out.d_max = d, out.loaded = run.outcome.history.normal;
  }
  out.restitution = run.closed ? 0 : run.grain.velocity.z / v;
  const Real left = run.closed ? run.law.energy_of(run.pair(), run.outcome.history).sum : 0;
  out.balance = (start - kinetic_energy(run.grain.mass, run.velocity()) - left - run.sums.normal) / start;
  return out;
}

template <class Normal>
void add_table(const ReferenceTable& table, Real n, Real parts, ImpactErrors& errors) {
  const Real v = 0.1, mass = 1e-3, radius = 2.5e-3;
  for (const auto& row : table.rows()) {
    if (row["n"] != n) continue;
    CAPTURE(n, row["l"]);
    NormalLawParameters p;
    p.own = Plasticity(row["l"], 0);
    (n == 1 ? p.normal_stiffness : p.effective_modulus) = n == 1 ? 1e4 : 1e7;
    const Real k1 = n == 1 ? 1e4 : 4e7 / 3 * std::sqrt(radius),
               d_max = std::pow((n + 1) * mass * v * v / 2 / k1, 1 / (n + 1));
    const Impact found = impact(head_on<Normal>(p, radius, mass, v, loading_time(d_max, v) / parts),
                                40 * static_cast<int>(parts));
    errors.restitution.add(found.restitution - row["e"]);
    errors.overlap.add(found.d_max / d_max - 1), errors.balance.add(found.balance);
  }
}

}  // namespace

TEST_CASE("EEPA without adhesion: the restitution follows from the plasticity ratio alone") {
  const ReferenceTable table("contact/eepa_restitution.csv");
  ImpactErrors coarse, fine;
  add_table<EepaLaw<LinearRestitutionLaw>>(table, 1, 500, coarse);
  add_table<EepaLaw<HertzLaw>>(table, 1.5, 500, coarse);
  add_table<EepaLaw<LinearRestitutionLaw>>(table, 1, 8000, fine);
  add_table<EepaLaw<HertzLaw>>(table, 1.5, 8000, fine);
  CHECK(keeps(coarse.restitution.worst(), {.promise = 1e-5, .measured = 2.4e-6}));
  CHECK(keeps(fine.restitution.worst(), {.promise = 1e-6, .measured = 1.9e-8}));
  CHECK(keeps(fine.overlap.worst(), {.promise = 1e-6, .measured = 6.3e-10}));
  CHECK(keeps(fine.balance.worst(), {.promise = 1e-6, .measured = 6.4e-9}));
}

TEST_CASE("EEPA with adhesion: two spheres rebound or stick") {
  const ReferenceTable table("contact/eepa_impact.csv");
  ImpactErrors errors;
  for (const auto& row : table.rows()) {
    CAPTURE(row["g"], row["v"]);
    const NormalLawParameters p{.effective_modulus = row["E_star"],
                                .adhesion_work = row["g"],
                                .own = Plasticity(row["l"], row["chi"])};
    const Real h = loading_time(row["d_max"], row["v"]) / 8000;
    const Impact found =
        impact(head_on<EepaLaw<HertzLaw>>(p, row["R_star"], row["m_star"], row["v"], h), 400000);
    errors.restitution.add(found.restitution - row["e"]), errors.overlap.add(found.d_max / row["d_max"] - 1);
    CHECK(near(found.loaded.pull_overlap, row["d_min"], {.relative = 1e-6}));
    CHECK(near(found.loaded.adhesion, row["k_ad"], {.relative = 1e-6}));
    errors.balance.add(found.balance);
  }
  CHECK(keeps(errors.restitution.worst(), {.promise = 1e-6, .measured = 9.3e-9}));
  CHECK(keeps(errors.overlap.worst(), {.promise = 1e-6, .measured = 6.3e-10}));
  CHECK(keeps(errors.balance.worst(), {.promise = 1e-6, .measured = 5.8e-9}));
}

TEST_CASE("EEPA: the pull-off force after a preload") {
  const ReferenceTable table("contact/eepa_impact.csv");
  for (const auto& row : table.rows()) {
    CAPTURE(row["g"], row["v"]);
    const EepaLaw<HertzLaw> law({.effective_modulus = row["E_star"],
                                 .adhesion_work = row["g"],
                                 .own = Plasticity(row["l"], row["chi"])});
    const PairSize size{row["R_star"], kInfinity, row["m_star"], kInfinity};
    const auto pair = law.of_pair(size);
    EepaState state = pair.after({}, row["d_max"]).state;
    Real least = 0;
    constexpr int kParts = 100000;
    for (int k = kParts - 1; k > 0; --k) {
      const Real d = row["d_max"] * k / kParts;
      const auto at = pair.after(state, d);
      least = std::min(least, at.elastic(d)), state = at.state;
    }
    CHECK(near(-least, row["f_min"], {.relative = 1e-4}));
  }
}

}  // namespace scree
