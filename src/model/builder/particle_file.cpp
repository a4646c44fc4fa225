#include "model/builder/particle_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/file_kinds.hpp"
#include "deck/suggestion.hpp"
#include "model/builder/hdf5_open.hpp"
#include "model/checks/memory.hpp"

namespace scree {

namespace {

std::vector<std::string> known_columns(int dimension) {
  if (dimension == 2) return {"x", "y", "vx", "vy", "wz", "radius", "mass", "inertia_factor"};
  return {"x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "radius", "mass", "inertia_factor"};
}

// Cells of a CSV line, without blanks around them. Cells are separated by commas; a quoted cell may contain
// commas, and two quotes stand for one (RFC 4180).
std::vector<std::string> split_line(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) {
    constexpr const char* kBlanks = " \t\r";
    cell.erase(0, std::min(cell.find_first_not_of(kBlanks), cell.size()));
    cell.erase(cell.find_last_not_of(kBlanks) + 1);
  }
  return cells;
}

// The separator that the file uses in place of commas; "" where none is recognised.
std::string separator_of(const std::string& cell) {
  return cell.find(';') != cell.npos             ? "semicolons"
         : cell.find('\t') != cell.npos          ? "tabs"
         : cell.find_first_of(" |") == cell.npos ? ""
         : cell.find('|') != cell.npos           ? "bars"
                                                 : "blanks";
}

// Empty where the cell is not a number. std::from_chars() does not accept a plus sign.
std::optional<Real> number_of(const std::string& cell) {
  Real value = 0;
  const char* const begin = cell.data() + (cell.size() > 1 && cell[0] == '+' && cell[1] != '-' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

bool is_number(const std::string& cell) { return number_of(cell).has_value(); }

std::string example_header(int dimension) { return dimension == 2 ? "x,y,radius" : "x,y,z,radius"; }

bool is_positive(const std::string& column) {
  return column == "radius" || column == "mass" || column == "inertia_factor";
}

// The error of a value, or "".
std::string value_error(const std::string& column, Real value) {
  if (column == "inertia_factor" && value > 1) return "must be at most 1, all mass at the radius";
  if (std::isfinite(value) && (!is_positive(column) || value > 0)) return "";
  return fmt::format("must be a {}finite number", is_positive(column) ? "positive, " : "");
}

// Throws InputError without the place.
Real parse_cell(const std::string& cell, const std::string& column) {
  const std::optional<Real> value = number_of(cell);
  const std::string trouble = value ? value_error(column, *value) : "must be a number";
  if (!trouble.empty()) throw InputError(fmt::format("column {} = {}: {}", column, cell, trouble));
  return *value;
}

std::vector<std::string> parse_header(const std::vector<std::string>& cells, int dimension,
                                      const std::string& place) {
  const std::vector<std::string> known = known_columns(dimension);
  std::set<std::string> seen;
  if (const std::string separator = separator_of(cells.front()); cells.size() == 1 && !separator.empty())
    throw InputError(
        fmt::format("{}: columns must be separated by commas, after a header line that names them, as {}; "
                    "here {} stand between "
                    "them",
                    place, example_header(dimension), separator));
  if (std::all_of(cells.begin(), cells.end(), is_number))
    throw InputError(
        fmt::format("{}: the first line that is no comment must name the columns, as {}; it has numbers",
                    place, example_header(dimension)));
  for (const std::string& name : cells) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw InputError(fmt::format("{}: unknown column \"{}\"{}", place, name, suggestion(name, known)));
    }
    if (!seen.insert(name).second)
      throw InputError(fmt::format("{}: column \"{}\" is repeated", place, name));
  }
  return cells;
}

// A CSV's table, line by line.
class CsvTable {
 public:
  explicit CsvTable(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw IoError(path + ": cannot be read");
  }
  // Reads the cells of the next line that is neither empty nor a comment; false at the end.
  bool next(std::vector<std::string>& cells) {
    for (std::string line; std::getline(file_, line);) {
      ++number_;
      constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // spreadsheets write it first
      if (number_ == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
      cells = split_line(line);
      if (!cells.front().starts_with("#") && !(cells.size() == 1 && cells.front().empty())) return true;
    }
    return false;
  }
  std::string place() const { return fmt::format("{}:{}", path_, number_); }

 private:
  std::string path_;
  std::ifstream file_;
  int number_ = 0;
};

// Names of the columns; empty for an empty file. Counts the rows.
std::vector<std::string> scan_csv(const std::string& path, int dimension, std::int64_t& count) {
  CsvTable table(path);
  std::vector<std::string> header, cells;
  if (!table.next(cells)) return {};
  header = parse_header(cells, dimension, table.place());
  for (count = 0; table.next(cells); ++count) {
    if (cells.size() == header.size()) continue;
    const std::string separator = cells.size() == 1 ? separator_of(cells.front()) : "";
    throw InputError(fmt::format("{}: {}; must be {}, as the header{}", table.place(),
                                 counted(std::ssize(cells), "value", "values"), header.size(),
                                 separator.empty() ? "" : fmt::format(", and {} are no commas", separator)));
  }
  return header;
}

ParticleColumns read_csv(const std::string& path, const std::vector<std::string>& header, IdRange rows) {
  ParticleColumns columns;
  for (const std::string& name : header) columns[name];
  CsvTable table(path);
  std::vector<std::string> cells;
  table.next(cells);
  for (std::int64_t row = 0; row < rows.last && table.next(cells); ++row) {
    if (row < rows.first) continue;
    try {
      for (std::size_t i = 0; i < cells.size(); ++i)
        columns[header[i]].push_back(parse_cell(cells[i], header[i]));
    } catch (const InputError& error) {
      throw InputError(table.place() + ": " + error.what());
    }
  }
  return columns;
}

// An HDF5 identifier with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Suppresses the library's error output while it exists: errors become exceptions.
class QuietHdf5 {
 public:
  QuietHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

Handle open_file(const std::string& path) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  return {open_hdf5(path, Hdf5Open::read, access.get()), H5Fclose};
}

[[noreturn]] void fail_dataset(const std::string& path, const std::string& name) {
  throw InputError(fmt::format("{}: dataset {} must hold numbers, one per particle", path, name));
}

// Advice for files that Scree has written; "" for others.
std::string advice_of_own(hid_t file) {
  constexpr const char* kSettled =
      "scree.packing.settled in Python makes particle files of a run's last snapshot, with what a deck says "
      "of them";
  if (H5Lexists(file, "VTKHDF", H5P_DEFAULT) > 0)
    return fmt::format("is a snapshot file (VTKHDF): {}", kSettled);
  if (H5Aexists(file, "format") > 0 && H5Lexists(file, "reals", H5P_DEFAULT) > 0)
    return fmt::format("is a checkpoint, which --restart goes on from: {}", kSettled);
  return "";
}

// Lengths of the file's columns.
std::map<std::string, std::int64_t> scan_hdf5(const std::string& path, int dimension) {
  const QuietHdf5 quiet;
  const Handle file = open_file(path);
  if (!file.valid()) throw IoError(path + ": cannot be read as HDF5");
  if (const std::string advice = advice_of_own(file.get()); !advice.empty())
    throw InputError(path + ": " + advice);
  std::map<std::string, std::int64_t> lengths;
  for (const std::string& name : known_columns(dimension)) {
    if (H5Lexists(file.get(), name.c_str(), H5P_DEFAULT) <= 0) continue;
    const Handle dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(dataset.valid() ? H5Dget_space(dataset.get()) : H5I_INVALID_HID, H5Sclose);
    if (!space.valid() || H5Sget_simple_extent_ndims(space.get()) != 1) fail_dataset(path, name);
    lengths[name] = H5Sget_simple_extent_npoints(space.get());
  }
  return lengths;
}

std::vector<Real> read_dataset(const std::string& path, hid_t file, const std::string& name, IdRange rows) {
  std::vector<Real> values(static_cast<std::size_t>(rows.size()));
  if (values.empty()) return values;
  const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const hsize_t first = static_cast<hsize_t>(rows.first), count = static_cast<hsize_t>(rows.size());
  const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr) < 0 ||
      H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, values.data()) < 0)
    fail_dataset(path, name);
  return values;
}

