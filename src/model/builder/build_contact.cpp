// Materials and the contact law of every pair of them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "deck/pair_laws.hpp"
#include "model/builder/build_normal_law.hpp"
#include "model/builder/build_parts.hpp"
#include "model/builder/mixing.hpp"
#include "model/checks/limits.hpp"
#include "model/derived/choose_law.hpp"
#include "model/derived/mesh_corners.hpp"
#include "model/derived/touching.hpp"
#include "physics/cohesion.hpp"
#include "physics/eepa.hpp"
#include "physics/liquid_bridge.hpp"
#include "physics/restitution.hpp"
#include "physics/wear.hpp"

namespace scree {

namespace {

// Throws InputError where particles are given an angular velocity without any friction.
void check_rotation(const DeckTable& deck, const Model& model) {
  if (model.rotates()) return;
  const std::string still = "no particle rotates: no pair in contact.pairs has friction";
  for (const DeckTable& group : deck.tables("particles")) {
    if (std::ranges::any_of(group.reals("angular_velocity"), [](Real one) { return one != 0; }))
      group.fail("angular_velocity", still);
    if (group.has("inertia_factor")) group.fail("inertia_factor", still);
  }
}

bool is_plastic(const NormalLawParameters& law) { return law.own.as<Plasticity>() != nullptr; }
bool has_bridges(const NormalLawParameters& law) { return law.own.as<BridgeParameters>() != nullptr; }
bool is_jkr(const NormalLawParameters& law) { return law.jkr && law.adhesion_work > 0; }
bool pulls(const NormalLawParameters& law) {
  return law.attraction > 0 || (law.adhesion_work > 0 && !law.jkr);
}

// Whether the pair has adhesion that no plastic law has.
bool adheres_elastically(const NormalLawParameters& law) {
  return !is_plastic(law) && (law.adhesion_work > 0 || law.range > 0);
}

// The pairs that have a law so far, and features that some of them have.
struct GivenPairs {
  std::vector<bool> slots;  // indexed as Contact::laws
  bool hertz = false, stiff = false, jkr = false, adhesion = false, bridges = false;
  bool plastic = false, elastic_adhesion = false;

