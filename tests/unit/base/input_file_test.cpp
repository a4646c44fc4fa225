// Reasons why a file is not usable as input.
#include "base/input_file.hpp"

#include <filesystem>
#include <fstream>

#include "support/catch.hpp"

namespace scree {

TEST_CASE("files that are no input, each with its reason") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "scree_input_file_test";
  std::filesystem::create_directories(folder);
  const auto convergence_error = [&](const char* name, const char* content) {
    std::ofstream(folder / name) << content;
    return input_file_error((folder / name).string());
  };
  CHECK(convergence_error("empty", "").empty());
  CHECK(convergence_error("short", "version").empty());
  CHECK(convergence_error("deck.toml", "title = \"version https://git-lfs.github.com/spec/v1\"\n").empty());
  CHECK(convergence_error("pointer", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n") ==
        kLfsPointerError);
  CHECK(input_file_error((folder / "none").string()) == "cannot be read: No such file or directory");
  CHECK(input_file_error((folder / "short/none").string()) == "cannot be read: Not a directory");
  CHECK(input_file_error(folder.string()) == "is a folder; must be a file");
  CHECK(input_file_error("/dev/zero") == "is not a regular file");
  std::filesystem::remove_all(folder);
}

}  // namespace scree
