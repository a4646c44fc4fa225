#include "output/series_names.hpp"

namespace scree {

namespace {

const std::string kFieldData = "/VTKHDF/FieldData/", kSteps = "/VTKHDF/Steps/";
const std::string kOffsets = "FieldDataOffsets/", kSizes = "FieldDataSizes/";

// Calls visit(dataset, list) for the datasets that assign texts to snapshots.
template <class Visit>
void for_each_list(const Hdf5File& file, const Visit& visit) {
  for (const std::string& dataset : file.dataset_names(kSteps))
    for (const std::string& group : {kOffsets, kSizes})
      if (dataset.starts_with(group)) visit(kSteps + dataset, dataset.substr(group.size()));
}

}  // namespace

void create_names(Hdf5File& file, const SeriesNames& names, std::int64_t steps_per_chunk) {
  if (names.entries.empty()) return;
  std::string lines;
  for (const std::string& entry : names.entries) lines += entry + '\n';
  file.write_text("/Scree/" + names.name, lines);
  file.write_texts(kFieldData + names.name, names.entries, {"1", "name of each, in the deck's order"});
  file.create_rows<std::int64_t>(kSteps + kOffsets + names.name, {1, steps_per_chunk},
                                 {"1", "first name of each snapshot"});
  file.create_rows<std::int64_t>(kSteps + kSizes + names.name, {2, steps_per_chunk},
                                 {"1", "components and number of the names of each snapshot"});
}

void append_names(Hdf5File& file) {
  for_each_list(file, [&](const std::string& dataset, const std::string& list) {
    const std::int64_t size[2] = {1, file.rows(kFieldData + list)}, none = 0;
    file.append_rows(dataset, file.width(dataset) == 2 ? size : &none, 1);
  });
}

void cut_names(Hdf5File& file, std::int64_t snapshots) {
  for_each_list(
      file, [&](const std::string& dataset, const std::string&) { file.resize_rows(dataset, snapshots); });
}

}  // namespace scree
