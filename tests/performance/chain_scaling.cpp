// Cost of one step for hanging chains of planar bodies: it must grow linearly with the chain's length.
// Usage: chain_scaling [FILE.csv], which gets a row per length, for scaling_model.py.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "base/version.hpp"
#include "mbs/multibody.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

constexpr Real kSpacing = 0.1;  // between joints [m]

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// A chain on revolute joints that hangs from a pin at the origin and starts at 30 degrees from the vertical.
Model hanging_chain(int bodies) {
  Model model = empty_model();
  // The trapezoidal rule (alpha = 0) is not stable for constraints that turn: see the README of src/mbs.
  model.integrator.hht_alpha = -0.1;
  const Real c = std::cos(-M_PI / 3), s = std::sin(-M_PI / 3);
  for (int i = 0; i < bodies; ++i) {
    const Real along = kSpacing * (i + 0.5);
    model.bodies.push_back(paper_disc("link." + std::to_string(i), along * c, along * s));
    model.bodies.back().angle = -M_PI / 3;
    Joint joint =
        ground_pin("joint." + std::to_string(i), i, {i == 0 ? 0 : kSpacing / 2, 0, 0}, {-kSpacing / 2, 0, 0});
    joint.body[0] = i - 1;  // the ground for the first one
    model.joints.push_back(joint);
  }
  return model;
}

void measure(int bodies, std::ofstream& csv) {
  const Model model = hanging_chain(bodies);
  const auto built = std::chrono::steady_clock::now();
  MultibodyRun run(model, 1e-8);
  const double construction = seconds_since(built);
  const int steps = std::max(20, 200000 / bodies);
  run.steps(5, 1e-3);
  run.iterations = 0;
  const auto started = std::chrono::steady_clock::now();
  run.steps(steps, 1e-3);
  const double per_step = seconds_since(started) / steps;
  const double iterations = static_cast<double>(run.iterations) / steps;
  fmt::print("{:7d} {:10d} {:12.2f} {:12.4f} {:14.4f} {:11.2f} {:14.4f}\n", bodies, 5 * bodies,
             1e3 * construction, 1e3 * per_step, 1e6 * per_step / bodies, iterations,
             1e3 * per_step / iterations);
  std::fflush(stdout);
  csv << fmt::format("{},{},{:.6g},{:.4g},{:.6g}\n", commit(), bodies, per_step, iterations,
                     per_step / iterations)
      << std::flush;
}

}  // namespace

int main(int count, char** values) {
  std::ofstream csv;
  if (count > 1) csv.open(values[1]);
  if (count > 2 || (count > 1 && !csv)) {
    fmt::print(stderr, "error: usage: chain_scaling [FILE.csv], a file that can be written\n");
    return 2;
  }
  csv << "commit,bodies,seconds_per_step,iterations,seconds_per_iteration\n";
  fmt::print("hanging chains on revolute joints, h = 1 ms, {}\n",
             MultibodyRun(hanging_chain(1)).multibody.solver_description());
  fmt::print("{:>7} {:>10} {:>12} {:>12} {:>14} {:>11} {:>14}\n", "bodies", "unknowns", "start [ms]",
             "step [ms]", "per body [us]", "iterations", "iteration [ms]");
  for (const int bodies : {20, 100, 1000, 10000}) measure(bodies, csv);
}
