// The measurements of bed.cpp as rows of a CSV file, one per rank, for rank_tables.py and scaling_model.py,
// and as numbers for the tables of documents (support/measured.hpp).
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "base/timer.hpp"
#include "dem/backend/backend.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The measurement of one bed, the same on every rank.
struct Measured {
  std::int64_t particles = 0;  // of all ranks
  std::size_t bodies = 0;
  double contacts = 0;            // of the bodies, mean of occasional samples
  std::string bed;                // where there are several: "plain", "with a hole", "with bodies"
  std::int64_t size = 0;          // particles of the plain one
  double newton = 0, linear = 0;  // iterations per step, of implicit ones
  // Times per step: median, extremes and mean of the samples. The stages' times are means.
  double seconds = 0, fastest = 0, slowest = 0, mean = 0;
  double steps = 0;              // of all samples
  std::int64_t list_builds = 0;  // within these samples
};

class BedReport {
 public:
  // path: the file to which rows are added, with a heading if it is new; empty: none are written. kind: what
  // all rows of this program have in common, as in kKindColumns. title: the same in words. Collective.
  // Throws IoError.
  BedReport(const std::string& path, const std::string& kind, const std::string& title, const Ranks& ranks);
  // before, after: this rank's stage times around the samples. Collective.
  void add(const Measured& measured, const StageTimers& before, const StageTimers& after, Backend& backend);

  // Columns of `kind`; rebuild: option of bed, or "coupled" where bodies and particles exchange in batches.
  static constexpr const char* kKindColumns =
      "commit,device,backend,precision,dimension,integrator,rebuild,friction";

 private:
  std::string path_, kind_, title_;
  Ranks ranks_;
  std::ofstream file_;  // of rank 0
};

}  // namespace scree
