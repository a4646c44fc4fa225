// The decks that come with the program: `scree new` writes one to begin from.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace scree {

// A deck of input/FOLDER/NAME.toml. The build makes the list (examples.cmake); decks that need other files
// are not in it.
struct Example {
  std::string_view folder, name, text;
};
std::span<const Example> examples();

// What the deck's first comment says, to the end of its first sentence.
std::string first_sentence(std::string_view deck);
// Names and first sentences, by folder.
std::string examples_text();
// Writes the deck under a new name, `file` or NAME.toml where that is empty, and returns it. name: "drum", or
// "examples/drum". Throws InputError where there is no such example, or where there is a file of that name,
// IoError where it cannot be written.
std::string write_example(const std::string& name, const std::string& file);

}  // namespace scree
