#include "model/particle_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>

#include "base/error.hpp"
#include "deck/suggestion.hpp"

namespace scree {

namespace {

std::vector<std::string> known_columns(int dimension) {
  if (dimension == 2) return {"x", "y", "vx", "vy", "radius", "mass"};
  return {"x", "y", "z", "vx", "vy", "vz", "radius", "mass"};
}

std::vector<std::string> split_line(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

Real parse_cell(const std::string& cell, const std::string& column, const std::string& place) {
  Real value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) {
    throw InputError(fmt::format("{}: column {} = {}: must be a number", place, column, cell));
  }
  return value;
}

std::vector<std::string> parse_header(const std::vector<std::string>& cells, int dimension,
                                      const std::string& place) {
  const std::vector<std::string> known = known_columns(dimension);
  std::set<std::string> seen;
  for (const std::string& name : cells) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw InputError(fmt::format("{}: unknown column \"{}\"{}", place, name, suggestion(name, known)));
    }
    if (!seen.insert(name).second)
      throw InputError(fmt::format("{}: column \"{}\" is repeated", place, name));
  }
  return cells;
}

ParticleColumns read_csv(const std::string& path, int dimension) {
  std::ifstream file(path);
  if (!file) throw IoError(path + ": cannot be read");
  ParticleColumns columns;
  std::vector<std::string> header;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::vector<std::string> cells = split_line(line);
    const std::string place = fmt::format("{}:{}", path, number);
    if (cells.front().starts_with("#") || (cells.size() == 1 && cells.front().empty())) continue;
    if (header.empty()) {
      header = parse_header(cells, dimension, place);
      for (const std::string& name : header) columns[name];
      continue;
    }
    if (cells.size() != header.size()) {
      throw InputError(
          fmt::format("{}: {} values; must be {}, as the header", place, cells.size(), header.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
      columns[header[i]].push_back(parse_cell(cells[i], header[i], place));
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

// The library prints no errors while this lives: they become exceptions.
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

ParticleColumns read_hdf5(const std::string& path, int dimension) {
  const QuietHdf5 quiet;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid()) throw IoError(path + ": cannot be read as HDF5");
  ParticleColumns columns;
  for (const std::string& name : known_columns(dimension)) {
    if (H5Lexists(file.get(), name.c_str(), H5P_DEFAULT) <= 0) continue;
    const Handle dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(dataset.valid() ? H5Dget_space(dataset.get()) : H5I_INVALID_HID, H5Sclose);
    const hssize_t count = space.valid() ? H5Sget_simple_extent_npoints(space.get()) : -1;
    std::vector<Real> values(static_cast<std::size_t>(std::max<hssize_t>(count, 0)));
    if (count < 0 || (count > 0 && H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                           values.data()) < 0)) {
      throw InputError(fmt::format("{}: dataset {} must hold numbers", path, name));
    }
    columns[name] = std::move(values);
  }
  return columns;
}

void require(const ParticleColumns& columns, const std::string& name, const std::string& path) {
  if (columns.contains(name)) return;
  throw InputError(fmt::format("{}: column {} is missing", path, name));
}

void check_columns(const ParticleColumns& columns, int dimension, const std::string& path) {
  const std::vector<std::string> axes =
      dimension == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
  const bool moving = columns.contains("vx") || columns.contains("vy") || columns.contains("vz");
  for (const std::string& axis : axes) {
    require(columns, axis, path);
    if (moving) require(columns, "v" + axis, path);
  }
  for (const auto& [name, values] : columns) {
    if (values.size() != columns.at("x").size()) {
      throw InputError(fmt::format("{}: column {} has {} values; must be {}, as x", path, name, values.size(),
                                   columns.at("x").size()));
    }
    const bool positive = name == "radius" || name == "mass";
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i]) && (!positive || values[i] > 0)) continue;
      throw InputError(fmt::format("{}: particle {}: {} = {}: must be a {}finite number", path, i, name,
                                   values[i], positive ? "positive, " : ""));
    }
  }
}

}  // namespace

ParticleColumns read_particle_file(const std::string& path, int dimension) {
  const bool hdf5 = path.ends_with(".h5") || path.ends_with(".hdf5");
  const ParticleColumns columns = hdf5 ? read_hdf5(path, dimension) : read_csv(path, dimension);
  check_columns(columns, dimension, path);
  return columns;
}

}  // namespace scree
