// Oblique impacts on a plane, through decks, against event-located solutions of each law.
#include <map>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/restitution.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/hertz_impacts.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

// All phases of a step in which a contact can begin are equally likely.
constexpr Real kPhases[] = {0, 0.4, 0.8};
// Smallest order where the dashpot, which uses the velocity at the middle of the step, matters most.
constexpr Real kLaggingDashpot = 0.9;
using Row = ReferenceTable::Row;

// Common data of the rows of a deck: its law and materials.
struct Setting {
  std::string law, materials;
  bool operator<(const Setting& o) const { return law + materials < o.law + o.materials; }
};
using Words = std::vector<std::string>;

Setting setting_of(const LinearImpact& impact, const Row&) {
  const Real damping = contact_damping(impact.damping_ratio, impact.grain.mass, impact.stiffness, 1);
  return {fmt::format("stiffness = {}\ndamping = {}\nfriction = {}\ntangential_stiffness = {}\n",
                      impact.stiffness, damping, impact.friction, impact.slip_stiffness),
          ""};
}

Setting setting_of(const HertzImpact& impact, const Row& row) {
  const Real restitution = restitution_of(impact.normal.damping_factor / std::sqrt(Real(5)), false);
  return {fmt::format("restitution = {}\nfriction = {}\n", restitution, impact.tangential.friction),
          hertz_materials(row["E"], row["nu"])};
}

// A deck of all the impacts of a setting, side by side, and the errors of its rebounds by rebound_error().
// Steps are relative to the shortest contact.
template <class Impact>
void add_rebounds(const Setting& setting, const std::vector<Impact>& impacts, Real parts, const Words& words,
                  Errors& errors) {
  Real contact_time = kInfinity;
  for (const Impact& impact : impacts) contact_time = std::min(contact_time, impact.contact_time);
  const Real h = contact_time / parts;
  GrainDeck deck{.law = setting.law, .grains = {}, .step = h, .end = 8 * contact_time};
  deck.materials = setting.materials, deck.settings = words;
  for (const Impact& impact : impacts)
    for (const Real phase : kPhases) {
      Grain grain = impact.grain;
      grain.position = {0, 3 * grain.radius * static_cast<Real>(deck.grains.size()),
                        grain.radius - phase * h * grain.velocity.z};
      deck.grains.push_back(grain);
    }
  SimulationRun run(deck.model());
  run.run();
  REQUIRE(run.particle_ledger().contacts == 0);
  const std::vector<Particle> after = run.particles();
  for (std::size_t k = 0; k < after.size(); ++k) {
    const Impact& impact = impacts[k / std::size(kPhases)];
    const Vec3 v = after[k].velocity - impact.velocity_after;
    const Vec3 w = impact.grain.radius * (after[k].angular_velocity - impact.spin_after);
    const Real speed =
        norm(impact.grain.velocity - impact.grain.radius * cross(impact.grain.spin, {0, 0, 1}));
    for (const Real error : {v.x, v.y, v.z, w.x, w.y, w.z}) errors.add(error / speed);
  }
}

template <class Impact, class Which>
Errors rebound_errors(const std::string& table, Real parts, const Which& which, const Words& words = {}) {
  const ReferenceTable rows(table);
  std::map<Setting, std::vector<Impact>> decks;
  for (const Row& row : rows.rows())
    if (which(row)) decks[setting_of(Impact(row), row)].push_back(Impact(row));
  Errors errors;
  for (const auto& [setting, impacts] : decks) add_rebounds(setting, impacts, parts, words, errors);
  return errors;
}

bool rescales(const Row& row) { return row.word("unload") == "rescale"; }

}  // namespace

TEST_CASE("oblique impacts on a wall with a linear spring and slider") {
  const auto at = [&](Real parts, bool damped) {
    return rebound_errors<LinearImpact>("contact/oblique_linear.csv", parts,
                                        [&](const Row& row) { return (row["e"] < 1) == damped; });
  };
  SECTION("without damping: of second order") {
    const Errors coarse = at(100, false), fine = at(200, false);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 1.7e-4}));
    CHECK(keeps(fine.worst(), {.promise = 3e-4, .measured = 2.8e-5}));
    CHECK(order_between(coarse, fine) > 1.8);
  }
  SECTION("with a normal dashpot, whose force jumps at touch and lags half a step: of first order") {
    const Errors coarse = at(100, true), fine = at(200, true);
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 4.6e-3}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 2.3e-3}));
    CHECK(order_between(coarse, fine) > kLaggingDashpot);
  }
}

