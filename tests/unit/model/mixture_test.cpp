// Mixtures of particles: shares of components and sizes after any number of births, and their keys.
#include "model/derived/mixture.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "model/builder/read_mixture.hpp"
#include "model/derived/exact_shares.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

Distribution constant(Real value, int power = 3) {
  return {{.kind = DistributionKind::constant, .value = value}, power};
}

Distribution sizes(CountedBy by) {
  return {{.kind = DistributionKind::lognormal,
           .by = by,
           .min = 0.001,
           .max = 0.005,
           .median = 0.002,
           .geometric_sd = 1.4},
          3};
}

MixtureComponent component(int material, Distribution radius, Real density, Real share) {
  return {.material = material,
          .radius = std::move(radius),
          .density = constant(density, 1),
          .inertia_factor = 0.4,
          .share = share};
}

// Two materials of many sizes and one of a single size.
std::vector<MixtureComponent> three() {
  return {component(0, sizes(CountedBy::mass), 2500, 0.55),
          component(1, sizes(CountedBy::number), 1200, 0.37), component(0, constant(0.003), 7800, 0.08)};
}

Real number_of(const Mixture& mixture, const std::vector<std::int64_t>& counts, int component) {
  std::int64_t sum = 0;
  for (int k = 0; k < mixture.classes(); ++k)
    if (mixture.component_of(k) == component) sum += counts[static_cast<std::size_t>(k)];
  return static_cast<Real>(sum);
}

// Largest differences of the numbers of components and classes from their shares of n births.
struct Deviation {
  Real component = 0, size_class = 0;
};

Deviation deviation(const Mixture& mixture, const std::vector<std::int64_t>& counts, Real n) {
  Deviation found;
  for (int k = 0; k < static_cast<int>(mixture.components().size()); ++k)
    found.component = std::max(found.component,
                               std::abs(number_of(mixture, counts, k) - n * mixture.share_of_component(k)));
  for (int k = 0; k < mixture.classes(); ++k)
    found.size_class = std::max(
        found.size_class,
        std::abs(static_cast<Real>(counts[static_cast<std::size_t>(k)]) - n * mixture.share_of_class(k)));
  return found;
}

struct Births {
  std::vector<std::int64_t> counts;
  std::vector<Mixture::Particle> particles;
  std::vector<int> classes;
  Deviation worst;
};

// The births from the state `counts` up to n.
Births births(const Mixture& mixture, std::int64_t n, std::vector<std::int64_t> counts = {}) {
  Births all{std::move(counts), {}, {}, {}};
  all.counts.resize(static_cast<std::size_t>(mixture.classes()));
  std::int64_t first = 0;
  for (const std::int64_t count : all.counts) first += count;
  for (std::int64_t k = first; k < n; ++k) {
    const Mixture::Birth birth = mixture.next(k, all.counts);
    CHECK(mixture.component_of(birth.size_class) == birth.component);
    ++all.counts[static_cast<std::size_t>(birth.size_class)];
    all.classes.push_back(birth.size_class);
    all.particles.push_back(mixture.particle(k, birth.size_class));
    const Deviation now = deviation(mixture, all.counts, static_cast<Real>(k + 1));
    all.worst = {std::max(all.worst.component, now.component),
                 std::max(all.worst.size_class, now.size_class)};
  }
  return all;
}

}  // namespace

TEST_CASE("the chairman assignment keeps every kind within its bound") {
  for (const std::vector<Real>& shares : {std::vector<Real>{1},
                                          {0.5, 0.5},
                                          {0.999, 0.001},
                                          {0.6, 0.3, 0.1},
                                          {0.97, 0.01, 0.01, 0.01},
                                          {1.0 / 3, 1.0 / 3, 1.0 / 3},
                                          {0.4, 0.25, 0.15, 0.1, 0.06, 0.03, 0.01}}) {
    const auto kinds = static_cast<Real>(shares.size());
    const Real bound = kinds == 1 ? 0 : 1 - 1 / (2 * kinds - 2);
    std::vector<std::int64_t> counts(shares.size());
    Real worst = 0;
    for (int n = 1; n <= 20000; ++n) {
      const Real u = std::fmod(n * 0.618, 1.0);  // among equally urgent kinds
      ++counts[static_cast<std::size_t>(next_by_shares(shares, counts, u))];
      for (std::size_t k = 0; k < shares.size(); ++k)
        worst = std::max(worst, std::abs(static_cast<Real>(counts[k]) - n * shares[k]));
    }
    CAPTURE(shares);
    CHECK(worst <= bound + 1e-9);
  }
}

