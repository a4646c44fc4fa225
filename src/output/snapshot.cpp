#include "output/snapshot.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/series_size.hpp"

namespace scree {

namespace {

constexpr const char* kGlobalId = "global_id";

PointSnapshot particle_points(Real time, const ParticleSnapshot& particles, const Ranks& ranks) {
  const std::int64_t own = std::ssize(particles.position);
  PointSnapshot snapshot{
      time, ranks.sum(own), {ranks.sum_below(own), own}, components(particles.position), {}};
  snapshot.fields = {{kGlobalId,
                      {"1", "identity of the particle, counted from 0 in the deck's order"},
                      1,
                      particles.global_id.data()}};
  snapshot.fields.insert(snapshot.fields.end(), particles.fields.begin(), particles.fields.end());
  return snapshot;
}

PointSnapshot body_points(Real time, const BodySnapshot& bodies) {
  const std::int64_t points = std::ssize(bodies.position);
  PointSnapshot snapshot{time, points, {0, points}, components(bodies.position), {}};
  snapshot.fields = {
      field_of("body", {"1", "body of the point, counted from 0 in the deck's order"}, bodies.body),
      field_of("kind", {"1", "0: shape, 1: centre of mass of a body, 2: shape without contact detection"},
               bodies.kind),
      field_of("radius", {"m", "radius of the shape; 0 for a centre of mass"}, bodies.radius),
      field_of("velocity", {"m/s", "velocity of the point"}, bodies.velocity),
      field_of("angle", {"rad", "angle of the body about z"}, bodies.angle),
      field_of("angular_velocity", {"rad/s", "angular velocity of the body about z"},
               bodies.angular_velocity),
      field_of("force", {"N", "total contact force on the shape; for a centre of mass that on the body"},
               bodies.force),
      field_of("contacts", {"1", "number of contacts of the shape; for a centre of mass that of the body"},
               bodies.contacts),
      field_of("origin", {"m", "origin of the body's frame"}, bodies.origin)};
  if (bodies.orientation.empty()) return snapshot;
  snapshot.fields.push_back(
      {"orientation",
       {"1", "orientation of the body's frame: unit quaternion, scalar first, with continuous sign"},
       4,
       bodies.orientation.data()});
  snapshot.fields.push_back(
      field_of("spin", {"rad/s", "angular velocity of the body in global axes"}, bodies.spin));
  return snapshot;
}

PointSnapshot surface_points(Real time, const SurfaceSnapshot& surfaces) {
  const std::int64_t points = std::ssize(surfaces.position);
  PointSnapshot snapshot{time, points, {0, points}, components(surfaces.position), {}};
  const auto add = [&](const char* name, const DatasetLabel& label, const auto& values) {
    if (!values.empty()) snapshot.fields.push_back(field_of(name, label, values));
  };
  add("pressure",
      {"Pa (2D: N/m)", "normal contact force on the triangle over its area (2D: over the segment's length)"},
      surfaces.pressure);
  add("shear",
      {"Pa (2D: N/m)",
       "tangential contact force on the triangle over its area (2D: over the segment's length)"},
      surfaces.shear);
  add("impact_work", {"J", "energy dissipated by normal contact damping since t = 0"}, surfaces.impact_work);
  add("sliding_work", {"J", "energy dissipated by friction since t = 0"}, surfaces.sliding_work);
  add("wear_depth", {"m", "wear volume since t = 0 (Archard) over the triangle's area (2D: 1 m deep)"},
      surfaces.wear_depth);
  return snapshot;
}

PointSnapshot line_points(Real time, const LineSnapshot& lines, const Ranks& ranks) {
  const std::int64_t own = std::ssize(lines.ends);
  return {time, ranks.sum(own), {ranks.sum_below(own), own}, components(lines.ends), lines.fields};
}

SeriesOptions with_global_id(SeriesOptions options) {
  if (options.fields) options.fields->emplace_back(kGlobalId);
  options.constant.emplace_back(kGlobalId);
  std::erase_if(options.names, [](const SeriesNames& of) { return of.name == kBodyNames; });
  options.triangles.reset();
  return options;
}

SeriesOptions of_contacts(SeriesOptions options, const WantedLines& lines) {
  options.fields.reset(), options.triangles.reset(), options.constant.clear();
  std::erase_if(options.names, [](const SeriesNames& of) { return of.name != kBodyNames; });
  if (lines.contacts) options.fields = lines.contact_fields;
  options.lines = true, options.likely_points = 2 * lines.likely_contacts;
  return options;
}

// Options of series that rank 0 writes alone.
SeriesOptions of_surfaces(SeriesOptions options) {
  options.ranks = {}, options.fields = {}, options.constant = {};
  std::erase_if(options.names, [](const SeriesNames& of) { return of.name == kGroupNames; });
  if (!options.triangles) options.triangles.emplace();
  return options;
}

SeriesOptions of_bodies(const SeriesOptions& options) {
  SeriesOptions own = of_surfaces(options);
  own.triangles.reset();
  own.constant = {"body", "kind", "radius"};
  return own;
}

SeriesOptions of_joints(SeriesOptions options, const WantedLines& lines) {
  options.names = {{kBodyNames, lines.links}}, options.lines = true, options.constant.clear();
  return options;
}

// Checks, before any file is cut, that continued files have the lines that are wanted.
const SeriesOptions& with_these_lines(const std::string& directory, const SeriesOptions& options,
                                      const WantedLines& lines) {
  const auto require = [&](const std::string& name, bool wanted) {
    const std::string path = fmt::format("{}/{}.vtkhdf", directory, name);
    if (options.keep == 0 || std::filesystem::exists(path) == wanted) return;
    throw IoError(fmt::format("{}: {}; set output.{} = {}, or choose another folder", path,
                              wanted ? "is missing, but the restarted run is to write it"
                                     : "exists, but the restarted run is not to write it",
                              name, !wanted));
  };
  options.ranks.on_root([&] {
    require("contacts", lines.contacts);
    require("links", !lines.links.empty());
  });
  return options;
}

}  // namespace

SnapshotWriter::SnapshotWriter(const std::string& directory, const SeriesOptions& options,
                               const WantedLines& lines)
    : ranks_(options.ranks),
      particles_(directory, "particles", with_global_id(with_these_lines(directory, options, lines))),
      contacts_(directory, "contacts", of_contacts(options, lines)),
      shows_contacts_(lines.contacts),
      shows_joints_(!lines.links.empty()),
      snapshots_(options.keep) {
  ranks_.on_root([&] {
    surfaces_.emplace(directory, "surfaces", of_surfaces(options));
    bodies_.emplace(directory, "bodies", of_bodies(options));
    links_.emplace(directory, "links", of_joints(of_bodies(options), lines));
  });
  if (particles_.snapshots() != snapshots_)
    throw IoError(particles_.path() + ": is missing, but the restarted run needs it");
}

void SnapshotWriter::append(Real time, const ParticleSnapshot& particles, const BodySnapshot& bodies,
                            const SurfaceSnapshot& surfaces, const LineSnapshot& contacts,
                            const LineSnapshot& links) {
  const PointSnapshot points = particle_points(time, particles, ranks_), shapes = body_points(time, bodies),
                      corners = surface_points(time, surfaces), touches = line_points(time, contacts, ranks_),
                      connections = line_points(time, links, {});
  // Applies an action to the series of all ranks, then to those of rank 0.
  const auto with_shared = [&](const auto& action) {
    action(particles_, points);
    if (shows_contacts_) action(contacts_, touches);
  };
  const auto with_others = [&](const auto& action) {
    ranks_.on_root([&] {
      if (shapes.points > 0) action(*bodies_, shapes);
      if (corners.points > 0) action(*surfaces_, corners);
      if (shows_joints_) action(*links_, connections);
    });
  };
  with_others([&](const VtkHdfSeries& series, const PointSnapshot&) {
    if (series.snapshots() == snapshots_) return;
    throw IoError(fmt::format("{}: has {} snapshots, but {} were written", series.path(), series.snapshots(),
                              snapshots_));
  });
  const auto with_all = [&](const auto& action) { with_shared(action), with_others(action); };
  with_all([](VtkHdfSeries& series, const PointSnapshot& of) { series.prepare(of); });
  with_all([](VtkHdfSeries& series, const PointSnapshot&) { series.show(); });
  ranks_.on_root([&] { sync_folder_of(particles_.path()); });
  with_all([](VtkHdfSeries& series, const PointSnapshot& of) { series.follow(of); });
  ++snapshots_;
}

void SnapshotWriter::finish() {
  particles_.finish(), contacts_.finish();
  ranks_.on_root([&] { bodies_->finish(), surfaces_->finish(), links_->finish(); });
}

SnapshotsSize snapshots_size(const SeriesOptions& options, const WantedLines& lines,
                             const ParticleSnapshot& particles, const BodySnapshot& bodies,
                             const SurfaceSnapshot& surfaces, const LineSnapshot& contacts,
                             const LineSnapshot& links, const SnapshotCounts& counts,
                             std::int64_t snapshots) {
  SnapshotsSize all;
  const auto add = [&](const char* name, const SeriesOptions& of_series, PointSnapshot like,
                       std::int64_t points, std::int64_t parts) {
    like.points = points;
    const SeriesSize size = series_size(name, of_series, like, snapshots, parts);
    all.data += size.data, all.xdmf += size.xdmf;
  };
  add("particles", with_global_id(options), particle_points(0, particles, {}), counts.particles, 1);
  if (lines.contacts)  // the number of contacts differs at each snapshot
    add("contacts", of_contacts(options, lines), line_points(0, contacts, {}), 2 * counts.contacts,
        snapshots);
  if (counts.body_points > 0)
    add("bodies", of_bodies(options), body_points(0, bodies), counts.body_points, 1);
  if (counts.surface_points > 0)
    add("surfaces", of_surfaces(options), surface_points(0, surfaces), counts.surface_points, 1);
  if (!lines.links.empty())
    add("links", of_joints(of_bodies(options), lines), line_points(0, links, {}), 2 * counts.links, 1);
  return all;
}

}  // namespace scree
