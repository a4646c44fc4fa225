// Particles of one rank: their state for checkpoints, and escaped particles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dem/history/packed_history.hpp"
#include "dem/host/host_surfaces.hpp"
#include "dem/particles/particle_fields.hpp"
#include "dem/reports/escape_items.hpp"
#include "dem/search/candidate_grid.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

// All functions are collective (see Backend) except load_contacts(), records(), contacts() and those of
// shapes and works.
class RankParticles {
 public:
  virtual ~RankParticles() = default;

  // State of the particles for checkpoints. load(): particles of this rank's part of the model, which the
  // first list distributes to their owners; records(): particles owned by this rank. The losses of shapes
  // belong to rank 0.
  virtual void load(const std::vector<Particle>& records, const ShapeLosses& shapes) = 0;
  virtual std::vector<Particle> records() = 0;  // ordered by global id
  // Packed contact history, in the order of the records; empty for laws without history. load_contacts():
  // after load(), before the first list; the history of another law is ignored.
  virtual void load_contacts(const PackedHistory& contacts) = 0;
  virtual PackedHistory contacts() = 0;
  virtual ShapeLosses shape_losses() const = 0;
  // Packed history of the contacts of bodies' shapes, on rank 0.
  virtual void load_shape_contacts(const ShapeContacts& contacts) = 0;
  virtual ShapeContacts shape_contacts() = 0;
  // Work of this rank's contacts at the triangles of meshes: limbs of TriangleWorks, empty if it is not an
  // output. The ranks' values add up; those of a state are loaded on rank 0, after load().
  virtual void load_works(const std::vector<std::int64_t>& words) = 0;
  virtual std::vector<std::int64_t> works() = 0;

  // Initial forces and accelerations of the loaded state, on a list that covers it.
  virtual void initial_forces() = 0;
  // Contact wrenches on the bodies, from initial_forces(). On rank 0; zero elsewhere.
  virtual void reduce_wrench(std::vector<BodyWrench>& wrench) = 0;

  // Whether each sphere of the grid overlaps a particle that has not escaped: 1 or 0 per sphere, on every
  // rank.
  virtual std::vector<std::uint8_t> overlapped(const CandidateGrid& candidates) = 0;
  // Adds particles between steps, after the first list. born: equal on every rank, inside the periodic box
  // and with their accelerations and forces; each is added on the rank that owns its position. The list must
  // be rebuilt.
  virtual void insert(const std::vector<Particle>& born) = 0;

  // Particles that have escaped from the domain and were not yet removed, and those in the outlets, ordered
  // by global id. outlets: at most kMostOutlets.
  std::vector<EscapedParticle> outside(std::span<const OutletRegion> outlets = {}) {
    return find_leaving(outlets);
  }
  // Removes these particles, found by the last outside(), from the search, and their contacts from the state
  // that the next step starts from: those in outlets are deleted, and escaped ones move ballistically from
  // now on or are deleted, as the deck says. The list must be rebuilt.
  virtual void remove_escaped(const std::vector<EscapedParticle>& escaped_particles) = 0;

 protected:
  virtual std::vector<EscapedParticle> find_leaving(std::span<const OutletRegion> outlets) = 0;
};

}  // namespace scree
