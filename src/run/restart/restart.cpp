#include "run/restart/restart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/index.hpp"
#include "deck/deck.hpp"
#include "deck/differences.hpp"
#include "model/derived/choose_law.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/scalar_function.hpp"
#include "model/derived/time_functions.hpp"
#include "run/restart/checkpoint_datasets.hpp"

namespace scree {
namespace {

using Differences = std::vector<DeckDifference>;

constexpr std::size_t kMostShown = 10;
constexpr const char* kHash = "state_hash";

std::string listed(const Differences& differences) {
  std::string text;
  for (std::size_t i = 0; i < std::min(differences.size(), kMostShown); ++i)
    text += (i == 0 ? "" : "; ") + to_text(differences[i]);
  if (differences.size() > kMostShown) text += fmt::format("; and {} more", differences.size() - kMostShown);
  return text;
}

bool starts_with_any(const std::string& text, std::initializer_list<const char*> starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const char* start) { return text.starts_with(start); });
}

// Whether a key must be the same in both decks. Numbers in a checkpoint follow the order of the deck's
// bodies, joints, drivers and particles, and positions along periodic axes lie on a grid that depends on the
// domain.
bool must_be_equal(const DeckDifference& difference, bool periodic) {
  static const std::set<std::string> kLists = {"",
                                               "bodies",
                                               "joints",
                                               "drivers",
                                               "cylinders",
                                               "motors",
                                               "joint_frictions",
                                               "couplers",
                                               "particles",
                                               "space.dimension",
                                               "bodies.*.count",
                                               "joints.*.type",
                                               "joints.*.bodies",
                                               "joints.*.markers",
                                               "markers.*.body",
                                               "joints.*.chain",
                                               "joints.*.each",
                                               "drivers.*.joint",
                                               "cylinders.*.type",
                                               "cylinders.*.chain",
                                               "cylinders.*.each",
                                               "motors.*.type",
                                               "joint_frictions.*.joint",
                                               "couplers.*.type",
                                               "couplers.*.joints",
                                               "particles.*.kind",
                                               "particles.*.count",
                                               "particles.*.positions",
                                               "particles.*.file",
                                               "particles.*.size"};
  static const std::set<std::string> kSides = {"space.min",   "space.max",   "space.x_min", "space.x_max",
                                               "space.y_min", "space.y_max", "space.z_min", "space.z_max"};
  if (kSides.count(difference.pattern))
    return periodic || difference.before == "\"periodic\"" || difference.after == "\"periodic\"";
  return kLists.count(difference.pattern) > 0;
}

bool is_periodic(const Space& space) {
  return std::count(space.boundary.begin(), space.boundary.end(), Boundary::periodic) > 0;
}

// Functions of time that have the same values up to time t in both decks: with respect to them the checkpoint
// belongs to either deck.
class SameFunctions {
 public:
  SameFunctions(const Deck& before, const Deck& after, Real t) : t_(t) {
    compare(before, after, "drivers", {"motion"}, build_motion);
    compare(before, after, "spring_dampers", {"actuator"}, build_force);
    compare(before, after, "applied_forces", {"fx", "fy", "fz", "torque_x", "torque_y", "torque_z"},
            build_force);
    compare(before, after, "motors", {"effort", "command", "rate"}, build_force);
    compare(before, after, "motors", {"position"}, build_motion);
    compare(before, after, "cylinders", {"force", "speed"}, build_force);
    compare(before, after, "cylinders", {"length"}, build_motion);
  }
  bool hold(const DeckDifference& difference) const {
    return std::any_of(keys_.begin(), keys_.end(),
                       [&](const std::string& key) { return difference.key.starts_with(key + "."); });
  }

 private:
  void compare(const Deck& before, const Deck& after, const std::string& list,
               std::initializer_list<const char*> names, TimeFunction (*build)(const DeckTable&)) {
    const std::vector<DeckTable>& old = before.root.tables(list);
    for (const DeckTable& now : after.root.tables(list)) {
      const auto then = std::find_if(old.begin(), old.end(),
                                     [&](const DeckTable& table) { return table.path() == now.path(); });
      if (then == old.end()) continue;
      for (const char* name : names)
        if (then->has(name) && now.has(name) &&
            ScalarFunction(build(then->table(name)), name, 0)
                .same_until(ScalarFunction(build(now.table(name)), name, 0), t_))
          keys_.push_back(now.path() + "." + name);
    }
  }

