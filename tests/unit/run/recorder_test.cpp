// The files are the same whether snapshots are written at once or during later steps.
#include "run/record/recorder.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "dem/cpu/cpu_backend.hpp"
#include "output/hdf5_file.hpp"
#include "run/state/step_clock.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/hdf5_texts.hpp"
#include "support/models.hpp"
#include "support/petsc_run.hpp"

namespace scree {

namespace {

// Two discs move towards a third; a body hangs on a pin between them.
const std::string kDeck = kSmallDeck + R"(
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
[[bodies]]
name = "pad"
position = [0.0, -0.3]
mass = 1.0
inertia = 0.01
shapes = [{ radius = 0.1 }]
[[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "pad"]
point = [0.0, 0.0]
[[particles]]
name = "discs"
kind = "list"
positions = [[0.21, 0.0], [-0.3, 0.0], [0.0, 0.0]]
velocity = [1.0, 0.5]
radius = 0.1
mass = 1.0
[output]
history_particles = [1]
contacts = true
)";

// Reports of a backend, until the test says that its device has failed.
class FailingReports : public Reports {
 public:
  explicit FailingReports(Reports& of) : of_(of) {}
  ParticleLedger ledger(Real verlet_step) override { return of_.ledger(verlet_step); }
  void start_output() override { of_.start_output(); }
  ParticleOutput output() override {
    if (failed) throw DeviceError("the device has failed");
    return of_.output();
  }
  ShapePack pack_shapes() override { return of_.pack_shapes(); }
  ContactLines contact_lines() override { return of_.contact_lines(); }
  RegionSums in_region(const RegionBounds& region) override { return of_.in_region(region); }
  std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) override { return of_.traced(wanted); }
  std::vector<ContactSum> parent_contacts() override { return of_.parent_contacts(); }
  std::vector<ContactSum> surface_contacts() override { return of_.surface_contacts(); }
  std::vector<ContactSum> wall_contacts(std::span<const int> of) override { return of_.wall_contacts(of); }
  std::vector<TriangleLoad> triangle_loads() override { return of_.triangle_loads(); }

  bool failed = false;

 private:
  void find_loads() override {}  // that of the other backend
  Reports& of_;
};

// Lets the recorder assume that steps continue while it could write, and idles when the test asks for it.
class LateBackend : public CpuBackend {
 public:
  using CpuBackend::CpuBackend;
  bool computes_asynchronously() const override { return true; }
  bool has_idle_work() const { return idle_work_ != nullptr; }
  void idle() { idle_work_(); }
  Reports& reports() override { return reports_; }
  void fail() { reports_.failed = true; }

 private:
  FailingReports reports_{CpuBackend::reports()};
};

class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "scree_recorder_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch directory");
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A manual run: the model's steps, and a recorder for their files.
template <class B>
struct Recording {
  explicit Recording(const std::string& deck = kDeck) : model((petsc(), model_of(deck))) {
    state.clock = StepClock(model).state();
    backend.particles().load(initial_records(model.particles, Subdomain(model.space)), {});
    step.start(state.bodies);
    recorder = std::make_unique<Recorder>(model, backend, link, folder.path(), state);
  }
  void advance() {
    step.explicit_steps(state.bodies, {state.clock.time}, model.time.step,
                        state.clock.time + model.time.step);
    state.clock.time += model.time.step;
    state.counts = step.counts();
    recorder->history(state, model.time.step);
  }
  // Times of the snapshots on disk.
  std::vector<Real> times() const {
    const std::string path = folder.path() + "/particles.vtkhdf";
    if (!std::filesystem::exists(path)) return {};
    return Hdf5File(path, Hdf5Access::read).read_array<Real>("/VTKHDF/Steps/Values");
  }
  std::int64_t history_rows() const {
    const std::string path = folder.path() + "/history.h5";
    return std::filesystem::exists(path) ? Hdf5File(path, Hdf5Access::read).rows("/step/time") : 0;
  }

  int snapshots_in_xdmf() const {
    std::ifstream file(folder.path() + "/particles.xdmf");
    int count = 0;
    for (std::string line; std::getline(file, line);) count += line.find("<Time ") != std::string::npos;
    return count;
  }

  Folder folder;
  const Model model;
  State state;
  StageTimers timers;
  B backend{model};
  BodyCoupling link{model};
  CoupledStep step{model, backend, link, timers};
  std::unique_ptr<Recorder> recorder;
};

// Whether two readings of a dataset are the same; false also where it is not of their type.
template <class Compare>
bool are_same(const Compare& compare) {
  try {
    return compare();
  } catch (const IoError&) {
    return false;
  }
}

template <class T>
bool same_values(const Hdf5File& a, const Hdf5File& b, const std::string& name) {
  return are_same([&] { return same_bits(a.read_array<T>(name), b.read_array<T>(name)); });
}

