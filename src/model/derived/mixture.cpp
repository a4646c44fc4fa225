#include "model/derived/mixture.hpp"

#include <algorithm>
#include <numeric>

#include "base/counter_random.hpp"
#include "model/derived/exact_shares.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

namespace {

// Equally probable size bins of a continuous distribution.
constexpr int kSizeBins = 16;

}  // namespace

Mixture::Mixture(std::vector<MixtureComponent> components, const MixtureOptions& options)
    : components_(std::move(components)), options_(options) {
  Real sum = 0;
  for (int k = 0; k < static_cast<int>(components_.size()); ++k) {
    add_classes(k);
    const Real share = component(k).share;
    shares_.push_back(options.counted_by == CountedBy::mass ? share / mean_mass_of(k) : share);
    sum += shares_.back();
  }
  first_.push_back(classes_.size());
  for (Real& share : shares_) share /= sum;
}

void Mixture::add_classes(int component) {
  first_.push_back(classes_.size());
  const Distribution& radius = this->component(component).radius;
  const bool table = radius.parameters().kind == DistributionKind::table;
  const int bins = radius.is_constant() ? 1
                   : table              ? static_cast<int>(radius.parameters().values.size())
                                        : kSizeBins;
  Real low = 0;
  for (int bin = 0; bin < bins; ++bin) {
    const Real high = bin + 1 == bins ? 1
                      : table         ? low + radius.parameters().weights[static_cast<std::size_t>(bin)]
                                      : static_cast<Real>(bin + 1) / kSizeBins;
    classes_.push_back({component, low, high});
    // Equal bins have equal shares, without round-off: their order within a round is then random.
    class_shares_.push_back(table && bins > 1 ? high - low : Real(1) / bins);
    low = high;
  }
}

Real Mixture::share_of_class(int size_class) const {
  const auto k = static_cast<std::size_t>(size_class);
  return share_of_component(classes_[k].component) * class_shares_[k];
}

Mixture::Birth Mixture::next(std::int64_t n, std::span<const std::int64_t> counts) const {
  if (options_.shares == MixtureShares::drawn) return drawn(n);
  CounterRandom random(options_.seed, RandomStream::mixture_class, n);
  std::vector<std::int64_t> of_component(components_.size());
  for (std::size_t k = 0; k < components_.size(); ++k)
    of_component[k] =
        std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(first_[k]),
                        counts.begin() + static_cast<std::ptrdiff_t>(first_[k + 1]), std::int64_t{0});
  const int component = next_by_shares(shares_, of_component, random.uniform());
  const std::size_t first = first_[static_cast<std::size_t>(component)],
                    bins = first_[static_cast<std::size_t>(component) + 1] - first;
  const int bin = next_by_shares(std::span(class_shares_).subspan(first, bins), counts.subspan(first, bins),
                                 random.uniform());
  return {static_cast<int>(first) + bin, component};
}

Mixture::Birth Mixture::drawn(std::int64_t n) const {
  Real u = CounterRandom(options_.seed, RandomStream::mixture_class, n).uniform();
  for (int k = 0; k + 1 < classes(); ++k) {
    u -= share_of_class(k);
    if (u < 0) return {k, component_of(k)};
  }
  return {classes() - 1, component_of(classes() - 1)};
}

Mixture::Particle Mixture::particle(std::int64_t n, int size_class) const {
  const SizeClass& of = classes_[static_cast<std::size_t>(size_class)];
  const MixtureComponent& from = component(of.component);
  const auto draw = [&](const Distribution& distribution, RandomStream stream, Real low, Real high) {
    return distribution.quantile(CounterRandom(options_.seed, stream, n).uniform(low, high));
  };
  Particle particle;
  particle.material = from.material;
  particle.inertia_factor = from.inertia_factor;
  // A bin of a table is one value, of which its middle is certain.
  particle.radius = from.radius.parameters().kind == DistributionKind::table
                        ? from.radius.quantile((of.low + of.high) / 2)
                        : draw(from.radius, RandomStream::radius, of.low, of.high);
  particle.mass = from.mass
                      ? draw(*from.mass, RandomStream::mass, 0, 1)
                      : mass_of(from, particle.radius, draw(*from.density, RandomStream::density, 0, 1));
  return particle;
}

Real Mixture::mass_of(const MixtureComponent& of, Real radius, Real density) const {
  return options_.dimension == 3 ? sphere_mass(radius, density) : disc_mass(radius, of.thickness, density);
}

Real Mixture::mean_mass() const {
  Real sum = 0;
  for (std::size_t k = 0; k < components_.size(); ++k) sum += shares_[k] * mean_mass_of(static_cast<int>(k));
  return sum;
}

Real Mixture::mean_volume() const {
  Real sum = 0;
  for (std::size_t k = 0; k < components_.size(); ++k) {
    const Real power = components_[k].radius.moment(options_.dimension);
    sum += shares_[k] * power * (options_.dimension == 3 ? sphere_mass(1, 1) : disc_mass(1, 1, 1));
  }
  return sum;
}

Real Mixture::mean_mass_of(int k) const {
  const MixtureComponent& of = component(k);
  if (of.mass) return of.mass->moment(1);
  return of.radius.moment(options_.dimension) * mass_of(of, 1, of.density->moment(1));
}

Real Mixture::smallest_mass_of(int k) const {
  const MixtureComponent& of = component(k);
  return of.mass ? of.mass->smallest() : mass_of(of, of.radius.smallest(), of.density->smallest());
}

Real Mixture::largest_mass_of(int k) const {
  const MixtureComponent& of = component(k);
  return of.mass ? of.mass->largest() : mass_of(of, of.radius.largest(), of.density->largest());
}

Real Mixture::smallest_radius() const {
  Real smallest = kInfinity;
  for (const MixtureComponent& of : components_) smallest = std::min(smallest, of.radius.smallest());
  return smallest;
}

Real Mixture::largest_radius() const {
  Real largest = 0;
  for (const MixtureComponent& of : components_) largest = std::max(largest, of.radius.largest());
  return largest;
}

Real Mixture::smallest_mass() const {
  Real smallest = kInfinity;
  for (std::size_t k = 0; k < components_.size(); ++k)
    smallest = std::min(smallest, smallest_mass_of(static_cast<int>(k)));
  return smallest;
}

Real Mixture::largest_mass() const {
  Real largest = 0;
  for (std::size_t k = 0; k < components_.size(); ++k)
    largest = std::max(largest, largest_mass_of(static_cast<int>(k)));
  return largest;
}

}  // namespace scree
