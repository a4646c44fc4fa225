// The elasto-plastic adhesion law: its three branches, its state, and its energy on any path.
#include "physics/eepa.hpp"

#include <algorithm>
#include <random>

#include "physics/contact_law.hpp"
#include "physics/step_limits.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

using Linear = EepaLaw<LinearRestitutionLaw>;
using Hertzian = EepaLaw<HertzLaw>;

constexpr PairSize kSpheres{5e-3, 5e-3, 1.3613568e-3, 1.3613568e-3};
constexpr Real kStiffness = 1e4;  // of the linear law [N/m]
constexpr Real kModulus = 1e7;    // of Hertz's law [Pa]

NormalLawParameters parameters(bool hertzian, Real plasticity, Real energy, Real attraction = 0,
                               Real chi = 0) {
  NormalLawParameters p;
  (hertzian ? p.effective_modulus : p.normal_stiffness) = hertzian ? kModulus : kStiffness;
  p.adhesion_work = energy, p.attraction = attraction;
  if (plasticity > 0) p.own = Plasticity(plasticity, chi);
  return p;
}

template <class Use>
void for_both_curves(const Use& use) {
  use(false, [](const NormalLawParameters& p) { return Linear(p); });
  use(true, [](const NormalLawParameters& p) { return Hertzian(p); });
}

// Work of the force along a straight path between two overlaps, by quadrature, less that of the state's
// change.
template <class Pair>
Real work_between(const Pair& pair, EepaState& state, Real from, Real to) {
  constexpr int kParts = 4000;
  Real work = 0;
  const auto force = [&](Real d) {
    if (!(d > 0)) return state = {}, Real(0);
    const Pair at = pair.after(state, d);
    state = at.state;
    return at.elastic(d);
  };
  Real before = force(from);
  for (int k = 1; k <= kParts; ++k) {
    const Real after = force(from + (to - from) * k / kParts);
    work += (before + after) / 2 * (to - from) / kParts, before = after;
  }
  return work;
}

}  // namespace

TEST_CASE("EEPA: loading, unloading, adhesive branch, and reloading from there") {
  for_both_curves([](bool hertzian, const auto& law_of) {
    CAPTURE(hertzian);
    const Real n = hertzian ? 1.5 : 1, l = 0.8, chi = 2.5, attraction = 1e-3;
    const auto pair = law_of(parameters(hertzian, l, 5, attraction, chi)).of_pair(kSpheres);
    const Real k1 = hertzian ? Real(4) / 3 * kModulus * std::sqrt(2.5e-3) : kStiffness, k2 = k1 / (1 - l);
    const Real most = 1e-4, plastic = std::pow(l, 1 / n) * most;
    const auto loaded = pair.after({}, most);
    CHECK(near(loaded.elastic(most), k1 * std::pow(most, n) - attraction, {.relative = 1e-13}));
    CHECK(near(loaded.plastic_power, std::pow(plastic, n), {.relative = 1e-13}));
    const Real full =
                   1.5 * std::numbers::pi_v<Real> * 5 * std::sqrt(2 * 2.5e-3 * plastic - plastic * plastic),
               pull = std::min(full, k2 * std::pow(plastic, n) / 2);
    const Real m = std::pow(std::pow(plastic, n) - pull / k2, 1 / n);
    CHECK(near(loaded.state.pull_overlap, m, {.relative = 1e-12}));
    CHECK(near(loaded.state.adhesion, pull / std::pow(m, chi), {.relative = 1e-12}));
    const Real above = (m + 3 * most) / 4;
    const auto unloaded = pair.after(loaded.state, above);
    CHECK(unloaded.state == loaded.state);
    CHECK(near(unloaded.elastic(above), k2 * (std::pow(above, n) - std::pow(plastic, n)) - attraction,
               {.relative = 1e-10}));
    // The largest tensile force, continuous where the branches meet.
    CHECK(near(pair.after(loaded.state, m * (1 + 1e-12)).elastic(m), -pull - attraction, {.relative = 1e-8}));
    const Real low = m / 3;
    const auto adhesive = pair.after(loaded.state, low);
    const Real k_a = loaded.state.adhesion;
    CHECK(near(adhesive.elastic(low), -k_a * std::pow(low, chi) - attraction, {.relative = 1e-12}));
    CHECK(adhesive.state.adhesion == k_a);
    CHECK(
        near(adhesive.plastic_power, std::pow(low, n) + k_a / k2 * std::pow(low, chi), {.relative = 1e-12}));
    // The friction load is zero there.
    CHECK(std::abs(adhesive.elastic(low) + adhesive.adhesion(low)) <= 1e-15 * pull);
    // Reloading with k2 from the new plastic overlap.
    const Real up = 1.2 * low;
    const auto again = pair.after(adhesive.state, up);
    if (l * std::pow(up, n) < adhesive.plastic_power)
      CHECK(near(again.elastic(up), k2 * (std::pow(up, n) - adhesive.plastic_power) - attraction,
                 {.relative = 1e-9, .absolute = 1e-12}));
    CHECK(near(pair.after(adhesive.state, most).elastic(most), loaded.elastic(most), {.relative = 1e-15}));
  });
}

