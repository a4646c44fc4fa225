#include "model/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/angle_plausibility.hpp"
#include "model/build_parts.hpp"
#include "model/limits.hpp"
#include "model/memory.hpp"
#include "model/plausibility.hpp"

namespace scree {

namespace {

// More cannot be meant, and counts of them must stay exact.
constexpr Real kMostSteps = 1e12, kMostOutputs = 1e9;

void build_boundaries(const DeckTable& table, Space& space) {
  for (int side = 0; side < kSides; ++side) space.boundary[side] = table.choice<Boundary>(kSideNames[side]);
  for (int side = kXMin; side < kSides; side += 2) {
    const bool first = space.boundary[side] == Boundary::periodic;
    const bool second = space.boundary[side + 1] == Boundary::periodic;
    if (first == second) continue;
    const int other = first ? side + 1 : side;
    table.fail(kSideNames[first ? side : side + 1],
               fmt::format("periodic sides come in pairs; {} must be \"periodic\" too", kSideNames[other]));
  }
  for (int side = kZMin; side <= kZMax && space.dimension == 2; ++side) {
    if (space.boundary[side] != Boundary::open)
      table.fail(kSideNames[side], "a space of dimension 2 has no z sides");
  }
}

// Short enough for any contact; from there on the step control goes by the error [s].
Real first_step(const Model& model) {
  constexpr Real kShareOfContact = 0.05, kShareOfRun = 1e-3;
  const std::optional<PairLimit> shortest = shortest_contact(pair_limits(model));
  const Real longest = kShareOfRun * model.time.end;
  return shortest ? std::min(kShareOfContact * shortest->contact_time, longest) : longest;
}

// In a longer one a particle as fast as at t = 0 that then fell through the space would go farther than half
// of the smallest radius, and might pass through others unnoticed: no error estimate says so [s].
Real longest_step(const Model& model) {
  constexpr Real kShareOfRadius = 0.5, kShareOfRun = 1e-2;
  const ParticleTotals& particles = model.particles.totals;
  const Real longest = kShareOfRun * model.time.end;
  if (particles.count == 0) return longest;
  const Vec3 extent = model.space.max - model.space.min, g = model.gravity;
  const Real fall = std::abs(g.x) * extent.x + std::abs(g.y) * extent.y + std::abs(g.z) * extent.z;
  const Real radii_per_second =
      std::hypot(particles.most_radii_per_second, std::sqrt(2 * fall) / particles.smallest_radius);
  return radii_per_second * longest > kShareOfRadius ? kShareOfRadius / radii_per_second : longest;
}

// The plane of a side of the space.
Wall side_wall(const Space& space, int side) {
  Wall wall{kSideNames[side], side % 2 == 0 ? space.min : space.max, {}, space.wall_material};
  const Real sign = side % 2 == 0 ? 1 : -1;
  if (side / 2 == 0) wall.normal.x = sign;
  if (side / 2 == 1) wall.normal.y = sign;
  if (side / 2 == 2) wall.normal.z = sign;
  return wall;
}

}  // namespace

Model build_model(const Deck& deck, Log& log, const Share& share) {
  const DeckTable& root = deck.root;
  Model model;
  ModelNames names;
  model.title = root.text("title");
  model.gravity = root.vector("gravity");
  model.consistent_velocities = root.choice<StartVelocities>("velocities") == StartVelocities::consistent;
  build_materials(root, model, names);
  share.together([&] { build_meshes(root, model, names); });
  build_space(root, names, model);
  build_time(root, model);
  check_time_tables(root, model.time.end, log);
  check_bodies_inside(root, model.space);
  ModelSize size = bodies_and_links(root);
  naming_memory(size, share.size(), [&] {
    check_memory(size, bytes_to_build_bodies(size, share.rank()), "building the bodies", share);
    build_bodies(root, model, names);
    check_surface_count(root, model);
    build_markers(root, model, names);
    build_joints(root, model, names);
    build_force_elements(root, model, names);
    build_bushings(root, model, names);
    build_joint_forces(root, model, names);
    build_particles(root, model, names, size, share, log);
    build_contact(root, model, names);
    check_step_limits(root, model);
    build_steps(root, model);
    build_output(root, names, model);
    build_parallel(root, model);
    check_start_positions(root, model, share, log);
    check_steps(root, model, log);
    for (const std::string& finding : implausible(root, model)) log.warning(finding);
    for (const std::string& finding : angles_in_degrees(root)) log.warning(finding);
  });
  return model;
}

void build_space(const DeckTable& deck, const ModelNames& names, Model& model) {
  const DeckTable& table = deck.table("space");
  Space& space = model.space;
  space.dimension = static_cast<int>(table.integer("dimension"));
  space.min = table.vector("min");
  space.max = table.vector("max");
  const Vec3 extent = space.max - space.min;
  if (!(extent.x > 0) || !(extent.y > 0) || (space.dimension == 3 && !(extent.z > 0))) {
    table.fail("max", "must be larger than space.min in every component");
  }
  build_boundaries(table, space);
  space.leaving = table.choice<Leaving>("leaving");
  for (const DeckTable& entry : deck.tables("walls")) {
    const auto side = std::find(kSideNames.begin(), kSideNames.end(), entry.text("name"));
    if (side != kSideNames.end() &&
        space.boundary[static_cast<std::size_t>(side - kSideNames.begin())] == Boundary::wall)
      entry.fail("name", "is the name of a side of the space that is a wall; choose another one");
    model.walls.push_back(build_wall(entry, names, space));
  }
  const bool walled = std::count(space.boundary.begin(), space.boundary.end(), Boundary::wall) > 0;
  if (walled || table.has("wall_material"))
    space.wall_material = find_material(names, table, "wall_material");
  for (int side = 0; side < kSides; ++side) {
    if (space.boundary[side] == Boundary::wall) model.walls.push_back(side_wall(space, side));
  }
}

void build_time(const DeckTable& deck, Model& model) {
  const DeckTable& table = deck.table("time");
  TimeControl& time = model.time;
  time.end = table.real("end");
  time.control = table.choice<StepControl>("control");
  const bool adaptive = time.control == StepControl::adaptive;
  if (adaptive) time.tolerance = table.real("tolerance");

  const DeckTable& method = deck.table("integrator");
  Integrator& integrator = model.integrator;
  integrator.hht_alpha = method.real("hht_alpha");
  integrator.corrected_start = method.boolean("corrected_start");
  integrator.redundant = method.choice<RedundantRows>("redundant");
  integrator.particles = method.choice<ParticleIntegrator>("particles");
  integrator.resolve_events = method.choice<ContactEvents>("contact_events") == ContactEvents::resolved;
  integrator.substeps = static_cast<int>(method.integer("substeps"));
  integrator.precision = method.choice<Precision>("precision");
  integrator.residual_tolerance = method.real("residual_tolerance");
  integrator.correction_tolerance = method.real("correction_tolerance");
  integrator.max_iterations = static_cast<int>(method.integer("max_iterations"));
  const bool implicit = integrator.particles == ParticleIntegrator::hht;
  if (implicit && integrator.substeps > 1) {
    method.fail("substeps", "must be 1, unless integrator.particles = \"velocity-verlet\"");
  }
  if (implicit && integrator.precision == Precision::mixed) {
    method.fail("precision", "must be \"double\", unless integrator.particles = \"velocity-verlet\"");
  }
  if (!implicit && adaptive) {
    method.fail("particles",
                "time.control = \"adaptive\" needs \"hht\": the explicit method has no error estimate");
  }
}

void build_steps(const DeckTable& deck, Model& model) {
  const DeckTable& table = deck.table("time");
  TimeControl& time = model.time;
  const bool adaptive = time.control == StepControl::adaptive;
  time.max_step = table.has("max_step") ? table.real("max_step") : longest_step(model);
  time.step = table.has("step") ? table.real("step") : std::min(first_step(model), time.max_step);
  time.min_step = table.has("min_step") ? table.real("min_step") : time.step / (adaptive ? 1e6 : 1e3);
  if (!table.has("max_step")) time.max_step = adaptive ? std::max(time.step, time.max_step) : time.step;
  if (time.step > time.end) table.fail("step", fmt::format("must be at most time.end = {}", time.end));
  if (time.end / time.step > kMostSteps)
    table.fail("step",
               fmt::format("must be at least time.end / {:g} = {:g}", kMostSteps, time.end / kMostSteps));
  if (time.min_step > time.step)
    table.fail("min_step", fmt::format("must be at most time.step = {}", time.step));
  if (time.max_step < time.step)
    table.fail("max_step", fmt::format("must be at least time.step = {}", time.step));
}

void build_parallel(const DeckTable& deck, Model& model) {
  const DeckTable& table = deck.table("parallel");
  model.parallel.imbalance = table.real("imbalance");
  model.parallel.transport = table.choice<Transport>("transport");
}

void build_output(const DeckTable& deck, const ModelNames& names, Model& model) {
  const DeckTable& table = deck.table("output");
  Output& output = model.output;
  output.directory = table.text("directory");
  output.snapshot_interval = table.real("snapshot_interval");
  output.history_interval = table.real("history_interval");
  output.checkpoint_interval = table.real("checkpoint_interval");
  output.checkpoint_wall_interval = table.real("checkpoint_wall_interval");
  output.history_csv = table.boolean("history_csv");
  output.contacts = table.boolean("contacts"), output.links = table.boolean("links");
  output.compression = static_cast<int>(table.integer("compression"));
  output.history_reactions = table.integer("history_reactions");
  output.history_efforts = table.integer("history_efforts");
  output.history_coordinates = table.integer("history_coordinates");
  output.history_bushings = table.integer("history_bushings");
  output.fields = table.texts("fields");
  build_surface_fields(table, model);
  for (const char* key : {"snapshot_interval", "history_interval", "checkpoint_interval"}) {
    const Real interval = table.real(key);
    if (interval > 0 && interval * kMostOutputs < model.time.end)
      table.fail(key, fmt::format("must be 0 or at least time.end / {:g} = {:g}", kMostOutputs,
                                  model.time.end / kMostOutputs));
  }
  for (const std::string& name : table.texts("history_bodies")) {
    const auto single = names.bodies.find(name);
    const std::vector<int> bodies = single != names.bodies.end()
                                        ? std::vector{single->second}
                                        : find_row(names, name, table, "history_bodies");
    for (const int body : bodies)
      add_once(output.history_bodies, body, table, "history_bodies",
               fmt::format("body \"{}\"", model.bodies[static_cast<std::size_t>(body)].name));
  }
  const std::int64_t count = model.particles.totals.count;
  for (const std::int64_t id : table.integers("history_particles")) {
    if (id >= count) {
      table.fail(
          "history_particles",
          fmt::format("there is no particle {}; the deck has {} particles, counted from 0", id, count));
    }
    add_once(output.history_particles, id, table, "history_particles", fmt::format("particle {}", id));
  }
  build_history_contacts(table, names, model);
}

}  // namespace scree
