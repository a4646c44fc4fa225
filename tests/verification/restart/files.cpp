// The program itself: a run continued with --restart has the files of the uninterrupted run.
#include <cmath>
#include <string>
#include <vector>

#include "output/checkpoint.hpp"
#include "output/hdf5_file.hpp"
#include "run/loop/simulation.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/petsc_run.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"
#include "verification/restart/cases.hpp"

using namespace scree;

namespace {

void run_to(Model model, Real end, const std::string& directory, const std::string& restart) {
  model.time.end = end;
  RunOptions options;
  options.output_directory = directory;
  options.restart = restart;
  options.fingerprint = "restart test";
  petsc();
  Log log(true);
  REQUIRE(run_simulation(model, options, log) == ExitCode::done);
}

// Names of the history's columns that differ in a bit.
std::string differing_columns(const std::string& path_a, const std::string& path_b) {
  const Hdf5File a(path_a, Hdf5Access::read), b(path_b, Hdf5Access::read);
  const std::vector<std::string> names = a.dataset_names("/");
  REQUIRE(names.size() > 20);
  REQUIRE(names == b.dataset_names("/"));
  std::string differing;
  for (const std::string& name : names)
    if (!same_bits(a.read_array<Real>("/" + name), b.read_array<Real>("/" + name))) differing += name + " ";
  return differing;
}

// The contacts of all bodies, of their row, and of all walls.
void record_contacts(Model& model) {
  ContactTarget row{"row", {}, true, -1};
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    row.bodies.push_back(b);
    model.output.history_contacts.push_back({"body " + std::to_string(b), {b}, false, -1});
  }
  if (!row.bodies.empty()) model.output.history_contacts.push_back(row);
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w)
    model.output.history_contacts.push_back({"wall " + std::to_string(w), {}, false, w});
}

}  // namespace

TEST_CASE("a run continued with --restart leaves the same history and the same last checkpoint") {
  for (const RestartCase& restart_case : restart_cases()) {
    CAPTURE(restart_case.name);
    const ScratchDirectory whole, parts;
    Model model = restart_case.model;
    record_contacts(model);
    // Whole 1024ths of a second: the first half then ends at exactly the time of the whole run's checkpoint.
    const Real end = std::ldexp(std::round(std::ldexp(model.time.end, 10)), -10);
    model.output.checkpoint_interval = model.output.snapshot_interval = end / 2;
    model.output.history_interval = end / 16;
    run_to(model, end, whole.path(), "");
    run_to(model, end / 2, parts.path(), "");
    run_to(model, end, parts.path(), parts / "checkpoint.h5");
    CHECK(measured("restart/history", "bits",
                   BitForBit{differing_columns(whole / "history.h5", parts / "history.h5")}));
    CHECK(measured("restart/state", "bits",
                   BitForBit{differing_arrays(read_checkpoint(whole / "checkpoint.h5"),
                                              read_checkpoint(parts / "checkpoint.h5"))}));
  }
}
