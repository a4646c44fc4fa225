// Snapshots: one VTKHDF time series per kind (particles, bodies, surfaces, contacts, links), each with an
// .xdmf that refers to its data.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "output/vtkhdf_series.hpp"

namespace scree {

// Views of the particles of one snapshot: one entry per particle of this rank, ordered by global id within
// and across ranks.
struct ParticleSnapshot {
  std::span<const GlobalId> global_id;
  std::span<const Vec3> position;  // [m]
  std::vector<PointField> fields;  // the fields with which the series was opened
};

// Names of the lists in SeriesOptions::names. kBodyNames: bodies, or links in links.vtkhdf, and not in
// particles.vtkhdf; kGroupNames: in particles.vtkhdf only.
inline const std::string kBodyNames = "names", kMaterialNames = "materials", kGroupNames = "groups";

enum BodyPointKind : int { kTouchingShape, kCenterOfMass, kDrawnShape };

// One entry per shape (disc or sphere) and per centre of mass of every body; on rank 0.
struct BodySnapshot {
  std::span<const int> body;               // index into the model's bodies
  std::span<const int> kind;               // a BodyPointKind
  std::span<const Real> radius;            // 0 for centres of mass [m]
  std::span<const Vec3> position;          // [m]
  std::span<const Vec3> velocity;          // [m/s]
  std::span<const Real> angle;             // of the body [rad]
  std::span<const Real> angular_velocity;  // of the body [rad/s]
  std::span<const Vec3> force;             // contact force on the shape, or on the body [N]
  std::span<const int> contacts;           // number of contacts of the shape, or of the body
  std::span<const Vec3> origin;            // of the body's frame [m]
  // For models with spatial bodies, otherwise empty. orientation: scalar first, 4 numbers per point.
  std::span<const Real> orientation{};
  std::span<const Vec3> spin{};  // angular velocity in global axes [rad/s]
};

// The meshes of walls and bodies with which the writer was created; on rank 0.
struct SurfaceSnapshot {
  std::span<const Vec3> position;  // of the meshes' points [m]
  // Per triangle; a field that is empty is missing in all snapshots of a series.
  std::span<const Real> pressure;                       // normal traction [Pa], in 2D [N/m]
  std::span<const Vec3> shear;                          // tangential traction [Pa], in 2D [N/m]
  std::span<const Real> impact_work{}, sliding_work{};  // energy dissipated there since t = 0 [J]
  std::span<const Real> wear_depth{};                   // [m]
};

// Lines: contacts of this rank, or all links on rank 0.
struct LineSnapshot {
  std::span<const Vec3> ends;      // two points per line [m]
  std::vector<PointField> fields;  // fields of the lines with which the series was opened
};

// The lines to write in addition to the points.
struct WantedLines {
  bool contacts = false;
  std::vector<std::string> contact_fields = {};
  std::int64_t likely_contacts = 0;     // upper estimate of their number
  std::vector<std::string> links = {};  // names of the links; on rank 0, if there are any
};

// Sizes of all files of a SnapshotWriter with so many snapshots [B], and of a snapshot with the numbers of
// entries in these views and in `counts`; for compressed files before compression. The values in the views do
// not matter.
struct SnapshotCounts {
  std::int64_t particles = 0, body_points = 0, surface_points = 0, contacts = 0, links = 0;
};
struct SnapshotsSize {
  Real data = 0, xdmf = 0;  // HDF5 files, and the texts that refer to them
};
SnapshotsSize snapshots_size(const SeriesOptions& options, const WantedLines& lines,
                             const ParticleSnapshot& particles, const BodySnapshot& bodies,
                             const SurfaceSnapshot& surfaces, const LineSnapshot& contacts,
                             const LineSnapshot& links, const SnapshotCounts& counts, std::int64_t snapshots);

// Writes DIRECTORY/particles.vtkhdf and particles.xdmf; for bodies also bodies.vtkhdf and bodies.xdmf, for
// meshes surfaces.vtkhdf and surfaces.xdmf, and the files of contacts and links if they are wanted. The files
// are complete, closed and synced after every append, and readable at any time, even after a kill during an
// append; before finish() the .xdmf may lack the last sixth of the snapshots. All ranks write particles and
// contacts, rank 0 the others; all functions are collective.
class SnapshotWriter {
 public:
  // options.keep: number of snapshots of existing files to keep for a restart (later ones are cut off); 0
  // replaces existing files. options.fields: fields of the particles besides the global id; options.constant:
  // those of them that never change. options.names: lists with the names above. options.triangles: of the
  // meshes, on rank 0. Throws IoError if the files have fewer snapshots, other fields or other triangles, or
  // if files of lines exist that are not wanted or the reverse.
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
  bool shows_contacts_, shows_joints_;
  int snapshots_ = 0;
};

}  // namespace scree