TEST_CASE("oblique impacts on a wall after Hertz and Mindlin") {
  SECTION("at all angles, three materials") {
    const auto at = [](Real parts) {
      return rebound_errors<MindlinImpact>("contact/oblique_mindlin.csv", parts, rescales);
    };
    const Errors coarse = at(100), fine = at(200);
    CHECK(keeps(coarse.worst(), {.promise = 2e-3, .measured = 1.2e-3}));
    CHECK(keeps(fine.worst(), {.promise = 1e-3, .measured = 6.1e-4}));
    CHECK(order_between(coarse, fine) > kLaggingDashpot);
  }
  SECTION("Chung and Ooi, test 4: at all angles") {
    const auto at = [](Real parts) {
      return rebound_errors<AngleImpact>("contact/chung_ooi_4.csv", parts, rescales);
    };
    const Errors coarse = at(100), fine = at(200);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 7.3e-5}));
    CHECK(keeps(fine.worst(), {.promise = 5e-4, .measured = 2.9e-5}));
    CHECK(order_between(coarse, fine) > 1.1);
  }
  SECTION("Chung and Ooi, test 5: at all tangential velocities, undamped") {
    const auto at = [](Real parts) {
      return rebound_errors<RecoilImpact>("contact/chung_ooi_5.csv", parts, rescales);
    };
    const Errors coarse = at(100), fine = at(200);
    CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 1.8e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-4, .measured = 4.3e-5}));
    CHECK(order_between(coarse, fine) > 1.8);
  }
  SECTION("Chung and Ooi, test 6: with spin alone") {
    const auto at = [](Real parts) {
      return rebound_errors<SpinImpact>("contact/chung_ooi_6.csv", parts, rescales);
    };
    const Errors coarse = at(100), fine = at(200);
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 4.8e-3}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 2.4e-3}));
    CHECK(order_between(coarse, fine) > kLaggingDashpot);
  }
}

TEST_CASE("oblique impacts on a wall in implicit steps: of second order, too where a normal dashpot jumps") {
  for (const Real alpha : {0.0, -0.05}) {
    CAPTURE(alpha);
    const auto at = [&](Real parts, bool damped) {
      return rebound_errors<LinearImpact>(
          "contact/oblique_linear.csv", parts, [&](const Row& row) { return (row["e"] < 1) == damped; },
          implicit_steps(alpha));
    };
    for (const bool damped : {false, true}) {
      CAPTURE(damped);
      const Errors coarse = at(50, damped), fine = at(100, damped);
      CHECK(keeps(coarse.worst(), {.promise = 2e-3, .measured = 6.4e-4}));
      CHECK(measured("oblique_friction/linear", "",
                     keeps(fine.worst(), {.promise = 5e-4, .measured = 1.7e-4})));
      const Real order = order_between(coarse, fine);
      if (damped) CHECK(measured("oblique_friction/damped order", "", at_least(order, 1.4)));
      if (!damped) CHECK(measured("oblique_friction/order", "", at_least(order, 1.9)));
    }
  }
}

// A spring that softens while its contact opens is rescaled at the start of the step.
TEST_CASE("oblique impacts on a wall after Hertz and Mindlin in implicit steps: of first order") {
  const auto steps = implicit_steps(-0.05);
  const auto check = [](const char* name, Bars coarse_bars, Bars fine_bars, const auto& at) {
    CAPTURE(name);
    const Errors coarse = at(100), fine = at(200);
    CHECK(keeps(coarse.worst(), coarse_bars));
    CHECK(measured("oblique_mindlin/" + std::string(name), "", keeps(fine.worst(), fine_bars)));
    CHECK(measured("oblique_mindlin/" + std::string(name) + ", order", "",
                   at_least(order_between(coarse, fine), 0.9)));
  };
  check("oblique", {.promise = 5e-3, .measured = 2.6e-3}, {.promise = 2.5e-3, .measured = 1.2e-3},
        [&](Real parts) {
          return rebound_errors<MindlinImpact>("contact/oblique_mindlin.csv", parts, rescales, steps);
        });
  check("test 4", {.promise = 2e-3, .measured = 5.3e-4}, {.promise = 1e-3, .measured = 2.5e-4},
        [&](Real parts) {
          return rebound_errors<AngleImpact>("contact/chung_ooi_4.csv", parts, rescales, steps);
        });
  check("test 5", {.promise = 5e-3, .measured = 1.7e-3}, {.promise = 2e-3, .measured = 7.7e-4},
        [&](Real parts) {
          return rebound_errors<RecoilImpact>("contact/chung_ooi_5.csv", parts, rescales, steps);
        });
  check("test 6", {.promise = 2e-3, .measured = 4.6e-4}, {.promise = 1e-3, .measured = 1.7e-4},
        [&](Real parts) {
          return rebound_errors<SpinImpact>("contact/chung_ooi_6.csv", parts, rescales, steps);
        });
}

}  // namespace scree
