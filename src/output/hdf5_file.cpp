#include "output/hdf5_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "model/builder/hdf5_open.hpp"
#include "output/hdf5_parts.hpp"

namespace scree {

namespace {

// After a failed write (a full disk) the library's exit handlers write again and crash. They are disabled:
// the one at exit here, the one in MPI_Finalize by starting the library before MPI. Every file is closed by
// its owner.
[[maybe_unused]] const bool kNoExitHandlers = H5dont_atexit() >= 0 && H5open() >= 0;

herr_t keep_description(unsigned level, const H5E_error2_t* error, void* reason) {
  if (level == 0) *static_cast<std::string*>(reason) = error->desc;
  return 0;
}

}  // namespace

std::string library_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_description, &reason);
  const bool is_lock = reason.starts_with("unable to lock file");
  const std::string mark = "error message = '";
  if (const auto begin = reason.find(mark); begin != std::string::npos) {
    const auto from = begin + mark.size();
    reason = reason.substr(from, reason.find('\'', from) - from);
  }
  const char* const asked = std::getenv("HDF5_USE_FILE_LOCKING");
  if (is_lock && asked != nullptr) reason += fmt::format("; HDF5_USE_FILE_LOCKING={} requires locks", asked);
  return reason.empty() ? "no reason given" : reason;
}

std::array<hsize_t, 2> shape_of(hid_t space) {
  std::array<hsize_t, 2> shape = {1, 1};
  if (H5Sget_simple_extent_ndims(space) <= 2) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

RowSelection::RowSelection(hid_t dataset, std::int64_t first, std::int64_t count)
    : file(H5Dget_space(dataset), H5Sclose), memory(H5I_INVALID_HID, H5Sclose) {
  const std::array<hsize_t, 2> start = {static_cast<hsize_t>(first), 0};
  const std::array<hsize_t, 2> size = {static_cast<hsize_t>(count), shape_of(file)[1]};
  memory = Hdf5Id(H5Screate_simple(H5Sget_simple_extent_ndims(file), size.data(), nullptr), H5Sclose);
  if (count > 0) {
    H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
  } else {
    H5Sselect_none(file), H5Sselect_none(memory);
  }
}

namespace {

// ASCII if the text permits: some readers of VTKHDF expect nothing else.
Hdf5Id text_type(const std::string& text) {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  if (!text.empty()) H5Tset_size(type, text.size());
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const auto beyond_ascii = [](char c) { return static_cast<unsigned char>(c) > 127; };
  if (std::any_of(text.begin(), text.end(), beyond_ascii)) H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

// HDF5 has no empty strings: an empty text is a dataspace without elements.
Hdf5Id text_space(const std::string& text) {
  return {H5Screate(text.empty() ? H5S_NULL : H5S_SCALAR), H5Sclose};
}

Hdf5Id making_groups() {
  Hdf5Id plist(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(plist, 1);
  return plist;
}

}  // namespace

void Hdf5File::fail(const std::string& action) const {
  throw IoError(fmt::format("{}: cannot {}: {}", path_, action, library_reason()));
}

unsigned chunk_index_width(std::int64_t likely_chunks) {
  constexpr std::int64_t kFewest = 4, kMost = 32;  // the library's default is 32
  if (likely_chunks == 0) return kMost;
  return static_cast<unsigned>(std::clamp((likely_chunks + 1) / 2, kFewest, kMost));
}

std::int64_t even_chunk(std::int64_t rows, std::int64_t most) {
  const std::int64_t pieces = std::max<std::int64_t>(1, (rows + most - 1) / most);
  return std::max<std::int64_t>(1, (rows + pieces - 1) / pieces);
}

Hdf5File::Hdf5File(const std::string& path, Hdf5Access access, std::int64_t likely_chunks)
    : path_(path), writing_(access != Hdf5Access::read) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Hdf5Id plist(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(plist, H5F_CLOSE_STRONG);
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_istore_k(creation, chunk_index_width(likely_chunks));
  if (access == Hdf5Access::create) unlink(path.c_str());  // a link is not followed
  file_ = open_hdf5(path,
                    access == Hdf5Access::create ? Hdf5Open::create
                    : writing_                   ? Hdf5Open::modify
                                                 : Hdf5Open::read,
                    plist, creation);
  if (file_ < 0) fail(access == Hdf5Access::create ? "create" : "open");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::close() {
  const hid_t file = std::exchange(file_, H5I_INVALID_HID);
  const bool flushed = !writing_ || H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0;
  const std::string reason = flushed ? "" : library_reason();
  if (H5Fclose(file) < 0 && flushed) fail("close");
  if (!flushed) throw IoError(fmt::format("{}: cannot write: {}", path_, reason));
}

void Hdf5File::create_rows(const std::string& name, hid_t type, const RowStorage& storage,
                           const DatasetLabel& label) {
  const int dimensions = storage.width == 1 ? 1 : 2;
  const auto width = static_cast<hsize_t>(storage.width);
  const bool grows = storage.fixed_rows < 0;
  const auto rows = static_cast<hsize_t>(grows ? 0 : storage.fixed_rows);
  const hsize_t shape[2] = {rows, width}, limit[2] = {grows ? H5S_UNLIMITED : rows, width};
  const hsize_t chunk[2] = {
      static_cast<hsize_t>(grows ? storage.chunk_rows : even_chunk(storage.fixed_rows, storage.chunk_rows)),
      width};
  {
    Hdf5Id space(H5Screate_simple(dimensions, shape, limit), H5Sclose);
    Hdf5Id layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (grows || storage.compression > 0) H5Pset_chunk(layout, dimensions, chunk);
    if (storage.shared) {
      H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER);  // every row is written
      // A collective write cannot allocate space. For compressed chunks without allocated space HDF5 1.10
      // confuses the ranks' chunks, and waits forever.
      H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY);
    }
    if (storage.compression > 0)
      H5Pset_shuffle(layout), H5Pset_deflate(layout, static_cast<unsigned>(storage.compression));
    Hdf5Id dataset(H5Dcreate2(file_, name.c_str(), type, space, making_groups(), layout, H5P_DEFAULT),
                   H5Dclose);
    if (!dataset.valid() || !dataset.close()) fail("create dataset " + name);
  }
  write_text_attribute(name, "unit", label.unit);
  write_text_attribute(name, "description", label.description);
}

void Hdf5File::append_rows(const std::string& name, hid_t type, const void* values, std::int64_t rows) {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  if (rows == 0) return;
  std::array<hsize_t, 2> shape = shape_of(Hdf5Id(H5Dget_space(dataset), H5Sclose));
  const auto first = static_cast<std::int64_t>(shape[0]);
  shape[0] += static_cast<hsize_t>(rows);
  if (H5Dset_extent(dataset, shape.data()) < 0) fail("extend dataset " + name);
  const RowSelection selected(dataset, first, rows);
  if (H5Dwrite(dataset, type, selected.memory, selected.file, H5P_DEFAULT, values) < 0 || !dataset.close())
    fail("write dataset " + name);
}

void Hdf5File::resize_rows(const std::string& name, std::int64_t rows) {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  std::array<hsize_t, 2> shape = shape_of(Hdf5Id(H5Dget_space(dataset), H5Sclose));
  shape[0] = static_cast<hsize_t>(rows);
  if (H5Dset_extent(dataset, shape.data()) < 0 || !dataset.close()) fail("resize dataset " + name);
}

std::int64_t Hdf5File::rows(const std::string& name) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  return static_cast<std::int64_t>(shape_of(Hdf5Id(H5Dget_space(dataset), H5Sclose))[0]);
}

int Hdf5File::width(const std::string& name) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  return static_cast<int>(shape_of(Hdf5Id(H5Dget_space(dataset), H5Sclose))[1]);
}