  Real t_;
  std::vector<std::string> keys_;
};

// The keys in which the two decks differ for the time up to the checkpoint.
Differences differences_until(const Checkpoint& checkpoint, const RunOptions& options) {
  if (checkpoint.text("fingerprint") == options.fingerprint) return {};
  Differences differences = deck_differences(checkpoint.text("fingerprint"), options.fingerprint);
  const std::vector<Real>& time = checkpoint.real_array("clock/time");
  try {
    const SameFunctions same(parse_deck(checkpoint.text("deck"), "checkpoint", {}),
                             parse_deck(options.resolved_deck, "deck", {}), time.empty() ? 0 : time[0]);
    std::erase_if(differences, [&](const DeckDifference& d) { return same.hold(d); });
  } catch (const InputError&) {  // a deck of a version with other keys: every difference counts
  }
  return differences;
}

[[noreturn]] void refuse(const Differences& differences, const RunOptions& options) {
  throw InputError(fmt::format(
      "--restart {}: the checkpoint belongs to another deck; only title, time.end and the tables output, "
      "stop and parallel may differ. With --allow-changes the run continues, but not bit for bit. Keys that "
      "differ: "
      "{}",
      options.restart, listed(differences)));
}

void check_allowed(const Differences& differences, const Model& model, const RunOptions& options) {
  if (!differences.empty() && !options.allow_changes) refuse(differences, options);
  Differences refused;
  for (const DeckDifference& difference : differences)
    if (must_be_equal(difference, is_periodic(model.space))) refused.push_back(difference);
  if (refused.empty()) return;
  throw InputError(
      fmt::format("--restart {}: the checkpoint's values have no meaning if these keys differ, not even with "
                  "--allow-changes: {}",
                  options.restart, listed(refused)));
}

bool concerns(const DeckDifference& difference, const char* key) {
  return difference.pattern.find(key) != std::string::npos;
}

void check_works(const Checkpoint& checkpoint, const Differences& differences, const Model& model,
                 const RunOptions& options) {
  if (!model.output.adds_up_works()) return;
  for (const DeckDifference& difference : differences)
    if (concerns(difference, "mesh"))
      throw InputError(fmt::format(
          "--restart {}: output.surface_fields selects work or wear, which belong to the triangles of the "
          "checkpoint; the meshes must not change: {}",
          options.restart, to_text(difference)));
  if (checkpoint.integers.count(kWorksName) > 0) return;
  throw InputError(
      fmt::format("--restart {}: output.surface_fields selects work or wear, which count from t = 0, but the "
                  "run that wrote the checkpoint did not accumulate them",
                  options.restart));
}

// Array lengths that do not match belong to another model if the decks differ, otherwise the file is damaged.
void check_fits(const Checkpoint& checkpoint, const Differences& differences, const Model& model,
                const RunOptions& options) {
  try {
    check_datasets(checkpoint, model, kRestartTexts);
  } catch (const IoError& error) {
    if (differences.empty()) throw;
    throw InputError(
        fmt::format("--restart {}: the checkpoint does not fit the model of this deck ({}), not even with "
                    "--allow-changes. Keys that differ: {}",
                    options.restart, error.what(), listed(differences)));
  }
}

// Whether the difference may change the numbers of surfaces or mesh features, which are parts of contact
// keys.
bool renumbers_surfaces(const DeckDifference& difference) {
  return starts_with_any(difference.pattern, {"walls", "space."}) || concerns(difference, "mesh") ||
         concerns(difference, "shapes");
}

// Reduces the contact history to the sides of open surfaces if the new law has another history.
void reduce_to_sides(const Model& model, State& state) {
  const auto differs = [](const auto& contacts, HistoryContent content) {
    return contacts.content.exists() && contacts.content != content;
  };
  const HistoryContent content = packed_content(model, history_of(model.contact));
  if (differs(state.contacts, content)) state.contacts = sides_of(state.contacts, model, content);
  if (differs(state.shape_contacts, content))
    state.shape_contacts = sides_of(state.shape_contacts, model, content);
}

