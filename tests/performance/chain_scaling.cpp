// Processor time of one step for hanging chains of planar and spatial bodies on revolute joints: it must
// grow linearly with the chain's length. The least of several repetitions, as other programs take time from
// this one. Usage: chain_scaling [--planar | --space] [FILE.csv] [LENGTH ...]; the file gets a row per
// length of the planar chain, for scaling_model.py.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "base/version.hpp"
#include "mbs/multibody.hpp"
#include "support/measured.hpp"
#include "support/multibody_run.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

constexpr Real kSpacing = 0.1;  // between joints [m]

double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / static_cast<double>(CLOCKS_PER_SEC);
}

// A chain on revolute joints that hangs from a pin at the origin and starts at 30 degrees from the vertical.
Model hanging_chain(int bodies) {
  Model model = empty_model();
  // The trapezoidal rule (alpha = 0) is not stable for rotating constraints: see the README of src/mbs.
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

// The chain of spatial discs, whose revolute joints have the axis z.
Model spatial_chain(int bodies) {
  Model model = spatial_model(-0.1);
  model.gravity = {0, -kGravity, 0};
  const Vec3 down{std::cos(-M_PI / 3), std::sin(-M_PI / 3), 0};
  for (int i = 0; i < bodies; ++i) {
    const std::string n = std::to_string(i);
    model.bodies.push_back(spatial_body("link." + n, 1, {0.0025, 0.0025, 0.005},
                                        (kSpacing * (i + 0.5)) * down, exponential({0, 0, -M_PI / 3})));
    model.joints.push_back(joint_at(JointKind::revolute, "joint." + n, i - 1, i,
                                    {i == 0 ? 0 : kSpacing / 2, 0, 0}, {-kSpacing / 2, 0, 0}));
    if (i == 0) model.joints.front().marker[1] = exponential({0, 0, M_PI / 3});
  }
  return model;
}

// chains: "planar" or "space".
void measure(const std::string& chains, const Model& model, std::ofstream& csv) {
  constexpr int kRepetitions = 3;
  const int bodies = static_cast<int>(model.bodies.size());
  const std::clock_t built = std::clock();
  MultibodyRun run(model, 1e-8);
  const double construction = seconds_since(built);
  const int steps = std::max(10, 70000 / bodies);
  run.steps(5, 1e-3);
  double per_step = 1e300, slowest = 0, iterations = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    run.iterations = 0;
    const std::clock_t started = std::clock();
    run.steps(steps, 1e-3);
    const double seconds = seconds_since(started) / steps;
    slowest = std::max(slowest, seconds);
    if (seconds >= per_step) continue;
    per_step = seconds;
    iterations = static_cast<double>(run.iterations) / steps;
  }
  fmt::print("{:7d} {:10d} {:12.2f} {:12.4f} {:14.4f} {:11.2f} {:14.4f}\n", bodies,
             run.multibody.coordinates() + run.multibody.constraints(), 1e3 * construction, 1e3 * per_step,
             1e6 * per_step / bodies, iterations, 1e3 * per_step / iterations);
  std::fflush(stdout);
  const std::string key = chains + fmt::format("/{} ", bodies);
  note_samples("chain/" + key + "step", "ms", 1e3 * per_step, 1e3 * per_step, 1e3 * slowest);
  note("chain/" + key + "Newton", "", iterations);
  if (csv.is_open())
    csv << fmt::format("{},{},{:.6g},{:.4g},{:.6g}\n", commit(), bodies, per_step, iterations,
                       per_step / iterations)
        << std::flush;
}

void print_head(const char* chains) {
  fmt::print("hanging chains {}, h = 1 ms, processor time, {}\n", chains,
             MultibodyRun(hanging_chain(1)).multibody.solver_description());
  fmt::print("{:>7} {:>10} {:>12} {:>12} {:>14} {:>11} {:>14}\n", "bodies", "unknowns", "start [ms]",
             "step [ms]", "per body [us]", "iterations", "iteration [ms]");
}

bool is_number(const std::string& word) {
  return word.size() < 8 &&
         std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
}

}  // namespace

int main(int count, char** values) {
  std::ofstream csv;
  std::vector<int> lengths;
  bool planar = true, space = true, sound = true;
  for (int i = 1; i < count; ++i) {
    const std::string word = values[i];
    if (word == "--planar") {
      space = false;
    } else if (word == "--space") {
      planar = false;
    } else if (is_number(word) && std::stoi(word) > 0) {
      lengths.push_back(std::stoi(word));
    } else {
      sound = sound && !csv.is_open();
      csv.open(word);
      sound = sound && csv;
    }
  }
  if (!sound || !(planar || space)) {
    fmt::print(stderr,
               "error: usage: chain_scaling [--planar | --space] [FILE.csv] [LENGTH ...], a file that can be "
               "written\n");
    return 2;
  }
  if (lengths.empty()) lengths = {20, 100, 1000, 10000};
  if (planar) {
    if (csv.is_open()) csv << "commit,bodies,seconds_per_step,iterations,seconds_per_iteration\n";
    print_head("of planar bodies on revolute joints");
    for (const int bodies : lengths) measure("planar", hanging_chain(bodies), csv);
  }
  if (space) {
    csv.close();
    print_head("of bodies in space on hinges");
    for (const int bodies : lengths) measure("space", spatial_chain(bodies), csv);
  }
}
