#include "run/record/output_plan.hpp"

#include <cmath>
#include <string>

#include "output/snapshot.hpp"
#include "run/state/step_clock.hpp"

namespace scree {
namespace {

std::int64_t outputs(Real end, Real interval) {
  constexpr Real kMost = 1e15;
  return 1 + static_cast<std::int64_t>(std::fmin(std::ceil(end / interval * (1 - 1e-9)), kMost));
}

// The lists of names, in the order in which the fields number their entries.
std::vector<SeriesNames> names_of(const Model& model) {
  SeriesNames bodies{kBodyNames, {}}, groups{kGroupNames, {}};
  for (const Body& body : model.bodies) bodies.entries.push_back(body.name);
  for (const ParticleGroup& group : model.particles.groups) groups.entries.push_back(group.name);
  return {bodies, {kMaterialNames, model.contact.material_names}, groups};
}

}  // namespace

std::int64_t likely_snapshots(const Model& model) {
  const Real interval = model.output.snapshot_interval;
  return interval == 0 ? 2 : outputs(model.time.end, interval);
}

std::int64_t likely_rows(const Model& model) {
  if (model.output.history_interval > 0) return outputs(model.time.end, model.output.history_interval);
  return model.time.control == StepControl::fixed ? steps_of_fixed(model) + 1 : 0;
}

std::int64_t fewest_rows(const Model& model) {
  const std::int64_t rows = likely_rows(model);
  return rows > 0 ? rows : outputs(model.time.end, model.time.max_step);
}

SeriesOptions series_options(const Model& model) {
  SeriesOptions options{.title = model.title,
                        .compression = model.output.compression,
                        .fields = model.output.fields,
                        .names = names_of(model),
                        .likely_snapshots = likely_snapshots(model)};
  for (const OutputField& field : wanted_fields(model.output))
    if (field.is_constant) options.constant.emplace_back(field.head.name);
  return options;
}

std::vector<PointField> point_fields(const Output& output, const std::vector<OutputValues>& values) {
  const std::vector<OutputField> wanted = wanted_fields(output);
  std::vector<PointField> fields;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const OutputHead& head = wanted[k].head;
    const auto field = [&]<class Value>(const std::vector<Value>& of) -> PointField {
      using Number = OutputNumber<Value>;
      const auto* const numbers = reinterpret_cast<const Number*>(of.data());
      return {head.name, {head.unit, head.description}, sizeof(Value) / sizeof(Number), numbers};
    };
    fields.push_back(std::visit(field, values[k]));
  }
  return fields;
}

}  // namespace scree
