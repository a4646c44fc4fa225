#include "run/report/scree_post.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "run/report/signals.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "scree-post";

bool can_run(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

// Path of the program on the PATH; empty if it is not there.
std::string first_on_path() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (can_run(fs::path(folder) / kName)) return (fs::path(folder) / kName).string();
  return "";
}

std::string in_source_tree() {
  std::error_code error;
  fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (; folder.has_relative_path(); folder = folder.parent_path())
    if (const fs::path path = folder / "postprocess" / kName; can_run(path)) return path.string();
  return "";
}

// The status of waitpid(), which a signal to this process does not interrupt.
int status_at_end(pid_t process) {
  constexpr useconds_t kPollInterval = 20000;  // [us]
  int status = 0;
  while (waitpid(process, &status, WNOHANG) == 0) {
    if (signal_received() != 0) kill(process, SIGTERM);
    usleep(kPollInterval);
  }
  return status;
}

// The last message of the program, without the prefix "error: ".
std::string last_message(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  const std::string word = "error: ";
  return last.starts_with(word) ? last.substr(word.size()) : last;
}

// Throws if the program failed. Its exit code 2 means a request that it cannot fulfil.
void check_status(int status, const std::string& program, const std::string& output) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string end = WIFSIGNALED(status)
                              ? fmt::format("was ended by a signal ({})", strsignal(WTERMSIG(status)))
                              : fmt::format("ended with exit code {}", WEXITSTATUS(status));
  const std::string message = fmt::format("{} {}{}", program, end, output.empty() ? "" : ": " + output);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) throw InputError(output.empty() ? message : output);
  throw IoError(message);
}

}  // namespace

std::string find_scree_post() {
  if (const char* const named = std::getenv("SCREE_POST"); named != nullptr && *named != '\0') {
    if (can_run(named)) return named;
    throw InputError(
        fmt::format("environment variable SCREE_POST = {}: is not an executable program", named));
  }
  for (const std::string& found : {first_on_path(), in_source_tree()})
    if (!found.empty()) return found;
  throw InputError(
      "--picture needs the program scree-post for drawing: it is not on the PATH, and the environment "
      "variable SCREE_POST does not name it; pip install ./postprocess installs it");
}

void run_scree_post(const std::string& program, const std::vector<std::string>& options,
                    const std::string& log) {
  std::vector<std::string> texts{program};
  texts.insert(texts.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& text : texts) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT, 0666);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t process = 0;
  const int error = posix_spawn(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw IoError(fmt::format("{}: cannot be started: {}", program, std::strerror(error)));
  const int status = status_at_end(process);
  if (signal_received() == 0) check_status(status, program, last_message(log));
}

}  // namespace scree
