#include "bed_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "dem/backend/device.hpp"
#include "dem/particles/particle_store.hpp"
#include "partition/shared_model.hpp"

namespace scree {
namespace {

double seconds_now(const Options& options) {
  timespec time{};
  clock_gettime(
      options.on_gpu() || options.wall || !options.ranks.alone() ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID,
      &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// This rank's part of a bed that every rank has made as a whole.
Model part_of(Model bed, const Ranks& ranks) {
  ParticleSet& set = bed.particles;
  if (std::ssize(set.position) < set.totals.count) return bed;
  const IdRange own = id_range(set.totals.count, ranks.rank(), ranks.size());
  const auto cut = [&](auto& values) {
    values = std::decay_t<decltype(values)>(values.begin() + own.first, values.begin() + own.last);
  };
  cut(set.position), cut(set.velocity), cut(set.radius), cut(set.mass), cut(set.material);
  set.first_id = own.first;
  return bed;
}

}  // namespace

Samples sample(const Options& options, Index quantum, const std::function<void(Index)>& advance,
               const std::function<void()>& before_samples) {
  const auto timed = [&](Index steps) {
    const double start = seconds_now(options);
    advance(steps);
    return options.ranks.max(seconds_now(options) - start);
  };
  advance(quantum);
  Index steps = quantum * std::max<Index>(1, (options.steps + quantum - 1) / quantum);
  const Index least = steps;
  double taken = timed(steps);
  while (taken < 0.2 * options.seconds) taken = timed(steps *= 4);
  const double quanta =
      std::ceil(options.seconds / taken * static_cast<double>(steps) / static_cast<double>(quantum));
  Samples samples;
  samples.steps = std::max(least, quantum * static_cast<Index>(quanta));
  before_samples();
  for (int r = 0; r < options.repeats; ++r)
    samples.seconds.push_back(timed(samples.steps) / static_cast<double>(samples.steps));
  std::sort(samples.seconds.begin(), samples.seconds.end());
  return samples;
}

Measured measured(const Samples& samples, const Model& bed, std::int64_t list_builds) {
  const auto count = static_cast<double>(samples.seconds.size());
  Measured out;
  out.particles = bed.particles.totals.count, out.bodies = bed.bodies.size();
  out.seconds = samples.median(), out.fastest = samples.seconds.front(), out.slowest = samples.seconds.back();
  out.mean = std::accumulate(samples.seconds.begin(), samples.seconds.end(), 0.0) / count;
  out.steps = static_cast<double>(samples.steps) * count, out.list_builds = list_builds;
  return out;
}

Run::Run(Model bed, const Options& options)
    : model(part_of(std::move(bed), options.ranks)),
      backend(options.on_gpu() ? make_cuda_backend(model, options.ranks)
                               : make_cpu_backend(model, options.ranks)),
      link(model, options.ranks),
      ranks(options.ranks),
      step(model, *backend, link, timers) {
  backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
}

double Run::listed() const {
  return static_cast<double>(ranks.sum(backend->list().entries())) /
         static_cast<double>(model.particles.totals.count);
}

std::string speed_text(const Samples& samples, std::int64_t particles) {
  const double n = static_cast<double>(particles);
  return fmt::format("{:.3g} ({:.3g} to {:.3g}) particle-steps/s, {:.4g} us per step", n / samples.median(),
                     n / samples.seconds.back(), n / samples.seconds.front(), 1e6 * samples.median());
}

void print_device_memory(Backend& backend) {
  const auto particles = static_cast<double>(backend.list().balance().halo.owned);
  std::string text;
  for (const DeviceShare& share : device_shares(backend))
    text += fmt::format("{}{} {:.0f} B", text.empty() ? "" : ", ", share.of,
                        static_cast<double>(share.bytes) / particles);
  if (!text.empty()) fmt::print("{:10} device memory per particle: {}\n", "", text);
}

void print_stages(const StageTimers& before, const StageTimers& after, double steps) {
  double all = 0;
  const auto seconds = [&](int s) {
    return after[static_cast<Stage>(s)].seconds - before[static_cast<Stage>(s)].seconds;
  };
  for (int s = 0; s < static_cast<int>(Stage::count); ++s) all += seconds(s);
  std::string text;
  for (int s = 0; s < static_cast<int>(Stage::count); ++s)
    if (seconds(s) > 0)
      text += fmt::format("{}{} {:.1f} % ({:.4g} us)", text.empty() ? "" : ", ",
                          kStageNames[static_cast<std::size_t>(s)], 100 * seconds(s) / all,
                          1e6 * seconds(s) / steps);
  fmt::print("{:10} {}\n", "", text);
}

}  // namespace scree
