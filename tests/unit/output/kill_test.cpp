// Files left by a killed or failing run.
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <new>
#include <optional>

#include "base/error.hpp"
#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"

using namespace scree;

// The HDF5 library frees nothing of a file whose last write failed; the leak sanitizer, where it is on, must
// not turn that into an exit code.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

// A disk that is full behind this offset of a file. Unlike under a limit on its size, the file may be longer.
static off_t disk_end = std::numeric_limits<off_t>::max();

// Points at which a process may be killed: before its writes, and on either side of an exchange of names. It
// kills itself at the one that is so many ahead (0: at none), so that no clock decides which one it is.
static long points_passed = 0, points_to_death = 0;

static void pass_point() {
  ++points_passed;
  if (points_to_death > 0 && --points_to_death == 0) kill(getpid(), SIGKILL);
}

extern "C" ssize_t pwrite(int file, const void* data, std::size_t bytes, off_t at) {
  pass_point();
  if (at + static_cast<off_t>(bytes) <= disk_end) return syscall(SYS_pwrite64, file, data, bytes, at);
  errno = ENOSPC;
  return -1;
}

// A file system that cannot exchange two names.
static bool can_exchange = true;

extern "C" int renameat2(int from_folder, const char* from, int to_folder, const char* to,
                         unsigned int flags) noexcept {
  pass_point();
  if (!can_exchange) {
    errno = EINVAL;
    return -1;
  }
  const auto result = static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
  const int error = errno;
  pass_point();
  errno = error;
  return result;
}

namespace {

// A counter shared by parent and child.
class SharedCounter {
 public:
  SharedCounter() {
    void* memory = mmap(nullptr, sizeof(Count), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    count_ = new (memory) Count(0);
  }
  ~SharedCounter() { munmap(count_, sizeof(Count)); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  int operator()() const { return *count_; }
  void set(int value) { *count_ = value; }

 private:
  using Count = std::atomic<int>;
  Count* count_;
};

// Runs `work` in a child process, which then ends; an exception is its exit code 1.
pid_t start_child(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child != 0) return child;
  try {
    work();
    _exit(0);
  } catch (...) {
    _exit(1);
  }
}

int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

// In the child: a file cannot grow past this size, as on a full disk.
void limit_file_size(rlim_t bytes) {
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
}

// Also where there is no document, as after a restart that has cut off all snapshots.
bool ends_its_document(const std::string& path) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return !file.is_open() || text.ends_with("</Xdmf>\n");
}

// Runs append() in a child, twice and on until its death at the given fraction (0 to 1) of the points of an
// append. acknowledge(): called after each. Returns its exit status.
int die_within(double share, const std::function<std::function<void()>()>& begin,
               const std::function<void()>& acknowledge) {
  return wait_for(start_child([&] {
    const std::function<void()> append = begin();
    append(), acknowledge();
    const long before = points_passed;
    append(), acknowledge();
    const long of_append = points_passed - before;
    points_to_death = 1 + static_cast<long>(share * static_cast<double>(of_append - 1));
    for (;;) append(), acknowledge();
  }));
}

int points_of_step(int step) { return 40 + 20 * (step / 5 % 3); }

}  // namespace

TEST_CASE("a run killed at any moment leaves every snapshot readable, and continues from there") {
  ScratchDirectory scratch;
  SharedCounter acknowledged;
  constexpr int kTrials = 60;
  int kept = 0, shown = 0, hidden = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    CAPTURE(trial);
    std::optional<SnapshotWriter> writer;
    acknowledged.set(kept);
    const int status = die_within(
        trial / (kTrials - 1.0),
        [&] {
          writer.emplace(scratch.path(), SeriesOptions{.title = "title", .keep = kept});
          return [&] {
            PredictableSnapshot(writer->snapshots(), points_of_step(writer->snapshots()), 2)
                .append_to(*writer);
          };
        },
        [&] { acknowledged.set(writer->snapshots()); });
    REQUIRE(WIFSIGNALED(status));
    REQUIRE(acknowledged() >= kept + 2);
    const auto counts = read_predictable_particles(scratch / "particles.vtkhdf");
    const int found = static_cast<int>(counts.size());
    REQUIRE(found >= acknowledged());
    REQUIRE(found <= acknowledged() + 1);
    for (int step = 0; step < found; ++step) {
      REQUIRE(counts[static_cast<std::size_t>(step)] == points_of_step(step));
    }
    const auto shapes = Hdf5File(scratch / "bodies.vtkhdf", Hdf5Access::read).rows("/VTKHDF/Points");
    REQUIRE(shapes >= 2 * acknowledged());
    for (const char* name : {"particles.xdmf", "bodies.xdmf"}) REQUIRE(ends_its_document(scratch / name));
    found > acknowledged() ? ++shown : ++hidden;
    kept = acknowledged() - trial % 2;  // so that every other run also cuts
  }
  CHECK(kept >= kTrials);
  CHECK(shown > kTrials / 10);   // killed when the new snapshot had the file's name
  CHECK(hidden > kTrials / 10);  // and before
}

