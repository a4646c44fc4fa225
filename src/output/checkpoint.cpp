#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <fstream>
#include <memory>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/input_file.hpp"
#include "model/data/id_range.hpp"
#include "output/durable_file.hpp"
#include "output/file_seal.hpp"
#include "output/hdf5_file.hpp"
#include "output/hdf5_size.hpp"
#include "output/shared_rows.hpp"

namespace scree {

namespace {

// Format name in the file, with a number that increases with every change of the layout.
const std::string kFormatName = "scree checkpoint ";
constexpr int kFormatNumber = 5;

// Every kind of value has a group of its own in the file.
const std::string kReals = "/reals/", kIntegers = "/integers/", kTexts = "/texts/";
const std::string kRealRows = "/real_rows/", kIntegerRows = "/integer_rows/";
constexpr std::int64_t kMostRowsPerChunk = 8192;  // for compressed rows

template <class Value>
const Value& find(const std::map<std::string, Value>& values, const std::string& name,
                  const Checkpoint& checkpoint) {
  const auto found = values.find(name);
  if (found == values.end())
    throw IoError(fmt::format("{}: the checkpoint lacks \"{}\"", checkpoint.path, name));
  return found->second;
}

template <class T>
using RowMap = std::map<std::string, CheckpointRows<T>>;

void write_small(Hdf5File& file, const Checkpoint& checkpoint) {
  for (const std::string& group : {kReals, kIntegers, kTexts, kRealRows, kIntegerRows})
    file.create_group(group);
  for (const auto& [name, values] : checkpoint.reals) file.write_array(kReals + name, values);
  for (const auto& [name, values] : checkpoint.integers) file.write_array(kIntegers + name, values);
  for (const auto& [name, text] : checkpoint.texts) file.write_text(kTexts + name, text);
  file.write_text_attribute("/", "format", kFormatName + std::to_string(kFormatNumber));
}

// Number of rows of an array, over all ranks and on this rank.
struct Extent {
  std::int64_t all;
  RowPart own;
};

template <class T>
std::map<std::string, Extent> extents_of(const RowMap<T>& arrays, const Ranks& ranks) {
  std::map<std::string, Extent> extents;
  for (const auto& [name, rows] : arrays)
    extents[name] = {ranks.sum(rows.count), {ranks.sum_below(rows.count), rows.count}};
  return extents;
}

template <class T>
void reserve_rows(Hdf5File& file, const std::string& group, const RowMap<T>& arrays,
                  const std::map<std::string, Extent>& extents, int compression) {
  for (const auto& [name, rows] : arrays) {
    file.create_rows<T>(group + name,
                        {rows.width, kMostRowsPerChunk, true, compression, extents.at(name).all},
                        {rows.unit, rows.description});
  }
}

template <class T>
void write_rows(SharedRows& file, const std::string& group, const RowMap<T>& arrays,
                const std::map<std::string, Extent>& extents) {
  for (const auto& [name, rows] : arrays) {
    std::vector<T> piece;
    file.write_pieces<T>(group + name, rows.width, extents.at(name).own,
                         [&, &rows = rows](std::int64_t first, std::int64_t count) {
                           piece.resize(as_size(count) * as_size(rows.width));
                           rows.copy(first, count, piece.data());
                           return piece.data();
                         });
  }
}

void write_file(const std::string& path, const Checkpoint& checkpoint, const Ranks& ranks, int compression) {
  const auto reals = extents_of(checkpoint.real_rows, ranks);
  const auto integers = extents_of(checkpoint.integer_rows, ranks);
  ranks.on_root([&] {
    Hdf5File file(path, Hdf5Access::create);
    write_small(file, checkpoint);
    reserve_rows(file, kRealRows, checkpoint.real_rows, reals, compression);
    reserve_rows(file, kIntegerRows, checkpoint.integer_rows, integers, compression);
    file.close();
  });
  SharedRows file(ranks, path);
  write_rows(file, kRealRows, checkpoint.real_rows, reals);
  write_rows(file, kIntegerRows, checkpoint.integer_rows, integers);
  file.close();
}

[[noreturn]] void refuse_format(const std::string& path, const std::string& format) {
  int number = 0;
  if (format.starts_with(kFormatName)) {
    const char* const end = format.data() + format.size();
    const auto [rest, error] = std::from_chars(format.data() + kFormatName.size(), end, number);
    if (error != std::errc() || rest != end) number = 0;
  }
  if (number == kFormatNumber)
    throw IoError(
        path + ": the checkpoint is damaged: it is truncated or changed, and does not end with its checksum");
  if (number < 1)
    throw IoError(fmt::format("{}: not a checkpoint of this program (its format is not \"{}{}\")", path,
                              kFormatName, kFormatNumber));
  throw IoError(
      fmt::format("{}: a checkpoint of {} version of this program (its format is \"{}\", not \"{}{}\")", path,
                  number < kFormatNumber ? "an older" : "a newer", format, kFormatName, kFormatNumber));
}

// The format of a file without a seal, searched for in its bytes, because HDF5 may crash on damaged files.
std::string format_in_bytes(const std::string& path) {
  constexpr std::size_t kSearchedBytes = std::size_t{1} << 26, kNear = 64;
  std::string bytes(kSearchedBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(kSearchedBytes));
  bytes.resize(as_size(file.gcount()));
  const std::string attribute("format\0", 7);
  for (std::size_t at = bytes.find(attribute); at != std::string::npos; at = bytes.find(attribute, at + 1)) {
    const std::size_t name = bytes.find(kFormatName, at);
    if (name == std::string::npos || name > at + kNear) continue;
    const std::size_t digits = name + kFormatName.size();
    return bytes.substr(name, bytes.find_first_not_of("0123456789", digits) - name);
  }
  return "";
}

// Throws unless the file is intact and of this format. Collective.
void check_file(const std::string& path, const Ranks& ranks) {
  const Seal seal = check_seal(path, ranks);
  ranks.on_root([&] {
    if (const std::string trouble = input_file_error(path); !trouble.empty())
      throw IoError(fmt::format("{}: {}", path, trouble));
    if (seal == Seal::none) refuse_format(path, format_in_bytes(path));
    if (seal == Seal::broken)
      throw IoError(path + ": the checkpoint is damaged: its content does not match the checksum at its end");
    const Hdf5File file(path, Hdf5Access::read);
    const std::string format =
        file.has_attribute("/", "format") ? file.read_text_attribute("/", "format") : "";
    if (format != kFormatName + std::to_string(kFormatNumber)) refuse_format(path, format);
  });
}

// Refuses datasets outside the groups.
void check_groups(const Hdf5File& file, const std::string& path) {
  for (const std::string& name : file.dataset_names("/")) {
    const auto holds = [&](const std::string& group) { return ("/" + name).starts_with(group); };
    if (!holds(kReals) && !holds(kIntegers) && !holds(kTexts) && !holds(kRealRows) && !holds(kIntegerRows))
      throw IoError(fmt::format("{}: dataset \"{}\" does not belong to a checkpoint", path, name));
  }
}

template <class T>
RowMap<T> find_rows(const std::shared_ptr<const Hdf5File>& file, const std::string& group,
                    const Ranks& ranks) {
  RowMap<T> arrays;
  for (const std::string& name : file->dataset_names(group)) {
    const std::string dataset = group + name;
    const IdRange part = id_range(file->rows(dataset), ranks.rank(), ranks.size());
    arrays[name] = {file->width(dataset), part.size(),
                    [file, dataset, part](std::int64_t first, std::int64_t count, T* to) {
                      file->read_rows(dataset, part.first + first, count, to);
                    }};
  }
  return arrays;
}

}  // namespace

const std::vector<Real>& Checkpoint::real_array(const std::string& name) const {
  return find(reals, name, *this);
}

const std::vector<std::int64_t>& Checkpoint::integer_array(const std::string& name) const {
  return find(integers, name, *this);
}

template <>
const CheckpointRows<Real>& Checkpoint::row_array(const std::string& name) const {
  return find(real_rows, name, *this);
}

template <>
const CheckpointRows<std::int64_t>& Checkpoint::row_array(const std::string& name) const {
  return find(integer_rows, name, *this);
}

const std::string& Checkpoint::text(const std::string& name) const { return find(texts, name, *this); }

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint, const Ranks& ranks,
                      int compression) {
  const std::string temporary_path = path + ".tmp";
  try {
    write_file(temporary_path, checkpoint, ranks, compression);
    ranks.collectively([&] { sync_file(temporary_path); });
    seal_file(temporary_path, ranks);
    ranks.on_root([&] { replace_file(temporary_path, path); });
  } catch (...) {
    if (ranks.is_root()) std::remove(temporary_path.c_str());
    throw;
  }
}

