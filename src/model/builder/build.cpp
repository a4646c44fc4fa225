#include "model/builder/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/builder/build_parts.hpp"
#include "model/checks/angle_plausibility.hpp"
#include "model/checks/deck_checks.hpp"
#include "model/checks/limits.hpp"
#include "model/checks/memory.hpp"
#include "model/checks/plausibility.hpp"
#include "model/derived/mesh_corners.hpp"

namespace scree {

namespace {

// Larger numbers are mistakes; below this limit counts are exact.
constexpr Real kMostOutputs = 1e9;

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

// The plane of a side of the domain.
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
  std::vector<ChosenValue> chosen;
  return build_model(deck, log, share, chosen);
}

Model build_model(const Deck& deck, Log& log, const Share& share, std::vector<ChosenValue>& chosen) {
  const DeckTable& root = deck.root;
  Model model;
  ModelNames names;
  model.title = root.text("title");
  model.gravity = root.vector("gravity");
  model.consistent_velocities = root.choice<StartVelocities>("velocities") == StartVelocities::consistent;
  build_materials(root, model, names);
  share.collectively([&] { build_meshes(root, model, names, log); });
  build_space(root, names, model);
  build_time(root, model);
  check_time_tables(root, model.time.end, log);
  check_bodies_inside(root, model.space);
  ModelSize size = bodies_and_joints(root);
  naming_memory(size, share.size(), [&] {
    check_memory(size, bytes_to_build_bodies(size, share.rank()), "building the bodies", share);
    build_bodies(root, model, names);
    check_surface_count(root, model);
    build_mesh_corners(model);
    build_markers(root, model, names);
    build_joints(root, model, names);
    build_cylinders(root, model, names);
    build_force_elements(root, model, names);
    build_bushings(root, model, names);
    build_joint_forces(root, model, names);
    build_particles(root, model, names, size, share, log);
    build_inserters(root, model, names, log);
    build_outlets(root, model, names);
    build_contact(root, model, names);
    choose_integrator(root, model, share, chosen);
    check_integrator(root, model);
    check_step_limits(root, model);
    build_steps(root, model, share, chosen);
    build_output(root, names, model);
    build_stop(root, model);
    build_parallel(root, model);
    check_start_positions(root, model, share, log);
    check_steps(root, model, log);
    check_driven_lengths(model, log);
    for (const std::string& finding : implausible(root, model)) log.warning(finding);
    for (const std::string& finding : angles_in_degrees(root)) log.warning(finding);
  });
  log.report_suppressed();
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
  space.leaving = table.choice<OutsidePolicy>("leaving");
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
    if (id >= count && model.inserters.empty()) {
      table.fail(
          "history_particles",
          fmt::format("there is no particle {}; the deck has {} particles, counted from 0", id, count));
    }
    add_once(output.history_particles, id, table, "history_particles", fmt::format("particle {}", id));
  }
  build_history_contacts(table, names, model);
  build_history_regions(table, model);
}

}  // namespace scree
