// The example decks in the program, which `scree new` writes.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace scree {

// The deck input/FOLDER/NAME.toml. The build makes the list (examples.cmake), without decks that need other
// files.
struct Example {
  std::string_view folder, name, text;
};
std::span<const Example> examples();

// The first sentence of the deck's leading comment.
std::string first_sentence(std::string_view deck);
// The list of examples: names and first sentences, by folder.
std::string examples_text();
// Writes the example to `file`, or to NAME.toml if `file` is empty, and returns that path. name: "drum" or
// "examples/drum". Throws InputError if there is no such example or the file exists, IoError if it cannot be
// written.
std::string write_example(const std::string& name, const std::string& file);

}  // namespace scree