TEST_CASE("EEPA: slopes and energies are the derivatives of energies and forces") {
  for_both_curves([](bool hertzian, const auto& law_of) {
    CAPTURE(hertzian);
    const auto pair = law_of(parameters(hertzian, 0.6, 5, 2e-3, 3)).of_pair(kSpheres);
    const auto loaded = pair.after({}, 1e-4);
    const Real m = loaded.state.pull_overlap;
    for (const Real d : {0.3 * m, 0.9 * m, 0.5 * (m + 1e-4)}) {
      const Real step = 1e-5 * d;
      CHECK(near((loaded.energy(d + step) - loaded.energy(d - step)) / (2 * step), loaded.elastic(d),
                 {.relative = 1e-5, .absolute = 1e-7}));
      CHECK(near((loaded.elastic(d + step) - loaded.elastic(d - step)) / (2 * step), loaded.slope(d),
                 {.relative = 1e-6}));
    }
    CHECK(loaded.energy(0) == 0);
    CHECK(loaded.cohesion(0.5 * m) < 0);
    CHECK(loaded.cohesion(1e-4) < 0);
  });
}

TEST_CASE("EEPA: work over a path is the change of the energy and the dissipation") {
  std::mt19937 engine(7);
  std::uniform_real_distribution<Real> uniform(0, 1);
  for_both_curves([&](bool hertzian, const auto& law_of) {
    for (const Real l : {0.2, 0.6, 0.95})
      for (const Real energy : {0.0, 5.0, 500.0}) {
        CAPTURE(hertzian, l, energy);
        const auto pair = law_of(parameters(hertzian, l, energy, 1e-3, 2)).of_pair(kSpheres);
        EepaState state{}, stepped{};
        Real d = 0, stored = 0;
        for (int k = 0; k < 12; ++k) {
          const Real next = 1e-4 * uniform(engine);
          const auto after = pair.after(stepped, next);
          const Real work = work_between(pair, state, d, next), now = after.energy(next);
          CHECK(after.dissipated >= 0);
          const Real scale = std::abs(after.elastic(1e-4)) * 1e-4 + std::abs(now) + std::abs(stored);
          CHECK(near(work, now - stored + after.dissipated, {.absolute = 1e-5 * scale}));
          stepped = after.state, stored = now, d = next;
        }
      }
  });
}

// Work of the force from the overlap d0 in a state to d1, by the integrals of the three branches.
struct BranchWork {
  Real n, k1, l, chi;

