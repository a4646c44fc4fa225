// Restitution from damping and the inverse, against closed forms in 40 digits.
#include "physics/restitution.hpp"

#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "support/restitution.hpp"

namespace scree {

namespace {

constexpr Real kTable = 2e-14;  // the 15 digits of the table

}  // namespace

TEST_CASE("the damping ratio of a restitution is the exact one, with tension and with the cut") {
  const ReferenceTable table("contact/damping_from_e.csv");
  for (const auto& row : table.rows()) {
    const Real e = row["e"];
    CAPTURE(e);
    CHECK(near(damping_ratio_of(e, true), row["z_tension"], {.relative = kTable}));
    CHECK(near(damping_ratio_of(e, false), row["z_cut"], {.relative = kTable}));
    for (const bool tension : {true, false})
      CHECK(near(restitution_of(damping_ratio_of(e, tension), tension), e, {.relative = 8 * kUlp}));
    CHECK(near(contact_damping(row["z_cut"], 1, 1, 1.5), row["alpha_hertz_cut"], {.relative = kTable}));
    CHECK(near(contact_damping(row["z_cut"], 4, 9, 1), 12 * row["z_cut"], {.relative = 4 * kUlp}));
  }
}

TEST_CASE("restitution at the ends: without damping 1, critically damped and beyond") {
  for (const bool tension : {true, false}) {
    CHECK(damping_ratio_of(1, tension) == 0);
    CHECK(restitution_of(0, tension) == 1);
  }
  CHECK(restitution_of(1, true) == 0);
  CHECK(restitution_of(3, true) == 0);
  CHECK(restitution_of(1, false) == std::exp(-2.0));
  // No jump where one form of the time changes into the other.
  for (const Real beside : {1 - kUlp, 1 - 1e-9, 1 + kUlp, 1 + 1e-9})
    CHECK(near(restitution_of(beside, false), std::exp(-2.0), {.relative = 2e-9}));
  for (const Real e : {1e-12, 1e-3, 1 - 1e-12})
    CHECK(near(restitution_of(damping_ratio_of(e, false), false), e, {.relative = 32 * kUlp}));
}

}  // namespace scree
