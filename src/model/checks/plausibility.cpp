#include "model/checks/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "deck/choices.hpp"
#include "model/checks/limits.hpp"
#include "model/checks/mesh_plausibility.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/distribution.hpp"
#include "model/derived/touching.hpp"
#include "physics/plausible.hpp"

namespace scree {

namespace {

constexpr Real kMostSizes = 1e5;                  // largest over smallest radius
constexpr Real kMostSteps = 1e9;                  // of a run
constexpr Real kLightest = 1, kHeaviest = 25000;  // densities: aerogel, osmium [kg/m^3]
constexpr Real kMostGyration = 2;                 // radius of gyration relative to a body's extent
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

std::array<Real, 3> components(Vec3 v) { return {v.x, v.y, v.z}; }

std::string and_more(std::size_t count) { return count > 1 ? fmt::format(" and {} more", count - 1) : ""; }

std::string pair_name(const Model& model, const PairLimit& limit) {
  const std::vector<std::string>& names = model.contact.material_names;
  return fmt::format("\"{}\" on \"{}\"", names[static_cast<std::size_t>(limit.material[0])],
                     names[static_cast<std::size_t>(limit.material[1])]);
}

// Base of the domain perpendicular to gravity, on which particles come to rest: area, in 2D length.
Real base_size(const Model& model) {
  const Vec3 extent = model.space.max - model.space.min;
  const Real volume = extent.x * extent.y * (model.space.dimension == 2 ? 1 : extent.z);
  return volume / fall_height(model);
}

std::string nothing_to_simulate(const DeckTable& deck, const Model& model) {
  if (!deck.tables("particles").empty() || !model.inserters.empty())
    return "";  // a warning about empty groups exists
  if (model.bodies.empty())
    return "the deck has no particles and no bodies: nothing will move; was the file cut off?";
  std::string only;
  bool meets = false;  // contacts of bodies that are integrated like those of particles
  const std::vector<MaterialUse> uses = material_uses(model);
  for (int a = 0; a < model.contact.materials(); ++a)
    for (int b = a; b < model.contact.materials(); ++b) {
      if (!model.contact.law(a, b).acts()) continue;
      if (can_touch(model, uses, a, b))
        meets = true;
      else
        only = fmt::format("contact.pairs has a law for \"{}\" on \"{}\", which nothing here can use",
                           model.contact.material_names[static_cast<std::size_t>(a)],
                           model.contact.material_names[static_cast<std::size_t>(b)]);
    }
  if (model.integrator.particles == ParticleIntegrator::velocity_verlet && !meets && only.empty())
    only = setting("integrator.particles", model.integrator.particles);
  return only.empty() ? "" : "the deck has no particles, and yet " + only + "; was the file cut off?";
}

std::string gravity_along_z(const Model& model) {
  const bool planar =
      std::ranges::any_of(model.bodies, [](const Body& body) { return body.kind == BodyKind::planar; });
  if (!planar || model.gravity.z == 0) return "";
  return fmt::format(
      "gravity has {} m/s^2 along z: planar bodies move in the x-y plane only and do not feel it; particles "
      "do",
      model.gravity.z);
}

std::string larger_than_space(const Model& model) {
  const std::array<Real, 3> extent = components(model.space.max - model.space.min);
  const auto axes = static_cast<std::size_t>(model.space.dimension);
  const std::size_t narrow = static_cast<std::size_t>(
      std::min_element(extent.begin(), extent.begin() + static_cast<std::ptrdiff_t>(axes)) - extent.begin());
  const auto finding = [&](const std::string& what, Real radius) {
    return fmt::format("{} of radius {:.4g} m {} larger than the space, {:.4g} m long in {}", what, radius,
                       what.ends_with("more") ? "are" : "is", extent[narrow], kAxes[narrow]);
  };
  const Real particle = model.particles.totals.largest_radius;
  if (2 * particle > extent[narrow]) return finding("a particle", particle);
  const Body* first = nullptr;
  Real radius = 0;
  std::size_t count = 0;
  for (const Body& body : model.bodies)
    for (const Shape& shape : body.shapes)
      if (2 * shape.radius > extent[narrow] && ++count == 1) first = &body, radius = shape.radius;
  return count == 0 ? ""
                    : finding(fmt::format("a shape of body \"{}\"{}", first->name, and_more(count)), radius);
}

// Distance of the farthest shape, mesh or point of action of each body from its centre [m].
std::vector<Real> body_extents(const Model& model) {
  std::vector<Real> extents(model.bodies.size());
  const auto reach = [&](int body, Vec3 point, Real radius) {
    if (body == kGround) return;
    Real& extent = extents[static_cast<std::size_t>(body)];
    extent = std::max(extent, norm(point) + radius);
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (const std::vector<Shape>* shapes : {&body.shapes, &body.drawn_shapes})
      for (const Shape& shape : *shapes) reach(static_cast<int>(b), shape.offset, shape.radius);
    for (const std::vector<MeshShape>* meshes : {&body.meshes, &body.drawn_meshes})
      for (const MeshShape& shape : *meshes) {
        const ModelMesh& mesh = model.meshes[static_cast<std::size_t>(shape.mesh)];
        extents[b] = std::max(extents[b], farthest(mesh, shape.offset, model.space.dimension));
      }
  }
  for (int side = 0; side < 2; ++side) {
    for (const Joint& joint : model.joints) reach(joint.body[side], joint.point[side], 0);
    for (const SpringDamper& spring : model.spring_dampers) reach(spring.body[side], spring.point[side], 0);
    for (const Bushing& bushing : model.bushings) reach(bushing.body[side], bushing.point[side], 0);
  }
  for (const AppliedForce& force : model.applied_forces) reach(force.body, force.point, 0);
  return extents;
}

std::string gyration_beyond_extent(const Model& model) {
  const std::vector<Real> extents = body_extents(model);
  std::size_t first = 0, count = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const bool far = !body.of_solids && extents[b] > 0 &&
                     radius_of_gyration(body.inertia, body.mass) > kMostGyration * extents[b];
    if (far && ++count == 1) first = b;
  }
  if (count == 0) return "";
  const Body& body = model.bodies[first];
  return fmt::format(
      "body \"{}\"{}: inertia {:.4g} kg m^2 and mass {:.4g} kg make a radius of gyration of {:.4g} m, while "
      "its "
      "shapes and joints reach {:.4g} m from its centre",
      body.name, and_more(count), body.inertia, body.mass, radius_of_gyration(body.inertia, body.mass),
      extents[first]);
}

std::string overdamped(const Model& model, const PairLimit& limit) {
  const Real mass = lightest_mass(limit),
             damping = model.contact.law(limit.material[0], limit.material[1]).normal_damping,
             ratio = damping_ratio(damping, limit.stiffness, mass);
  if (ratio <= 1) return "";
  return fmt::format(
      "contact {}: a damping of {:.4g} N s/m is {:.3g} times the critical one of its lightest pair, {:.3g} N "
      "s/m: "
      "nothing rebounds",
      pair_name(model, limit), damping, ratio, damping / ratio);
}

// Number of particles above one in a column of the smallest particles, spread over the whole base: no bed is
// lower on average.
Real particles_on_top(const Model& model) {
  const Real diameter = 2 * model.particles.totals.smallest_radius;
  const Real per_layer = std::max(base_size(model) / std::pow(diameter, model.space.dimension - 1), Real(1));
  return std::clamp(static_cast<Real>(model.particles.totals.count) / per_layer, Real(1),
                    std::max(fall_height(model) / diameter, Real(1)));
}

std::string overlap_at_rest(const Model& model, const std::vector<MaterialUse>& uses,
                            const PairLimit& limit) {
  const ParticleTotals& totals = model.particles.totals;
  if (totals.count == 0 || fall_height(model) == 0) return "";
  const auto particles = [&](int side) {
    return uses[static_cast<std::size_t>(limit.material[side])].particles;
  };
  if (particles(0) + particles(1) == 0) return "";
  const Real stack = particles_on_top(model), weight = weight_at_bottom(model),
             overlap = static_overlap(limit.law, weight);
  if (overlap <= totals.smallest_radius) return "";
  return fmt::format(
      "contact {}: too soft for the weight on it: {:.3g} particles on top of each other weigh {:.3g} N, an "
      "overlap "
      "of {:.3g} m at a radius of {:.3g} m",
      pair_name(model, limit), stack, weight, overlap, totals.smallest_radius);
}

// An open surface pushes a particle back to its side until the centre is one radius beyond; other surfaces
// let it through once its centre has passed the middle.
std::string overlap_at_impact(const Model& model, const std::vector<MaterialUse>& uses,
                              const ImpactSpeeds& speeds, const PairLimit& limit) {
  Real radius = kInfinity;
  for (const int material : limit.material) {
    const MaterialUse& use = uses[static_cast<std::size_t>(material)];
    if (use.smallest_radius > 0) radius = std::min(radius, use.smallest_radius);
  }
  const Real speed = speeds.of(limit);
  const Real overlap = impact_overlap(limit.law, lightest_mass(limit), speed);
  const bool sheets = touch_open_surfaces_only(uses, limit.material[0], limit.material[1]);
  if (overlap <= (sheets ? 2 : 1) * radius) return "";
  return fmt::format(
      "contact {}: the stiffness is too low for impacts at {:.3g} m/s (speeds at t = 0, and a fall through "
      "the space{}): an overlap of {:.3g} m at a radius of {:.3g} m, and things pass through each other",
      pair_name(model, limit), speed,
      speeds.fastest_surface() > 0
          ? fmt::format(", and surfaces that motions, drivers and motors move at up to {:.3g} m/s",
                        speeds.fastest_surface())
          : "",
      overlap, radius);
}

std::string many_sizes(const Model& model) {
  const auto [smallest, largest] = radius_range(model);
  if (smallest == 0 || !(largest >= kMostSizes * smallest)) return "";
  return fmt::format(
      "radii from {:.3g} to {:.3g} m: the cells of the pair search are as wide as the largest, and the many "
      "small "
      "ones in a cell are compared one by one",
      smallest, largest);
}

std::string wide_attraction(const Model& model) {
  const Real smallest = radius_range(model).smallest, reach = model.contact.interaction_range;
  if (smallest == 0 || reach <= smallest) return "";
  // The range of a law's own attraction, as of liquid bridges, has no keys that a shorter one would need.
  if (std::ranges::any_of(model.contact.laws, [](const auto& law) { return law.own->attracts(); })) return "";
  return fmt::format(
      "adhesion acts up to {:.3g} m beyond contact, more than the smallest radius, {:.3g} m: adhesion laws "
      "are for surfaces nearly in contact; use a shorter attraction_range, less work of adhesion, or a "
      "larger modulus",
      reach, smallest);
}

// Whether a random group fills a plain box.
bool is_boxed(const DeckTable& group) {
  return group.has("min") && group.has("max") && !group.has("cylinder_radius") && !group.has("mesh") &&
         !group.has("body");
}

// Such groups have equal positions in their boxes, with equal radii in equal order where those are drawn from
// equal distributions.
std::string same_random_positions(const DeckTable& deck) {
  const auto size = [](const DeckTable& table) { return table.vector("max") - table.vector("min"); };
  const auto alike = [&](const DeckTable& a, const DeckTable& b) {
    constexpr Real kRoundOff = 1e-12;
    return norm(size(a) - size(b)) <= kRoundOff * norm(size(a));
  };
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<const DeckTable*>> others;  // by seed and count
  for (const DeckTable& group : deck.tables("particles")) {
    if (group.choice<GroupKind>("kind") != GroupKind::random || !group.has("count") || !is_boxed(group))
      continue;
    auto& same = others[{group.integer("seed"), group.integer("count")}];
    for (const DeckTable* const other : same)
      if (alike(*other, group))
        return fmt::format(
            "{}: the same count, seed and size of the box as {}: the particles of both groups stand alike in "
            "their boxes; give one of them another seed",
            group.label(), other->path());
    same.push_back(&group);
  }
  return "";
}

std::string odd_density(const DeckTable& deck) {
  const auto finding = [](const DeckTable& table, Real density) -> std::string {
    if (density >= kLightest && density <= kHeaviest) return "";
    return fmt::format("{}.density: no material has {:.4g} kg/m^3 (water 1000, osmium 22600)", table.path(),
                       density);
  };
  for (const DeckTable& table : deck.tables("materials"))
    if (table.has("density"))
      if (const std::string text = finding(table, table.real("density")); !text.empty()) return text;
  for (const DeckTable& table : deck.tables("particles"))
    if (table.has("density")) {
      const Distribution densities = read_distribution(table.table("density"), 1);
      for (const Real density : {densities.smallest(), densities.largest()})
        if (const std::string text = finding(table, density); !text.empty()) return text;
    }
  return "";
}

// For spheres with given masses; a disc may have any thickness.
std::string odd_mass(const DeckTable& deck, const Model& model) {
  const ParticleTotals& totals = model.particles.totals;
  if (model.space.dimension == 2 || totals.count == 0 || !odd_density(deck).empty()) return "";
  const Real lightest = totals.smallest_density, heaviest = totals.largest_density;
  if (lightest >= kLightest && heaviest <= kHeaviest) return "";
  return fmt::format(
      "particles: their masses and radii make a density of {:.4g} kg/m^3, which no material has (water 1000, "
      "osmium "
      "22600)",
      lightest < kLightest ? lightest : heaviest);
}

std::string belt_without_friction(const Model& model) {
  const auto belt = std::ranges::find_if(model.walls, &Wall::is_conveyor);
  if (belt == model.walls.end() || !model.contact.friction.empty()) return "";
  return fmt::format("wall \"{}\": its surface_velocity has no effect: no pair in contact.pairs has friction",
                     belt->name);
}

std::string many_steps(const Model& model) {
  const TimeControl& time = model.time;
  const bool fixed = time.control == StepControl::fixed;
  const Real steps = time.end / (fixed ? time.step : time.max_step) * model.integrator.substeps;
  if (steps <= kMostSteps) return "";
  return fmt::format("time.end / {} = {:.3g} steps{}{}: more than 10^9 take weeks however small the model is",
                     fixed ? "time.step" : "time.max_step", steps,
                     model.integrator.substeps > 1 ? " with their substeps" : "", fixed ? "" : " at least");
}

// The trapezoidal rule does not damp velocity errors perpendicular to constraints whose direction changes.
std::string undamped_joints_in_space(const Model& model) {
  const bool joints = std::ranges::any_of(
      model.joints, [&](const Joint& joint) { return between(model, joint.body) == BodyKind::spatial; });
  if (!joints || model.integrator.hht_alpha != 0) return "";
  return "integrator.hht_alpha = 0 does not damp the reactions of joints that turn in space: within the "
         "steps they oscillate, and do not converge with shorter ones; -0.02 already suffices";
}

}  // namespace