  Real operator()(const EepaState& state, Real d0, Real d1) const {
    const Real k2 = k1 / (1 - l), m = state.pull_overlap, k_a = state.adhesion;
    const Real plastic_power = std::pow(m, n) + k_a / k2 * std::pow(m, chi);
    const Real loaded = std::pow(plastic_power / l, 1 / n);
    const auto loading = [&](Real d) { return k1 * std::pow(d, n + 1) / (n + 1); };
    const auto unloading = [&](Real d) { return k2 * (std::pow(d, n + 1) / (n + 1) - plastic_power * d); };
    const auto adhesive = [&](Real d) { return -k_a * std::pow(d, chi + 1) / (chi + 1); };
    if (d1 > d0) {
      const Real meets = std::clamp(loaded, d0, d1);
      return unloading(meets) - unloading(d0) + (loading(d1) - loading(meets));
    }
    const Real meets = std::clamp(m, d1, d0);
    return unloading(meets) - unloading(d0) + (adhesive(d1) - adhesive(meets));
  }
};

TEST_CASE("EEPA: no path creates energy in a million random histories") {
  std::mt19937 engine(11);
  std::uniform_real_distribution<Real> uniform(0, 1);
  constexpr int kHistories = 1000000, kSteps = 6;
  Real least = 0, balance = 0;  // relative to the largest energy: work of a loop, and error of the accounting
  for_both_curves([&](bool hertzian, const auto& law_of) {
    for (int history = 0; history < kHistories / 2; ++history) {
      const Real n = hertzian ? 1.5 : 1, l = 0.998 * uniform(engine) + 1e-3,
                 chi = std::round(2 * (n + (5 - n) * uniform(engine))) / 2,
                 energy = std::pow(10, 4 * uniform(engine) - 1);
      const auto pair = law_of(parameters(hertzian, l, energy, 0, chi)).of_pair(kSpheres);
      const BranchWork work_of{n, pair.stiffness, l, chi};
      EepaState state{};
      Real d = 0, work = 0, dissipated = 0, most = 0;
      for (int step = 0; step < kSteps; ++step) {
        const Real next = step + 1 < kSteps ? 1e-4 * uniform(engine) * uniform(engine) : 0;
        work += work_of(state, d, next);
        const auto after = pair.after(state, next);
        dissipated += after.dissipated, state = after.state, d = next;
        most = std::max(most, std::abs(after.energy(next)) + dissipated);
        balance = std::max(balance, std::abs(work - after.energy(next) - dissipated) / most);
      }
      least = std::min(least, work / most);
    }
  });
  CHECK(least > -1e-12);
  CHECK(balance < 1e-9);
}

TEST_CASE(
    "EEPA: a plastic contact without history in the first step counts its plastic work as energy before") {
  const ContactLaw<Hertzian> law{Hertzian(parameters(true, 0.7, 5))};
  static_assert(decltype(law)::kHistory == 2 && decltype(law)::kNeedsMotion);
  const ContactGeometry geometry = sphere_pair(Vec3{0, 0, 9.95e-3}, Real(1e-2));
  const ContactMotion rest = sphere_motion(geometry, {}, {{}, 5e-3, 1}, {{}, 5e-3, 1}, 1);
  const MovingPair pair{{geometry, {}, kSpheres}, rest};
  const auto first = law.respond(pair, {});
  CHECK(first.load.loss > 0);  // in a step of 1 s
  const Real before = law.energy_of(pair, {}).sum, after = law.energy_of(pair, first.history).sum;
  CHECK(near(before - after, first.load.loss, {.relative = 1e-13}));
  CHECK(near(before, 0.4 * Real(4) / 3 * kModulus * std::sqrt(2.5e-3) * std::pow(geometry.overlap, 2.5),
             {.relative = 1e-12}));
  CHECK(std::abs(law.respond(pair, first.history).load.loss) <= 1e-12 * first.load.loss);
}

