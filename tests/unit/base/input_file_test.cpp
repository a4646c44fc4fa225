// Reasons why a file is not usable as input.
#include "base/input_file.hpp"

#include <filesystem>
#include <fstream>

#include "support/catch.hpp"

namespace scree {

TEST_CASE("files that are no input, each with its reason") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "scree_input_file_test";
  std::filesystem::create_directories(folder);
  const auto trouble_of = [&](const char* name, const char* content) {
    std::ofstream(folder / name) << content;
    return input_file_trouble((folder / name).string());
  };
  CHECK(trouble_of("empty", "").empty());
  CHECK(trouble_of("short", "version").empty());
  CHECK(trouble_of("deck.toml", "title = \"version https://git-lfs.github.com/spec/v1\"\n").empty());
  CHECK(trouble_of("pointer", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n") ==
        kLfsPointerTrouble);
  CHECK(input_file_trouble((folder / "none").string()) == "cannot be read: No such file or directory");
  CHECK(input_file_trouble((folder / "short/none").string()) == "cannot be read: Not a directory");
  CHECK(input_file_trouble(folder.string()) == "is a folder; must be a file");
  CHECK(input_file_trouble("/dev/zero") == "is not a regular file");
  std::filesystem::remove_all(folder);
}

}  // namespace scree
