// Materials and the contact law of every pair of them.
#include <fmt/format.h>

#include <algorithm>

#include "model/build_parts.hpp"
#include "model/limits.hpp"
#include "model/touching.hpp"
#include "physics/restitution.hpp"

namespace scree {

namespace {

// F = K d^n + C d_dot, K given.
KelvinVoigt stiffness_law(const DeckTable& table, bool has_moduli) {
  const KelvinVoigt law{table.real("stiffness"), table.real("damping"), table.real("exponent"),
                        table.boolean("tension")};
  if (law.normal_stiffness == 0 && law.normal_damping > 0)
    table.fail("damping", "must be 0 where the stiffness is 0");
  if (table.has("restitution"))
    table.fail("restitution", "belongs to Hertz's law; a pair with a stiffness has damping instead");
  if (law.acts() && has_moduli)
    table.fail("stiffness",
               "both materials have a young_modulus, too; leave out the stiffness for Hertz's law, or the "
               "moduli for this one");
  return law;
}

void check_moduli(const DeckTable& material) {
  const bool has_modulus = material.has("young_modulus"), has_ratio = material.has("poisson_ratio");
  if (has_modulus != has_ratio)
    material.fail(has_modulus ? "poisson_ratio" : "young_modulus",
                  "missing; Hertz's law takes young_modulus and poisson_ratio together");
}

// Young's modulus over 1 - nu^2 [Pa], or 0 where the material has none.
Real plane_strain_modulus(const DeckTable& material) {
  if (!material.has("young_modulus")) return 0;
  const Real ratio = material.real("poisson_ratio");
  return material.real("young_modulus") / (1 - ratio * ratio);
}

// Hertz's law of spheres; moduli: of the two materials.
KelvinVoigt hertz_law(const DeckTable& table, const Model& model, const Real (&moduli)[2],
                      const int (&material)[2]) {
  for (int side = 0; side < 2; ++side)
    if (moduli[side] == 0)
      table.fail("stiffness",
                 fmt::format("missing; give it or, for Hertz's law, young_modulus and poisson_ratio of both "
                             "materials: \"{}\" has none",
                             model.contact.material_names[static_cast<std::size_t>(material[side])]));
  if (model.space.dimension == 2)
    table.fail("stiffness",
               "missing; Hertz's law is one of spheres, and in 2D there are discs: give a stiffness");
  if (table.real("damping") > 0)
    table.fail("damping", "must be left out for Hertz's law, whose damping follows from restitution");
  if (table.real("exponent") != 1)
    table.fail("exponent", "must be left out for Hertz's law, which has its own");
  KelvinVoigt law;
  law.tension = table.boolean("tension");
  law.effective_modulus = 1 / (1 / moduli[0] + 1 / moduli[1]);
  if (table.has("restitution")) law.damping_ratio = damping_ratio_of(table.real("restitution"), law.tension);
  return law;
}

KelvinVoigt build_law(const DeckTable& deck, const DeckTable& table, const Model& model,
                      const int (&material)[2]) {
  const std::vector<DeckTable>& materials = deck.tables("materials");
  Real moduli[2] = {0, 0};
  for (std::size_t side = 0; side < 2 && !materials.empty(); ++side)
    moduli[side] = plane_strain_modulus(materials[static_cast<std::size_t>(material[side])]);
  if (table.has("stiffness")) return stiffness_law(table, moduli[0] > 0 && moduli[1] > 0);
  return hertz_law(table, model, moduli, material);
}

// G* of two materials with a Young's modulus [Pa].
Real shear_modulus(const DeckTable& a, const DeckTable& b) {
  return effective_shear_modulus(a.real("young_modulus"), a.real("poisson_ratio"), b.real("young_modulus"),
                                 b.real("poisson_ratio"));
}

Friction build_friction(const DeckTable& deck, const DeckTable& table, const KelvinVoigt& law,
                        const int (&material)[2]) {
  if (!table.has("friction")) {
    if (table.has("tangential_stiffness"))
      table.fail("tangential_stiffness", "needs friction beside it: without, contacts do not rub");
    if (table.real("tangential_damping_ratio") > 0)
      table.fail("tangential_damping_ratio", "needs friction beside it: without, contacts do not rub");
    return {};
  }
  Friction friction{.friction = table.real("friction"),
                    .damping_ratio = table.real("tangential_damping_ratio")};
  if (law.effective_modulus > 0) {
    if (table.has("tangential_stiffness"))
      table.fail("tangential_stiffness",
                 "must be left out for Hertz's law: Mindlin's follows from the moduli");
    const std::vector<DeckTable>& materials = deck.tables("materials");
    friction.shear_modulus = shear_modulus(materials[static_cast<std::size_t>(material[0])],
                                           materials[static_cast<std::size_t>(material[1])]);
  } else if (table.has("tangential_stiffness")) {
    friction.stiffness = table.real("tangential_stiffness");
  } else if (law.exponent == 1) {
    friction.stiffness = Real(2) / 7 * law.normal_stiffness;
  } else {
    table.fail("tangential_stiffness", "missing; it follows from the stiffness only where exponent = 1");
  }
  return friction;
}

// Where contacts rub; what that does not go with yet.
void check_friction(const DeckTable& deck, const Model& model) {
  const DeckTable& integrator = deck.table("integrator");
  for (const DeckTable& pair : deck.table("contact").tables("pairs")) {
    if (!pair.has("friction")) continue;
    if (model.integrator.particles != ParticleIntegrator::velocity_verlet)
      pair.fail("friction",
                "needs integrator.particles = \"velocity-verlet\": implicit steps have no friction yet");
    if (model.integrator.precision == Precision::mixed)
      integrator.fail("precision", "must be \"double\" where a pair has friction");
    for (const Body& body : model.bodies)
      if (!body.shapes.empty())
        pair.fail(
            "friction",
            fmt::format("particles do not rub against bodies yet, and body \"{}\" has shapes", body.name));
  }
  if (model.rotates()) return;
  for (const DeckTable& group : deck.tables("particles"))
    if (!group.reals("angular_velocity").empty())
      group.fail("angular_velocity", "no particle rotates: no pair in contact.pairs has friction");
}

// A run has one form of law.
void check_mixing(const DeckTable& table, const Contact& contact, const KelvinVoigt& law) {
  for (const KelvinVoigt& other : contact.laws)
    if (law.acts() && other.acts() && (law.effective_modulus > 0) != (other.effective_modulus > 0))
      table.fail("stiffness",
                 fmt::format("{}, while a pair before has {}; a deck follows Hertz's law for all pairs "
                             "(none with a stiffness but 0) or for none",
                             law.effective_modulus > 0 ? "missing" : "given",
                             law.effective_modulus > 0 ? "one" : "none"));
}

void build_pair(const DeckTable& deck, const DeckTable& table, Model& model, const ModelNames& names,
                std::vector<bool>& given) {
  Contact& contact = model.contact;
  int material[2] = {0, 0};
  if (table.has("materials")) {
    for (std::size_t i = 0; i < 2; ++i) {
      material[i] = find_name(names.materials, table.texts("materials")[i], table, "materials", "material");
    }
  } else if (contact.materials() > 1) {
    table.fail("materials", "missing; it must be a list of two materials, as the deck has more than one");
  }
  const KelvinVoigt law = build_law(deck, table, model, material);
  check_mixing(table, contact, law);
  const Friction friction = build_friction(deck, table, law, material);
  if (table.has("friction")) contact.friction.resize(contact.laws.size());
  for (int side = 0; side < 2; ++side) {
    const auto slot = static_cast<std::size_t>(material[side] * contact.materials() + material[1 - side]);
    if (given[slot] && (side == 0 || material[0] != material[1])) {
      table.fail("materials", "repeated; every pair of materials must be given once");
    }
    contact.laws[slot] = law;
    if (table.has("friction")) contact.friction[slot] = friction;
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
    check_moduli(table);
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
  for (const DeckTable& pair : table.tables("pairs")) build_pair(deck, pair, model, names, given);
  check_pairs(table, model, given);
  const auto [smallest, largest] = radius_range(model);
  // With nothing to search for, any positive length serves.
  const Real standard = smallest > 0 ? 0.2 * smallest : 0.01 * norm(model.space.max - model.space.min);
  contact.skin = table.has("skin") ? table.real("skin") : standard;
  check_periods(deck, model, largest);
  check_friction(deck, model);
}

}  // namespace scree
