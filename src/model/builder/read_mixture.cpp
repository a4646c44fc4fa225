#include "model/builder/read_mixture.hpp"

#include <fmt/format.h>

#include "model/checks/plausibility.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

namespace {

Distribution density_of(const DeckTable& table, const ModelNames& names, int material) {
  if (table.has("density")) return read_distribution(table.table("density"), 1);
  DistributionParameters constant;
  constant.value = names.densities[static_cast<std::size_t>(material)];
  if (constant.value == 0)
    table.fail("density", "missing; mass or density is needed, or a material with a density");
  return {constant, 1};
}

// Values outside the range of normal numbers of the machine would make the mass of a particle 0 or infinite.
void check_masses(const DeckTable& table, const MixtureComponent& of, int dimension) {
  const Mixture alone({of}, {.dimension = dimension});
  for (const Real r : {alone.smallest_radius(), alone.largest_radius()}) check_normal(table, "radius", r);
  for (const Real m : {alone.smallest_mass(), alone.largest_mass()})
    check_normal(table, of.mass ? "mass" : "radius", m);
}

MixtureComponent read_component(const DeckTable& table, const ModelNames& names, int dimension) {
  const int material = find_material(names, table, "material");
  MixtureComponent component{material, read_distribution(table.table("radius"), dimension)};
  if (table.has("mass") && table.has("density")) table.fail("density", "not used together with mass");
  if (table.has("mass"))
    component.mass = read_distribution(table.table("mass"), 1);
  else
    component.density = density_of(table, names, material);
  component.thickness = table.real("thickness");
  component.inertia_factor =
      table.has("inertia_factor") ? table.real("inertia_factor") : solid_inertia_factor(dimension);
  check_masses(table, component, dimension);
  return component;
}

}  // namespace

Mixture read_mixture(const DeckTable& table, const ModelNames& names, int dimension) {
  const std::vector<DeckTable>& given = table.tables("mixture");
  MixtureOptions options{.seed = static_cast<std::uint64_t>(table.integer("seed")),
                         .dimension = dimension,
                         .shares = table.choice<MixtureShares>("shares")};
  std::vector<MixtureComponent> components;
  if (given.empty()) {
    if (!table.has("radius"))
      table.fail("radius", "missing; it must be a number above 0 [m] or a distribution, or mixture be given");
    components.push_back(read_component(table, names, dimension));
    return {std::move(components), options};
  }
  for (const char* key : {"radius", "mass", "density", "inertia_factor", "material"})
    if (table.has(key)) table.fail(key, "not used together with mixture, whose components have it");
  for (const DeckTable& one : given) {
    components.push_back(read_component(one, names, dimension));
    components.back().share = one.real("share");
  }
  if (given.size() > 1 && !table.has("shares_by"))
    table.fail("shares_by", fmt::format("missing; it must be \"{}\" or \"{}\"", word_of(CountedBy::number),
                                        word_of(CountedBy::mass)));
  if (table.has("shares_by")) options.counted_by = table.choice<CountedBy>("shares_by");
  return {std::move(components), options};
}

}  // namespace scree
