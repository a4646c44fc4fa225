// Distributions of a positive quantity of particles: radius, mass or density.
#pragma once

#include <memory>
#include <vector>

#include "base/types.hpp"
#include "deck/choices.hpp"
#include "deck/deck.hpp"

namespace scree {

// A distribution of x > 0, truncated to [min, max]. Values are in the quantity's unit.
struct DistributionParameters {
  DistributionKind kind = DistributionKind::constant;
  CountedBy by = CountedBy::number;  // what the density of the distribution counts
  Real value = 0;                    // constant
  Real min = 0, max = 0;
  Real mean = 0, sd = 0;                  // normal, before truncation
  Real median = 0, geometric_sd = 0;      // lognormal, before truncation; geometric_sd > 1, without unit
  Real scale = 0, exponent = 0;           // Rosin-Rammler: R(x) = exp(-(x / scale)^exponent) is larger than x
  std::vector<Real> values{}, weights{};  // table: possible values; weights > 0, as many
};

// The quantile function of a distribution by number, and its moments.
class Distribution {
 public:
  // mass_power: the mass of a particle is proportional to x^mass_power (radius: the dimension of space; mass,
  // density: 1). It converts a distribution by mass to one by number.
  Distribution(const DistributionParameters& parameters, int mass_power);

  // The x below which the fraction u of all particles lies, by number. u: in [0, 1). Monotone.
  Real quantile(Real u) const;
  Real smallest() const { return parameters_.min; }
  Real largest() const { return parameters_.max; }
  bool is_constant() const { return smallest() == largest(); }
  // Mean of x^power by number, from a quadrature with a relative error below 1e-12.
  Real moment(int power) const;
  const DistributionParameters& parameters() const { return parameters_; }
  const DistributionParameters& given() const { return given_; }  // as the caller gave them
  int mass_power() const { return mass_power_; }
  // The distribution with the same parameters whose density counts the other of number and mass.
  Distribution other_reading() const;

 private:
  struct Integrals;
  // Limits so close that the density between them does not matter.
  bool is_narrow() const { return largest() - smallest() <= 1e-6 * smallest(); }
  void take_table();
  Real uniform_quantile(Real u) const;

  DistributionParameters parameters_;  // a table in ascending order, with weights by number that add up to 1
  DistributionParameters given_;       // as the caller gave them
  int mass_power_;
  std::shared_ptr<const Integrals> integrals_;  // of normal, lognormal and Rosin-Rammler distributions
};

// Share of the distribution before truncation that is from min to max, by what it counts; 1 for kinds that
// are not truncated.
Real share_within_limits(const DistributionParameters& parameters);

// The distribution that a quantity of the deck gives. Throws InputError on invalid limits or weights.
Distribution read_distribution(const DeckTable& quantity, int mass_power);

}  // namespace scree
