#include "run/restart/checkpoint_datasets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "dem/reports/triangle_works.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "model/data/body_layout.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "run/population/births.hpp"
#include "run/state/contact_rows.hpp"

namespace scree {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw IoError(path + ": not a valid checkpoint: " + what);
}

// Refuses datasets of `group` that only one of the two maps has, or that differ in their number of values.
template <class Values>
void check_group(const std::string& path, const std::string& group,
                 const std::map<std::string, Values>& found, const std::map<std::string, Values>& expected) {
  for (const auto& [name, values] : expected) {
    const auto there = found.find(name);
    if (there == found.end()) refuse(path, fmt::format("dataset {}/{} is missing", group, name));
    if constexpr (!std::is_same_v<Values, std::string>)
      if (there->second.size() != values.size())
        refuse(path, fmt::format("dataset {}/{} has {} values; the deck's model has {}", group, name,
                                 there->second.size(), values.size()));
  }
  for (const auto& [name, values] : found)
    if (!expected.count(name)) refuse(path, fmt::format("dataset {}/{} is not known", group, name));
}

template <class T>
void check_row_group(const std::string& path, const std::string& group,
                     const std::map<std::string, CheckpointRows<T>>& found,
                     const std::map<std::string, CheckpointRows<T>>& expected) {
  for (const auto& [name, rows] : expected) {
    const auto there = found.find(name);
    if (there == found.end()) refuse(path, fmt::format("dataset {}/{} is missing", group, name));
    if (there->second.width != rows.width)
      refuse(path, fmt::format("dataset {}/{} has {} values per row; it should have {}", group, name,
                               there->second.width, rows.width));
  }
  for (const auto& [name, rows] : found)
    if (!expected.count(name)) refuse(path, fmt::format("dataset {}/{} is not known", group, name));
}

}  // namespace

State sized_state(const Model& model) {
  State sizes;
  const BodyLayout layout(model.bodies);
  sizes.bodies.counted_angles = as_size(counted_angles(model));
  sizes.bodies.position.resize(as_size(layout.positions()) + sizes.bodies.counted_angles);
  for (std::vector<Real>* values :
       {&sizes.bodies.velocity, &sizes.bodies.acceleration, &sizes.bodies.force, &sizes.bodies.applied})
    values->resize(as_size(layout.columns()));
  sizes.bodies.multipliers.resize(as_size(constraint_count(model)));
  sizes.bodies.memory.resize(as_size(memory_count(model)));
  const SurfaceSet surfaces(model);
  const bool driven =
      std::ranges::any_of(model.walls, [](const Wall& wall) { return wall.moves() || wall.is_conveyor(); });
  sizes.bodies.wrench.resize(driven ? surfaces.parents() : model.bodies.size());
  if (std::ranges::any_of(model.walls, [](const Wall& wall) { return wall.is_conveyor(); }))
    sizes.bodies.belt_power.resize(surfaces.parents() - model.bodies.size());
  if (model.output.adds_up_works()) sizes.works.resize(kLimbsPerTriangle * TriangleWorks(model).triangles());
  sizes.there = {model.rotates(), model.rolls()};
  sizes.population = Births(model).start(), sizes.outlets = Outlets(model).start();
  return sizes;
}

void check_datasets(const Checkpoint& checkpoint, const Model& model, const std::vector<std::string>& texts) {
  State sizes = sized_state(model);
  // Older checkpoints have no counted angles of spatial joints.
  if (checkpoint.reals.count("bodies/counted_angles") == 0) {
    sizes.bodies.position.resize(sizes.bodies.position.size() - sizes.bodies.counted_angles);
    sizes.bodies.counted_angles = 0;
  }
  // A model without accumulated works accepts those of a checkpoint, of whatever meshes.
  const bool has_works = checkpoint.integers.count(kWorksName) > 0;
  if (!has_works) sizes.works.clear();
  if (has_works && !model.output.adds_up_works())
    sizes.works.resize(checkpoint.integer_array(kWorksName).size());
  // Energy and particles that wait are stored where there are any.
  if (checkpoint.reals.count(kCarriedInName) > 0) sizes.balance.last.carried_in = 1;
  if (checkpoint.integers.count(kWaitingName) > 0)
    sizes.population.waiting.resize(checkpoint.integer_array(kWaitingName).size());
  if (checkpoint.reals.count(kShapeFrictionLosses) > 0) sizes.shapes.tangential.of[kFrictionLoss] = 1;
  for (auto [name, values] : {std::pair(kShapeContactsOf, &sizes.shape_contacts.shapes),
                              std::pair(kShapeContactsWith, &sizes.shape_contacts.keys),
                              std::pair(kShapeSidesOf, &sizes.shape_contacts.shapes),
                              std::pair(kShapeSidesWith, &sizes.shape_contacts.keys)})
    if (checkpoint.integers.count(name) > 0) values->resize(checkpoint.integer_array(name).size());
  sizes.shape_contacts.content = shape_content_in(checkpoint);
  if (checkpoint.reals.count(kShapeHistory) > 0)
    sizes.shape_contacts.values.resize(checkpoint.real_array(kShapeHistory).size());
  // Contact history and rotation are optional in a checkpoint: without them it starts empty.
  sizes.contacts.content = content_in(checkpoint), sizes.there = fields_there(checkpoint);
  sizes.stop_watches = watches_in(checkpoint);  // of any conditions
  Checkpoint expected = pack(sizes);
  for (const std::string& name : texts) expected.texts[name] = "";
  check_group(checkpoint.path, "/reals", checkpoint.reals, expected.reals);
  check_group(checkpoint.path, "/integers", checkpoint.integers, expected.integers);
  check_group(checkpoint.path, "/texts", checkpoint.texts, expected.texts);
  check_row_group(checkpoint.path, "/real_rows", checkpoint.real_rows, expected.real_rows);
  check_row_group(checkpoint.path, "/integer_rows", checkpoint.integer_rows, expected.integer_rows);
}

}  // namespace scree
