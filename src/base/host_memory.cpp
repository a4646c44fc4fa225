#include "base/host_memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

namespace scree {

namespace {

// Version 1 of control groups expresses "no limit" by a number near 2^63.
constexpr Real kNoLimit = 1e18;

void tighten(MemoryBound& bound, Real bytes, const std::string& set_by) {
  if (bytes < bound.bytes) bound = {std::max(bytes, Real(0)), set_by};
}

// The number that follows a word at the start of a line; with an empty word the only number of a file.
std::optional<Real> number_in(const std::string& path, const std::string& word = "") {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(word)) continue;
    std::istringstream rest(line.substr(word.size()));
    Real number = 0;
    return rest >> number ? std::optional(number) : std::nullopt;
  }
  return std::nullopt;
}

struct GroupFiles {
  std::string limit, usage, cache;  // file names; the last is an entry of memory.stat: reclaimable pages
};

// Applies the limits of the groups from `path` up to the root of the hierarchy mounted at `mount`.
void tighten_by_groups(MemoryBound& bound, const std::string& mount, std::string path,
                       const GroupFiles& files) {
  for (;; path = path.substr(0, path.rfind('/'))) {
    if (path == "/") path.clear();
    const std::string folder = mount + path + "/";
    const std::optional<Real> limit = number_in(folder + files.limit),
                              usage = number_in(folder + files.usage);
    if (limit && usage && *limit < kNoLimit) {
      const Real cache = number_in(folder + "memory.stat", files.cache + " ").value_or(0);
      tighten(bound, *limit - std::max(*usage - cache, Real(0)), files.limit + " of the control group");
    }
    if (path.find('/') == std::string::npos) return;
  }
}

// Parses lines "5:memory:/group" of version 1 and "0::/group" of version 2.
void tighten_by_control_groups(MemoryBound& bound, const std::string& root) {
  const std::string mount = root + "/sys/fs/cgroup";
  std::ifstream file(root + "/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first, second - first) + ':', path = line.substr(second + 1);
    if (controllers == "::")
      tighten_by_groups(bound, mount, path, {"memory.max", "memory.current", "inactive_file"});
    if (std::regex_search(controllers, std::regex("[:,]memory[:,]")))
      tighten_by_groups(bound, mount + "/memory", path,
                        {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"});
  }
}

// used: key of a line of /proc/self/status, in kB.
void tighten_by_limit(MemoryBound& bound, const std::string& root, int resource, const std::string& used,
                      const std::string& set_by) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return;
  const Real now = 1024 * number_in(root + "/proc/self/status", used).value_or(0);
  tighten(bound, static_cast<Real>(limit.rlim_cur) - now, set_by);
}

}  // namespace

FreeMemory free_memory(const std::string& root) {
  FreeMemory free;
  if (const auto available = number_in(root + "/proc/meminfo", "MemAvailable:"))
    tighten(free.host, 1024 * *available, "MemAvailable of /proc/meminfo");
  tighten_by_control_groups(free.host, root);
  tighten_by_limit(free.process, root, RLIMIT_AS, "VmSize:", "ulimit -v, the address space");
  tighten_by_limit(free.process, root, RLIMIT_DATA, "VmData:", "ulimit -d, the data segment");
  return free;
}

}  // namespace scree
