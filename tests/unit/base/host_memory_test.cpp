// Free memory as reported by /proc, control groups and limits.
#include "base/host_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/catch.hpp"

namespace scree {

namespace {

// A host of 8 GB, 6 GB of them available, in a folder.
class Host {
 public:
  Host() : root_(std::filesystem::temp_directory_path() / ("scree_host_" + std::to_string(getpid()))) {
    write("/proc/meminfo", "MemTotal:  8000000 kB\nMemFree:  1000000 kB\nMemAvailable:  6000000 kB\n");
    write("/proc/self/status", "VmSize:  100000 kB\nVmData:  50000 kB\n");
  }
  ~Host() { std::filesystem::remove_all(root_); }
  void write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = root_.string() + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  MemoryBound free() const { return free_memory(root_.string()).host; }
  std::string root() const { return root_.string(); }

 private:
  std::filesystem::path root_;
};

}  // namespace

TEST_CASE("without control groups the host's available memory counts") {
  const Host host;
  CHECK(host.free().bytes == 6000000.0 * 1024);
  CHECK(host.free().set_by == "MemAvailable of /proc/meminfo");
}

TEST_CASE("the tightest control group above the process counts, less what it cannot give back") {
  const Host host;
  host.write("/proc/self/cgroup", "0::/job/step\n");
  host.write("/sys/fs/cgroup/job/step/memory.max", "max\n");
  host.write("/sys/fs/cgroup/job/step/memory.current", "1000\n");
  host.write("/sys/fs/cgroup/job/memory.max", "3000000000\n");
  host.write("/sys/fs/cgroup/job/memory.current", "900000000\n");
  CHECK(host.free().bytes == 2.1e9);
  host.write("/sys/fs/cgroup/job/memory.stat", "anon 100000000\ninactive_file 800000000\n");
  CHECK(host.free().bytes == 2.9e9);
  CHECK(host.free().set_by == "memory.max of the control group");
  host.write("/sys/fs/cgroup/job/memory.current", "5000000000\n");
  CHECK(host.free().bytes == 0);
}

TEST_CASE("control groups of version 1") {
  const Host host;
  host.write("/proc/self/cgroup", "9:cpu:/job\n5:memory:/job\n0::/\n");
  host.write("/sys/fs/cgroup/memory/job/memory.limit_in_bytes", "2000000000\n");
  host.write("/sys/fs/cgroup/memory/job/memory.usage_in_bytes", "500000000\n");
  host.write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  host.write("/sys/fs/cgroup/memory/memory.usage_in_bytes", "100\n");
  CHECK(host.free().bytes == 1.5e9);
  CHECK(host.free().set_by == "memory.limit_in_bytes of the control group");
}

TEST_CASE("limits of the process") {
  const Host host;
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_DATA, &before) == 0);
  rlimit limited = before;
  limited.rlim_cur = 4000000000;
  REQUIRE(setrlimit(RLIMIT_DATA, &limited) == 0);
  const MemoryBound bound = free_memory(host.root()).process;
  CHECK(setrlimit(RLIMIT_DATA, &before) == 0);
  CHECK(bound.bytes == 4e9 - 50000.0 * 1024);
  CHECK(bound.set_by == "ulimit -d, the data segment");
}

}  // namespace scree
