// Each column of the history shows its own value.
#include "run/record/history_columns.hpp"

#include <cmath>
#include <map>

#include "support/catch.hpp"

namespace scree {

namespace {

Model recorded_model() {
  Model model;
  model.bodies.resize(2);
  model.bodies[1].name = "arm";
  model.output.history_bodies = {1};
  model.output.history_particles = {8};
  model.output.history_contacts = {{"arm", {1}, false, -1}, {"floor", {}, false, 0}};
  return model;
}

// All numbers differ.
HistorySample distinct_sample() {
  HistorySample s;
  s.time = 1, s.step = 2;
  s.counts.steps = 3, s.counts.newton_iterations = 4, s.counts.linear_iterations = 5;
  s.counts.rejected_error = 6, s.counts.rejected_newton = 7;
  s.particles.contacts = 8, s.left = 9, s.bodies_outside = 10;
  s.ledger.kinetic = 11, s.ledger.gravitational = 12, s.ledger.elastic_force_elements = 13;
  s.ledger.elastic_contacts = 14, s.ledger.dissipated_force_elements = 15;
  s.ledger.dissipated_contacts = 16, s.ledger.dissipated_integrator = 17;
  s.ledger.driver_work = 18, s.ledger.carried_out = 19;
  s.balance_error = 21, s.exchanged = 22;
  s.particles.momentum = {23, 24, 25}, s.particles.angular_momentum = {26, 27, 28};
  s.reactions = {{"pin", {29, 30, 0}, {0, 0, 31}}};
  s.contacts = {{{32, 33, 34}, {35, 36, 37}, 38}, {{39, 40, 41}, {42, 43, 44}, 45}};
  s.bodies = {{}, {{46, 47, 48}, {49, 51, 52}, 53, 54}};
  s.traced = {{8, {55, 56, 57}, {58, 59, 60}}};
  s.coordinates = {{"nut", JointCoordinate::angle, 71, 72}, {"nut", JointCoordinate::displacement, 73, 74}};
  return s;
}

}  // namespace

TEST_CASE("a column's value is that of its name") {
  const HistorySample sample = distinct_sample();
  std::map<std::string, Real> found;
  for (const RecordedColumn& column :
       history_columns(recorded_model(), sample.reactions, {}, sample.coordinates)) {
    const std::string path = column.head.group + "/" + column.head.name;
    CAPTURE(path);
    CHECK(found.emplace(path, column.value(sample)).second);
    CHECK_FALSE(column.head.unit.empty());
    CHECK_FALSE(column.head.description.empty());
  }
  const std::map<std::string, Real> expected{{"step/time", 1},
                                             {"step/length", 2},
                                             {"step/steps", 3},
                                             {"step/newton_iterations", 4},
                                             {"step/linear_iterations", 5},
                                             {"step/rejected_error", 6},
                                             {"step/rejected_newton", 7},
                                             {"step/contacts", 8},
                                             {"step/particles_escaped", 9},
                                             {"step/bodies_outside", 10},
                                             {"energy/kinetic", 11},
                                             {"energy/gravitational", 12},
                                             {"energy/elastic_force_elements", 13},
                                             {"energy/elastic_contacts", 14},
                                             {"energy/dissipated_force_elements", 15},
                                             {"energy/dissipated_contacts", 16},
                                             {"energy/dissipated_integrator", 17},
                                             {"energy/driver_work", 18},
                                             {"energy/carried_out", 19},
                                             {"energy/total", 11 + 12 + 13 + 14},
                                             {"energy/balance_error", 21},
                                             {"energy/exchanged", 22},
                                             {"momentum/linear_x", 23},
                                             {"momentum/linear_y", 24},
                                             {"momentum/linear_z", 25},
                                             {"momentum/angular_x", 26},
                                             {"momentum/angular_y", 27},
                                             {"momentum/angular_z", 28},
                                             {"reactions/pin/fx", 29},
                                             {"reactions/pin/fy", 30},
                                             {"reactions/pin/torque", 31},
                                             {"coordinates/nut/angle", 71},
                                             {"coordinates/nut/angle_rate", 72},
                                             {"coordinates/nut/displacement", 73},
                                             {"coordinates/nut/displacement_rate", 74},
                                             {"contacts/arm/fx", 32},
                                             {"contacts/arm/fy", 33},
                                             {"contacts/arm/fz", 34},
                                             {"contacts/arm/torque_x", 35},
                                             {"contacts/arm/torque_y", 36},
                                             {"contacts/arm/torque_z", 37},
                                             {"contacts/arm/contacts", 38},
                                             {"contacts/floor/fx", 39},
                                             {"contacts/floor/fy", 40},
                                             {"contacts/floor/fz", 41},
                                             {"contacts/floor/torque_x", 42},
                                             {"contacts/floor/torque_y", 43},
                                             {"contacts/floor/torque_z", 44},
                                             {"contacts/floor/contacts", 45},
                                             {"bodies/arm/x", 46},
                                             {"bodies/arm/y", 47},
                                             {"bodies/arm/z", 48},
                                             {"bodies/arm/vx", 49},
                                             {"bodies/arm/vy", 51},
                                             {"bodies/arm/vz", 52},
                                             {"bodies/arm/angle", 53},
                                             {"bodies/arm/angular_velocity", 54},
                                             {"particles/8/x", 55},
                                             {"particles/8/y", 56},
                                             {"particles/8/z", 57},
                                             {"particles/8/vx", 58},
                                             {"particles/8/vy", 59},
                                             {"particles/8/vz", 60}};
  CHECK(found == expected);
}

// A quarter revolution about z: the marker's x is the global y.
TEST_CASE("reactions between spatial bodies, also along the axes of the marker") {
  HistorySample sample = distinct_sample();
  sample.reactions[0] = {"pin", {1, 2, 3}, {4, 5, 6}, BodyKind::spatial, exponential({0, 0, M_PI / 2})};
  std::map<std::string, Real> found;
  for (const RecordedColumn& column : history_columns(recorded_model(), sample.reactions))
    if (column.head.group == "reactions/pin")
      found[column.head.name] = std::round(column.value(sample) * 1e12) / 1e12;
  const std::map<std::string, Real> expected{{"fx", 1},
                                             {"fy", 2},
                                             {"fz", 3},
                                             {"torque_x", 4},
                                             {"torque_y", 5},
                                             {"torque_z", 6},
                                             {"marker_fx", 2},
                                             {"marker_fy", -1},
                                             {"marker_fz", 3},
                                             {"marker_torque_x", 5},
                                             {"marker_torque_y", -4},
                                             {"marker_torque_z", 6}};
  CHECK(found == expected);
}

TEST_CASE("a body whose frame is beside its centre of mass has columns of that") {
  Model model = recorded_model();
  HistorySample sample = distinct_sample();
  sample.bodies[1].angle = 0;
  model.bodies[1].center_of_mass = {1, 2, 0};
  std::map<std::string, Real> found;
  for (const RecordedColumn& column : history_columns(model, sample.reactions))
    if (column.head.name.starts_with("origin_")) found[column.head.name] = column.value(sample);
  const Real w = 54;  // the velocity of the origin is v - w x (1, 2, 0)
  const std::map<std::string, Real> expected{{"origin_x", 45},      {"origin_y", 45},
                                             {"origin_z", 48},      {"origin_vx", 49 + 2 * w},
                                             {"origin_vy", 51 - w}, {"origin_vz", 52}};
  CHECK(found == expected);
}

TEST_CASE("runs whose particles rotate have columns of that, beside all others") {
  Model model = recorded_model();
  HistorySample sample = distinct_sample();
  sample.particles.rotation = {61, 62, 63, {}};
  sample.losses = {{64, 65, 66}};
  const std::size_t spins = 3 * model.output.history_particles.size();
  const std::size_t others = history_columns(model, sample.reactions).size() + spins;
  model.contact.friction.resize(1);
  std::map<std::string, Real> found;
  const auto find_columns = [&] {
    found.clear();
    const std::vector<RecordedColumn> columns = history_columns(model, sample.reactions);
    for (const RecordedColumn& column : columns) {
      if (column.head.group != "rotation") continue;
      found[column.head.name] = column.value(sample);
      CHECK((column.head.unit == "J" && !column.head.description.empty()));
    }
    CHECK(columns.size() == others + found.size());
  };
  find_columns();
  std::map<std::string, Real> expected{
      {"kinetic", 61}, {"elastic_friction", 62}, {"elastic_rolling", 63}, {"loss_friction", 64}};
  CHECK(found == expected);
  model.contact.rolling.resize(1);
  find_columns();
  expected["loss_rolling"] = 65, expected["loss_twisting"] = 66;
  CHECK(found == expected);
}

TEST_CASE("runs with cohesion have a column of its energy") {
  Model model = recorded_model();
  HistorySample sample = distinct_sample();
  sample.particles.cohesion = -71;
  const auto held = [&] {
    std::vector<Real> values;
    for (const RecordedColumn& column : history_columns(model, sample.reactions))
      if (column.head.group == "energy" && column.head.name == "elastic_cohesion")
        values.push_back(column.value(sample));
    return values;
  };
  model.contact.laws.resize(1);
  CHECK(held().empty());
  model.contact.laws[0].attraction = 1;
  CHECK(held() == std::vector<Real>{-71});
}

}  // namespace scree