TEST_CASE("exact shares: components and size classes are within one particle after any number of births") {
  for (const CountedBy by : {CountedBy::number, CountedBy::mass}) {
    const Mixture mixture(three(), {.seed = 3, .counted_by = by});
    CHECK(mixture.classes() == 33);
    const Births all = births(mixture, 7000);
    CHECK(all.worst.component < 1);
    CHECK(all.worst.size_class < 1);
  }
}

TEST_CASE("exact shares of the values of a table") {
  const Distribution grades(
      {.kind = DistributionKind::table, .values = {0.001, 0.002, 0.004}, .weights = {5, 3, 2}}, 3);
  const Mixture mixture({component(0, grades, 2500, 1)}, {});
  const Births all = births(mixture, 1000);
  CHECK(all.worst.size_class < 1);
  CHECK(all.counts == std::vector<std::int64_t>{500, 300, 200});
  const std::vector<Real> values{0.001, 0.002, 0.004};
  for (std::size_t k = 0; k < 1000; ++k)
    CHECK(all.particles[k].radius == values[static_cast<std::size_t>(all.classes[k])]);
}

TEST_CASE("shares by mass") {
  const Mixture mixture(three(), {.seed = 3, .counted_by = CountedBy::mass});
  const Births all = births(mixture, 7000);
  std::vector<Real> mass(3);
  Real sum = 0;
  for (std::size_t k = 0; k < all.particles.size(); ++k) {
    mass[static_cast<std::size_t>(mixture.component_of(all.classes[k]))] += all.particles[k].mass;
    sum += all.particles[k].mass;
  }
  // Numbers are exact. Sizes within the bins are random: the standard error of a component's mass is 1 %,
  // most of it from the bin of its largest particles.
  CHECK(near(mass[0] / sum, 0.55, {.relative = 0.03}));
  CHECK(near(mass[1] / sum, 0.37, {.relative = 0.03}));
  CHECK(near(mass[2] / sum, 0.08, {.relative = 0.03}));
  CHECK(near(sum / 7000, mixture.mean_mass(), {.relative = 0.02}));
}

TEST_CASE("particles of a mixture lie in its ranges and have the means that it states") {
  const Mixture mixture(three(), {.seed = 9});
  const Births all = births(mixture, 7000);
  Real mass = 0, volume = 0;
  for (const Mixture::Particle& p : all.particles) {
    CHECK((p.radius >= mixture.smallest_radius() && p.radius <= mixture.largest_radius()));
    CHECK((p.mass >= mixture.smallest_mass() && p.mass <= mixture.largest_mass()));
    CHECK(p.inertia_factor == 0.4);
    mass += p.mass, volume += 4.0 / 3 * std::numbers::pi * p.radius * p.radius * p.radius;
  }
  CHECK(near(mass / 7000, mixture.mean_mass(), {.relative = 0.005}));
  CHECK(near(volume / 7000, mixture.mean_volume(), {.relative = 0.005}));
  CHECK(mixture.largest_mass_of(2) == mixture.smallest_mass_of(2));
}

TEST_CASE("births are reproducible and continue from the counts of a restart") {
  const Mixture mixture(three(), {.seed = 3});
  const Births all = births(mixture, 1000), again = births(mixture, 1000);
  CHECK(all.classes == again.classes);
  CHECK(all.classes != births(Mixture(three(), {.seed = 4}), 1000).classes);
  const Births first = births(mixture, 400), rest = births(mixture, 1000, first.counts);
  CHECK(std::equal(rest.classes.begin(), rest.classes.end(), all.classes.begin() + 400));
  for (std::size_t k = 0; k < rest.particles.size(); ++k)
    CHECK(rest.particles[k].mass == all.particles[400 + k].mass);
}

