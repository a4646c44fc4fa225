#include "run/check/examples.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <vector>

#include "base/error.hpp"
#include "base/version.hpp"
#include "deck/suggestion.hpp"

namespace scree {
namespace {

constexpr std::size_t kWidth = 110;

std::string path_of(const Example& example) { return fmt::format("{}/{}", example.folder, example.name); }

const Example& find_example(const std::string& name) {
  std::vector<const Example*> found;
  std::vector<std::string> names;
  for (const Example& example : examples()) {
    if (name == example.name || name == path_of(example)) found.push_back(&example);
    names.emplace_back(example.name);
  }
  if (found.size() == 1) return *found.front();
  if (found.empty())
    throw InputError(
        fmt::format("{}: no such example{}; scree new lists them", name, suggestion(name, names)));
  throw InputError(fmt::format("{}: ambiguous: {} or {}", name, path_of(*found[0]), path_of(*found[1])));
}

// Replaces the example's path in the source tree, which its comments mention, by the new file's name.
std::string with_own_name(std::string text, const Example& example, const std::string& file) {
  const std::string path_in_tree = fmt::format("input/{}.toml", path_of(example));
  for (std::size_t at = text.find(path_in_tree); at != std::string::npos;
       at = text.find(path_in_tree, at + file.size()))
    text.replace(at, path_in_tree.size(), file);
  return text;
}

void write_new_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST)
    throw InputError(
        path + ": already exists and is not overwritten; scree new EXAMPLE FILE writes to another name");
  if (file < 0) throw IoError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  errno = ENOSPC;  // the reason for a truncated write
  const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  if (close(file) == 0 && written) return;
  unlink(path.c_str());
  throw IoError(fmt::format("{}: cannot be written: {}", path, std::strerror(error)));
}

}  // namespace

// The first sentence ends with a full stop before a capital letter, outside parentheses: "(Mech. Mach.
// Theory)" does not end one.
std::string first_sentence(std::string_view deck) {
  std::string comment;
  while (deck.starts_with("# ")) {
    const std::size_t end = std::min(deck.find('\n'), deck.size());
    comment += std::string(comment.empty() ? "" : " ") + std::string(deck.substr(2, end - 2));
    deck.remove_prefix(std::min(end + 1, deck.size()));
  }
  int depth = 0;
  for (std::size_t i = 0; i + 2 < comment.size(); ++i) {
    depth += comment[i] == '(' ? 1 : comment[i] == ')' ? -1 : 0;
    if (depth == 0 && comment.compare(i, 2, ". ") == 0 && std::isupper(comment[i + 2]) != 0)
      return comment.substr(0, i + 1);
  }
  return comment;
}

std::string examples_text() {
  std::size_t widest = 0;
  for (const Example& example : examples()) widest = std::max(widest, example.name.size());
  std::string text = "scree new EXAMPLE [FILE] writes one of these decks to begin from:\n", folder;
  for (const Example& example : examples()) {
    if (folder != example.folder) text += fmt::format("\n{}\n", folder = example.folder);
    std::string line = fmt::format("  {:<{}}  {}", example.name, widest, first_sentence(example.text));
    if (line.size() > kWidth) line = line.substr(0, line.rfind(' ', kWidth - 4)) + " ...";
    text += line + "\n";
  }
  return text;
}

std::string write_example(const std::string& name, const std::string& file) {
  const Example& example = find_example(name);
  const std::string path = file.empty() ? std::string(example.name) + ".toml" : file;
  write_new_file(
      path, fmt::format("# From `scree new {}`, Scree {}. `scree keys` explains every key.\n#\n{}",
                        example.name, version(), with_own_name(std::string(example.text), example, path)));
  return path;
}

}  // namespace scree