void check_same_files(const std::string& folder, const std::string& other) {
  for (const char* name :
       {"particles.vtkhdf", "bodies.vtkhdf", "contacts.vtkhdf", "links.vtkhdf", "history.h5"}) {
    const Hdf5File a(folder + "/" + name, Hdf5Access::read), b(other + "/" + name, Hdf5Access::read);
    const std::vector<std::string> datasets = a.dataset_names("/");
    CHECK(datasets.size() > 10);
    CHECK(datasets == b.dataset_names("/"));
    for (const std::string& dataset : datasets) {
      CAPTURE(name, dataset);
      CHECK((same_values<Real>(a, b, dataset) || same_values<std::int64_t>(a, b, dataset) ||
             same_values<std::int32_t>(a, b, dataset) ||
             are_same([&] { return a.read_text(dataset) == b.read_text(dataset); }) ||
             are_same([&] { return read_texts(a, dataset) == read_texts(b, dataset); })));
    }
  }
}

}  // namespace

TEST_CASE("a snapshot of a synchronous backend is on disk when it is taken") {
  Recording<CpuBackend> run;
  run.recorder->history(run.state, 0);
  run.recorder->snapshot(run.state);
  CHECK(run.state.snapshots == 1);
  CHECK(run.times() == std::vector<Real>{0});
}

TEST_CASE("the history waits for its own flush, the .xdmf for the end at the latest") {
  Recording<CpuBackend> run;
  for (int k = 0; k < 8; ++k) run.recorder->history(run.state, 0), run.recorder->snapshot(run.state);
  CHECK(run.times().size() == 8);
  CHECK(run.history_rows() == 0);
  run.recorder->flush_history();
  CHECK(run.history_rows() == 8);
  CHECK(run.snapshots_in_xdmf() < 8);
  run.recorder->history(run.state, 0);
  run.recorder->finish();
  CHECK(run.history_rows() == 9);
  CHECK(run.snapshots_in_xdmf() == 8);
}

TEST_CASE("a snapshot of an asynchronous backend is written while it computes") {
  Recording<LateBackend> run;
  run.recorder->history(run.state, 0);
  run.recorder->snapshot(run.state);
  CHECK(run.state.snapshots == 1);
  CHECK(run.recorder->snapshots_written() == 0);
  CHECK(run.times().empty());
  run.backend.idle();
  CHECK(run.times() == std::vector<Real>{0});
  run.backend.idle();  // nothing is pending
  CHECK(run.recorder->snapshots_written() == 1);
}

TEST_CASE("a pending snapshot goes to disk before the next one and with a flush") {
  Recording<LateBackend> run;
  run.recorder->snapshot(run.state);
  run.state.clock.time = 1;
  run.recorder->snapshot(run.state);
  CHECK(run.times() == std::vector<Real>{0});
  run.recorder->flush();
  CHECK(run.times() == std::vector<Real>{0, 1});
  CHECK(run.state.snapshots == run.recorder->snapshots_written());
}

TEST_CASE("late and immediate snapshots give the same files") {
  Recording<CpuBackend> now;
  Recording<LateBackend> late;
  for (int k = 0; k < 300; ++k) {
    if (k % 40 == 0) now.recorder->snapshot(now.state), late.recorder->snapshot(late.state);
    if (k % 80 == 0) late.backend.idle();  // the others are written by a history row of a later state
    now.advance(), late.advance();
  }
  now.recorder->flush(), late.recorder->flush();
  REQUIRE(now.times().size() == 8);
  REQUIRE(now.history_rows() == 300);
  check_same_files(now.folder.path(), late.folder.path());
}

