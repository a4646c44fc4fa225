#include "output/lock_owner.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/utc.hpp"

namespace scree {

namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string first_word(const std::string& text) {
  std::string word;
  std::istringstream(text) >> word;
  return word;
}

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : first_word(value);
}

// Start time of a process, which tells processes with the same id apart. Empty if there is no such process.
std::string start_of(const std::string& process) {
  const std::string status = text_of("/proc/" + process + "/stat");
  const auto name_end = status.rfind(')');  // the name may hold blanks
  if (name_end == std::string::npos) return {};
  std::istringstream fields(status.substr(name_end + 1));
  std::string field;
  for (int number = 3; number <= 22; ++number) fields >> field;
  return field;
}

// Calls use(name, value) for the lines of the text.
template <class Entries, class Use>
void for_each_entry(Entries& owner, const Use& use) {
  use("host", owner.host), use("boot", owner.boot);
  use("process", owner.process), use("process_start", owner.process_start);
  use("job", owner.job), use("job_start", owner.job_start), use("since", owner.since);
}

}  // namespace

LockOwner LockOwner::this_process() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string id = std::to_string(getpid());
  return {host.data(),
          first_word(text_of("/proc/sys/kernel/random/boot_id")),
          id,
          start_of(id),
          environment("SLURM_JOB_ID"),
          environment("SLURM_RESTART_COUNT"),
          utc_now()};
}

LockOwner LockOwner::read(const std::string& path) {
  LockOwner owner;
  std::istringstream lines(text_of(path));
  for (std::string name, value; lines >> name >> value;) {
    for_each_entry(owner, [&](const char* entry, std::string& to) {
      if (name == entry) to = value;
    });
  }
  return owner;
}

std::string LockOwner::text() const {
  std::string text;
  for_each_entry(*this, [&](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} {}\n", name, value);
  });
  return text;
}

std::string LockOwner::described() const {
  if (host.empty()) return "";
  return fmt::format("process {} on host {}{}, since {}", process, host,
                     job.empty() ? "" : ", SLURM job " + job, since);
}

bool is_over(const LockOwner& owner, const LockOwner& self, LockState lock, bool on_own_disk) {
  if (on_own_disk && lock != LockState::unknown) return lock == LockState::free;
  // A file server may keep the lock of a machine that is down.
  if (!owner.job.empty() && owner.job == self.job && owner.job_start != self.job_start) return true;
  if (lock == LockState::held) return false;
  if (owner.host.empty()) return lock == LockState::free;
  if (owner.host != self.host) return false;
  return lock == LockState::free || owner.boot != self.boot || owner.process_start != start_of(owner.process);
}

}  // namespace scree
