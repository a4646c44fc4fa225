#include "deck/deck.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "base/error.hpp"
#include "base/file_kinds.hpp"
#include "base/input_file.hpp"
#include "deck/former_names.hpp"
#include "deck/nesting.hpp"
#include "deck/overrides.hpp"
#include "deck/reader.hpp"

namespace scree {

namespace {

// Beginnings of toml++'s messages about a text without quotes.
constexpr std::array<std::string_view, 3> kBareWords = {
    "could not determine value type", "parsing boolean: expected", "parsing floating-point: expected"};

}  // namespace

const DeckValue& DeckTable::value(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) throw std::logic_error("deck: no value for " + path_ + "." + key);
  return found->second;
}

const std::string& DeckTable::word(const std::string& key, const std::type_info& choice_of) const {
  for (const Key& declared : keys_->keys)
    if (declared.name == key && declared.choice_of != nullptr && *declared.choice_of == choice_of)
      return text(key);
  throw std::logic_error("deck: " + path_ + "." + key + " is not this choice");
}

std::string DeckTable::place(const std::string& key) const {
  const std::string full = path_.empty() ? key : path_ + "." + key;
  const auto found = values_.find(key);
  if (found == values_.end()) return location_ + ": " + full;
  const DeckValue& given = found->second;
  if (given.location.starts_with("--set ")) return given.location;
  return fmt::format("{}: {} = {}", given.location, full, given.shown);
}

void DeckTable::fail(const std::string& key, const std::string& problem) const {
  throw InputError(place(key) + ": " + problem);
}

Deck parse_deck(const std::string& text, const std::string& path, const std::vector<std::string>& overrides) {
  if (const int line = line_of_deep_key(text); line > 0)
    throw InputError(fmt::format("{}:{}: a key of more than {} parts", path, line, kMostKeyParts));
  try {
    toml::table source = toml::parse(text, std::string_view(path));
    FormerNames former(SourceText(text, path), path);
    former.replace(source);
    for (const std::string& override_text : overrides) {
      apply_override(source, override_text);
      former.replace(source);
    }
    return {path, read_deck(source, text, path), former.lines()};
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    const bool bare = std::ranges::any_of(kBareWords, [&](std::string_view words) {
      return error.description().find(words) != std::string_view::npos;
    });
    throw InputError(fmt::format("{}:{}:{}: not TOML: {}{}", path, at.line, at.column, error.description(),
                                 bare ? "; texts need quotes" : ""));
  }
}

namespace {

// Advice for some kinds of files that are not decks; "" for others.
std::string way_to_a_deck(const std::string& path, const std::string& kind) {
  if (kind == kUrdfKind) return fmt::format(": scree-post urdf {} converts it to one", path);
  if (kind == kHdf5Kind) return "; a run continues with its deck and --restart CHECKPOINT";
  if (kind.starts_with("a triangle mesh")) return ", which names meshes by meshes.file";
  return "";
}

}  // namespace

Deck load_deck(const std::string& path, const std::vector<std::string>& overrides) {
  if (std::filesystem::is_directory(path)) throw IoError("deck " + path + ": is a folder; must be a file");
  errno = 0;
  std::ifstream file(path);  // may be a pipe
  if (!file) throw IoError(fmt::format("deck {}: cannot be read: {}", path, std::strerror(errno)));
  std::stringstream text;
  text << file.rdbuf();
  if (is_lfs_pointer(text.view())) throw IoError(fmt::format("deck {}: {}", path, kLfsPointerError));
  if (const std::string kind = kind_of_file(text.view().substr(0, kFileBeginning)); !kind.empty())
    throw InputError(
        fmt::format("{}:1: is {}; a deck is text in TOML{}", path, kind, way_to_a_deck(path, kind)));
  return parse_deck(text.str(), path, overrides);
}

}  // namespace scree
