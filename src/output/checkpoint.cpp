#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/hdf5_file.hpp"

namespace scree {

namespace {

// The file's first word to a reader; a new layout gets a new number.
const std::string kFormat = "scree checkpoint 1";

// In the file, each kind of value has a group of its own.
const std::string kReals = "/reals/", kIntegers = "/integers/", kTexts = "/texts/";

template <class Value>
const Value& find(const std::map<std::string, Value>& values, const std::string& name,
                  const Checkpoint& checkpoint) {
  const auto found = values.find(name);
  if (found == values.end())
    throw IoError(fmt::format("{}: the checkpoint lacks \"{}\"", checkpoint.path, name));
  return found->second;
}

void write_file(const std::string& path, const Checkpoint& checkpoint) {
  Hdf5File file(path, Hdf5Access::create);
  for (const std::string& group : {kReals, kIntegers, kTexts}) file.create_group(group);
  for (const auto& [name, values] : checkpoint.reals) file.write_array(kReals + name, values);
  for (const auto& [name, values] : checkpoint.integers) file.write_array(kIntegers + name, values);
  for (const auto& [name, text] : checkpoint.texts) file.write_text(kTexts + name, text);
  file.write_text_attribute("/", "format", kFormat);
  file.close();
}

}  // namespace

const std::vector<Real>& Checkpoint::real_array(const std::string& name) const {
  return find(reals, name, *this);
}

const std::vector<std::int64_t>& Checkpoint::integer_array(const std::string& name) const {
  return find(integers, name, *this);
}

const std::string& Checkpoint::text(const std::string& name) const { return find(texts, name, *this); }

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  const std::string beside = path + ".tmp";
  try {
    write_file(beside, checkpoint);
    sync_file(beside);
    replace_file(beside, path);
  } catch (...) {
    std::remove(beside.c_str());
    throw;
  }
}

Checkpoint read_checkpoint(const std::string& path) {
  const Hdf5File file(path, Hdf5Access::read);
  if (!file.has_attribute("/", "format") || file.read_text_attribute("/", "format") != kFormat) {
    throw IoError(
        fmt::format("{}: not a checkpoint of this program (its format is not \"{}\")", path, kFormat));
  }
  Checkpoint checkpoint;
  checkpoint.path = path;
  for (const std::string& name : file.dataset_names(kReals)) {
    checkpoint.reals[name] = file.read_array<Real>(kReals + name);
  }
  for (const std::string& name : file.dataset_names(kIntegers)) {
    checkpoint.integers[name] = file.read_array<std::int64_t>(kIntegers + name);
  }
  for (const std::string& name : file.dataset_names(kTexts)) {
    checkpoint.texts[name] = file.read_text(kTexts + name);
  }
  return checkpoint;
}

}  // namespace scree
