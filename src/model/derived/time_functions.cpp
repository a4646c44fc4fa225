#include "model/derived/time_functions.hpp"

#include <fmt/format.h>

namespace scree {

namespace {

void check_points(const DeckTable& table) {
  const std::vector<Real>&times = table.reals("times"), &values = table.reals("values");
  if (times.size() < 2) table.fail("times", "must have two entries at least");
  if (times.size() != values.size())
    table.fail("values", fmt::format("must have {} entries, as times", times.size()));
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1])) {
      table.fail("times", fmt::format("must increase; entry {} is {} after {}", i, times[i], times[i - 1]));
    }
  }
}

void build_table(const DeckTable& table, Interpolation otherwise, TimeFunction& function) {
  check_points(table);
  function.times = table.reals("times");
  function.values = table.reals("values");
  function.interpolation =
      table.has("interpolation") ? table.choice<Interpolation>("interpolation") : otherwise;
  if (!table.has("end_rates")) return;
  if (function.interpolation != Interpolation::clamped)
    table.fail("end_rates", "used only with interpolation = \"clamped\"");
  for (std::size_t i = 0; i < 2; ++i) function.end_rates[i] = table.reals("end_rates")[i];
}

void read_start_and_end(const DeckTable& table, TimeFunction& function) {
  function.start = table.has("start") ? table.real("start") : 0;
  function.end = table.real("end");
  if (!(function.end > function.start))
    table.fail("end", fmt::format("must be above start = {}", function.start));
}

void build_step(const DeckTable& table, TimeFunction& function) {
  function.end_value = table.real("end_value");
  read_start_and_end(table, function);
}

void build_ramp(const DeckTable& table, TimeFunction& function) {
  function.rate = table.real("rate");
  if (table.has("end")) return read_start_and_end(table, function);
  if (table.has("start"))
    table.fail("start",
               "needs end, the time from which on the slope is rate: between the two it grows from 0");
}

// otherwise: the default interpolation of a table.
TimeFunction build_function(const DeckTable& table, Interpolation otherwise) {
  TimeFunction function;
  function.kind = table.choice<TimeFunctionKind>("kind");
  if (function.kind != TimeFunctionKind::table) function.value = table.real("value");
  switch (function.kind) {
    case TimeFunctionKind::constant:
      break;
    case TimeFunctionKind::ramp:
      build_ramp(table, function);
      break;
    case TimeFunctionKind::sine:
      function.amplitude = table.real("amplitude");
      function.frequency = table.real("frequency");
      function.phase = table.real("phase");
      break;
    case TimeFunctionKind::step:
      build_step(table, function);
      break;
    case TimeFunctionKind::table:
      build_table(table, otherwise, function);
      break;
  }
  return function;
}

}  // namespace

TimeFunction build_motion(const DeckTable& table) {
  const TimeFunction function = build_function(table, Interpolation::natural);
  if (function.kind == TimeFunction::Kind::table && function.interpolation == Interpolation::linear)
    table.fail("interpolation",
               "the velocity of a motion must not jump; allowed for a driver: natural, clamped, monotone");
  return function;
}

TimeFunction build_force(const DeckTable& table) { return build_function(table, Interpolation::linear); }

}  // namespace scree
