#include "bed_report.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <vector>

#include "base/error.hpp"
#include "dem/backend/device.hpp"
#include "support/measured.hpp"

namespace scree {
namespace {

// The data of one rank.
struct OfRank {
  HaloSize halo;
  double imbalance = 0;
  double host_bytes = 0, device_bytes = 0;
  std::array<double, static_cast<int>(Stage::count)> stage_seconds{};  // per step
};

struct HaloTimes {
  double bytes = 0, seconds = 0, exposed = 0;  // of the rank that waits longest
};

// A step's time, in the unit in which it has few digits.
void note_step(const std::string& key, const Measured& m) {
  const double unit = m.seconds < 1e-3 ? 1e6 : 1e3;
  note_samples("bed/" + key + "step", m.seconds < 1e-3 ? "us" : "ms", unit * m.seconds, unit * m.fastest,
               unit * m.slowest);
}

// The numbers for documents. memory: of all devices, per particle [B].
void note_numbers(const std::string& title, const Measured& m, double memory, const HaloTimes& halo) {
  const std::string row = title + (m.bed.empty() ? "" : ", " + m.bed),
                    key = row + fmt::format("/{} ", m.size > 0 ? m.size : m.particles);
  const auto rate = [&](double seconds) { return static_cast<double>(m.particles) / seconds; };
  note_samples("bed/" + key + "rate", "particle-steps/s", rate(m.seconds), rate(m.slowest), rate(m.fastest));
  note_step(key, m);
  if (memory > 0) note("bed/" + key + "memory", "B", memory);
  if (m.newton > 0) note("bed/" + key + "Newton", "", m.newton), note("bed/" + key + "linear", "", m.linear);
  if (m.bodies > 0) note("bed/" + key + "contacts", "", m.contacts);
  if (halo.seconds <= 0) return;
  note("bed/" + key + "halo", "MB", 1e-6 * halo.bytes);
  note("bed/" + key + "halo update", "us", 1e6 * halo.seconds);
  note("bed/" + key + "hidden", "%", 100 * (1 - halo.exposed / halo.seconds));
}

// For one rank without bodies: each stage's fraction of the total.
void note_stages(const std::string& title, const Measured& m,
                 const std::array<double, static_cast<int>(Stage::count)>& seconds) {
  const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  for (std::size_t s = 0; s < seconds.size() && m.bed.empty(); ++s)
    if (seconds[s] > 0.01 * all)
      note("bed/" + title + fmt::format("/{} {}", m.particles, kStageNames[s]), "%", 100 * seconds[s] / all);
}

// Largest memory that the process had so far [B].
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

BedReport::BedReport(const std::string& path, const std::string& kind, const std::string& title,
                     const Ranks& ranks)
    : path_(path), kind_(kind), title_(title), ranks_(ranks) {
  if (path_.empty()) return;
  ranks_.on_root([&] {
    const bool is_new = !std::filesystem::exists(path_);
    file_.open(path_, std::ios::app);
    if (is_new) {
      file_ << kKindColumns
            << ",bodies,contacts,ranks,rank,particles,owned,ghosts,receivers,halo_bytes,imbalance,"
               "list_builds,steps,seconds_per_step,fastest,slowest,mean,host_bytes,device_bytes,halo_seconds,"
               "halo_exposed";
      for (const char* name : kStageNames) file_ << ',' << name;
      file_ << '\n' << std::flush;
    }
    if (!file_) throw IoError(path_ + ": cannot be written");
  });
}

void BedReport::add(const Measured& measured, const StageTimers& before, const StageTimers& after,
                    Backend& backend) {
  OfRank own;
  own.halo = backend.list().balance().halo, own.imbalance = backend.list().balance().imbalance;
  own.host_bytes = peak_memory();
  own.device_bytes = static_cast<double>(device_memory_in_use());
  for (int s = 0; s < static_cast<int>(Stage::count); ++s)
    own.stage_seconds[static_cast<std::size_t>(s)] =
        (after[static_cast<Stage>(s)].seconds - before[static_cast<Stage>(s)].seconds) / measured.steps;
  const std::vector<OfRank> all = ranks_.gather(std::vector<OfRank>{own});
  ranks_.on_root([&] {
    double memory = 0;
    HaloTimes halo;
    for (const OfRank& r : all) {
      memory += r.device_bytes;
      halo.bytes = std::max(halo.bytes, static_cast<double>(r.halo.bytes));
      if (r.halo.exposed_seconds >= halo.exposed)
        halo.seconds = r.halo.seconds, halo.exposed = r.halo.exposed_seconds;
    }
    note_numbers(title_, measured, memory / static_cast<double>(measured.particles), halo);
    note_stages(title_, measured, all.front().stage_seconds);
    if (path_.empty()) return;
    for (std::size_t rank = 0; rank < all.size(); ++rank) {
      const OfRank& r = all[rank];
      file_ << fmt::format(
          "{},{},{:.4g},{},{},{},{},{},{},{},{:.4g},{},{:.0f},{:.6g},{:.6g},{:.6g},{:.6g},{:.0f},{:.0f},"
          "{:.4g},{:.4g}",
          kind_, measured.bodies, measured.contacts, ranks_.size(), rank, measured.particles, r.halo.owned,
          r.halo.ghosts, r.halo.neighbors, r.halo.bytes, r.imbalance, measured.list_builds, measured.steps,
          measured.seconds, measured.fastest, measured.slowest, measured.mean, r.host_bytes, r.device_bytes,
          r.halo.seconds, r.halo.exposed_seconds);
      for (const double seconds : r.stage_seconds) file_ << fmt::format(",{:.6g}", seconds);
      file_ << '\n';
    }
    file_.flush();
    if (!file_) throw IoError(path_ + ": cannot be written");
  });
}

}  // namespace scree
