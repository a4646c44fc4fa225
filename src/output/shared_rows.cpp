#include "output/shared_rows.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>

#include "base/bit_hash.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "model/builder/hdf5_open.hpp"
#include "output/durable_file.hpp"

#if SCREE_PARALLEL_HDF5 && !defined(H5_HAVE_PARALLEL)
#error "SCREE_PARALLEL_HDF5 needs a parallel HDF5 library"
#endif

namespace scree {

const bool kParallelHdf5 = SCREE_PARALLEL_HDF5;

namespace {

// Size of a piece that a rank writes at a time, and that rank 0 then holds of another rank.
constexpr std::size_t kPieceBytes = std::size_t{1} << 25;

Hdf5Id new_properties(hid_t kind) { return {H5Pcreate(kind), H5Pclose}; }

std::int64_t rows_per_piece(std::size_t row_bytes) {
  return static_cast<std::int64_t>(std::max<std::size_t>(1, kPieceBytes / row_bytes));
}

std::uint64_t hash_of(const void* values, std::size_t bytes) {
  BitHash hash;
  hash.add(values, bytes);
  return hash.hash();
}

// Reserves disk space; impossible for compressed rows, whose positions change when they are written.
bool reserve(const std::string& path) {
  {
    const Hdf5File file(path, Hdf5Access::read);
    for (const std::string& name : file.dataset_names("/"))
      if (file.is_compressed("/" + name)) return false;
  }
  return reserve_file(path);
}

// Rows of piece k, relative to the part.
RowPart piece_of(RowPart part, std::int64_t rows, std::int64_t k) {
  const std::int64_t first = std::min(k * rows, part.count);
  return {first, std::min(rows, part.count - first)};
}

}  // namespace

void SharedRows::fail(const std::string& action) const {
  const std::string reason = library_reason();
  reserve_file(path_);  // the MPI library does not report a full disk; this throws with the system's reason
  throw IoError(fmt::format("{}: cannot {}: {}", path_, action, reason));
}

SharedRows::SharedRows(const Ranks& ranks, const std::string& path, bool collective)
    : ranks_(ranks),
      path_(path),
      collective_(collective && !ranks.alone()),
      transfer_(new_properties(H5P_DATASET_XFER)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Id access = new_properties(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
#if SCREE_PARALLEL_HDF5
  if (collective_) {
    H5Pset_fapl_mpio(access, MPI_Comm_f2c(ranks_.communicator()), MPI_INFO_NULL);
    H5Pset_dxpl_mpio(transfer_, H5FD_MPIO_COLLECTIVE);
  }
#endif
  ranks_.on_root([&] { reads_back_ = !reserve(path); });
  ranks_.broadcast(reads_back_);
  ranks_.collectively([&] {
    if (!has_file()) return;
    // The MPI part of HDF5 does not lock files.
    file_ =
        collective_ ? H5Fopen(path.c_str(), H5F_ACC_RDWR, access) : open_hdf5(path, Hdf5Open::modify, access);
    if (file_ < 0) fail("open");
  });
}

SharedRows::SharedRows(const Ranks& ranks, Hdf5File* open)
    : ranks_(ranks),
      path_(open != nullptr ? open->path() : ""),
      collective_(false),
      reads_back_(false),
      file_(open != nullptr ? open->id() : H5I_INVALID_HID),
      owns_file_(false),
      transfer_(new_properties(H5P_DATASET_XFER)) {}

SharedRows::~SharedRows() {
  if (owns_file_ && file_ >= 0) H5Fclose(file_);
}

void SharedRows::close() {
  ranks_.collectively([&] {
    // Closing a collective file also writes the remaining data. A flush would also sync, and Open MPI's sync
    // blocks the other ranks if it fails on one.
    if (has_file() && !collective_ && H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) fail("write");
  });
  ranks_.collectively([&] {
    if (has_file() && H5Fclose(std::exchange(file_, H5I_INVALID_HID)) < 0) fail("close");
  });
  if (reads_back_) ranks_.collectively([&] { read_back(); });
}

void SharedRows::read_back() {
  if (written_.empty()) return;
  const Hdf5Id access = new_properties(H5P_FILE_ACCESS);
  const Hdf5Id file(open_hdf5(path_, Hdf5Open::read, access), H5Fclose);
  if (!file.valid()) fail("read back");
  std::vector<std::byte> values;
  for (const Written& w : written_) {
    values.resize(as_size(w.rows.count) * w.type.bytes());
    const Hdf5Id dataset(H5Dopen2(file, w.name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.valid()) fail("read back dataset " + w.name);
    const RowSelection selected(dataset, w.rows.first, w.rows.count);
    if (H5Dread(dataset, w.type.value, selected.memory, selected.file, H5P_DEFAULT, values.data()) >= 0 &&
        hash_of(values.data(), values.size()) == w.hash)
      continue;
    reserve_file(path_);  // throws with the system's reason if the disk is full
    throw IoError(fmt::format("{}: cannot write dataset {}: the file does not contain the data written to it",
                              path_, w.name));
  }
}

void SharedRows::write(const std::string& name, RowType type, RowPart part, const Piece& piece) {
  if (collective_)
    write_collectively(name, type, part, piece);
  else
    write_through_root(name, type, part, piece);
}

void SharedRows::put(const std::string& name, RowType type, RowPart rows, const void* values) {
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail("open dataset " + name);
  const RowSelection selected(dataset, rows.first, rows.count);
  if (H5Dwrite(dataset, type.value, selected.memory, selected.file, transfer_, values) < 0 ||
      !dataset.close())
    fail("write dataset " + name);
  if (reads_back_ && rows.count > 0)
    written_.push_back({name, type, rows, hash_of(values, as_size(rows.count) * type.bytes())});
}

// Every rank takes part in as many writes as the rank with the most rows.
void SharedRows::write_collectively(const std::string& name, RowType type, RowPart part, const Piece& piece) {
  const std::int64_t rows = rows_per_piece(type.bytes()), own = (part.count + rows - 1) / rows;
  const std::int64_t rounds = -ranks_.min(-own);
  for (std::int64_t k = 0; k < rounds; ++k) {
    ranks_.collectively([&] {
      const RowPart now = piece_of(part, rows, k);
      put(name, type, {part.first + now.first, now.count},
          now.count > 0 ? piece(now.first, now.count) : this);
    });
  }
}

void SharedRows::write_through_root(const std::string& name, RowType type, RowPart part, const Piece& piece) {
  const std::size_t bytes = type.bytes();
  const std::int64_t rows = rows_per_piece(bytes);
  const std::vector<RowPart> parts = ranks_.gather(std::vector<RowPart>{part});
  const auto give = [&](std::int64_t k) {
    const RowPart now = piece_of(part, rows, k);
    return Ranks::Bytes(static_cast<const std::byte*>(piece(now.first, now.count)),
                        as_size(now.count) * bytes);
  };
  ranks_.stream_to_root((part.count + rows - 1) / rows, give,
                        [&](int rank, std::int64_t k, Ranks::Bytes values) {
                          const RowPart whole = parts[as_size(rank)], now = piece_of(whole, rows, k);
                          put(name, type, {whole.first + now.first, now.count}, values.data());
                        });
}

}  // namespace scree