// Error of the accounting over a head-on impact of two spheres with a damper and without adhesion, over the
// energy of the impact; steps: per period at the stiffness k1.
template <class Law>
Real impact_balance(const Law& law, Real stiffness, int steps) {
  constexpr Real kSpeed = 0.3;
  const Real mass = kSpheres.effective_mass(), sum = kSpheres.radius_i + kSpheres.radius_j,
             h = 2 * std::numbers::pi_v<Real> * std::sqrt(mass / stiffness) / steps;
  typename Law::History history{};
  Real distance = sum + 0.4 * kSpeed * h, rate = -kSpeed, loss = 0;
  for (int k = 0; k < 10 * steps; ++k) {
    distance += h * rate;
    const ContactGeometry geometry = sphere_pair(Vec3{0, 0, distance}, sum);
    const Vec3 velocity{0, 0, rate};
    const ContactMotion motion =
        sphere_motion(geometry, h * velocity, {{}, kSpheres.radius_i, 1}, {{}, kSpheres.radius_j, 1}, h);
    const auto out = law.respond(MovingPair{{geometry, velocity, kSpheres}, motion}, history);
    rate += h / mass * out.load.force.z, loss += h * out.load.loss, history = out.history;
    if (rate > 0 && distance > sum) break;
  }
  return (mass / 2 * (rate * rate - kSpeed * kSpeed) + loss) / (mass / 2 * kSpeed * kSpeed);
}

TEST_CASE("EEPA: without adhesion a limited damper that is drawn off dissipates nothing") {
  for_both_curves([](bool hertzian, const auto& law_of) {
    for (const Real l : {0.35, 0.8})
      for (const Real damping_ratio : {0.05, 0.3}) {
        CAPTURE(hertzian, l, damping_ratio);
        NormalLawParameters p = parameters(hertzian, l, 0);
        p.damping_ratio = damping_ratio;
        const ContactLaw law{law_of(p)};
        const Real stiffness =
            law.normal.of_pair(kSpheres).unloading_stiffness * (hertzian ? std::sqrt(Real(1e-4)) : 1);
        const Real coarse = impact_balance(law, stiffness, 400), fine = impact_balance(law, stiffness, 1600);
        CHECK(std::abs(coarse) < 5e-5);
        CHECK(std::abs(fine) < 5e-6);
      }
  });
}

TEST_CASE("EEPA: pairs without plasticity are elastic, with a constant attraction or without") {
  const auto pair = Linear(parameters(false, 0, 0, 0.5)).of_pair(kSpheres);
  for (const Real d : {1e-6, 1e-4}) {
    const auto after = pair.after({0.3, 5}, d);
    CHECK(near(after.elastic(d), kStiffness * d - 0.5, {.relative = 1e-15}));
    CHECK(near(after.energy(d), kStiffness * d * d / 2 - 0.5 * d, {.relative = 1e-13}));
    CHECK((after.dissipated == 0 && after.state == EepaState{} && after.adhesion(d) == 0.5));
  }
}

TEST_CASE("EEPA: the law for parameters that no other law accepts") {
  const NormalLawParameters plastic = parameters(true, 0.5, 0), linear = parameters(false, 0.5, 0);
  CHECK((plastic.is_cohesive() && linear.is_cohesive()));
  CHECK((Hertzian::accepts(plastic) && !Hertzian::accepts(linear)));
  CHECK((Linear::accepts(linear) && !Linear::accepts(plastic)));
  CHECK_FALSE((HertzLaw::accepts(plastic) || JkrLaw::accepts(plastic)));
  CHECK_FALSE((LinearRestitutionLaw::accepts(linear) || PowerLaw::accepts(linear)));
  CHECK_FALSE(CohesiveLaw<HertzLaw>::accepts(plastic));
  CHECK_FALSE(CohesiveLaw<LinearRestitutionLaw>::accepts(linear));
  // Adhesion without plasticity is another law, an attraction without it is not.
  CHECK_FALSE(Hertzian::accepts(parameters(true, 0, 5)));
  CHECK(Hertzian::accepts(parameters(true, 0, 0, 1)));
}

TEST_CASE("EEPA: the step follows from the unloading stiffness") {
  const Real elastic = typical_stiffness(parameters(true, 0, 0), kSpheres),
             plastic = typical_stiffness(parameters(true, 0.59, 0), kSpheres);
  CHECK(near(plastic, elastic / (1 - 0.59), {.relative = kUlp}));
  CHECK(loading_stiffness(parameters(true, 0.59, 0), kSpheres) == elastic);
}

}  // namespace scree
