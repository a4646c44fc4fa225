#include "base/input_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/index.hpp"

namespace scree {

namespace {

// The first line of every pointer file, without the version number.
constexpr std::string_view kLfsBeginning = "version https://git-lfs.github.com/spec/";

}  // namespace

bool is_lfs_pointer(std::string_view beginning) { return beginning.starts_with(kLfsBeginning); }

std::string input_file_error(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return "cannot be read: " + error.message();
  if (std::filesystem::is_directory(status)) return "is a folder; must be a file";
  if (!std::filesystem::is_regular_file(status)) return "is not a regular file";
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::string("cannot be read: ") + std::strerror(errno);
  std::array<char, kLfsBeginning.size()> beginning{};
  file.read(beginning.data(), beginning.size());
  if (file.bad()) return std::string("cannot be read: ") + std::strerror(errno);
  if (is_lfs_pointer({beginning.data(), as_size(file.gcount())})) return kLfsPointerError;
  return "";
}

}  // namespace scree
