// A directory for the duration of a test, and snapshots with values that a reader can predict.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "output/hdf5_file.hpp"
#include "output/snapshot.hpp"

namespace scree {

class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "scree_output_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch directory");
    path_ = pattern;
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

// Snapshot `step` with n points: every value encodes its position.
struct PredictableSnapshot {
  PredictableSnapshot(int step, int n, int shapes) : time(0.25 * step) {
    for (int i = 0; i < n; ++i) {
      const Real base = value(step, i);
      global_id.push_back(3 * i);
      radius.push_back(base + 0.5);
      position.push_back({base, -base, base + 0.25});
      velocity.push_back({-base, base, 1});
      contacts.push_back(step + i);
    }
    for (int i = 0; i < shapes; ++i) body.push_back(i), scalar.push_back(value(step, i));
    for (int i = 0; i < shapes; ++i) vector.push_back({value(step, i), 0, 1}), number.push_back(step);
  }
  static Real value(int step, int i) { return 1000.0 * step + i; }
  // The points [first, first + count).
  ParticleSnapshot particles(std::size_t first, std::size_t count) const {
    const auto reals = [&](const std::vector<Vec3>& v) {
      return reinterpret_cast<const Real*>(v.data() + first);
    };
    return {std::span(global_id).subspan(first, count),
            std::span(position).subspan(first, count),
            {{"radius", {"m", "radius"}, 1, radius.data() + first},
             {"velocity", {"m/s", "velocity"}, 3, reals(velocity)},
             {"force", {"N", "total contact force on the particle"}, 3, reals(velocity)},
             {"contacts", {"1", "touching neighbours and walls"}, 1, contacts.data() + first}}};
  }
  ParticleSnapshot particles() const { return particles(0, position.size()); }
  BodySnapshot bodies() const {
    return {body, number, scalar, vector, vector, scalar, scalar, vector, number, vector};
  }
  void append_to(SnapshotWriter& writer) const { writer.append(time, particles(), bodies()); }

  Real time;
  std::vector<GlobalId> global_id;
  std::vector<Real> radius, scalar;
  std::vector<Vec3> position, velocity, vector;
  std::vector<int> contacts, body, number;
};

// Reads a series back the way a VTKHDF reader does: by the offsets in Steps. Returns the number of points of
// every snapshot, or an empty vector where a value is not PredictableSnapshot's.
inline std::vector<int> read_predictable_particles(const std::string& path) {
  const Hdf5File file(path, Hdf5Access::read);
  const auto integers = [&](const std::string& name) {
    return file.read_array<std::int64_t>("/VTKHDF/" + name);
  };
  const auto times = file.read_array<Real>("/VTKHDF/Steps/Values");
  const auto part = integers("Steps/PartOffsets"), parts = integers("Steps/NumberOfParts");
  const auto first_point = integers("Steps/PointOffsets"),
             first_field = integers("Steps/PointDataOffsets/contacts");
  const auto first_cell = integers("Steps/CellOffsets"), first_id = integers("Steps/ConnectivityIdOffsets");
  const auto points_of = integers("NumberOfPoints"), cells_of = integers("Vertices/NumberOfCells");
  const auto connectivity = integers("Vertices/Connectivity"), offsets = integers("Vertices/Offsets");
  const auto positions = file.read_array<Real>("/VTKHDF/Points");
  const auto velocities = file.read_array<Real>("/VTKHDF/PointData/velocity");
  const auto contacts = file.read_array<int>("/VTKHDF/PointData/contacts");
  std::vector<int> counts;
  for (std::size_t s = 0; s < times.size(); ++s) {
    const auto p = static_cast<std::size_t>(part.at(s));
    const std::int64_t n = points_of.at(p);
    bool right = times[s] == 0.25 * static_cast<Real>(s) && parts.at(s) == 1 && cells_of.at(p) == n;
    for (std::int64_t i = 0; i < n; ++i) {
      const Real base = PredictableSnapshot::value(static_cast<int>(s), static_cast<int>(i));
      const auto row = static_cast<std::size_t>(first_point.at(s) + i);
      const auto field_row = static_cast<std::size_t>(first_field.at(s) + i);
      right = right && positions.at(3 * row) == base && positions.at(3 * row + 2) == base + 0.25;
      right = right && velocities.at(3 * field_row) == -base;
      right = right && contacts.at(field_row) == static_cast<int>(s) + static_cast<int>(i);
      right = right && connectivity.at(static_cast<std::size_t>(first_id.at(4 * s) + i)) == i;
    }
    // The offsets of a part have one more row than it has cells.
    for (std::int64_t i = 0; i <= n; ++i) {
      right = right && offsets.at(static_cast<std::size_t>(first_cell.at(4 * s) + i) + p) == i;
    }
    if (!right) return {};
    counts.push_back(static_cast<int>(n));
  }
  return counts;
}

inline void write_snapshots(SnapshotWriter& writer, const std::vector<int>& counts, int shapes) {
  for (const int n : counts) PredictableSnapshot(writer.snapshots(), n, shapes).append_to(writer);
}

inline std::string file_text(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline int occurrences(const std::string& text, const std::string& word) {
  int count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

}  // namespace scree
