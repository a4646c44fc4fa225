#include "model/builder/mean_mass.hpp"

#include "model/derived/distribution.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

namespace {

// factor: mass over x^power [kg over the unit of x^power].
std::optional<MeanMass> mean_mass_of(const Distribution& x, int power, Real factor) {
  if (x.is_constant() || factor == 0) return {};
  return MeanMass{x.parameters().by, factor * x.moment(power), factor * x.other_reading().moment(power)};
}

}  // namespace

std::optional<MeanMass> mean_mass(const DeckTable& group, Real material_density, int dimension) {
  if (group.has("mass")) return mean_mass_of(read_distribution(group.table("mass"), 1), 1, 1);
  if (!group.has("radius")) return {};
  const Real density =
      group.has("density") ? read_distribution(group.table("density"), 1).moment(1) : material_density;
  const Real factor =
      dimension == 3 ? sphere_mass(1, density) : disc_mass(1, group.real("thickness"), density);
  return mean_mass_of(read_distribution(group.table("radius"), dimension), dimension, factor);
}

}  // namespace scree