// Applies the values of the new deck. Step data in the state follow from the old deck, forces and
// accelerations from the old model.
void apply(const Differences& differences, const Model& model, Restart& restart) {
  if (differences.empty()) return;
  restart.changed = true;
  bool new_steps = false, other_surfaces = false;
  for (const DeckDifference& difference : differences) {
    new_steps |= starts_with_any(difference.pattern, {"time."});
    other_surfaces |= renumbers_surfaces(difference);
    restart.forces_changed |= !starts_with_any(difference.pattern, {"time.", "integrator."}) ||
                              difference.pattern == "integrator.particles";
    restart.changes += fmt::format("t = {:.9g} s: {}\n", restart.state.clock.time, to_text(difference));
  }
  if (other_surfaces) {
    restart.state.contacts = restart.state.contacts.without_surfaces();
    ShapeContacts& of_shapes = restart.state.shape_contacts;
    of_shapes.shapes.clear(), of_shapes.keys.clear(), of_shapes.values.clear();
  }
  reduce_to_sides(model, restart.state);
  if (new_steps) restart.state.clock = with_new_steps(restart.state.clock, model.time);
}

void check_hash(const State& state, const Checkpoint& checkpoint, const Ranks& ranks) {
  const std::string found = hash_of_all(state, ranks), &written = checkpoint.text(kHash);
  if (found != written)
    throw IoError(fmt::format("{}: the checkpoint is damaged: the hash of its state is {}, but {} was stored",
                              checkpoint.path, found, written));
}

}  // namespace

std::string hash_of_all(const State& state, const Ranks& ranks) {
  const auto own = static_cast<std::int64_t>(state_hash(state, ranks.is_root()));
  return fmt::format("{:016x}", static_cast<std::uint64_t>(ranks.sum(own)));
}

void add_restart_texts(Checkpoint& checkpoint, const RunOptions& options, const std::string& state_hash,
                       const std::string& changes, const std::vector<RunStart>& starts) {
  checkpoint.texts["fingerprint"] = options.fingerprint;
  checkpoint.texts["deck"] = options.resolved_deck;
  checkpoint.texts[kHash] = state_hash;
  checkpoint.texts["changes"] = changes;
  checkpoint.texts["starts"] = to_text(starts);
}

Restart read_restart(const Model& model, const RunOptions& options, Log& log) {
  const Ranks& ranks = options.ranks;
  const Checkpoint checkpoint = read_checkpoint(options.restart, ranks);
  Restart restart;
  Differences differences;
  ranks.collectively([&] {
    differences = differences_until(checkpoint, options);
    check_allowed(differences, model, options);
    check_works(checkpoint, differences, model, options);
    check_fits(checkpoint, differences, model, options);
    restart.starts = starts_in(checkpoint.text("starts"), options.restart);
  });
  restart.state = unpack(checkpoint, ranks);
  check_state(restart.state, options.restart, model.particles, ranks);
  ranks.collectively([&] {
    if (differences.empty()) check_constants(restart.state, options.restart, model.particles.totals);
  });
  check_hash(restart.state, checkpoint, ranks);
  if (!model.output.adds_up_works()) restart.state.works = {};
  // A checkpoint of a version without counted angles: they are counted from here on.
  MultibodyState& bodies = restart.state.bodies;
  const auto angles = as_size(counted_angles(model));
  bodies.position.resize(bodies.position.size() - bodies.counted_angles + angles, 0);
  bodies.counted_angles = angles;
  restart.changes = checkpoint.text("changes");
  apply(differences, model, restart);
  if (restart.changed)
    log.warning(fmt::format(
        "--allow-changes: from t = {:.9g} s on the run has another deck, and its results are not bit for bit "
        "those of either{}. Keys that differ: {}",
        restart.state.clock.time, restart.forces_changed ? "; forces and accelerations are recomputed" : "",
        listed(differences)));
  return restart;
}

}  // namespace scree
