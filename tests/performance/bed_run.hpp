// A bed on its backend, and samples of the time of its steps.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bed_cases.hpp"
#include "bed_report.hpp"
#include "coupling/coupled_step.hpp"

namespace scree {

// Options of bed's command line.
struct Options {
  int dimension = 3;
  std::string backend = "cpu", precision = "double", integrator = "verlet";
  std::vector<std::int64_t> particles;
  Index rebuild = 25;
  int repeats = 5;
  Index steps = 0;
  double seconds = 0.5;
  double spread = 0;  // largest over smallest diameter in a periodic box; 0: the bed
  BedContact contact;
  bool net = false, plough = false, wall = false, per_rank = false;
  std::string tile = SCREE_SOURCE_DIR "/tests/reference/bed_tile.h5", csv;
  Ranks ranks = Ranks::world();

  bool on_gpu() const { return backend == "cuda"; }
  bool with_bodies() const { return net || plough; }
};

struct Samples {
  Index steps = 0;              // per sample
  std::vector<double> seconds;  // per step, in increasing order

  double median() const { return seconds[seconds.size() / 2]; }
};

// Sections of equal length, in multiples of `quantum` steps, and of at least options.steps. advance(n) takes
// n steps and returns when they are done; before_samples is called between the search for the length and the
// first sample.
Samples sample(
    const Options& options, Index quantum, const std::function<void(Index)>& advance,
    const std::function<void()>& before_samples = [] {});
Measured measured(const Samples& samples, const Model& bed, std::int64_t list_builds);

struct Run {
  Run(Model bed, const Options& options);
  double listed() const;  // neighbours per particle

  Model model;
  StageTimers timers;
  std::unique_ptr<Backend> backend;
  BodyCoupling link;
  Ranks ranks;
  CoupledStep step;
  MultibodyState bodies;
};

// "2.51e+07 (2.44e+07 to 2.53e+07) particle-steps/s, 398 us per step"
std::string speed_text(const Samples& samples, std::int64_t particles);
// Memory of the arrays of this rank's backend on its GPU, per particle of the rank.
void print_device_memory(Backend& backend);
// Each stage's fraction of the total between the two, and its time over the steps.
void print_stages(const StageTimers& before, const StageTimers& after, double steps);

}  // namespace scree