bool Hdf5File::is_compressed(const std::string& name) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  return H5Pget_nfilters(Hdf5Id(H5Dget_create_plist(dataset), H5Pclose)) > 0;
}

void Hdf5File::read_rows(const std::string& name, hid_t type, std::int64_t first, std::int64_t count,
                         void* to) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  check_type(dataset, type, name);
  const RowSelection selected(dataset, first, count);
  if (H5Dread(dataset, type, selected.memory, selected.file, H5P_DEFAULT, to) < 0)
    fail("read dataset " + name);
}

void Hdf5File::check_type(hid_t dataset, hid_t type, const std::string& name) const {
  Hdf5Id file_type(H5Dget_type(dataset), H5Tclose);
  if (H5Tequal(file_type, type) <= 0) {
    throw IoError(fmt::format("{}: dataset {} does not have the expected type", path_, name));
  }
}

void Hdf5File::write_array(const std::string& name, hid_t type, const void* values, std::int64_t count) {
  const hsize_t size = static_cast<hsize_t>(count);
  Hdf5Id space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  Hdf5Id dataset(H5Dcreate2(file_, name.c_str(), type, space, making_groups(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) fail("create dataset " + name);
  const bool written = count == 0 || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  if (!written || !dataset.close()) fail("write dataset " + name);
}

std::int64_t Hdf5File::value_count(const std::string& name) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  return static_cast<std::int64_t>(H5Sget_simple_extent_npoints(space));
}

void Hdf5File::read_array(const std::string& name, hid_t type, void* values) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  check_type(dataset, type, name);
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) fail("read dataset " + name);
}