// Two balls on a rotating body whose frame is off its centre of mass, and a ball without contacts.
TEST_CASE("shapes and centre of a spatial body are fixed in its frame, which snapshots store") {
  Recording<CpuBackend> run(R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 1.0
step = 5e-3
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e3
[[bodies]]
name = "still"
kind = "spatial"
mass = 1.0
inertia_tensor = [0.1, 0.2, 0.25, 0.0, 0.0, 0.0]
position = [-0.5, 0.0, 0.0]
shapes = [{ radius = 0.1 }]
[[bodies]]
name = "top"
kind = "spatial"
mass = 1.0
inertia_tensor = [0.1, 0.2, 0.25, 0.0, 0.0, 0.0]
center_of_mass = [0.1, 0.2, 0.0]
position = [0.3, 0.0, 0.0]
body_angular_velocity = [1.0, 8.0, -2.0]
shapes = [{ radius = 0.1 }, { radius = 0.07, offset = [0.0, 0.0, 2.0], collides = false },
          { radius = 0.05, offset = [0.2, 0.1, 0.3] }]
)");
  for (int k = 0; k < 60; ++k) {
    if (k % 20 == 0) run.recorder->snapshot(run.state);
    run.advance();
  }
  const Hdf5File file(run.folder.path() + "/bodies.vtkhdf", Hdf5Access::read);
  CHECK(file.read_text("/Scree/names") == "still\ntop\n");
  CHECK(read_texts(file, "/VTKHDF/FieldData/names") == std::vector<std::string>{"still", "top"});
  const auto body = file.read_array<std::int32_t>("/VTKHDF/PointData/body");
  REQUIRE(body == std::vector<std::int32_t>{0, 1, 1, 1, 0, 1});  // of all snapshots
  const auto kind = file.read_array<std::int32_t>("/VTKHDF/PointData/kind");
  const auto radius = file.read_array<Real>("/VTKHDF/PointData/radius");
  for (std::size_t i = 0; i < body.size(); ++i) {
    CHECK(kind[i] == std::array{0, 0, 0, 2, 1, 1}[i]);
    CHECK(radius[i] == std::array{0.1, 0.1, 0.05, 0.07, 0.0, 0.0}[i]);
  }
  const auto points = file.read_array<Real>("/VTKHDF/Points"),
             origins = file.read_array<Real>("/VTKHDF/PointData/origin"),
             turns = file.read_array<Real>("/VTKHDF/PointData/orientation");
  const auto vec = [](const std::vector<Real>& all, std::size_t i) {
    return Vec3{all[3 * i], all[3 * i + 1], all[3 * i + 2]};
  };
  const Vec3 offsets[6] = {{}, {}, {0.2, 0.1, 0.3}, {0, 0, 2}, {}, {0.1, 0.2, 0}};
  REQUIRE(points.size() == 3 * 3 * body.size());
  for (std::size_t i = 0; i < points.size() / 3; ++i) {
    CAPTURE(i);
    const Quaternion p{turns[4 * i], turns[4 * i + 1], turns[4 * i + 2], turns[4 * i + 3]};
    CHECK(norm(vec(points, i) - vec(origins, i) - rotated(p, offsets[i % 6])) < 1e-15);
    if (i % 6 % 4 == 0) CHECK((p.w == 1 && vec(points, i) == Vec3{-0.5, 0, 0}));
  }
  CHECK(norm(vec(origins, 1) - Vec3{0.3, 0, 0}) < 1e-15);
  CHECK(norm(vec(points, 14) - vec(points, 2)) > 0.2);
}

// A ball lies on a box that a body lifts, off the box's edges and diagonals; another one is beside the box.
TEST_CASE("pressure on a mesh is stored per triangle, at its position") {
  Recording<CpuBackend> run(R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
step = 1e-6
control = "fixed"
end = 1.0
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
[[meshes]]
name = "box"
kind = "box"
size = [0.4, 0.2, 0.1]
offset = [0.1, 0.0, 0.0]
[[bodies]]
name = "lift"
kind = "spatial"
mass = 1e6
inertia_tensor = [1e6, 1e6, 1e6, 0.0, 0.0, 0.0]
position = [0.0, 0.0, 0.0]
velocity = [0.0, 0.0, 0.5]
meshes = [{ mesh = "box" }]
[[particles]]
name = "ball"
kind = "list"
positions = [[0.2, -0.05, 0.098], [0.2, 0.5, 0.0]]
radius = 0.05
density = 1000.0
velocity = [0.0, 0.0, 0.5]
)");
  run.recorder->snapshot(run.state);
  const Hdf5File file(run.folder.path() + "/surfaces.vtkhdf", Hdf5Access::read);
  const auto corners = file.read_array<std::int64_t>("/VTKHDF/Polygons/Connectivity");
  const auto points = file.read_array<Real>("/VTKHDF/Points"),
             pressure = file.read_array<Real>("/VTKHDF/CellData/pressure"),
             shear = file.read_array<Real>("/VTKHDF/CellData/shear");
  REQUIRE(pressure.size() == 12);
  REQUIRE(points.size() == 24);
  int pressed = 0;
  for (std::size_t t = 0; t < pressure.size(); ++t) {
    if (pressure[t] == 0) continue;
    ++pressed;
    CHECK(std::abs(pressure[t] * (0.5 * 0.4 * 0.2) / (1e4 * 0.002) - 1) < 1e-9);
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) {
      CHECK(points[3 * static_cast<std::size_t>(corners[k]) + 2] == 0.05);
      CHECK(shear[k] == 0);
    }
  }
  CHECK(pressed == 1);
  const Real start = points[0], height = points[2];
  for (int k = 0; k < 10; ++k) run.advance();
  run.recorder->snapshot(run.state);
  const auto later =
      Hdf5File(run.folder.path() + "/surfaces.vtkhdf", Hdf5Access::read).read_array<Real>("/VTKHDF/Points");
  REQUIRE(later.size() == 48);
  CHECK(std::abs(later[24] - start) < 1e-12);
  CHECK(std::abs(later[26] - height - 0.5 * run.state.clock.time) < 1e-9);
}

TEST_CASE("a snapshot that a failed device holds is given up once") {
  Recording<LateBackend> run;
  run.recorder->snapshot(run.state);
  run.backend.fail();
  CHECK_THROWS_AS(run.recorder->write_pending(), DeviceError);
  run.recorder->flush();
  CHECK(run.recorder->snapshots_written() == 0);
}

TEST_CASE("a recorder that has gone leaves no work behind") {
  Recording<LateBackend> run;
  CHECK(run.backend.has_idle_work());
  run.recorder.reset();
  CHECK(!run.backend.has_idle_work());
}

}  // namespace scree
