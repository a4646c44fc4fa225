#include "output/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/hdf5_size.hpp"

namespace scree {

namespace {

// A run continued past its end adds chunks of the same length, so that they must not be too short.
std::int64_t rows_of_chunk(std::int64_t likely_rows) {
  constexpr std::int64_t kFewest = 16, kMost = 512;
  return likely_rows == 0 ? kMost : std::clamp(likely_rows, kFewest, kMost);
}

std::int64_t chunks_of(std::int64_t likely_rows) {
  const std::int64_t rows = rows_of_chunk(likely_rows);
  return (likely_rows + rows - 1) / rows;
}

std::string dataset_path(const HistoryColumn& column) {
  return column.group.empty() ? column.name : column.group + "/" + column.name;
}

// A column that earlier versions wrote under another path.
struct FormerColumn {
  std::string former, now;
};
const std::vector<FormerColumn>& former_columns() {
  static const std::vector<FormerColumn> all = {{"step/left", "step/particles_escaped"}};
  return all;
}

std::vector<FormerColumn> former_columns_among(const std::vector<std::string>& names) {
  std::vector<FormerColumn> found;
  for (const FormerColumn& column : former_columns())
    if (std::ranges::find(names, column.former) != names.end()) found.push_back(column);
  return found;
}

// What in the deck chooses the column.
std::string key_of(const std::string& column) {
  const std::string group = column.substr(0, column.find('/'));
  for (const char* const listed :
       {"bodies", "particles", "contacts", "reactions", "efforts", "coordinates", "bushings"})
    if (group == listed) return "output.history_" + group;
  return "the deck";
}

// Quoted if it contains a comma, a quote or a line break (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_header(const std::vector<HistoryColumn>& columns) {
  std::string line;
  for (const HistoryColumn& column : columns) {
    if (!line.empty()) line += ',';
    line += csv_field(fmt::format("{} [{}]", dataset_path(column), column.unit));
  }
  return line + '\n';
}

// values[column][row]; each number in the shortest form that reads back as the same number.
std::string csv_rows(const std::vector<std::vector<Real>>& values) {
  fmt::memory_buffer text;
  const std::size_t rows = values.empty() ? 0 : values.front().size();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < values.size(); ++column) {
      fmt::format_to(std::back_inserter(text), "{}{}", column == 0 ? "" : ",", values[column][row]);
    }
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

}  // namespace

HistoryWriter::HistoryWriter(const std::string& directory, std::vector<HistoryColumn> columns, bool csv,
                             std::int64_t keep, std::int64_t likely_rows)
    : columns_(std::move(columns)),
      chunk_rows_(rows_of_chunk(likely_rows)),
      file_(directory + "/history.h5", {}, chunks_of(likely_rows)),
      csv_path_(csv ? directory + "/history.csv" : ""),
      buffer_(columns_.size()),
      rows_(keep) {
  if (keep == 0) {
    file_.remove();
    std::error_code none_there;
    std::filesystem::remove(directory + "/history.csv", none_there);
  } else {
    cut(keep);
  }
  if (csv) rewrite_csv();
}

void HistoryWriter::cut(std::int64_t keep) {
  bool longer = false;
  std::vector<FormerColumn> renamed;
  {
    const Hdf5File file(file_.path(), Hdf5Access::read);
    const std::vector<std::string> names = file.dataset_names("/");
    renamed = former_columns_among(names);
    require_columns(names);
    for (const HistoryColumn& column : columns_) {
      const auto former = std::ranges::find(renamed, dataset_path(column), &FormerColumn::now);
      const std::int64_t rows = file.rows(former == renamed.end() ? dataset_path(column) : former->former);
      if (rows < keep) {
        throw IoError(fmt::format("{}: {} holds {} rows, but the restarted run has written {}", file_.path(),
                                  dataset_path(column), rows, keep));
      }
      longer = longer || rows > keep;
    }
  }
  if (!longer && renamed.empty()) return;
  file_.update({[&](Hdf5File& file) {
                  for (const FormerColumn& column : renamed) file.rename(column.former, column.now);
                  for (const HistoryColumn& column : columns_) file.resize_rows(dataset_path(column), keep);
                },
                {}});
}

// A restart may ask for other columns: they begin a new file.
void HistoryWriter::require_columns(std::vector<std::string> names) const {
  for (const FormerColumn& column : former_columns_among(names))
    std::ranges::replace(names, column.former, column.now);
  const std::set<std::string> held(names.begin(), names.end());
  std::set<std::string> wanted;
  for (const HistoryColumn& column : columns_) wanted.insert(dataset_path(column));
  const auto refuse = [&](const std::string& column, const char* trouble) {
    throw IoError(fmt::format("{}: {} {}; keep {} unchanged, or choose another folder with --output",
                              file_.path(), trouble, column, key_of(column)));
  };
  for (const std::string& column : wanted)
    if (held.count(column) == 0) refuse(column, "lacks the column that the restarted run is to write,");
  for (const std::string& column : held)
    if (wanted.count(column) == 0) refuse(column, "holds a column that the restarted run is not to write,");
}

void HistoryWriter::append(const std::vector<Real>& row) {
  if (row.size() != columns_.size()) {
    throw SimulationError(
        fmt::format("history row of {} values for {} columns", row.size(), columns_.size()));
  }
  for (std::size_t column = 0; column < row.size(); ++column) buffer_[column].push_back(row[column]);
  ++rows_;
}

void HistoryWriter::write_rows(Hdf5File& file, std::int64_t rows_before) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const std::string path = dataset_path(columns_[c]);
    if (rows_before == 0) {
      file.create_rows<Real>(path, {1, chunk_rows_}, {columns_[c].unit, columns_[c].description});
    }
    file.append_rows(path, buffer_[c].data(), std::ssize(buffer_[c]));
  }
}

void HistoryWriter::flush() {
  if (buffer_.empty() || buffer_.front().empty()) return;
  const std::int64_t rows_before = rows_ - std::ssize(buffer_.front());
  file_.update({[&](Hdf5File& file) { write_rows(file, rows_before); }, {}});
  if (!csv_path_.empty()) append_text_file(csv_path_, csv_rows(buffer_));
  for (auto& column : buffer_) column.clear();
}

// Rewritten from history.h5, so that a restarted run does not need the first run's CSV.
void HistoryWriter::rewrite_csv() const {
  std::vector<std::vector<Real>> values(columns_.size());
  if (rows_ > 0) {
    const Hdf5File file(file_.path(), Hdf5Access::read);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      values[c] = file.read_array<Real>(dataset_path(columns_[c]));
  }
  write_text_file(csv_path_, csv_header(columns_) + csv_rows(values));
}

HistorySize history_size(const std::vector<HistoryColumn>& columns, std::int64_t rows,
                         std::int64_t likely_rows) {
  constexpr Real kCsvValue = 15;  // the shortest form of most numbers has 5 to 20 characters, and a comma
  Hdf5Size size(chunks_of(likely_rows));
  std::map<std::string, std::int64_t> names;  // number of names per group
  for (const HistoryColumn& column : columns) {
    size.add_rows({1, rows_of_chunk(likely_rows)}, sizeof(Real), rows);
    const std::string path = dataset_path(column);
    for (std::size_t end = path.rfind('/'); end != std::string::npos; end = path.rfind('/', end - 1))
      if (++names[path.substr(0, end)] > 1 || end == 0) break;  // a new group adds a name to its parent
  }
  for (const auto& [group, count] : names) size.add_group(count);
  return {size.bytes(), kCsvValue * static_cast<Real>(columns.size()) * static_cast<Real>(rows)};
}

}  // namespace scree