  void add(const NormalLawParameters& law) {
    hertz = hertz || law.effective_modulus > 0, stiff = stiff || (law.acts() && law.effective_modulus == 0);
    jkr = jkr || is_jkr(law), adhesion = adhesion || pulls(law), bridges = bridges || has_bridges(law);
    plastic = plastic || is_plastic(law), elastic_adhesion = elastic_adhesion || adheres_elastically(law);
  }
};

// Throws InputError where pairs have different kinds of laws: a run has one.
void check_mixing(const DeckTable& table, const GivenPairs& before, const NormalLawParameters& law) {
  const bool hertz = law.effective_modulus > 0;
  if (!law.acts() || !(hertz ? before.stiff : before.hertz)) return;
  table.fail("stiffness",
             fmt::format("{}, while a pair before has {}; a deck follows Hertz's law for all pairs "
                         "(none with a stiffness but 0) or for none",
                         hertz ? "missing" : "given", hertz ? "one" : "none"));
}

// Throws InputError where pairs have different kinds of adhesion: a run has JKR contacts, or added adhesive
// forces, or plastic contacts, or liquid bridges.
void check_adhesion_kinds(const DeckTable& table, const GivenPairs& before, const NormalLawParameters& law) {
  if ((is_plastic(law) && before.elastic_adhesion) || (adheres_elastically(law) && before.plastic))
    table.fail(
        is_plastic(law)               ? "plasticity_ratio"
        : table.has("surface_energy") ? "surface_energy"
        : law.adhesion_work > 0       ? "work_of_adhesion"
                                      : "attraction_range",
        "in a deck with a plasticity_ratio, all pairs with a work of adhesion have one, and no pair has an "
        "attraction_range");
  if (!law.is_cohesive()) return;
  const bool jkr = is_jkr(law) || before.jkr, adhesion = pulls(law) || before.adhesion;
  if ((has_bridges(law) || before.bridges) && (jkr || adhesion || is_plastic(law) || before.plastic))
    table.fail(has_bridges(law)              ? "bridge_volume"
               : is_plastic(law)             ? "plasticity_ratio"
               : law.attraction > 0          ? "attraction"
               : table.has("surface_energy") ? "surface_energy"
                                             : "work_of_adhesion",
               "in a deck with liquid bridges no pair has adhesion, an attraction or a plasticity_ratio");
  if (!jkr || !adhesion) return;
  table.fail(table.has("attraction") ? "attraction" : "adhesion",
             "a deck has adhesion = \"jkr\" for all pairs that attract, or \"dmt\" and attraction");
}

// Takes the keys of a law. Throws InputError where they replace parameters that only another law has.
void take_law(const PairLaw& law, const PairInDeck& pair, PairParameters& parameters) {
  const auto all = [](const PairParameters& of) {
    return std::array{of.normal.own, of.friction.own, of.rolling.own};
  };
  const auto before = all(parameters);
  law.take(pair, parameters);
  const auto after = all(parameters);
  for (std::size_t k = 0; k < after.size(); ++k)
    if (before[k] && before[k].operator->() != after[k].operator->())
      pair.table.fail(after[k]->key(),
                      fmt::format("stands beside {}; a pair has one of the two", before[k]->key()));
}

// Parameters of the laws of the pair of these materials.
PairParameters parameters_of(const DeckTable& deck, const DeckTable& table, const Model& model,
                             const int (&material)[2], const GivenPairs& given) {
  PairParameters parameters;
  NormalLawParameters& law = parameters.normal = build_law(deck, table, model, material);
  check_mixing(table, given, law);
  const std::vector<DeckTable>& materials = deck.tables("materials");
  const auto of_material = [&](int side) {
    return materials.empty() ? nullptr : &materials[static_cast<std::size_t>(material[side])];
  };
  const PairInDeck pair{table, {of_material(0), of_material(1)}, model.space.dimension};
  for (const PairLaw& one : pair_laws()) take_law(one, pair, parameters);
  // The damping force of adhesive laws is not limited.
  if (law.is_cohesive() && table.has("restitution"))
    law.damping_ratio = damping_ratio_of(table.real("restitution"), true);
  check_adhesion_kinds(table, given, law);
  return parameters;
}

// Throws InputError where no law serves the pair beside those before it.
void check_served(const DeckTable& table, const Contact& contact, const PairParameters& of_pair) {
  if (has_contact_law(contact)) return;
  const AnyParameters& own = of_pair.normal.own     ? of_pair.normal.own
                             : of_pair.friction.own ? of_pair.friction.own
                                                    : of_pair.rolling.own;
  table.fail(
      own ? own->key() : "stiffness",
      "no contact law has the features of this pair and of the pairs before it; a deck has one law for all "
      "pairs. With adhesion, an attraction, a plasticity_ratio or liquid bridges, all pairs need exponent = "
      "1, or Hertz's law");
}

void build_pair(const DeckTable& deck, const DeckTable& table, Model& model, const ModelNames& names,
                GivenPairs& given) {
  Contact& contact = model.contact;
  int material[2] = {0, 0};
  if (table.has("materials")) {
    for (std::size_t i = 0; i < 2; ++i) {
      material[i] = find_name(names.materials, table.texts("materials")[i], table, "materials", "material");
    }
  } else if (contact.materials() > 1) {
    table.fail("materials", "missing; it must be a list of two materials, as the deck has more than one");
  }
  const PairParameters pair = parameters_of(deck, table, model, material, given);
  if (table.has("friction") || needs_friction(pair.normal)) contact.friction.resize(contact.laws.size());
  if (pair.rolling.act()) contact.rolling.resize(contact.laws.size());
  if (pair.wear_coefficient > 0) contact.wear.resize(contact.laws.size());
  for (int side = 0; side < 2; ++side) {
    const auto slot = static_cast<std::size_t>(material[side] * contact.materials() + material[1 - side]);
    if (given.slots[slot] && (side == 0 || material[0] != material[1])) {
      table.fail("materials", "repeated; every pair of materials must be given once");
    }
    contact.laws[slot] = pair.normal;
    if (table.has("friction")) contact.friction[slot] = pair.friction;
    if (pair.rolling.act()) contact.rolling[slot] = pair.rolling;
    if (pair.wear_coefficient > 0)
      contact.wear[slot] = wear_per_work(pair.wear_coefficient, pair.friction.friction);
    given.slots[slot] = true;
  }
  check_served(table, contact, pair);
  given.add(pair.normal);
}

// Combines the pairs that can meet and are not given, where the deck has a rule. Pairs of meshes and planes
// alone need no law.
void complete_pairs(const DeckTable& deck, Model& model, const ModelNames& names, GivenPairs& given) {
  const DeckTable& table = deck.table("contact");
  const LikePairs like = like_pairs(table);
  const std::vector<MaterialUse> uses = material_uses(model);
  const int count = model.contact.materials();
  const auto is_given = [&](int a, int b) { return given.slots[static_cast<std::size_t>(a * count + b)]; };
  const bool mixes = table.choice<Mixing>("mixing") != Mixing::none;
  for (int a = 0; a < count; ++a) {
    for (int b = a; b < count; ++b) {
      if (is_given(a, b) || !can_touch(model, uses, a, b)) continue;
      if (!must_have_law(model, uses, a, b) && !(mixes && is_given(a, a) && is_given(b, b))) continue;
      const std::string &name_a = model.contact.material_names[static_cast<std::size_t>(a)],
                        &name_b = model.contact.material_names[static_cast<std::size_t>(b)];
      if (a == b || !mixes)
        table.fail(
            "pairs",
            fmt::format("no pair with materials = [\"{}\", \"{}\"], which can meet; every pair that can "
                        "meet must be given in [[contact.pairs]]{}",
                        name_a, name_b, a == b ? "" : ", unless contact.mixing says how it follows"));
      const DeckTable made = combined_pair(table, like, name_a, name_b);
      build_pair(deck, made, model, names, given);
      model.contact.combined.push_back({{a, b}, keys_of(made)});
    }
  }
}

// Throws InputError where two objects could touch through both sides of a periodic axis at once.
void check_periods(const DeckTable& deck, const Model& model, Real largest_radius) {
  const Space& space = model.space;
  const Vec3 extent = space.max - space.min;
  const Real lengths[3] = {extent.x, extent.y, extent.z};
  const Real reach = 2 * (2 * largest_radius + model.contact.interaction_range + model.contact.skin);
  for (int axis = 0; axis < 3; ++axis) {
    if (space.boundary[2 * axis] != Boundary::periodic || lengths[axis] >= reach) continue;
    deck.table("space").fail(
        "max", fmt::format("the periodic space must be at least {} m long in {}: twice the largest "
                           "diameter plus contact.skin and what contacts reach beyond touch",
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
  GivenPairs given{std::vector<bool>(slots, false)};
  for (const DeckTable& pair : table.tables("pairs")) build_pair(deck, pair, model, names, given);
  complete_pairs(deck, model, names, given);
  const auto [of_spheres, largest] = radius_range(model);
  const Real smallest = of_spheres > 0 ? of_spheres : largest_corner_radius(model);
  // Any positive length is valid without particles and shapes.
  const Real standard = smallest > 0 ? 0.2 * smallest : 0.01 * norm(model.space.max - model.space.min);
  contact.skin_is_default = !table.has("skin");
  contact.skin = contact.skin_is_default ? standard : table.real("skin");
  for (const NormalLawParameters& law : contact.laws)
    contact.interaction_range = std::max(contact.interaction_range, contact_search_range(law, largest));
  check_periods(deck, model, largest);
  check_rotation(deck, model);
}

}  // namespace scree