Real weight_at_bottom(const Model& model) {
  if (model.particles.totals.count == 0 || fall_height(model) == 0) return 0;
  return particles_on_top(model) * model.particles.totals.smallest_mass * norm(model.gravity);
}

void check_normal(const DeckTable& table, const std::string& key, Real value) {
  constexpr Real kSmallest = std::numeric_limits<Real>::min();
  if (!(value >= kSmallest))
    table.fail(key, fmt::format("{:.3g} is too small; must be at least {:.3g}", value, kSmallest));
}

std::vector<std::string> implausible(const DeckTable& deck, const Model& model) {
  std::vector<std::string> findings = {nothing_to_simulate(deck, model),
                                       gravity_along_z(model),
                                       larger_than_space(model),
                                       gyration_beyond_extent(model),
                                       undamped_joints_in_space(model),
                                       many_sizes(model),
                                       wide_attraction(model),
                                       odd_density(deck),
                                       odd_mass(deck, model),
                                       belt_without_friction(model),
                                       many_steps(model),
                                       same_random_positions(deck)};
  const ImpactSpeeds speeds(model);
  const std::vector<MaterialUse> uses = material_uses(model);
  for (const PairLimit& limit : pair_limits(model)) {
    findings.push_back(overdamped(model, limit));
    findings.push_back(overlap_at_rest(model, uses, limit));
    findings.push_back(overlap_at_impact(model, uses, speeds, limit));
  }
  const std::vector<std::string> of_meshes = implausible_meshes(deck, model);
  findings.insert(findings.end(), of_meshes.begin(), of_meshes.end());
  std::erase(findings, "");
  return findings;
}

void check_step_limits(const DeckTable& deck, const Model& model) {
  for (const PairLimit& limit : pair_limits(model)) {
    const bool usable = std::isnormal(limit.contact_time) && std::isfinite(limit.explicit_step);
    if (usable) continue;
    deck.table("contact").fail(
        "pairs",
        fmt::format("contact {}: stiffness and masses make contacts of {:.3g} s and velocity-verlet steps "
                    "of {:.3g} s; both must be finite and above 0",
                    pair_name(model, limit), limit.contact_time, limit.explicit_step));
  }
}

}  // namespace scree