TEST_CASE("drawn shares depend on the seed and the number of the birth alone") {
  const Mixture mixture(three(), {.seed = 3, .shares = MixtureShares::drawn});
  const Births all = births(mixture, 7000);
  for (const std::int64_t n : {0, 17, 6999})
    CHECK(mixture.next(n, {}).size_class == all.classes[static_cast<std::size_t>(n)]);
  for (int k = 0; k < 3; ++k) {
    const Real share = mixture.share_of_component(k);
    CHECK(near(number_of(mixture, all.counts, k) / 7000, share,
               {.absolute = 4 * std::sqrt(share * (1 - share) / 7000)}));
  }
  CHECK(all.worst.component > 1);
}

namespace {

const char* const kTable = "deck.toml:1:1";

void give(DeckTable& table, const std::string& key, decltype(DeckValue::data) data) {
  table.set(key, {std::move(data), kTable, "", true});
}

DeckTable quantity(const std::string& path, Real value) {
  DeckTable table(distribution_keys(), path, kTable);
  give(table, "kind", std::string("constant"));
  give(table, "value", value);
  return table;
}

DeckTable component_table(const TableKeys& keys, const std::string& path, const std::string& material,
                          Real radius) {
  DeckTable table(keys, path, kTable);
  give(table, "material", material);
  give(table, "radius", std::vector{quantity(path + ".radius", radius)});
  give(table, "thickness", 1.0);
  return table;
}

// A table like that of an inserter.
const TableKeys& test_keys() {
  static const TableKeys keys = [] {
    TableKeys made{"", mixture_list_keys(), ""};
    made.keys.push_back(integer("seed"));
    return made;
  }();
  return keys;
}

DeckTable inserter(std::vector<DeckTable> mixture) {
  DeckTable table(test_keys(), "inserters.feed", kTable);
  give(table, "mixture", std::move(mixture));
  give(table, "seed", std::int64_t{1});
  give(table, "thickness", 1.0);
  give(table, "shares", std::string("exact"));
  return table;
}

}  // namespace

TEST_CASE("a mixture of the deck") {
  ModelNames names;
  names.materials = {{"glass", 0}, {"steel", 1}};
  names.densities = {2500, 7800};
  DeckTable glass = component_table(mixture_keys(), "inserters.feed.mixture.0", "glass", 0.002),
            steel = component_table(mixture_keys(), "inserters.feed.mixture.1", "steel", 0.001);
  give(glass, "share", 0.7), give(steel, "share", 0.3);
  DeckTable table = inserter({glass, steel});
  const auto error = [&](const DeckTable& of) { return input_error([&] { read_mixture(of, names, 3); }); };
  CHECK(contains(error(table), "inserters.feed.shares_by: missing; it must be \"number\" or \"mass\""));
  give(table, "shares_by", std::string("mass"));
  const Mixture mixture = read_mixture(table, names, 3);
  REQUIRE(mixture.components().size() == 2);
  CHECK(mixture.classes() == 2);
  const Real glass_mass = 2500 * 4.0 / 3 * std::numbers::pi * 8e-9,
             steel_mass = 7800 * 4.0 / 3 * std::numbers::pi * 1e-9;
  CHECK(near(mixture.mean_mass_of(0), glass_mass, {.relative = 1e-14}));
  CHECK(near(mixture.share_of_component(0) / mixture.share_of_component(1),
             0.7 / glass_mass / (0.3 / steel_mass), {.relative = 1e-14}));
  CHECK(mixture.particle(0, 1).material == 1);
  CHECK(mixture.particle(0, 1).inertia_factor == 0.4);

  give(table, "radius", std::vector{quantity("inserters.feed.radius", 0.1)});
  CHECK(contains(error(table), "not used together with mixture, whose components have it"));
  DeckTable none = inserter({});
  CHECK(contains(error(none), "inserters.feed.radius: missing"));
  DeckTable alone = component_table(test_keys(), "inserters.feed", "steel", 0.001);
  give(alone, "mixture", std::vector<DeckTable>{}), give(alone, "seed", std::int64_t{1});
  give(alone, "shares", std::string("exact"));
  CHECK(near(read_mixture(alone, names, 3).mean_mass(), steel_mass, {.relative = 1e-14}));
  names.densities = {2500, 0};
  CHECK(contains(error(alone), "inserters.feed.density: missing; mass or density is needed"));
}

}  // namespace scree
