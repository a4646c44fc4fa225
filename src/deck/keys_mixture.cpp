// Keys of distributions of the particles' properties, and of mixtures of particles.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

const TableKeys& distribution_keys() {
  using Kind = DistributionKind;
  static constexpr auto limited = {Kind::uniform, Kind::normal, Kind::lognormal, Kind::rosin_rammler};
  static const TableKeys keys{
      "A positive quantity per particle: a number, or a table such as { kind = \"uniform\", min = 0.01, max "
      "= 0.02 }.",
      {choice<Kind>("kind").required().about(
           "Constant: value. Uniform: between min and max. Normal: mean and sd. Lognormal: median and "
           "geometric_sd. Rosin-Rammler (Weibull): scale and exponent; the share exp(-(x / "
           "scale)^exponent) is larger than x. Table: one of values, in proportion to weights. Normal, "
           "lognormal and Rosin-Rammler distributions are cut at min and max."),
       choice<CountedBy>("by")
           .only_for({Kind::uniform, Kind::normal, Kind::lognormal, Kind::rosin_rammler, Kind::table})
           .required_for({Kind::lognormal, Kind::rosin_rammler})
           .left_out("number")
           .about("Whether the distribution is by number of particles or by mass, as from a sieve analysis. "
                  "By mass, the number of particles at a size is in proportion to the mass there, divided by "
                  "the mass of one particle."),
       real("value", kQuantityUnit).only_for({Kind::constant}).above(0).required().about("Value."),
       real("mean", kQuantityUnit)
           .only_for({Kind::normal})
           .above(0)
           .required()
           .about("Mean before truncation."),
       real("sd", kQuantityUnit)
           .only_for({Kind::normal})
           .above(0)
           .required()
           .about("Standard deviation before truncation."),
       real("median", kQuantityUnit)
           .only_for({Kind::lognormal})
           .above(0)
           .required()
           .about("Median before truncation."),
       real("geometric_sd", "")
           .only_for({Kind::lognormal})
           .above(1)
           .required()
           .about("Geometric standard deviation before truncation: the ratio of the values below which 84.1 "
                  "% and 50 % lie."),
       real("scale", kQuantityUnit)
           .only_for({Kind::rosin_rammler})
           .above(0)
           .required()
           .about("Value that 36.8 % exceed, before truncation."),
       real("exponent", "")
           .only_for({Kind::rosin_rammler})
           .above(0)
           .within(0, 1000)
           .required()
           .about("Exponent; the larger, the narrower the distribution."),
       real("min", kQuantityUnit).only_for(limited).above(0).required().about("Smallest."),
       real("max", kQuantityUnit).only_for(limited).above(0).required().about("Largest."),
       reals("values", kQuantityUnit).only_for({Kind::table}).above(0).required().about("Possible values."),
       reals("weights", "")
           .only_for({Kind::table})
           .above(0)
           .left_out("equal")
           .about("Weight of each value.")},
      "kind"};
  return keys;
}

namespace {

Key radius_key() {
  return quantity("radius", "m", distribution_keys())
      .about("Radius, or a distribution from which it is drawn.");
}

// Keys of the kind of particle beside its radius.
std::vector<Key> kind_keys() {
  return {quantity("mass", "kg", distribution_keys())
              .left_out("from density")
              .about("Mass, or a distribution, independent of the radius."),
          quantity("density", "kg/m^3", distribution_keys())
              .left_out("the material's density")
              .about("Density, or a distribution; gives the mass of a sphere (3D), or of a disc of the given "
                     "thickness (2D)."),
          real("thickness", "m").above(0).otherwise("1.0").about("2D: thickness of the discs, for density."),
          real("inertia_factor", "")
              .above(0)
              .within(0, 1)
              .left_out("2/5 (3D) and 1/2 (2D), solid spheres and discs")
              .about("Moment of inertia about the centre over m r^2."),
          text("material").left_out("the only material").about("Material.")};
}

}  // namespace

const TableKeys& mixture_keys() {
  static const TableKeys keys = [] {
    TableKeys made{"Components of a mixture of particles.", {radius_key().required()}, ""};
    for (Key& key : kind_keys()) made.keys.push_back(std::move(key));
    made.keys.push_back(
        real("share", "")
            .above(0)
            .otherwise("1.0")
            .about("Share of the component, relative to those of the others, of the number or "
                   "the mass of the particles (shares_by)."));
    return made;
  }();
  return keys;
}

std::vector<Key> mixture_list_keys() {
  std::vector<Key> keys{
      tables("mixture", mixture_keys()),
      choice<CountedBy>("shares_by")
          .left_out("at most one component")
          .about(
              "Whether the shares of the mixture's components are of the number or of the mass of the "
              "particles. The components' mean masses convert shares of the mass to shares of the number."),
      choice<MixtureShares>("shares")
          .otherwise_choice(MixtureShares::exact)
          .about("Exact: after any number of particles that were due, the number of each component is within "
                 "one particle of its share, and so is that of each of its 16 equally probable size bins. "
                 "Drawn: component and size of each particle are random."),
      radius_key().left_out("mixture is given")};
  for (Key& key : kind_keys()) keys.push_back(std::move(key));
  return keys;
}

}  // namespace scree