Checkpoint read_checkpoint(const std::string& path, const Ranks& ranks) {
  check_file(path, ranks);
  Checkpoint checkpoint;
  checkpoint.path = path;
  ranks.collectively([&] {
    const auto file = std::make_shared<const Hdf5File>(path, Hdf5Access::read);
    check_groups(*file, path);
    for (const std::string& name : file->dataset_names(kReals))
      checkpoint.reals[name] = file->read_array<Real>(kReals + name);
    for (const std::string& name : file->dataset_names(kIntegers))
      checkpoint.integers[name] = file->read_array<std::int64_t>(kIntegers + name);
    for (const std::string& name : file->dataset_names(kTexts))
      checkpoint.texts[name] = file->read_text(kTexts + name);
    checkpoint.real_rows = find_rows<Real>(file, kRealRows, ranks);
    checkpoint.integer_rows = find_rows<std::int64_t>(file, kIntegerRows, ranks);
  });
  return checkpoint;
}

Real checkpoint_size(const Checkpoint& checkpoint, const std::map<std::string, std::int64_t>& rows) {
  Hdf5Size size;
  std::map<std::string, std::int64_t> groups;
  const auto count_name = [&](const std::string& name) {
    for (std::size_t end = name.rfind('/'); end != std::string::npos && end > 0;
         end = name.rfind('/', end - 1))
      if (++groups[name.substr(0, end)] > 1) break;
  };
  for (const auto& [name, values] : checkpoint.reals)
    count_name(kReals + name), size.add_array(std::ssize(values) * static_cast<std::int64_t>(sizeof(Real)));
  for (const auto& [name, values] : checkpoint.integers)
    count_name(kIntegers + name),
        size.add_array(std::ssize(values) * static_cast<std::int64_t>(sizeof(std::int64_t)));
  for (const auto& [name, text] : checkpoint.texts)
    count_name(kTexts + name), size.add_array(std::ssize(text));
  const auto add_rows = [&](const std::string& group, const auto& arrays) {
    for (const auto& [name, array] : arrays) {
      const auto of_all = rows.find(name);
      const std::int64_t count = of_all == rows.end() ? array.count : of_all->second;
      count_name(group + name);
      size.add_rows({.width = array.width, .fixed_rows = count}, sizeof(std::int64_t), count);
    }
  };
  add_rows(kRealRows, checkpoint.real_rows), add_rows(kIntegerRows, checkpoint.integer_rows);
  for (const auto& [group, names] : groups) size.add_group(names);
  return size.bytes();
}

}  // namespace scree
