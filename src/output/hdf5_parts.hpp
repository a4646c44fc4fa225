// Shared by the owners of HDF5 files: identifiers, selections, reasons of failures.
#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace scree {

// Owner of one identifier; negative if its creation failed. The library may write a dataset's values only at
// its close, and reports failures only there: a writer calls close() itself.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Id() { close(); }
  Hdf5Id(Hdf5Id&& other) : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) {
    std::swap(id_, other.id_), std::swap(close_, other.close_);
    return *this;
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  // Closes and returns whether that succeeded. Without an open identifier it does nothing and returns true.
  bool close() {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 || close_(id) >= 0;
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// The message of the library's innermost function, reduced to the system's message if it contains one.
std::string library_reason();

// Shape of a dataset: {rows, width}, width 1 for a vector, {1, 1} for a scalar.
std::array<hsize_t, 2> shape_of(hid_t space);

// Rows [first, first + count) of a dataset, and matching contiguous values in memory; count may be 0.
struct RowSelection {
  RowSelection(hid_t dataset, std::int64_t first, std::int64_t count);
  Hdf5Id file, memory;
};

}  // namespace scree
