// Values as messages show them: numbers are quoted from the deck's text.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.hpp"

namespace scree {

// The text of a deck, which must outlive this. path: that of its nodes.
class SourceText {
 public:
  SourceText() = default;
  SourceText(std::string_view text, std::string_view path);

  // The text of the region; empty where it is not in this text, spans several lines or begins far to the
  // right in a line.
  std::string_view at(const toml::source_region& region) const;

 private:
  std::string_view text_, path_;
  std::vector<std::size_t> lines_;  // where they begin
};

// A number as TOML text: the shortest that reads back to the same.
std::string number_text(Real x);
// A value as TOML text, shortened to a line's length; numbers as written in `source`, where they are in it.
std::string shown(const toml::node& node, const SourceText& source = {});

}  // namespace scree
