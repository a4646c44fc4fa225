// Tables of tests/reference with named columns, some of them with text cells.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// The rows below the line of names; lines that start with # are comments.
class ReferenceTable {
 public:
  // One row; throws where there is no such column, or where its cell is not a number.
  class Row {
   public:
    Row(const ReferenceTable& table, std::vector<std::string> cells)
        : table_(&table), cells_(std::move(cells)) {}

    const std::string& word(const std::string& column) const { return cells_.at(table_->column(column)); }
    Real operator[](const std::string& column) const {
      const std::string& cell = word(column);
      char* end = nullptr;
      const Real value = std::strtod(cell.c_str(), &end);
      if (end == cell.c_str() || *end != '\0') throw std::runtime_error(column + ": no number: " + cell);
      return value;
    }
    bool empty(const std::string& column) const { return word(column).empty(); }

   private:
    const ReferenceTable* table_;
    std::vector<std::string> cells_;
  };

  // Reads tests/reference/NAME.
  explicit ReferenceTable(const std::string& name) {
    std::ifstream file(std::filesystem::path(SCREE_SOURCE_DIR) / "tests/reference" / name);
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      if (columns_.empty())
        columns_ = cells_of(line);
      else
        rows_.emplace_back(*this, cells_of(line));
    }
    if (rows_.empty()) throw std::runtime_error("no rows in tests/reference/" + name);
  }
  ReferenceTable(const ReferenceTable&) = delete;
  ReferenceTable& operator=(const ReferenceTable&) = delete;

  const std::vector<Row>& rows() const { return rows_; }
  bool has(const std::string& name) const {
    return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
  }

 private:
  static std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) cells.push_back(word);
    if (line.back() == ',') cells.emplace_back();
    return cells;
  }
  std::size_t column(const std::string& name) const {
    const auto found = std::find(columns_.begin(), columns_.end(), name);
    if (found == columns_.end()) throw std::runtime_error("no column " + name);
    return static_cast<std::size_t>(found - columns_.begin());
  }

  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace scree
