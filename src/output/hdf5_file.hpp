// One HDF5 file: owner of the C library's identifiers. Every failure is an IoError with the name of the file
// and the library's reason; the library itself prints nothing.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "base/index.hpp"
#include "base/types.hpp"

namespace scree {

enum class Hdf5Access {
  create,  // a new file; an existing one is removed, a link is not followed
  read,
  modify  // an existing file
};

// Description of a dataset for its users: the attributes "unit" and "description".
struct DatasetLabel {
  std::string unit, description;
};

// Number of rows per chunk, at most `most`, such that the chunks are of nearly equal size and the last one
// has little unused space.
std::int64_t even_chunk(std::int64_t rows, std::int64_t most);

// Half of the number of chunks per node of a dataset's index: small if few chunks are expected, because every
// dataset has a node. likely_chunks: as for Hdf5File.
unsigned chunk_index_width(std::int64_t likely_chunks);

// Layout of a dataset of rows.
struct RowStorage {
  int width = 1;
  std::int64_t chunk_rows = 1;  // at most
  // For rows written by SharedRows: their space is allocated before they are written.
  bool shared = false;
  int compression = 0;  // 0: none; 1 to 9: deflate, of shared rows
  // Number of rows if it does not change: the rows are contiguous, or in even chunks if they are compressed.
  std::int64_t fixed_rows = -1;
};

// The library's type for a value in memory, and also in the file.
template <class T>
hid_t hdf5_type() {
  static_assert(std::is_same_v<T, Real> || std::is_same_v<T, std::int32_t> ||
                std::is_same_v<T, std::int64_t>);
  if constexpr (std::is_same_v<T, Real>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  return H5T_NATIVE_INT64;
}

// All functions throw IoError. Names are paths from the root; missing groups are created.
class Hdf5File {
 public:
  // likely_chunks: upper estimate of chunks per dataset of a new file, which sizes the library's chunk index;
  // more chunks are possible. 0: many.
  Hdf5File(const std::string& path, Hdf5Access access, std::int64_t likely_chunks = 0);
  ~Hdf5File();  // closes without reporting a failure; writers call close() first
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  void close();  // passes all data to the operating system
  const std::string& path() const { return path_; }
  hid_t id() const { return file_; }  // identifier of the library

  // ---- extensible datasets of shape [rows] (width 1) or [rows][width] ----
  template <class T>
  void create_rows(const std::string& name, const RowStorage& storage, const DatasetLabel& label) {
    create_rows(name, hdf5_type<T>(), storage, label);
  }
  // values: [rows][width].
  template <class T>
  void append_rows(const std::string& name, const T* values, std::int64_t rows) {
    append_rows(name, hdf5_type<T>(), values, rows);
  }
  // For datasets of width 1.
  template <class T>
  void append_row(const std::string& name, T value) {
    append_rows(name, &value, 1);
  }
  // Removes rows past the new number, or adds rows, which stay undefined until SharedRows writes them.
  void resize_rows(const std::string& name, std::int64_t rows);
  void add_rows(const std::string& name, std::int64_t more) { resize_rows(name, rows(name) + more); }
  std::int64_t rows(const std::string& name) const;
  int width(const std::string& name) const;
  bool is_compressed(const std::string& name) const;
  // Reads rows [first, first + count), row by row. Throws also if the file has another type.
  template <class T>
  void read_rows(const std::string& name, std::int64_t first, std::int64_t count, T* to) const {
    read_rows(name, hdf5_type<T>(), first, count, to);
  }

  // ---- datasets of fixed size ----
  template <class T>
  void write_array(const std::string& name, const std::vector<T>& values) {
    write_array(name, hdf5_type<T>(), values.data(), static_cast<std::int64_t>(values.size()));
  }
  void write_text(const std::string& name, const std::string& text);
  // [n] texts of any length without zero bytes.
  void write_texts(const std::string& name, const std::vector<std::string>& texts, const DatasetLabel& label);

  // Reads all values of a dataset of either kind, row by row. Throws also if the file has another type.
  template <class T>
  std::vector<T> read_array(const std::string& name) const {
    std::vector<T> values(as_size(value_count(name)));
    read_array(name, hdf5_type<T>(), values.data());
    return values;
  }
  std::string read_text(const std::string& name) const;

  // ---- attributes and links ----
  void write_text_attribute(const std::string& object, const std::string& name, const std::string& text);
  // Writes a scalar for one value, a vector for several; overwrites an existing attribute.
  void write_integer_attribute(const std::string& object, const std::string& name,
                               const std::vector<std::int64_t>& values);
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::string read_text_attribute(const std::string& object, const std::string& name) const;
  void create_group(const std::string& name);
  // Creates `name` as a second name of `target` (hard link).
  void link(const std::string& target, const std::string& name);
  // Of a dataset; the new path must be free.
  void rename(const std::string& from, const std::string& to);
  // Paths below `group`, relative to it, of all datasets.
  std::vector<std::string> dataset_names(const std::string& group) const;

 private:
  void create_rows(const std::string& name, hid_t type, const RowStorage& storage, const DatasetLabel& label);
  void append_rows(const std::string& name, hid_t type, const void* values, std::int64_t rows);
  void write_array(const std::string& name, hid_t type, const void* values, std::int64_t count);
  void read_array(const std::string& name, hid_t type, void* values) const;
  void read_rows(const std::string& name, hid_t type, std::int64_t first, std::int64_t count, void* to) const;
  void check_type(hid_t dataset, hid_t type, const std::string& name) const;
  // Reads the text of a dataset or attribute. what: its name in messages; read(to): copies its bytes.
  template <class Read>
  std::string read_text(hid_t type, hid_t space, const std::string& what, const Read& read) const;
  std::int64_t value_count(const std::string& name) const;
  [[noreturn]] void fail(const std::string& action) const;

  std::string path_;
  bool writing_;
  hid_t file_ = H5I_INVALID_HID;
};

}  // namespace scree
