#include "model/checks/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "base/host_memory.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/data/model.hpp"
#include "model/derived/shape_positions.hpp"

namespace scree {

namespace {

// Measured as the growth of the peak memory of `scree check` from 10^5 to 10^6 of each [B]. A body and each
// of its shapes need this on every rank, unknowns and joints or force elements on rank 0.
constexpr Real kToBuildBody = 600, kToBuildShape = 300, kToBuildUnknowns = 1400, kToBuildLink = 1600;
// A particle and its entry in the search for overlaps; a particle of a random group, with the items that it
// must avoid.
constexpr Real kToBuildParticle = 150, kToPlace = 130;
// The part of a run's memory that is in use once the model is built: of a triangle all but its output.
constexpr Real kOfModelShape = 170, kOfModelDrawnShape = 140;
// Additional memory per particle where particles rotate, and where there is rolling resistance, in a dense
// packing: fields of rotation, and the contact history in the copies from which a checkpoint is made
// (tests/performance/bytes_per_item.py) [B].
constexpr Real kOfRotation = 400, kOfRolling = 280;

Real gigabytes(Real bytes) { return bytes / 1e9; }

Real triangles_of(const Model& model) {
  Real triangles = 0;
  for (const ModelMesh& mesh : model.meshes) triangles += static_cast<Real>(mesh.surface->triangles.size());
  return triangles;
}

}  // namespace

Real bytes_per_particle(const Model& model) {
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  Real bytes = implicit ? kBytesPerImplicitParticle : kBytesPerExplicitParticle;
  if (model.rotates()) bytes += kOfRotation;
  if (model.rolls()) bytes += kOfRolling;
  if (model.output.contacts) bytes += kLinesPerParticle * kBytesPerLine;
  return bytes;
}

Real bytes_per_triangle(const Model& model) {
  return kBytesPerTriangle + (model.output.adds_up_works() ? kBytesPerWorks : 0);
}

Real bytes_of_meshes(const Model& model, bool is_root) {
  const Real triangles = triangles_of(model), shown = is_root ? shown_meshes(model).triangles : 0;
  return std::max(kBytesPerTriangle * triangles,
                  kBytesPerStoredTriangle * triangles + kBytesPerShownTriangle * shown) +
         (bytes_per_triangle(model) - kBytesPerTriangle) * triangles;
}

ShownMeshes shown_meshes(const Model& model) {
  ShownMeshes shown;
  const auto show = [&](int mesh) {
    const SurfaceMesh& surface = *model.meshes[static_cast<std::size_t>(mesh)].surface;
    shown.points += static_cast<Real>(surface.vertices.size());
    shown.triangles += static_cast<Real>(surface.triangles.size());
  };
  for (const Wall& wall : model.walls)
    if (wall.mesh >= 0) show(wall.mesh);
  for (const Body& body : model.bodies) {
    for (const MeshShape& of : body.meshes) show(of.mesh);
    for (const MeshShape& of : body.drawn_meshes) show(of.mesh);
  }
  return shown;
}

Real bytes_of_shapes(const ModelSize& size) {
  return kBytesPerShape * static_cast<Real>(size.shapes) +
         kBytesPerDrawnShape * static_cast<Real>(size.drawn_shapes);
}

Real bytes_of_model(const Model& model) {
  const ModelSize size = size_of(model);
  return kToBuildParticle * static_cast<Real>(model.particles.size()) +
         kOfModelShape * static_cast<Real>(size.shapes) +
         kOfModelDrawnShape * static_cast<Real>(size.drawn_shapes) + kBytesPerTriangle * triangles_of(model);
}

std::string counted(std::int64_t count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

ModelSize bodies_and_joints(const DeckTable& deck) {
  ModelSize size;
  const int dimension = static_cast<int>(deck.table("space").integer("dimension"));
  std::map<std::string, std::int64_t> rows;
  for (const DeckTable& table : deck.tables("bodies")) {
    const std::int64_t count = table.has("count") ? table.integer("count") : 1;
    rows[table.text("name")] = count;
    size.bodies += count;
    for (const DeckTable& shape : table.tables("shapes"))
      (table.boolean("collides") && shape.boolean("collides") ? size.shapes : size.drawn_shapes) +=
          count * ShapePositions(shape, dimension).count();
  }
  std::map<std::string, std::int64_t> joints;
  for (const char* key : {"joints", "cylinders", "spring_dampers", "torsional_spring_dampers", "bushings"}) {
    for (const DeckTable& table : deck.tables(key)) {
      const char* row = table.has("chain") ? "chain" : "each";
      const std::int64_t count = table.has(row) ? rows[table.text(row)] : 1;
      const bool cylinder = key == std::string("cylinders");
      if (cylinder || key == std::string("joints")) joints[table.text("name")] = count;
      size.links += cylinder ? (table.has("stop_stiffness") ? 3 : 2) * count : count;
    }
  }
  for (const char* key : {"drivers", "applied_forces", "couplers"})
    size.links += std::ssize(deck.tables(key));
  for (const char* key : {"motors", "joint_springs", "joint_limits", "joint_frictions"})
    for (const DeckTable& table : deck.tables(key))
      size.links += std::max<std::int64_t>(1, joints[table.text("joint")]);
  return size;
}

ModelSize size_of(const Model& model) {
  std::int64_t shapes = 0, drawn_shapes = 0;
  for (const Body& body : model.bodies)
    shapes += std::ssize(body.shapes), drawn_shapes += std::ssize(body.drawn_shapes);
  return {model.particles.totals.count, std::ssize(model.bodies),
          std::ssize(model.joints) + std::ssize(model.drivers) + std::ssize(model.spring_dampers) +
              std::ssize(model.torsional_spring_dampers) + std::ssize(model.bushings) +
              std::ssize(model.applied_forces) + std::ssize(model.motors) + std::ssize(model.joint_springs) +
              std::ssize(model.joint_limits) + std::ssize(model.joint_frictions) + std::ssize(model.couplers),
          shapes, drawn_shapes};
}

Real bytes_to_build_bodies(const ModelSize& size, int rank) {
  const auto bodies = static_cast<Real>(size.bodies), links = static_cast<Real>(size.links);
  return kToBuildBody * bodies + kToBuildShape * static_cast<Real>(size.shapes + size.drawn_shapes) +
         (rank == 0 ? kToBuildUnknowns * bodies + kToBuildLink * links : 0);
}

Real bytes_to_build_particles(std::int64_t own, std::int64_t placed) {
  return kToBuildParticle * static_cast<Real>(own) + kToPlace * static_cast<Real>(placed);
}

void check_memory(const ModelSize& size, Real bytes, const std::string& task, const Share& share) {
  const FreeMemory free = free_memory();
  const Real together = share.sum_on_host(bytes);
  share.collectively([&] {
    const bool alone = bytes > free.process.bytes || together == bytes;
    const MemoryBound& bound = bytes > free.process.bytes ? free.process : free.host;
    const Real needed = alone ? bytes : together;
    if (needed <= bound.bytes) return;
    throw InputError(memory_trouble(
        size, share.size(),
        fmt::format("{} takes about {:.3g} GB{}, {:.3g} GB are free ({})", task, gigabytes(needed),
                    alone ? "" : " for the ranks of a host", gigabytes(bound.bytes), bound.set_by)));
  });
}

std::string memory_trouble(const ModelSize& size, int ranks, const std::string& finding) {
  const Real particles = kBytesPerExplicitParticle * static_cast<Real>(size.particles);
  // A body has three coordinates; a joint or force element has at most two constraints, except for fixed
  // joints.
  const Real unknowns =
      kBytesPerUnknown * static_cast<Real>(3 * size.bodies + 2 * size.links) + bytes_of_shapes(size);
  std::string of = counted(size.particles, "particle", "particles");
  if (size.bodies > 0) {
    const std::string bodies = counted(size.bodies, "body", "bodies");
    of = size.particles > 0 ? fmt::format("{} and {}", of, bodies) : bodies;
  }
  const std::string where =
      ranks == 1 ? "on one rank"
                 : fmt::format("on {} ranks, {:.3g} GB on {}", ranks, gigabytes(particles / ranks + unknowns),
                               size.bodies > 0 ? "rank 0" : "each");
  const char* advice = particles >= unknowns
                           ? "start more ranks on more machines (mpirun -n), or take fewer particles"
                           : "take fewer bodies, or a machine with more memory: rank 0 has them all";
  return fmt::format("not enough memory: {}{}a run of {} takes at least {:.3g} GB {}; {}", finding,
                     finding.empty() ? "" : "; ", of, gigabytes(particles + unknowns), where, advice);
}

}  // namespace scree
