// Oblique impacts on a plane, against event-located solutions of each law.
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/hertz_impacts.hpp"

namespace scree {

namespace {

// All phases of a step in which a contact can begin are equally likely.
constexpr Real kPhases[] = {0, 0.2, 0.4, 0.6, 0.8};
// Smallest order with a dashpot that grows with the fourth root of the overlap: 5/4, less some scatter.
// Without it the laws are of second order.
constexpr Real kRootDashpot = 1.15;

template <class Impact, class Which>
Errors rebound_errors(const ReferenceTable& table, Real parts, const Which& which) {
  Errors errors;
  for (const auto& row : table.rows())
    if (which(row))
      for (const Real phase : kPhases) errors.add(rebound_error(Impact(row), parts, phase));
  return errors;
}

}  // namespace

TEST_CASE("oblique impacts with a linear spring and slider") {
  const ReferenceTable table("contact/oblique_linear.csv");
  const auto at = [&](Real parts, bool damped) {
    return rebound_errors<LinearImpact>(table, parts,
                                        [&](const auto& row) { return (row["e"] < 1) == damped; });
  };
  SECTION("without damping: of second order, with every change between sticking and sliding") {
    const Errors coarse = at(100, false), fine = at(200, false);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 1.7e-4}));
    CHECK(keeps(fine.worst(), {.promise = 3e-4, .measured = 3.8e-5}));
    CHECK(order_between(coarse, fine) > 1.8);
  }
  SECTION("with a normal dashpot, whose force jumps at touch: of first order") {
    const Errors coarse = at(100, true), fine = at(200, true);
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 3.5e-3}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 1.8e-3}));
    CHECK(order_between(coarse, fine) > 0.9);
  }
}

TEST_CASE("oblique impacts after Hertz and Mindlin, the spring weakening as the contact shrinks") {
  const auto rescale = [](const auto& row) { return row.word("unload") == "rescale"; };
  SECTION("at all angles, three materials") {
    const ReferenceTable table("contact/oblique_mindlin.csv");
    const Errors coarse = rebound_errors<MindlinImpact>(table, 100, rescale),
                 fine = rebound_errors<MindlinImpact>(table, 200, rescale);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 4.9e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-4, .measured = 2.3e-4}));
    CHECK(order_between(coarse, fine) > kRootDashpot);
  }
  SECTION("Chung and Ooi, test 4: at all angles") {
    const ReferenceTable table("contact/chung_ooi_4.csv");
    const Errors coarse = rebound_errors<AngleImpact>(table, 100, rescale),
                 fine = rebound_errors<AngleImpact>(table, 200, rescale);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 6.1e-5}));
    CHECK(keeps(fine.worst(), {.promise = 5e-4, .measured = 2.6e-5}));
    CHECK(order_between(coarse, fine) > kRootDashpot);
  }
  SECTION("Chung and Ooi, test 5: at all tangential velocities, undamped") {
    const ReferenceTable table("contact/chung_ooi_5.csv");
    const Errors coarse = rebound_errors<RecoilImpact>(table, 100, rescale),
                 fine = rebound_errors<RecoilImpact>(table, 200, rescale);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 1.8e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-4, .measured = 4.3e-5}));
    CHECK(order_between(coarse, fine) > 1.8);
  }
  SECTION("Chung and Ooi, test 6: with spin alone") {
    const ReferenceTable table("contact/chung_ooi_6.csv");
    const Errors coarse = rebound_errors<SpinImpact>(table, 100, rescale),
                 fine = rebound_errors<SpinImpact>(table, 200, rescale);
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 1.5e-3}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 6.1e-4}));
    CHECK(order_between(coarse, fine) > kRootDashpot);
  }
}

}  // namespace scree
