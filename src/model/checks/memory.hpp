// Memory use of a model, and the message where it is not available.
#pragma once

#include <cstdint>
#include <new>
#include <string>

#include "base/error.hpp"
#include "base/types.hpp"
#include "deck/deck.hpp"
#include "model/data/share.hpp"

namespace scree {

struct Model;
struct ModelSize;

// Largest memory use of one particle in a run, while a checkpoint is written [B]: state, scratch and a list
// of some ten neighbours, with velocity-Verlet and with HHT (tests/performance/bytes_per_item.py).
constexpr Real kBytesPerExplicitParticle = 960, kBytesPerImplicitParticle = 1140;
// Memory of one contact while it is written to a snapshot, where snapshots have contacts [B]. A particle in a
// dense packing has three contacts with other particles.
constexpr Real kBytesPerLine = 240, kLinesPerParticle = 3;
// Memory of one particle with rotation and contact lines, without the contact history that is stored beside a
// list (history_bytes) [B].
Real bytes_per_particle(const Model& model);
// Memory of one coordinate or constraint of the multibody side, on rank 0: a few vectors and the sparse
// factors [B].
constexpr Real kBytesPerUnknown = 1000;
// Memory of a body's shape on every rank, in a run with 10^6 of them on one body, and of a visual-only shape
// [B].
constexpr Real kBytesPerShape = 1200, kBytesPerDrawnShape = 340;
Real bytes_of_shapes(const ModelSize& size);

// Memory of a mesh's triangle on every rank, while it is prepared and afterwards [B]; measured on spheres and
// refined drums. While snapshots are written, rank 0 has each triangle once for every wall or body with the
// mesh.
constexpr Real kBytesPerTriangle = 560, kBytesPerStoredTriangle = 430, kBytesPerShownTriangle = 120;
// Memory of the dissipation sums of a triangle, where the output asks for them [B]: the sums of the run, of
// its last good state, in the order of snapshots and checkpoints, and as numbers.
constexpr Real kBytesPerWorks = 420;
Real bytes_per_triangle(const Model& model);
// Memory of all meshes, on rank 0 or on another rank [B].
Real bytes_of_meshes(const Model& model, bool is_root);
// Number of triangles in snapshots: a mesh counts once for every wall or body with it.
struct ShownMeshes {
  Real points = 0, triangles = 0;
};
ShownMeshes shown_meshes(const Model& model);

// The part of this memory that the model itself uses on this rank, before a run begins [B].
Real bytes_of_model(const Model& model);

// The sizes on which the memory use of a model depends. links: joints, drivers and force elements; shapes: of
// all bodies; drawn_shapes: the visual-only ones, counted separately.
struct ModelSize {
  std::int64_t particles = 0, bodies = 0, links = 0, shapes = 0, drawn_shapes = 0;
};

// From the deck, before anything is built; without particles, whose files may have to be read.
ModelSize bodies_and_joints(const DeckTable& deck);
ModelSize size_of(const Model& model);

// "1 body", "3 bodies".
std::string counted(std::int64_t count, const std::string& one, const std::string& many);

// Estimates of the memory that building the model needs and keeps [B]: for the bodies on this rank, and for
// particles. own: particles of this rank; placed: particles that a random group inserts or avoids, on every
// rank.
Real bytes_to_build_bodies(const ModelSize& size, int rank);
Real bytes_to_build_particles(std::int64_t own, std::int64_t placed);

// Throws InputError, on all ranks, where one rank, or the ranks of a host together, need more memory than is
// free. bytes: of this rank. task: "building the model". Collective.
void check_memory(const ModelSize& size, Real bytes, const std::string& task, const Share& share);

// The memory use of a model, with advice. finding: details of the failure, may be empty.
std::string memory_trouble(const ModelSize& size, int ranks, const std::string& finding = "");

// Runs an action for a model of this size, which the action may set. Throws InputError where it runs out of
// memory.
template <class Action>
auto naming_memory(const ModelSize& size, int ranks, const Action& action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    throw InputError(memory_trouble(size, ranks));
  }
}

}  // namespace scree
