// Impacts in discrete steps against the exact rebound.
#include "physics/trial_impact.hpp"

#include <numbers>

#include "physics/cohesion.hpp"
#include "physics/restitution.hpp"
#include "physics/step_limits.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "support/restitution.hpp"

namespace scree {

namespace {

constexpr Real kExact = 2e-4;  // of the speed: error of the short steps of the exact rebound

// One disc of 1 kg on a wall, K = 1e7 N/m.
struct Case {
  Real ratio;  // ratio to its damping
  bool tension = true;
  Real hht_alpha = 0;
  bool resolve_events = true;

  LinearLaw law() const { return {1e7, contact_damping(ratio, 1, 1e7, 1), tension}; }
  static Real touch() { return contact_time(1e7, 1); }
};

const TrialImpact kOnWall{{0.05, kInfinity, 1, kInfinity}, 1, kInfinity, kInfinity, 6.7, 0};

TrialResult implicit(const Case& one, Real share) {
  const LinearLaw pair = one.law();
  const TrialMethod method{hht_coefficients(one.hht_alpha), one.resolve_events};
  const auto make = [&](Real gap) { return ImplicitTrial(pair, method, kOnWall, gap); };
  return Trials(ContactLaw<LinearLaw>{pair}, kOnWall, Case::touch(), make).with(share * Case::touch());
}

template <class Law>
auto explicit_trials(const Law& law, const TrialImpact& impact, Real touch) {
  const auto make = [&](Real gap) { return ExplicitTrial<Law>(law, impact, gap); };
  return Trials(law, impact, touch, make);
}

TrialResult verlet(const Case& one, Real share) {
  return explicit_trials(ContactLaw<LinearLaw>{one.law()}, kOnWall, Case::touch())
      .with(share * Case::touch());
}

}  // namespace

TEST_CASE("trial impacts err as whole runs do: the table of impacts at any step") {
  constexpr Real kDigits = 0.05;  // of two digits, and of another number of phases
  struct Claim {
    Case impact;
    Real share, error;  // step over contact time
  };
  for (const auto& [impact, share, error] :
       {Claim{{0.2}, 1, 0.29}, Claim{{0.2}, 3, 0.43}, Claim{{0.2}, 0.3, 0.072}, Claim{{0.2}, 0.1, 0.0099},
        Claim{{0.063}, 1, 0.080}, Claim{{0, true, -0.05}, 1, 0.035}, Claim{{0, true, -0.1}, 1, 0.060},
        Claim{{0, true, -0.3}, 1, 0.088}, Claim{{0.2, true, -0.3}, 3, 1.10}}) {
    const TrialResult found = implicit(impact, share);
    CAPTURE(impact.ratio, impact.hht_alpha, share, found.normal_error);
    CHECK(near(found.normal_error, error, {.relative = kDigits}));
    CHECK(found.across_error == 0);
  }
  CHECK(near(verlet({0}, 0.1).normal_error, 0.0011, {.relative = kDigits}));
  CHECK(near(verlet({0.2}, 0.1).normal_error, 0.059, {.relative = kDigits}));
  CHECK(near(verlet({0.2}, 0.05).normal_error, 0.032, {.relative = kDigits}));
}

// The force at the end of the step is used for the whole step: the paper's form, at the paper's step.
TEST_CASE("trial impacts know whether contact events are resolved") {
  const Real share = 1e-3 / Case::touch();
  CHECK(near(implicit({0.0016, true, 0, false}, share).normal_error, 0.43, {.relative = 0.05}));
  CHECK(implicit({0, true, 0, true}, share).normal_error < kExact);
}

TEST_CASE("trial impacts in fine steps are exact, at the order of their method") {
  for (const bool tension : {true, false}) {
    CAPTURE(tension);
    const Case damped{0.2, tension, -0.05};
    const Real e = restitution_of(0.2, tension);
    CHECK(near(implicit(damped, 0.01).exact.restitution, e, {.absolute = kExact}));
    CHECK(near(implicit(damped, 1e-3).mean.restitution, e, {.absolute = kExact}));
    CHECK(near(verlet(damped, 1e-3).mean.restitution, e, {.absolute = kExact}));
    // A dashpot that jumps at touch is resolved by the implicit steps, and of first order in the others; but
    // with tension their errors at touch and at release can cancel.
    const auto order = [](Real coarse, Real fine) { return std::log2(coarse / fine); };
    const auto bias = [&](Real mean) { return std::abs(mean - e); };
    CHECK(near(
        order(bias(implicit(damped, 0.08).mean.restitution), bias(implicit(damped, 0.04).mean.restitution)),
        2, {.absolute = 0.15}));
    if (!tension)
      CHECK(near(order(verlet(damped, 0.04).normal_error, verlet(damped, 0.02).normal_error), 1,
                 {.absolute = 0.2}));
  }
}

TEST_CASE("a step within which a trial impact errs no more than it may") {
  const ContactLaw<LinearLaw> law{Case{0.2}.law()};
  const auto trials = explicit_trials(law, kOnWall, Case::touch());
  const Real good = trials.step_within(0.01);
  CHECK(trials.with(good).error() < 0.01);
  CHECK(trials.with(1.2 * good).error() > 0.01);
  const LinearLaw bare = Case{0}.law();
  const TrialMethod method{hht_coefficients(0), true};
  const auto make = [&](Real gap) { return ImplicitTrial(bare, method, kOnWall, gap); };
  const Trials any(ContactLaw<LinearLaw>{bare}, kOnWall, Case::touch(), make);
  CHECK(any.step_within(0.01) == any.longest_step());
}

TEST_CASE("a trial impact on a plane finds the exact rebound, with friction") {
  const ReferenceTable table("contact/oblique_linear.csv");
  for (std::size_t k = 0; k < table.rows().size(); k += 7) {
    const auto& row = table.rows()[k];
    const Real angle = row["angle_deg"] * std::numbers::pi_v<Real> / 180, m = row["m"], R = row["R"];
    const Real damping = contact_damping(row["z_cut"], m, row["K"], 1), touch = contact_time(row["K"], m);
    const ContactLaw<LinearLaw, LinearSlider> law{LinearLaw(row["K"], damping, false),
                                                  {row["kt"], row["mu"], 0}};
    const TrialImpact impact{
        {R, kInfinity, m, kInfinity}, m, 0.4 * m * R * R, kInfinity, std::cos(angle), std::sin(angle)};
    const auto trials = explicit_trials(law, impact, touch);
    const TrialResult result = trials.with(touch / 50);
    // From the slip u at the contact: a change of the sphere's velocity by w changes its spin velocity by
    // 5/2 w.
    const Real across = std::sin(angle) + (row["u"] - std::sin(angle)) / 3.5;
    CAPTURE(row["angle_deg"], row["e"]);
    CHECK(near(result.exact.restitution, row["e"], {.absolute = kExact}));
    CHECK(near(result.exact.across, across / std::cos(angle), {.absolute = 5e-4}));
    CHECK(near(result.mean.restitution, row["e"], {.absolute = 1e-2}));
    CHECK(trials.with(trials.step_within(1e-2)).error() < 1e-2);
  }
}

TEST_CASE("a trial impact of two spheres, damped after Hertz; spheres that stick do not rebound") {
  const PairSize size{0.01, 0.02, 0.1, 0.8};
  const TrialImpact impact{size, size.effective_mass(), 4e-6, 1.3e-4, 1, 0};
  const Real touch = 1e-3;
  const ContactLaw<HertzLaw> law{HertzLaw(1e9, std::sqrt(5.0) * damping_ratio_of(0.7, false), false)};
  CHECK(near(explicit_trials(law, impact, touch).with(1e-6).exact.restitution, 0.7, {.absolute = kExact}));
  const ContactLaw<JkrLaw> adhesive{{1e9, 1, 2e4}};
  const Real formation = adhesive.normal.of_pair(size).formation_loss();
  REQUIRE(formation > size.effective_mass() / 2);  // more than the kinetic energy
  CHECK(explicit_trials(adhesive, impact, touch).with(1e-5).mean.restitution == 0);
}

}  // namespace scree