void Hdf5File::write_text(const std::string& name, const std::string& text) {
  Hdf5Id type = text_type(text);
  Hdf5Id dataset(
      H5Dcreate2(file_, name.c_str(), type, text_space(text), making_groups(), H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (!dataset.valid()) fail("create dataset " + name);
  const bool written =
      text.empty() || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
  if (!written || !dataset.close()) fail("write dataset " + name);
}

void Hdf5File::write_texts(const std::string& name, const std::vector<std::string>& texts,
                           const DatasetLabel& label) {
  std::vector<const char*> values;
  for (const std::string& text : texts) values.push_back(text.c_str());
  const hsize_t size = values.size();
  // VTK's reader accepts no texts marked as UTF-8, and passes all bytes on.
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  H5Tset_size(type, H5T_VARIABLE);
  Hdf5Id dataset(H5Dcreate2(file_, name.c_str(), type, space, making_groups(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) fail("create dataset " + name);
  const bool written = H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (!written || !dataset.close()) fail("write dataset " + name);
  write_text_attribute(name, "unit", label.unit);
  write_text_attribute(name, "description", label.description);
}

template <class Read>
std::string Hdf5File::read_text(hid_t type, hid_t space, const std::string& what, const Read& read) const {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0)
    throw IoError(fmt::format("{}: {} is not a text", path_, what));
  if (H5Sget_simple_extent_type(space) == H5S_NULL) return {};
  std::string text(H5Tget_size(type), '\0');
  if (read(text.data()) < 0) fail("read " + what);
  return text;
}

std::string Hdf5File::read_text(const std::string& name) const {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  Hdf5Id type(H5Dget_type(dataset), H5Tclose);
  Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  return read_text(type, space, "dataset " + name,
                   [&](char* to) { return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); });
}

void Hdf5File::write_text_attribute(const std::string& object, const std::string& name,
                                    const std::string& text) {
  Hdf5Id type = text_type(text);
  Hdf5Id owner(H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose);
  Hdf5Id attribute(H5Acreate2(owner, name.c_str(), type, text_space(text), H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  if (!attribute.valid()) fail(fmt::format("create attribute {} of {}", name, object));
  const bool written = text.empty() || H5Awrite(attribute, type, text.data()) >= 0;
  if (!written || !attribute.close() || !owner.close()) fail("write attribute " + name);
}

void Hdf5File::write_integer_attribute(const std::string& object, const std::string& name,
                                       const std::vector<std::int64_t>& values) {
  const hsize_t size = values.size();
  Hdf5Id space(size == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose);
  Hdf5Id owner(H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose);
  const bool there = H5Aexists(owner, name.c_str()) > 0;
  Hdf5Id attribute(there ? H5Aopen(owner, name.c_str(), H5P_DEFAULT)
                         : H5Acreate2(owner, name.c_str(), H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  if (!attribute.valid()) fail(fmt::format("create attribute {} of {}", name, object));
  const bool written = H5Awrite(attribute, H5T_NATIVE_INT64, values.data()) >= 0;
  if (!written || !attribute.close() || !owner.close()) fail("write attribute " + name);
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5File::read_text_attribute(const std::string& object, const std::string& name) const {
  Hdf5Id owner(H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose);
  Hdf5Id attribute(H5Aopen(owner, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail(fmt::format("read attribute {} of {}", name, object));
  Hdf5Id type(H5Aget_type(attribute), H5Tclose);
  Hdf5Id space(H5Aget_space(attribute), H5Sclose);
  return read_text(type, space, "attribute " + name, [&](char* to) { return H5Aread(attribute, type, to); });
}

void Hdf5File::create_group(const std::string& name) {
  Hdf5Id group(H5Gcreate2(file_, name.c_str(), making_groups(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail("create group " + name);
}

void Hdf5File::link(const std::string& target, const std::string& name) {
  if (H5Lcreate_hard(file_, target.c_str(), file_, name.c_str(), making_groups(), H5P_DEFAULT) < 0) {
    fail(fmt::format("link {} to {}", name, target));
  }
}

void Hdf5File::rename(const std::string& from, const std::string& to) {
  if (H5Lmove(file_, from.c_str(), file_, to.c_str(), making_groups(), H5P_DEFAULT) < 0)
    fail(fmt::format("rename {} to {}", from, to));
}

std::vector<std::string> Hdf5File::dataset_names(const std::string& group) const {
  std::vector<std::string> found;
  Hdf5Id id(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!id.valid()) fail("open group " + group);
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* names) -> herr_t {
    static_cast<std::vector<std::string>*>(names)->push_back(name);
    return 0;
  };
  if (H5Lvisit(id, H5_INDEX_NAME, H5_ITER_INC, visit, &found) < 0) fail("list group " + group);
  std::erase_if(found, [&](const std::string& name) {
    Hdf5Id object(H5Oopen(id, name.c_str(), H5P_DEFAULT), H5Oclose);
    return H5Iget_type(object) != H5I_DATASET;
  });
  return found;
}

}  // namespace scree
