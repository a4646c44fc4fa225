#include "run/check/disk_use.hpp"

#include <fmt/format.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/index.hpp"
#include "dem/history/packed_history.hpp"
#include "model/checks/memory.hpp"
#include "model/derived/choose_law.hpp"
#include "model/derived/connections.hpp"
#include "run/record/body_points.hpp"
#include "run/record/contact_network.hpp"
#include "run/record/joint_lines.hpp"
#include "run/record/mesh_surfaces.hpp"
#include "run/record/model_columns.hpp"
#include "run/record/output_plan.hpp"
#include "run/restart/checkpoint_datasets.hpp"
#include "run/state/contact_rows.hpp"

namespace scree {
namespace {

// Contacts per particle in a dense packing, each counted once.
constexpr std::int64_t kTouchingInPlane = 4, kTouchingInSpace = 6;

void add_history(const Model& model, DiskUse& use) {
  std::vector<HistoryColumn> heads;
  for (const RecordedColumn& column : model_columns(model)) heads.push_back(column.head);
  use.columns = std::ssize(heads), use.rows = fewest_rows(model);
  use.rows_are_known = likely_rows(model) > 0;
  const HistorySize size = history_size(heads, use.rows, likely_rows(model));
  use.history = size.hdf5, use.csv = model.output.history_csv ? size.csv : 0;
}

// One point of each kind with the fields that snapshots store for it.
struct Sample {
  std::vector<OutputValues> particle;
  BodyPoints body;
  MeshSurfaces::Sample surface;
  LineSnapshot contact;
  JointLines::Sample link;
};

Sample sample_of(const Model& model) {
  Sample one;
  for (const OutputField& field : wanted_fields(model.output)) one.particle.push_back(field.values(1));
  if (has_spatial_bodies(model)) one.body.orientation.resize(4), one.body.spin.resize(1);
  const std::vector<Real> number(1);
  const auto show = [&](SurfaceField field, std::vector<Real>& values) {
    if (model.output.shows(field)) values = number;
  };
  show(SurfaceField::pressure, one.surface.pressure);
  if (model.output.shows(SurfaceField::shear)) one.surface.shear.resize(1);
  show(SurfaceField::impact_work, one.surface.impact_work);
  show(SurfaceField::sliding_work, one.surface.sliding_work);
  show(SurfaceField::wear_depth, one.surface.wear_depth);
  return one;
}

SnapshotCounts counts_of(const Model& model, std::int64_t links) {
  SnapshotCounts counts{model.particles.totals.count, std::ssize(model.bodies), 0, 0, links};
  for (const Body& body : model.bodies)
    counts.body_points += std::ssize(body.shapes) + std::ssize(body.drawn_shapes);
  counts.surface_points = static_cast<std::int64_t>(shown_meshes(model).points);
  counts.contacts = static_cast<std::int64_t>(kLinesPerParticle * static_cast<Real>(counts.particles));
  return counts;
}

void add_snapshots(const Model& model, DiskUse& use) {
  const Sample one = sample_of(model);
  SeriesOptions options = series_options(model);
  if (!model.meshes.empty()) options.triangles = MeshSurfaces(model).triangles();
  const ContactNetwork no_contacts(model, {}, 0, {});
  WantedLines lines{false, ContactNetwork::field_names(model), model.particles.totals.count};
  if (model.output.links && !model.bodies.empty()) lines.links = JointLines(model).names();
  const SnapshotCounts counts = counts_of(model, std::ssize(lines.links));
  const MeshSurfaces::Sample& surface = one.surface;
  const auto size_of = [&](std::int64_t snapshots, bool with_contacts) {
    lines.contacts = with_contacts;
    const SnapshotsSize size = snapshots_size(
        options, lines, {{}, {}, point_fields(model.output, one.particle)}, one.body.view(),
        {{}, surface.pressure, surface.shear, surface.impact_work, surface.sliding_work, surface.wear_depth},
        no_contacts.snapshot(), one.link.snapshot(), counts, snapshots);
    return size.data + size.xdmf;
  };
  // Small snapshots share chunks: the size of one is the mean over many.
  constexpr std::int64_t kMany = 10000;
  use.snapshots = likely_snapshots(model);
  use.all_snapshots = size_of(use.snapshots, false);
  use.snapshot = (size_of(use.snapshots + kMany, false) - use.all_snapshots) / kMany;
  if (model.output.contacts) use.contacts = size_of(use.snapshots, true) - use.all_snapshots;
}

void add_checkpoint(const Model& model, std::int64_t resolved_deck, DiskUse& use) {
  State state = sized_state(model);
  state.contacts.content = packed_content(model, history_of(model.contact));
  Checkpoint checkpoint = pack(state);
  checkpoint.texts = {{"fingerprint", std::string(as_size(resolved_deck), ' ')},
                      {"deck", ""},
                      {"state_hash", std::string(16, ' ')},
                      {"changes", ""},
                      {"starts", std::string(220, ' ')}};
  const std::int64_t particles = model.particles.totals.count,
                     touching = model.space.dimension == 2 ? kTouchingInPlane : kTouchingInSpace;
  const auto size = [&](std::int64_t contacts) {
    std::map<std::string, std::int64_t> rows;
    const auto count = [&](const auto& arrays) {
      for (const auto& [name, array] : arrays)
        rows[name] = name.starts_with("particles/") || name.ends_with("/count") ? particles : contacts;
    };
    count(checkpoint.real_rows), count(checkpoint.integer_rows);
    return checkpoint_size(checkpoint, rows);
  };
  use.checkpoint = size(0), use.dense_checkpoint = size(touching * particles);
  use.checkpoints = model.output.checkpoint_interval > 0 ? 2 : 1;
}

std::string size_text(Real bytes) {
  const char* unit = "kB";
  bytes /= 1e3;
  for (const char* const larger : {"MB", "GB", "TB"}) {
    if (bytes < 999.5) break;
    bytes /= 1000, unit = larger;
  }
  return fmt::format("{:.3g} {}", bytes, unit);
}

std::string checkpoint_count(const Model& model) {
  const Real interval = model.output.checkpoint_interval;
  if (interval == 0) return "one at the end";
  return fmt::format("{:.0f} during the run and one at the end",
                     std::ceil(model.time.end / interval * (1 - 1e-9)) - 1);
}

}  // namespace

Real DiskUse::left() const {
  return all_snapshots + contacts + history + csv + checkpoints * dense_checkpoint;
}

Real DiskUse::most() const { return left() + all_snapshots + contacts + history + dense_checkpoint; }

DiskUse disk_use(const Model& model, std::int64_t resolved_deck) {
  DiskUse use;
  add_snapshots(model, use), add_history(model, use), add_checkpoint(model, resolved_deck, use);
  return use;
}

Real free_disk(const std::string& folder) {
  std::error_code error;
  std::filesystem::path path = std::filesystem::absolute(folder, error);
  while (!std::filesystem::is_directory(path, error) && path.has_relative_path()) path = path.parent_path();
  struct statvfs system {};
  if (statvfs(path.c_str(), &system) != 0) return -1;
  return static_cast<Real>(system.f_bavail) * static_cast<Real>(system.f_frsize);
}

std::string disk_warning(const Model& model, const DiskUse& use, const std::string& folder) {
  const Real free = free_disk(folder);
  if (free < 0 || use.most() <= free) return "";
  const Real checkpoints = use.checkpoints * use.dense_checkpoint;
  const char* remedy = "fewer particles";
  const Real snapshots = use.all_snapshots + use.contacts;
  if (snapshots >= std::max(use.history + use.csv, checkpoints))
    remedy = model.output.snapshot_interval > 0 ? "a longer output.snapshot_interval, fewer of output.fields"
                                                : "fewer of output.fields, output.contacts = false";
  else if (use.history + use.csv >= checkpoints)
    remedy = use.columns > use.rows
                 ? "fewer of output.history_bodies, history_particles or history_contacts, history_reactions"
                 : "a longer output.history_interval";
  return fmt::format(
      "the results need about {} of disk space during the run{}, but {} are free in {}: snapshots {}, "
      "history {}, checkpoints {}; remedy: {}{}, or --output on another disk",
      size_text(use.most()), model.output.compression > 0 ? ", before compression" : "", size_text(free),
      folder, size_text(snapshots), size_text(use.history + use.csv), size_text(checkpoints), remedy,
      model.output.compression == 0 ? ", output.compression" : "");
}

std::string disk_lines(const Model& model, const DiskUse& use, const std::string& folder) {
  const char* const compressed = model.output.compression > 0 ? ", before compression" : "";
  const bool grows = use.dense_checkpoint > 1.02 * use.checkpoint;
  const Real free = free_disk(folder);
  return fmt::format("snapshots      {} of about {}, {} together{}{}\n", use.snapshots,
                     size_text(use.snapshot), size_text(use.all_snapshots),
                     use.contacts > 0 ? fmt::format("; contacts add {} if particles are densely packed",
                                                    size_text(use.contacts))
                                      : "",
                     compressed) +
         fmt::format(
             "checkpoints    {}, about {} each{}{}\n", checkpoint_count(model), size_text(use.checkpoint),
             grows ? fmt::format("; {} if particles are densely packed", size_text(use.dense_checkpoint))
                   : "",
             compressed) +
         fmt::format("history        {}{} of {} columns, about {}{}\n", use.rows_are_known ? "" : "at least ",
                     counted(use.rows, "row", "rows"), use.columns, size_text(use.history),
                     use.csv > 0 ? fmt::format(", {} as CSV", size_text(use.csv)) : "") +
         fmt::format("disk           about {}, {} during the run{}\n", size_text(use.left()),
                     size_text(use.most()),
                     free < 0 ? "" : fmt::format("; {} are free in {}", size_text(free), folder));
}

}  // namespace scree