ParticleColumns read_hdf5(const std::string& path, const std::vector<std::string>& names, IdRange rows) {
  const QuietHdf5 quiet;
  const Handle file = open_file(path);
  if (!file.valid()) throw IoError(path + ": cannot be read as HDF5");
  ParticleColumns columns;
  for (const std::string& name : names) columns[name] = read_dataset(path, file.get(), name, rows);
  return columns;
}

void check_names(const std::vector<std::string>& names, int dimension, const std::string& path) {
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto require = [&](const std::string& name) {
    if (!has(name)) throw InputError(fmt::format("{}: column {} is missing", path, name));
  };
  const std::vector<std::string> axes =
      dimension == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
  const bool moving = has("vx") || has("vy") || has("vz"),
             spinning = dimension == 3 && (has("wx") || has("wy") || has("wz"));
  for (const std::string& axis : axes) {
    require(axis);
    if (moving) require("v" + axis);
    if (spinning) require("w" + axis);
  }
}

// first: row of the first value.
void check_values(const ParticleColumns& columns, std::int64_t first, const std::string& path) {
  for (const auto& [name, values] : columns) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string trouble = value_error(name, values[i]);
      if (trouble.empty()) continue;
      throw InputError(fmt::format("{}: dataset {}, row {} = {}: {}", path, name,
                                   first + static_cast<std::int64_t>(i), values[i], trouble));
    }
  }
}

}  // namespace

ParticleFile::ParticleFile(const std::string& path, int dimension)
    : path_(path), hdf5_(path.ends_with(".h5") || path.ends_with(".hdf5")) {
  const std::string beginning = beginning_of_file(path), kind = kind_of_file(beginning);
  hdf5_ = hdf5_ || is_hdf5(beginning);
  if (!kind.empty() && !is_hdf5(beginning))
    throw InputError(fmt::format("{}: is {}; must be CSV, with a header line as {}, or HDF5", path, kind,
                                 example_header(dimension)));
  if (!hdf5_) {
    if (beginning.find('\r') != beginning.npos && beginning.find('\n') == beginning.npos)
      throw InputError(path + ": its lines end in a carriage return alone; they must end in a line feed");
    columns_ = scan_csv(path, dimension, count_);
    check_names(columns_, dimension, path);
    return;
  }
  const std::map<std::string, std::int64_t> lengths = scan_hdf5(path, dimension);
  for (const auto& [name, length] : lengths) columns_.push_back(name);
  check_names(columns_, dimension, path);
  count_ = lengths.at("x");
  for (const auto& [name, length] : lengths) {
    if (length != count_)
      throw InputError(
          fmt::format("{}: column {} has {} values; must be {}, as x", path, name, length, count_));
  }
}

bool ParticleFile::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

ParticleColumns ParticleFile::read(IdRange rows) const {
  if (!hdf5_) return read_csv(path_, columns_, rows);
  const ParticleColumns columns = read_hdf5(path_, columns_, rows);
  check_values(columns, rows.first, path_);
  return columns;
}

}  // namespace scree
