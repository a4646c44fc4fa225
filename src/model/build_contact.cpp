// Materials and the contact law of every pair of them.
#include <fmt/format.h>

#include <algorithm>

#include "model/build_parts.hpp"
#include "model/limits.hpp"
#include "model/touching.hpp"

namespace scree {

namespace {

void build_pair(const DeckTable& table, Contact& contact, const ModelNames& names, std::vector<bool>& given) {
  int material[2] = {0, 0};
  if (table.has("materials")) {
    for (std::size_t i = 0; i < 2; ++i) {
      material[i] = find_name(names.materials, table.texts("materials")[i], table, "materials", "material");
    }
  } else if (contact.materials() > 1) {
    table.fail("materials", "missing; it must be a list of two materials, as the deck has more than one");
  }
  const KelvinVoigt law{table.real("stiffness"), table.real("damping"), table.real("exponent"),
                        table.boolean("tension")};
  if (law.normal_stiffness == 0 && law.normal_damping > 0) {
    table.fail("damping", "must be 0 where the stiffness is 0");
  }
  for (int side = 0; side < 2; ++side) {
    const auto slot = static_cast<std::size_t>(material[side] * contact.materials() + material[1 - side]);
    if (given[slot] && (side == 0 || material[0] != material[1])) {
      table.fail("materials", "repeated; every pair of materials must be given once");
    }
    contact.laws[slot] = law;
    given[slot] = true;
  }
}

// Every pair that can meet needs a law.
void check_pairs(const DeckTable& table, const Model& model, const std::vector<bool>& given) {
  const std::vector<MaterialUse> uses = material_uses(model);
  const int count = model.contact.materials();
  for (int a = 0; a < count; ++a) {
    for (int b = a; b < count; ++b) {
      if (given[static_cast<std::size_t>(a * count + b)] || !can_meet(model, uses, a, b)) continue;
      table.fail("pairs",
                 fmt::format("no pair with materials = [\"{}\", \"{}\"], which can meet; every pair that can "
                             "meet must be given in [[contact.pairs]]",
                             model.contact.material_names[static_cast<std::size_t>(a)],
                             model.contact.material_names[static_cast<std::size_t>(b)]));
    }
  }
}

// Two items must not meet through both sides of a periodic axis at once.
void check_periods(const DeckTable& deck, const Model& model, Real largest_radius) {
  const Space& space = model.space;
  const Vec3 extent = space.max - space.min;
  const Real lengths[3] = {extent.x, extent.y, extent.z};
  const Real reach = 2 * (2 * largest_radius + model.contact.skin);
  for (int axis = 0; axis < 3; ++axis) {
    if (space.boundary[2 * axis] != Boundary::periodic || lengths[axis] >= reach) continue;
    deck.table("space").fail(
        "max", fmt::format("the periodic space must be at least {} m long in {}: twice the largest "
                           "diameter plus contact.skin",
                           reach, "xyz"[axis]));
  }
}

}  // namespace

void build_materials(const DeckTable& deck, Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("materials")) {
    const std::string& name = table.text("name");
    add_name(names.materials, name, model.contact.materials(), table);
    names.densities.push_back(table.has("density") ? table.real("density") : 0);
    model.contact.material_names.push_back(name);
  }
  if (!model.contact.material_names.empty()) return;
  names.materials.emplace("default", 0);
  names.densities.push_back(0);
  model.contact.material_names.emplace_back("default");
}

void build_contact(const DeckTable& deck, Model& model, const ModelNames& names) {
  const DeckTable& table = deck.table("contact");
  Contact& contact = model.contact;
  const auto slots =
      static_cast<std::size_t>(contact.materials()) * static_cast<std::size_t>(contact.materials());
  contact.laws.assign(slots, {});
  contact.connected_bodies_touch = table.boolean("connected_bodies_touch");
  std::vector<bool> given(slots, false);
  for (const DeckTable& pair : table.tables("pairs")) build_pair(pair, contact, names, given);
  check_pairs(table, model, given);
  const auto [smallest, largest] = radius_range(model);
  // With nothing to search for, any positive length serves.
  const Real standard = smallest > 0 ? 0.2 * smallest : 0.01 * norm(model.space.max - model.space.min);
  contact.skin = table.has("skin") ? table.real("skin") : standard;
  check_periods(deck, model, largest);
}

}  // namespace scree
