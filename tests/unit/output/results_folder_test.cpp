// Permission to write into a folder of results.
#include "output/results_folder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "base/error.hpp"
#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "output/lock_owner.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"

using namespace scree;
namespace fs = std::filesystem;

namespace {

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

std::string read(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The message of an InputError; empty where none is thrown.
std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// A process that holds the folder until it is killed.
class Holder {
 public:
  explicit Holder(const std::string& folder) {
    int ready[2];
    REQUIRE(pipe(ready) == 0);
    process_ = fork();
    if (process_ == 0) {
      ResultsFolder own({folder, "", true});
      own.claim();
      const ssize_t told = ::write(ready[1], "x", 1);
      for (;;) pause();
      _exit(static_cast<int>(told));
    }
    char byte = 0;
    REQUIRE(::read(ready[0], &byte, 1) == 1);
    close(ready[0]), close(ready[1]);
  }
  ~Holder() { end(); }
  void end() {
    if (process_ == 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  pid_t process() const { return process_; }

 private:
  pid_t process_ = 0;
};

}  // namespace

TEST_CASE("a folder belongs to one run at a time, and to the next one after a kill") {
  ScratchDirectory scratch;
  Holder holder(scratch.path());
  ResultsFolder folder({scratch.path(), "", true});
  for (const std::string& message : {refusal([&] { folder.check(); }), refusal([&] { folder.claim(); })}) {
    CAPTURE(message);
    CHECK(message.find("process " + std::to_string(holder.process()) + " on host ") != std::string::npos);
    CHECK(message.find(scratch / "scree.lock") != std::string::npos);
  }
  holder.end();
  CHECK(fs::exists(scratch / "scree.lock"));
  folder.check();
  folder.claim();
  CHECK(read(scratch / "scree.lock").find("process " + std::to_string(getpid()) + "\n") != std::string::npos);
}

TEST_CASE("a run releases its folder, and leaves a folder that was not used before unchanged") {
  ScratchDirectory scratch;
  write(scratch / "notes.txt", "mine");
  {
    ResultsFolder folder({scratch / "new/and deep", "", false});
    folder.check();
    CHECK(!fs::exists(scratch / "new"));
    folder.claim();
    CHECK(fs::exists(scratch / "new/and deep/scree.lock"));
    ResultsFolder beside({scratch.path(), "", false});
    beside.claim(), beside.clear();
  }
  CHECK(fs::is_empty(scratch / "new/and deep"));
  CHECK(!fs::exists(scratch / "scree.lock"));
  CHECK(read(scratch / "notes.txt") == "mine");
}

TEST_CASE("a lock that its writer had no time to fill, and one that a dead machine left, are taken over") {
  ScratchDirectory scratch;  // on a disk of this machine
  for (const char* text : {"", "host elsewhere\nprocess 1\nprocess_start 5\n", "no lock at all"}) {
    write(scratch / "scree.lock", text);
    ResultsFolder folder({scratch.path(), "", false});
    folder.check();
    folder.claim();
    CHECK(read(scratch / "scree.lock").find("host ") == 0);
  }
}

TEST_CASE("an entry with the lock's name that is not a file is refused, and is not a lock") {
  for (const bool is_folder : {true, false}) {
    ScratchDirectory scratch;
    const std::string path = scratch / "scree.lock";
    if (is_folder)
      fs::create_directory(path);
    else
      REQUIRE(mkfifo(path.c_str(), 0666) == 0);  // a reader of which would block
    const auto message_of_use = [&](const auto& use) {
      try {
        ResultsFolder folder({scratch.path(), "", true});
        use(folder);
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return std::string("nothing was refused");
    };
    const std::string words = path + " is " + (is_folder ? "a folder" : "no file") + ", but has the name";
    CHECK(message_of_use([](const ResultsFolder& f) { f.check(); }).find(words) != std::string::npos);
    CHECK(message_of_use([](ResultsFolder& f) { f.claim(); }).find(words) != std::string::npos);
    CHECK(!FolderLock(scratch.path()).owner());
    CHECK(fs::exists(path));
  }
}

TEST_CASE("where the system's lock is not available, the text of the file decides") {
  const LockOwner self = LockOwner::this_process();
  REQUIRE(!self.process_start.empty());
  LockOwner owner = self;
  const auto over = [&](LockState lock) { return is_over(owner, self, lock, false); };
  SECTION("the same process, as far as the text goes") {
    CHECK(!over(LockState::unknown));
    CHECK(over(LockState::free));
    CHECK(!over(LockState::held));
  }
  SECTION("a process that has ended") {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    owner.process = std::to_string(child);
    CHECK(over(LockState::unknown));
  }
  SECTION("a process whose id is another's by now") {
    owner.process_start = "1";
    CHECK(over(LockState::unknown));
  }
  SECTION("before the machine's last start") {
    owner.boot = "another";
    CHECK(over(LockState::unknown));
  }
  SECTION("another host, of which this one cannot know") {
    owner.host = "another", owner.process_start = "1";
    CHECK(!over(LockState::unknown));
    CHECK(!over(LockState::free));
    CHECK(is_over(owner, self, LockState::free, true));
    CHECK(!is_over(owner, self, LockState::held, true));
  }
  SECTION("another host, and an earlier start of the same job") {
    LockOwner now = self;
    owner.host = "another", owner.job = now.job = "17", now.job_start = "1";
    CHECK(is_over(owner, now, LockState::unknown, false));
    CHECK(is_over(owner, now, LockState::held, false));  // by a server whose information is not up to date
    CHECK(!is_over(owner, now, LockState::held, true));
    now.job_start = owner.job_start;
    CHECK(!is_over(owner, now, LockState::unknown, false));
    now.job = "18", now.job_start = "1";
    CHECK(!is_over(owner, now, LockState::unknown, false));
  }
  SECTION("nothing is known") {
    owner = {};
    CHECK(!over(LockState::unknown));
    CHECK(over(LockState::free));
  }
  ScratchDirectory scratch;
  write(scratch / "text", owner.text());
  CHECK(LockOwner::read(scratch / "text").text() == owner.text());
}

TEST_CASE("results of another run are refused, or removed as a whole when that is asked for") {
  ScratchDirectory scratch;
  const char* const old[] = {"history.h5", "checkpoint.h5", "particles.xdmf", "run_record.json"};
  for (const char* name : old) write(scratch / name, "old");
  for (const char* name : {"bodies.vtkhdf.spare", "checkpoint_end.h5.tmp", "history.h5.old", "notes.txt"})
    write(scratch / name, "old");
  const auto careful = [&] { return ResultsFolder({scratch.path(), "", false}); };
  const std::string message = refusal([&] { careful().check(); });
  CAPTURE(message);
  CHECK(message.find(scratch.path()) != std::string::npos);
  CHECK(message.find("--overwrite") != std::string::npos);
  CHECK(message.find("--restart " + (scratch / "checkpoint.h5") + " continues") != std::string::npos);
  for (const char* name : old) CHECK(message.find(name) != std::string::npos);
  CHECK(refusal([&] { careful().claim(); }) == message);

  ResultsFolder bold({scratch.path(), "", true});
  bold.check();
  bold.claim();
  CHECK(fs::exists(scratch / "history.h5"));  // nothing is lost before the run begins
  bold.clear();
  const fs::directory_iterator files(scratch.path());
  CHECK(std::distance(begin(files), end(files)) == 2);  // the lock and the log
  CHECK(fs::exists(scratch / "notes.txt"));
}

TEST_CASE("a restart continues in its own folder, and spares others") {
  ScratchDirectory scratch;
  fs::create_directory(scratch / "other");
  for (const char* name : {"history.h5", "checkpoint.h5", "checkpoint_end.h5", "other/checkpoint.h5"})
    write(scratch / name, "old");
  write(scratch / "history.h5.tmp", "old");
  {
    ResultsFolder own({scratch.path(), scratch / "other/../checkpoint.h5", false});
    own.check(), own.claim(), own.clear();
    CHECK(own.continues());
    // A checkpoint of steps that are repeated is set aside.
    CHECK((fs::exists(scratch / "checkpoint.h5") && fs::exists(scratch / "checkpoint_end.h5.earlier")));
    CHECK(!fs::exists(scratch / "checkpoint_end.h5"));
    CHECK(!fs::exists(scratch / "history.h5.tmp"));
  }
  const std::string message = refusal([&] {
    ResultsFolder({scratch.path(), scratch / "other/checkpoint.h5", false}).check();
  });
  CHECK(message.find("history.h5, checkpoint.h5") != std::string::npos);
  CHECK(message.find("continues them") == std::string::npos);
  // A checkpoint that was copied into an empty folder is the start of a run: it stays.
  ResultsFolder copied({scratch / "other", scratch / "other/checkpoint.h5", false});
  copied.check(), copied.claim(), copied.clear();
  CHECK(!copied.continues());
  CHECK(fs::exists(scratch / "other/checkpoint.h5"));
}

TEST_CASE("links in the folder are not followed") {
  ScratchDirectory scratch, elsewhere;
  write(elsewhere / "victim", "untouched");
  for (const char* name : {"c.h5.tmp", "history.h5.spare", "history.csv.tmp", "particles.vtkhdf.spare",
                           "particles.xdmf.tmp", "bodies.vtkhdf.spare", "bodies.xdmf.tmp", "history.h5.old"})
    fs::create_symlink(elsewhere / "victim", scratch / name);
  Checkpoint checkpoint;
  checkpoint.reals["a"] = {1};
  write_checkpoint(scratch / "c.h5", checkpoint);
  HistoryWriter history(scratch.path(), {{"", "time", "s", "time"}}, true, 0);
  SnapshotWriter snapshots(scratch.path(), {.title = "title", .keep = 0});
  for (int step = 0; step < 3; ++step) {
    // Files that another process puts there during the run.
    for (const char* name : {"particles.xdmf.tmp", "bodies.xdmf.tmp"})
      if (!fs::is_symlink(scratch / name)) fs::create_symlink(elsewhere / "victim", scratch / name);
    PredictableSnapshot(step, 5, 2).append_to(snapshots);
    history.append({1.0 * step});
    history.flush();
  }
  CHECK(read(elsewhere / "victim") == "untouched");
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf").size() == 3);
  CHECK(!fs::is_symlink(scratch / "c.h5"));
  fs::create_symlink(elsewhere / "nothing", scratch / "scree.lock");
  ResultsFolder folder({scratch.path(), "", true});
  CHECK_THROWS_AS(folder.claim(), IoError);
  CHECK(!fs::exists(elsewhere / "nothing"));
}
