// Tables of tests/reference, and decks of input, for tests.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "model/builder/build.hpp"
#include "support/catch.hpp"

namespace scree {

// Rows of numbers of a reference file; lines that do not start with a number are its header.
inline std::vector<std::vector<Real>> reference_rows(const std::string& name) {
  std::ifstream file(std::filesystem::path(SCREE_SOURCE_DIR) / "tests/reference" / name);
  REQUIRE(file.good());
  std::vector<std::vector<Real>> rows;
  for (std::string line; std::getline(file, line);) {
    std::vector<Real> row;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) {
      char* end = nullptr;
      const Real value = std::strtod(word.c_str(), &end);
      if (end == word.c_str()) break;
      row.push_back(value);
    }
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

// Model of the deck input/NAME.
inline Model input_model(const std::string& name, const std::vector<std::string>& overrides = {}) {
  Log log(true);
  return build_model(
      load_deck((std::filesystem::path(SCREE_SOURCE_DIR) / "input" / name).string(), overrides), log);
}

}  // namespace scree
