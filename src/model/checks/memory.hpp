// What a model takes, and the message where there is not so much.
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

// What one particle of a run takes in memory at the most, while a checkpoint is written [B]: state, scratch
// and a list of some ten neighbours, with velocity-Verlet and with HHT (tests/performance/bytes_per_item.py).
constexpr Real kBytesPerExplicitParticle = 960, kBytesPerImplicitParticle = 1140;
// A contact on its way into a snapshot, where these show contacts; a particle of a dense packing has three
// with others [B].
constexpr Real kBytesPerLine = 240, kLinesPerParticle = 3;
// With its rotation and the lines of its contacts, but for what these remember beside a list
// (bytes_remembered).
Real bytes_per_particle(const Model& model);
// The same of one coordinate or constraint of the multibody side, on rank 0: a few vectors and the sparse
// factors [B].
constexpr Real kBytesPerUnknown = 1000;
// A shape of a body, on every rank: of a run with 10^6 of them on one body; one for pictures alone [B].
constexpr Real kBytesPerShape = 1200, kBytesPerDrawnShape = 340;
Real bytes_of_shapes(const ModelSize& size);

// A triangle of a mesh on every rank: while it is prepared, and what it keeps [B]; measured on spheres and
// refined drums. Each time that a wall or a body has it, snapshots show it: on rank 0, while they are
// written.
constexpr Real kBytesPerTriangle = 560, kBytesPerKeptTriangle = 430, kBytesPerShownTriangle = 120;
// What contacts lose at it, where the output asks for it: the sums of a run, of its last good state, and in
// the order of snapshots and checkpoints, those as numbers, too [B].
constexpr Real kBytesPerWorks = 420;
Real bytes_per_triangle(const Model& model);
// Of all meshes, on rank 0 or on another one [B].
Real bytes_of_meshes(const Model& model, bool is_root);
// Of all that shows in snapshots: a mesh counts as often as walls and bodies have it.
struct ShownMeshes {
  Real points = 0, triangles = 0;
};
ShownMeshes shown_meshes(const Model& model);

// What the model itself is of all this on this rank: there before a run begins [B].
Real bytes_of_model(const Model& model);

// What the memory of a model depends on. Links: joints, drivers and force elements; shapes: of all bodies;
// drawn_shapes: those for pictures alone, beside the others.
struct ModelSize {
  std::int64_t particles = 0, bodies = 0, links = 0, shapes = 0, drawn_shapes = 0;
};

// From the deck alone, before anything is built; without the particles, whose files may have to be looked
// through.
ModelSize bodies_and_links(const DeckTable& deck);
ModelSize size_of(const Model& model);

// "1 body", "3 bodies".
std::string counted(std::int64_t count, const std::string& one, const std::string& many);

// What building the model takes on the way and keeps [B], estimated: of the bodies on this rank, and of
// particles. own: those of this rank; placed: those that a random group places or keeps clear of, which every
// rank does for itself.
Real bytes_to_build_bodies(const ModelSize& size, int rank);
Real bytes_to_build_particles(std::int64_t own, std::int64_t placed);

// Throws InputError, on all ranks, where one of them, or those of a host together, need more than is free
// there. bytes: of this rank. task: "building the model". Collective.
void check_memory(const ModelSize& size, Real bytes, const std::string& task, const Share& share);

// What a model takes and what to do; finding: what is known of the trouble, may be empty.
std::string memory_trouble(const ModelSize& size, int ranks, const std::string& finding = "");

// Runs an action on behalf of a model of this size, which may become known on the way. Throws InputError
// where it runs out of memory.
template <class Action>
auto naming_memory(const ModelSize& size, int ranks, const Action& action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    throw InputError(memory_trouble(size, ranks));
  }
}

}  // namespace scree
