#include "run/record/model_columns.hpp"

#include "base/index.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"

namespace scree {
namespace {

template <class Values>
void cut_to(Values& values, std::int64_t most) {
  if (std::ssize(values) > most) values.resize(as_size(most));
}

}  // namespace

std::vector<RecordedColumn> model_columns(const Model& model) {
  const Output& output = model.output;
  std::vector<Reaction> reactions;
  const auto add_reaction = [&](const std::string& name, const Joint& joint) {
    reactions.push_back({name, {}, {}, between(model, joint.body)});
  };
  const auto joint_of = [&](int joint) -> const Joint& { return model.joints[as_size(joint)]; };
  for (const Joint& joint : model.joints) add_reaction(joint.name, joint);
  for (const Driver& driver : model.drivers) add_reaction(driver.name, joint_of(driver.joint));
  for (const Coupler& coupler : model.couplers) add_reaction(coupler.name, joint_of(coupler.joints[0]));
  cut_to(reactions, output.history_reactions);
  std::vector<JointEffortSample> efforts;
  const auto add_efforts = [&](const auto& elements) {
    for (const auto& element : elements) efforts.push_back({element.name});
  };
  add_efforts(model.motors), add_efforts(model.joint_springs);
  add_efforts(model.joint_limits), add_efforts(model.joint_frictions);
  cut_to(efforts, output.history_efforts);
  std::vector<JointReading> readings;
  std::int64_t left = output.history_coordinates;
  for (const Joint& joint : model.joints) {
    const std::vector<JointCoordinate> own = coordinates_of(joint.kind);
    if (own.empty() || left-- <= 0) continue;
    for (const JointCoordinate coordinate : own) readings.push_back({joint.name, coordinate});
  }
  std::vector<BushingSample> bushings;
  for (const Bushing& bushing : model.bushings) bushings.push_back({bushing.name, {}, {}, {}, {}});
  cut_to(bushings, output.history_bushings);
  return history_columns(model, reactions, efforts, readings, bushings);
}

}  // namespace scree