TEST_CASE("where names cannot be exchanged, snapshots are as complete") {
  ScratchDirectory scratch;
  SharedCounter acknowledged;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    CAPTURE(trial);
    std::optional<SnapshotWriter> writer;
    acknowledged.set(0);
    const int status = die_within(
        trial / (kTrials - 1.0),
        [&] {
          can_exchange = false;
          writer.emplace(scratch.path(), SeriesOptions{.title = "title", .keep = 0});
          return [&] { PredictableSnapshot(writer->snapshots(), 50, 2).append_to(*writer); };
        },
        [&] { acknowledged.set(writer->snapshots()); });
    REQUIRE(WIFSIGNALED(status));
    CHECK(acknowledged() >= 2);
    CHECK(static_cast<int>(read_predictable_particles(scratch / "particles.vtkhdf").size()) >=
          acknowledged());
  }
}

TEST_CASE("a full disk is an error, and what was written stays") {
  ScratchDirectory scratch;
  SECTION("checkpoint") {
    Checkpoint checkpoint;
    checkpoint.reals["a"] = {1, 2, 3};
    write_checkpoint(scratch / "c.h5", checkpoint);
    const int status = wait_for(start_child([&] {
      limit_file_size(100000);
      checkpoint.reals["a"].assign(100000, 4);
      try {
        write_checkpoint(scratch / "c.h5", checkpoint);
      } catch (const IoError&) {
        std::exit(4);  // runs the handlers at exit
      }
    }));
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 4);
    CHECK(read_checkpoint(scratch / "c.h5").real_array("a") == std::vector<Real>{1, 2, 3});
    CHECK(!std::filesystem::exists(scratch / "c.h5.tmp"));
  }
  SECTION("snapshots") {
    SharedCounter written;
    const int status = wait_for(start_child([&] {
      SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
      limit_file_size(200000);
      try {
        for (;; written.set(writer.snapshots()))
          PredictableSnapshot(writer.snapshots(), 200, 0).append_to(writer);
      } catch (const IoError&) {
        std::exit(4);
      }
    }));
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 4);
    CHECK(written() > 2);
    CHECK(read_predictable_particles(scratch / "particles.vtkhdf") ==
          std::vector<int>(static_cast<std::size_t>(written()), 200));
  }
}

TEST_CASE("a history that the disk has no room for holds every flushed row") {
  // Any write of an update may be the one that fails.
  for (off_t end = 20000; end < 40000; end += 1111) {
    CAPTURE(end);
    ScratchDirectory scratch;
    SharedCounter flushed;
    const int status = wait_for(start_child([&] {
      HistoryWriter writer(scratch.path(), {{"", "time", "s", "time"}}, false, 0);
      disk_end = end;
      try {
        for (;; writer.flush(), flushed.set(static_cast<int>(writer.rows())))
          for (int i = 0; i < 100; ++i) writer.append({static_cast<Real>(1 + writer.rows())});
      } catch (const IoError&) {
        std::exit(4);
      }
    }));
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 4);
    CHECK(flushed() > 0);
    const auto time = Hdf5File(scratch / "history.h5", Hdf5Access::read).read_array<Real>("/time");
    CHECK(static_cast<int>(time.size()) == flushed());
    for (std::size_t row = 0; row < time.size(); ++row) REQUIRE(time[row] == static_cast<Real>(row + 1));
  }
}

TEST_CASE("a history killed at any moment holds every flushed row") {
  ScratchDirectory scratch;
  SharedCounter flushed;
  const std::vector<HistoryColumn> columns = {{"", "time", "s", "time"},
                                              {"energy", "kinetic", "J", "energy"}};
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    CAPTURE(trial);
    std::optional<HistoryWriter> writer;
    flushed.set(0);
    const int status = die_within(
        trial / (kTrials - 1.0),
        [&] {
          writer.emplace(scratch.path(), columns, true, 0);
          return [&] {
            for (int i = 0; i < 100; ++i) writer->append({static_cast<Real>(writer->rows()), 0.5});
            writer->flush();
          };
        },
        [&] { flushed.set(static_cast<int>(writer->rows())); });
    REQUIRE(WIFSIGNALED(status));
    CHECK(flushed() >= 200);
    const auto time = Hdf5File(scratch / "history.h5", Hdf5Access::read).read_array<Real>("/time");
    REQUIRE(static_cast<int>(time.size()) >= flushed());
    for (std::size_t row = 0; row < time.size(); ++row) REQUIRE(time[row] == static_cast<Real>(row));
  }
}
