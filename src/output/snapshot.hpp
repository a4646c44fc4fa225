// Snapshots: one VTKHDF time series per kind (particles, bodies, surfaces, contacts, links) and an .xdmf that
// refers to the same data.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "output/vtkhdf_series.hpp"

namespace scree {

// Views of what one snapshot stores; one entry per particle of this rank, ordered by global id on the rank
// and from rank to rank.
struct ParticleSnapshot {
  std::span<const GlobalId> global_id;
  std::span<const Vec3> position;  // [m]
  std::vector<PointField> fields;  // those that the series was opened with
};

// The lists of SeriesOptions::names: bodies, or links in links.vtkhdf; bodies are not in particles.vtkhdf,
// groups in no other.
inline const std::string kBodyNames = "names", kMaterialNames = "materials", kGroupNames = "groups";

enum BodyPointKind : int { kTouchingShape, kCenterOfMass, kDrawnShape };

// One entry per shape (disc or sphere) and one per centre of mass of every body; on rank 0.
struct BodySnapshot {
  std::span<const int> body;               // index into the model's bodies
  std::span<const int> kind;               // a BodyPointKind
  std::span<const Real> radius;            // 0 of centres [m]
  std::span<const Vec3> position;          // [m]
  std::span<const Vec3> velocity;          // [m/s]
  std::span<const Real> angle;             // of the body [rad]
  std::span<const Real> angular_velocity;  // of the body [rad/s]
  std::span<const Vec3> force;             // contact force on the shape, or the body [N]
  std::span<const int> contacts;           // likewise
  std::span<const Vec3> origin;            // of the body's frame [m]
  // Of the bodies, where some are spatial; else empty. orientation: scalar first, 4 numbers a point.
  std::span<const Real> orientation{};
  std::span<const Vec3> spin{};  // angular velocity, global [rad/s]
};

// The meshes of walls and bodies, those that the writer was made with; on rank 0.
struct SurfaceSnapshot {
  std::span<const Vec3> position;  // of their points [m]
  // Per triangle; empty: left out, of all snapshots of a series.
  std::span<const Real> pressure;                       // what presses on it [Pa], in 2D [N/m]
  std::span<const Vec3> shear;                          // what drags it along, likewise
  std::span<const Real> impact_work{}, sliding_work{};  // lost there since t = 0 [J]
  std::span<const Real> wear_depth{};                   // [m]
};

// Lines: of this rank those of contacts, all of links on rank 0.
struct LineSnapshot {
  std::span<const Vec3> ends;      // two of each [m]
  std::vector<PointField> fields;  // of the lines: those that the series was opened with
};

// Which lines are written beside the points.
struct WantedLines {
  bool contacts = false;
  std::vector<std::string> contact_fields = {};
  std::int64_t likely_contacts = 0;     // how many there may be
  std::vector<std::string> links = {};  // names of the links; on rank 0, where there are some
};

// The sizes of all files of a SnapshotWriter with so many snapshots [B]; of these the one in which there is
// as much of everything as in these views, of which the numbers count and not the values, and as in `counts`.
// In compressed files: before compression.
struct SnapshotCounts {
  std::int64_t particles = 0, body_points = 0, surface_points = 0, contacts = 0, links = 0;
};
struct SnapshotsSize {
  Real data = 0, xdmf = 0;  // HDF5, and the texts that refer to it
};
SnapshotsSize snapshots_size(const SeriesOptions& options, const WantedLines& lines,
                             const ParticleSnapshot& particles, const BodySnapshot& bodies,
                             const SurfaceSnapshot& surfaces, const LineSnapshot& contacts,
                             const LineSnapshot& links, const SnapshotCounts& counts, std::int64_t snapshots);

// Writes DIRECTORY/particles.vtkhdf + particles.xdmf and, where there are bodies, bodies.vtkhdf +
// bodies.xdmf, surfaces.vtkhdf + surfaces.xdmf where there are meshes, and contacts and links likewise where
// they are wanted. The files are complete, closed and on disk after every append, and readable at every
// instant, a kill in the middle of an append included; the .xdmf may lack the last sixth of the snapshots
// until finish(). All ranks write the particles and the contacts, rank 0 the others; all functions are
// collective.
class SnapshotWriter {
 public:
  // options.keep: number of snapshots to keep when a restarted run continues existing files (later ones are
  // cut off); 0 starts new files and removes old ones. options.fields: those of the particles beside
  // the global id; options.constant: which of them never change. options.names: lists of the names above.
  // options.triangles: of the meshes, on rank 0, where there are some. Throws IoError where the files hold
  // fewer snapshots, other fields or other triangles, or where there are lines that are not wanted, or none
  // that are.
  SnapshotWriter(const std::string& directory, const SeriesOptions& options, const WantedLines& lines = {});
  // Both throw IoError.
  void append(Real time, const ParticleSnapshot& particles, const BodySnapshot& bodies,
              const SurfaceSnapshot& surfaces = {}, const LineSnapshot& contacts = {},
              const LineSnapshot& links = {});
  void finish();
  int snapshots() const { return snapshots_; }

 private:
  Ranks ranks_;
  VtkHdfSeries particles_, contacts_;
  std::optional<VtkHdfSeries> bodies_, surfaces_, links_;  // on rank 0
  bool shows_contacts_, shows_links_;
  int snapshots_ = 0;
};

}  // namespace scree
