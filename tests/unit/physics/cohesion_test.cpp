// JKR contacts against their curve, and attractive forces on top of other laws.
#include "physics/cohesion.hpp"

#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"

namespace scree {

namespace {

constexpr Real kTable = 1e-13;  // the 15 digits of the tables, less near the pull-off point
constexpr Real kRoundOff = 16 * kUlp;

JkrPair jkr_pair(const ReferenceTable::Row& row) {
  return JkrLaw{4 * row["E_star"] / 3, 0, row["w"]}.of_pair(
      {row["R_star"], kInfinity, row["m_star"], kInfinity});
}

}  // namespace

TEST_CASE("JKR: characteristic points") {
  const ReferenceTable table("contact/jkr_points.csv");
  for (const auto& row : table.rows()) {
    const JkrPair law = jkr_pair(row);
    CHECK(near(law.pull_off, row["Fc"], {.relative = kTable}));
    CHECK(near(law.interaction_range(), -row["d_sep"], {.relative = kTable}));
    CHECK(near(law.pull_off_radius, row["a_sep"], {.relative = kTable}));
    CHECK(near(law.contact_radius(0), row["a_d0"], {.relative = kTable}));
    CHECK(near(law.elastic(0), row["F_d0"], {.relative = kTable}));
    CHECK(std::abs(law.elastic(row["d_F0"])) <= kTable * row["Fc"]);
    CHECK(near(law.elastic(row["d_Fc"]), -row["Fc"], {.relative = kTable}));
    CHECK(near(law.formation_loss(), row["W_stick"], {.relative = kTable}));
    CHECK(near(law.energy(0), -law.formation_loss(), {.relative = kTable}));
    // The root of dF/dd = infinity: half the digits.
    CHECK(near(law.elastic(row["d_sep"] * (1 - 1e-15)), row["F_sep"], {.relative = 1e-6}));
    CHECK(std::abs(law.energy(row["d_sep"] * (1 - 1e-15))) <= 1e-6 * row["W_stick"]);
  }
}

TEST_CASE("JKR: contact radius, force, stiffness, energy") {
  const ReferenceTable points("contact/jkr_points.csv"), table("contact/jkr_curve.csv");
  for (const auto& row : table.rows()) {
    const auto& head = points.rows().at(row.word("set") == "a" ? 0 : 1);
    const JkrPair law = jkr_pair(head);
    const Real d = row["d"];
    if (!(d > -law.interaction_range() * (1 - 1e-12))) continue;  // the pull-off point itself: see above
    CAPTURE(row.word("set"), d);
    // Near the pull-off point the error of d grows as the root of the distance to it falls.
    const Real digits = kTable / std::min<Real>(1, std::sqrt(1 + d / law.interaction_range()));
    CHECK(near(law.contact_radius(d), row["a"], {.relative = digits}));
    CHECK(near(law.elastic(d), row["F"], {.relative = digits, .absolute = digits * law.pull_off}));
    CHECK(near(law.slope(d), row["dF_dd"],
               {.relative = 10 * digits, .absolute = digits * law.pull_off / law.interaction_range()}));
    CHECK(near(law.energy(d) - law.energy(0), row["energy"],
               {.relative = digits, .absolute = digits * head["W_stick"]}));
  }
}

TEST_CASE("JKR: the contact forms at touch and persists under tension until it breaks") {
  const ContactLaw<JkrLaw> law{{1e7, 0, 0.05}};
  static_assert(decltype(law)::kHistory == 1);
  const PairSize size{1e-4, kInfinity, 2e-9, kInfinity};
  const Real reach = interaction_range_of(law.normal.of_pair(size));
  CHECK(reach > 0);
  const auto at = [&](Real overlap, bool touched) {
    const ContactGeometry geometry{overlap, size.radius_i - overlap, {0, 0, 1}, 1};
    const ContactMotion rest = face_motion(geometry, {0, 0, 1}, {}, {{}, size.radius_i, 1}, {}, 1);
    return law.respond({{geometry, {}, size}, rest}, {{}, {}, touched});
  };
  CHECK(at(-0.1 * reach, false).load.force == Vec3{});
  CHECK_FALSE(at(-0.1 * reach, false).history.touched);
  CHECK(at(0.1 * reach, false).history.touched);
  const Real formation = law.normal.of_pair(size).formation_loss();  // in a step of 1 s, without rate
  CHECK(at(0.1 * reach, false).load.loss == formation);
  CHECK(at(0.1 * reach, true).load.loss == 0);
  CHECK(at(-0.1 * reach, true).load.force.z < 0);
  CHECK(at(-0.1 * reach, true).history.touched);
  CHECK(at(-1.001 * reach, true).load.force == Vec3{});
  CHECK_FALSE(at(-1.001 * reach, true).history.touched);
}

TEST_CASE("an attractive force on top of another law, with and without range") {
  const PairSize size{2, 2, 1, 1};
  const auto near_only = CohesiveLaw<LinearLaw>{LinearLaw(100, 0, true), 3, 4, 0}.of_pair(size);
  CHECK(near_only.elastic(0.5) == 100 * 0.5 - (3 + 4));
  CHECK(near_only.adhesion(0.5) == 7);
  CHECK(near_only.elastic(-1e-9) == 0);
  CHECK(near_only.energy(-1e-9) == 0);
  const auto far = CohesiveLaw<LinearLaw>{LinearLaw(100, 0, true), 3, 0, 0.2}.of_pair(size);
  CHECK(far.interaction_range() == 0.2);
  CHECK(near(far.elastic(-0.1), -1.5, {.relative = kRoundOff}));
  CHECK(far.elastic(-0.3) == 0);
  for (const Real d : {-0.15, -0.05, 0.05, 0.3}) {  // the force is the slope of the energy
    const Real step = 1e-6, slope = (far.energy(d + step) - far.energy(d - step)) / (2 * step);
    CHECK(near(far.elastic(d), slope, {.relative = 1e-8, .absolute = 1e-8}));
  }
  const ContactLaw<CohesiveLaw<LinearLaw>> law{{LinearLaw(100, 0, true), 3, 0, 0.2}};
  static_assert(decltype(law)::kHistory == 0);
  const ContactGeometry apart = sphere_pair(Vec3{0, 0, 4.1}, Real(4));
  const ContactMotion rest = sphere_motion(apart, {}, {{}, 2, 1}, {{}, 2, 1}, 1);
  CHECK(near(law.respond({{apart, {}, size}, rest}, {}).load.force.z, -1.5, {.relative = 1e-13}));
}

TEST_CASE(
    "an attractive force without history is a law of the instant, in double and single, and of implicit "
    "steps") {
  const ContactLaw<CohesiveLaw<HertzLaw>> law{{HertzLaw(100, 0.1, true), 0.5, 2, 0}};
  static_assert(!decltype(law)::kNeedsMotion);
  const PairSize size{2, 2, 1, 1};
  const PairState pair{sphere_pair(Vec3{0, 3.9, 0}, Real(4)), {0.1, -0.3, 0}, size};
  const auto load = law.respond(pair, {}).load;
  const ContactMotion rest = sphere_motion(pair.geometry, {}, {{}, 2, 1}, {{}, 2, 1}, 1);
  CHECK(load.force == law.respond({pair, rest}, {}).load.force);
  CHECK(load.loss == law.respond({pair, rest}, {}).load.loss);
  const PairStateOf<float, Vec3f> single{
      {0.1f, 3.9f, {0, 3.9f, 0}, 1 / 3.9f}, {0.1f, -0.3f, 0}, {2, 2, 1, 1}};
  CHECK(near(in_double(law.respond(single, {}).load.force), load.force, {.relative = 1e-5}));
  // Undamped, touching on a straight path: the impulse's work is the energy.
  const auto undamped = CohesiveLaw<HertzLaw>{HertzLaw(100, 0, true), 0.5, 2, 0}.of_pair(size);
  const Real touching = step_contact_force(undamped, {-0.01, 1, 0.02, 1, 0.03}).force;
  CHECK(near(touching / 2 * 0.03, undamped.energy(0.02), {.relative = kRoundOff}));
}

// Without a range the attraction jumps at touch. The impulse of a step within which the contact opens or
// closes is that of the part in contact, so that the work is the change of the energy.
TEST_CASE("an attraction without range does exact work in implicit steps that open or close the contact") {
  constexpr Real kStep = 1e-3, kReach = 2e-4;
  const auto check = [&](const auto& law) {
    for (const Real d0 : {-kReach, -1e-3 * kReach, 1e-3 * kReach, kReach})
      for (const Real d1 : {-2 * kReach, -1e-3 * kReach, 1e-3 * kReach, 2 * kReach}) {
        if ((d0 > 0) == (d1 > 0)) continue;
        CAPTURE(d0, d1);
        const Real rate = (d1 - d0) / kStep;
        const ContactStep step{d0, rate, d1, rate, kStep};
        const StepContactForce over = step_contact_force(law, step);
        const Real before = d0 > 0 ? law.energy(d0) : 0, after = d1 > 0 ? law.energy(d1) : 0;
        CHECK(near((start_force(law, step) + over.force) / 2 * (d1 - d0), after - before,
                   {.relative = kRoundOff, .absolute = kRoundOff * law.attraction * kReach}));
        CHECK(over.stiffness >= 0);
        if (d0 > 0) continue;
        const Real falls = step_contact_force(law, {d0, rate, 1e-9 * kReach, rate, kStep}).force;
        CHECK(std::abs(falls) < 1e-5 * law.attraction);  // continuous at touch
      }
  };
  NormalLawParameters linear{}, dmt{};
  linear.normal_stiffness = 1e4, linear.attraction = 1;
  dmt.effective_modulus = 1e7, dmt.adhesion_work = 5;
  const PairSize size{0.01, 0.02, 0.1, 0.2};
  check(CohesiveLaw<LinearRestitutionLaw>(linear).of_pair(size));
  check(CohesiveLaw<HertzLaw>(dmt).of_pair(size));
}

}  // namespace scree
