#include "run/report/progress.hpp"

#include <fmt/format.h>

#include <cmath>

namespace scree {
namespace {

constexpr double kRecent = 20;  // period over which rates are averaged [s]

}  // namespace

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  const auto whole = static_cast<std::int64_t>(std::round(std::max(seconds, 0.0)));
  const std::int64_t minutes = whole / 60, hours = minutes / 60, days = hours / 24;
  if (days > 0) return fmt::format("{} d {:02} h", days, hours % 24);
  if (hours > 0) return fmt::format("{} h {:02} min", hours, minutes % 60);
  if (minutes > 0) return fmt::format("{} min {:02} s", minutes, whole % 60);
  return fmt::format("{} s", whole);
}

std::string percent_text(const Progress& p) {
  return fmt::format("{:.0f} %", std::floor(100 * p.time / p.end));
}

std::string rate_text(const Progress& p) {
  if (!std::isfinite(p.step_rate)) return "?";
  return p.particles > 0 ? fmt::format("{:.2g} particle-steps/s", p.particle_step_rate)
                         : fmt::format("{:.2g} steps/s", p.step_rate);
}

std::string balance_text(const Progress& p) {
  return p.exchanged > 0 ? fmt::format("{:.0e}", std::abs(p.balance_error) / p.exchanged) : "-";
}

std::string progress_line(const Progress& p) {
  const std::string contacts = p.contacts < 0 ? "" : fmt::format(", {} contacts", p.contacts);
  return fmt::format("t = {:.6g} of {:g} s ({}), {} left, {} steps, h = {:.2e} s{}, {}, balance {}", p.time,
                     p.end, percent_text(p), duration_text(p.seconds_left), p.steps, p.step, contacts,
                     rate_text(p), balance_text(p));
}

void RecentRate::add(double wall, std::int64_t steps, Real time) {
  samples_.push_back({wall, steps, time});
  // The oldest sample kept is just older than the averaging period.
  while (samples_.size() > 2 && wall - samples_[1].wall > kRecent) samples_.pop_front();
}

double RecentRate::steps_per_second() const {
  if (samples_.size() < 2) return std::nan("");
  const Sample &first = samples_.front(), &last = samples_.back();
  return static_cast<double>(last.steps - first.steps) / (last.wall - first.wall);
}

double RecentRate::time_per_second() const {
  if (samples_.size() < 2) return std::nan("");
  const Sample &first = samples_.front(), &last = samples_.back();
  return (last.time - first.time) / (last.wall - first.wall);
}

}  // namespace scree
