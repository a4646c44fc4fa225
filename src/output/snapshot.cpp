#include "output/snapshot.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "output/durable_file.hpp"

namespace scree {

namespace {

constexpr const char* kGlobalId = "global_id";

static_assert(sizeof(Vec3) == 3 * sizeof(Real), "a Vec3 array is written as a [n][3] dataset");

PointField scalar(const char* name, const char* unit, const char* description, std::span<const Real> values) {
  return {name, {unit, description}, 1, values.data()};
}

// [n][3]
const Real* components(std::span<const Vec3> values) { return reinterpret_cast<const Real*>(values.data()); }

PointField vector(const char* name, const char* unit, const char* description, std::span<const Vec3> values) {
  return {name, {unit, description}, 3, components(values)};
}

PointField number(const char* name, const char* description, std::span<const int> values) {
  return {name, {"1", description}, 1, values.data()};
}

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
      number("body", "body that the point belongs to, counted from 0 in the deck's order", bodies.body),
      number("kind", "0: a shape, 1: a body's centre of mass, 2: a shape that touches nothing", bodies.kind),
      scalar("radius", "m", "radius of the shape; 0 of a centre of mass", bodies.radius),
      vector("velocity", "m/s", "velocity of the point", bodies.velocity),
      scalar("angle", "rad", "angle of the body about z", bodies.angle),
      scalar("angular_velocity", "rad/s", "angular velocity of the body about z", bodies.angular_velocity),
      vector("force", "N", "total contact force on the shape; of a centre of mass that on the body",
             bodies.force),
      number("contacts", "touching neighbours and walls, likewise", bodies.contacts),
      vector("origin", "m", "origin of the body's frame", bodies.origin)};
  if (bodies.orientation.empty()) return snapshot;
  snapshot.fields.push_back({"orientation",
                             {"1", "unit quaternion of the body's frame, scalar first, of continuous sign"},
                             4,
                             bodies.orientation.data()});
  snapshot.fields.push_back(
      vector("spin", "rad/s", "angular velocity of the body, global axes", bodies.spin));
  return snapshot;
}

PointSnapshot surface_points(Real time, const SurfaceSnapshot& surfaces) {
  const std::int64_t points = std::ssize(surfaces.position);
  PointSnapshot snapshot{time, points, {0, points}, components(surfaces.position), {}};
  const auto add_scalar = [&](const char* name, const char* unit, const char* description,
                              std::span<const Real> values) {
    if (!values.empty()) snapshot.fields.push_back(scalar(name, unit, description, values));
  };
  add_scalar("pressure", "Pa", "normal contact forces on the triangle over its area", surfaces.pressure);
  if (!surfaces.shear.empty())
    snapshot.fields.push_back(
        vector("shear", "Pa", "tangential contact forces on the triangle over its area", surfaces.shear));
  add_scalar("impact_work", "J", "taken by the damping of normal contact forces since t = 0",
             surfaces.impact_work);
  add_scalar("sliding_work", "J", "taken by friction since t = 0", surfaces.sliding_work);
  add_scalar("wear_depth", "m", "volume worn off since t = 0 after Archard over the triangle's area",
             surfaces.wear_depth);
  return snapshot;
}

SeriesOptions with_global_id(SeriesOptions options) {
  if (options.fields) options.fields->emplace_back(kGlobalId);
  std::erase_if(options.names, [](const SeriesNames& of) { return of.name == kBodyNames; });
  options.triangles.reset();
  return options;
}

}  // namespace

SnapshotWriter::SnapshotWriter(const std::string& directory, const SeriesOptions& options)
    : ranks_(options.ranks),
      particles_(directory, "particles", with_global_id(options)),
      snapshots_(options.keep) {
  ranks_.on_root([&] {
    SeriesOptions alone = options;
    alone.ranks = {}, alone.fields = {};
    std::erase_if(alone.names, [](const SeriesNames& of) { return of.name == kGroupNames; });
    alone.triangles = options.triangles.value_or(SeriesTriangles{});
    surfaces_.emplace(directory, "surfaces", alone);
    alone.triangles.reset();
    bodies_.emplace(directory, "bodies", alone);
  });
  if (particles_.snapshots() != snapshots_)
    throw IoError(particles_.path() + ": missing, the restarted run needs it");
}

void SnapshotWriter::append(Real time, const ParticleSnapshot& particles, const BodySnapshot& bodies,
                            const SurfaceSnapshot& surfaces) {
  const PointSnapshot points = particle_points(time, particles, ranks_), shapes = body_points(time, bodies),
                      corners = surface_points(time, surfaces);
  const auto with_others = [&](const auto& action) {
    ranks_.on_root([&] {
      if (shapes.points > 0) action(*bodies_, shapes);
      if (corners.points > 0) action(*surfaces_, corners);
    });
  };
  with_others([&](const VtkHdfSeries& series, const PointSnapshot&) {
    if (series.snapshots() == snapshots_) return;
    throw IoError(fmt::format("{}: holds {} snapshots where {} were written", series.path(),
                              series.snapshots(), snapshots_));
  });
  particles_.prepare(points);
  with_others([](VtkHdfSeries& series, const PointSnapshot& of) { series.prepare(of); });
  particles_.show();
  with_others([](VtkHdfSeries& series, const PointSnapshot&) { series.show(); });
  ranks_.on_root([&] { sync_folder_of(particles_.path()); });
  particles_.follow(points);
  with_others([](VtkHdfSeries& series, const PointSnapshot& of) { series.follow(of); });
  ++snapshots_;
}

void SnapshotWriter::finish() {
  particles_.finish();
  ranks_.on_root([&] { bodies_->finish(), surfaces_->finish(); });
}

}  // namespace scree
