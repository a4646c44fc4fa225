// The particles of one rank: what a checkpoint stores of them, and those that leave the space.
#pragma once

#include <cstdint>
#include <vector>

#include "dem/history/kept_contacts.hpp"
#include "dem/host/surface_side.hpp"
#include "dem/particles/particle_fields.hpp"
#include "dem/reports/leaver_items.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

// All functions but load_contacts(), records(), contacts(), those of shapes and those of works are collective
// (see Backend).
class RankParticles {
 public:
  virtual ~RankParticles() = default;

  // State of the particle side: what a checkpoint stores. load: of particles that this rank's part of the
  // model has; the first list brings them to the ranks that own them; records: of those that this rank owns.
  // Shapes' losses are rank 0's.
  virtual void load(const std::vector<Particle>& records, const ShapeLosses& shapes) = 0;
  virtual std::vector<Particle> records() = 0;  // ordered by global id
  // What their contacts remember, in the same order; nothing where the law remembers nothing. After load(),
  // before the first list; what another law has remembered counts for nothing.
  virtual void load_contacts(const KeptContacts& contacts) = 0;
  virtual KeptContacts contacts() = 0;
  virtual ShapeLosses shape_losses() const = 0;
  // The same of the contacts of bodies' shapes, which are rank 0's.
  virtual void load_shape_contacts(const ShapeContacts& contacts) = 0;
  virtual ShapeContacts shape_contacts() = 0;
  // What contacts of this rank's particles have lost at the triangles of meshes: words of TriangleWorks, none
  // where the output asks for none. Those of all ranks add up; a state's are loaded on rank 0, after load().
  virtual void load_works(const std::vector<std::int64_t>& words) = 0;
  virtual std::vector<std::int64_t> works() = 0;

  // Start: forces and accelerations of the loaded positions and velocities, on a list of these.
  virtual void initial_forces() = 0;
  // Contact wrenches on the bodies, from the contacts that were found last: here, by initial_forces. On rank
  // 0; zero elsewhere.
  virtual void reduce_wrench(std::vector<BodyWrench>& wrench) = 0;

  // The particles that are outside the space now and not known to drift, ordered by global id.
  virtual std::vector<Leaver> outside() = 0;
  // Takes them out of the search, and their contacts out of what the next step starts from: they drift from
  // now on or are removed, as the deck says. The list must then be built anew.
  virtual void take_out(const std::vector<Leaver>& leavers) = 0;
};

}  // namespace scree
