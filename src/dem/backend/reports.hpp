// What a backend tells of its particles as they are now: sums, and values for output.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/host/surface_side.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/output_fields.hpp"

namespace scree {

// What of the energies of a ParticleLedger there is where particles rotate; zero elsewhere [J].
struct RotationEnergies {
  Real kinetic = 0;                                // of the rotation
  Real friction_springs = 0, rolling_springs = 0;  // of contact_elastic: SpringEnergies
  RubbingLosses losses{};                          // of contact_loss

  friend bool operator==(const RotationEnergies&, const RotationEnergies&) = default;
};

// Energies of the particles that have not left the space [J]; integrator_loss includes that of bodies'
// contacts.
struct InsideEnergies {
  Real kinetic = 0, gravitational = 0, integrator_loss = 0;
};

// Sums over all particles; order-independent.
struct ParticleLedger {
  Real kinetic = 0, gravitational = 0, contact_elastic = 0;  // [J]
  Real contact_loss = 0, integrator_loss = 0;                // since t = 0 [J]
  InsideEnergies inside;                                     // where none drifts, the same bits
  Vec3 momentum;                                             // [kg m/s]
  Vec3 angular_momentum;                                     // about the origin, with spins [kg m^2/s]
  RotationEnergies rotation;
  Real cohesion = 0;          // of contact_elastic, where contacts attract: ContactEnergy [J]
  std::int64_t contacts = 0;  // touching pairs, walls and body shapes included
  std::int64_t drifting = 0;  // particles outside that drift on
};

// From the sums of LedgerItem over the particles, indexed by LedgerTerm, and what the bodies do to each
// other.
ParticleLedger make_particle_ledger(const Real* sums, const SurfaceSide& bodies);
// The same of RotationItem, indexed by RotationTerm.
RotationEnergies make_rotation_energies(const Real* sums, const SurfaceSide& bodies);

// One entry per particle of this rank, any order.
struct ParticleOutput {
  std::vector<GlobalId> global_id;
  std::vector<Vec3> position;        // inside the periodic box [m]
  std::vector<OutputValues> fields;  // of computed_fields()
};

// The contacts of this rank's particles, those with other particles on the rank of the first one alone.
struct ContactLines {
  std::vector<GlobalId> global_id;   // of the particles, any order
  std::vector<std::int64_t> counts;  // lines of each
  std::vector<ContactLine> lines;    // in that order; those of a particle in the order of its row
  // Of bodies' shapes with each other and with surfaces, in the order of the first ones' numbers; first is a
  // surface_id(). On rank 0.
  std::vector<ContactLine> of_bodies;
};

// A particle whose motion is recorded.
struct TracedParticle {
  GlobalId global_id;
  Vec3 position, velocity;     // position inside the periodic box [m], [m/s]
  Vec3 angular_velocity = {};  // along the global axes [rad/s]; 0 where particles do not rotate
};

// All functions but output() and traced() are collective (see Backend).
class Reports {
 public:
  // While one is there, all reports are of one instant, for which contacts with bodies are found once:
  // nothing moves, and no list is built. One within another is of the same instant.
  class Instant {
   public:
    explicit Instant(Reports& of) : of_(of) { ++of_.instants_; }
    ~Instant() {
      if (--of_.instants_ == 0) of_.loads_found_ = false;
    }
    Instant(const Instant&) = delete;
    Instant& operator=(const Instant&) = delete;

   private:
    Reports& of_;
  };

  Reports() = default;
  Reports(const Reports&) = delete;
  Reports& operator=(const Reports&) = delete;
  virtual ~Reports() = default;

  // verlet_step: 0 for HHT, else the substep whose energy shift belongs to the state [s]. Complete on rank 0.
  virtual ParticleLedger ledger(Real verlet_step) = 0;
  // ParticleLedger::inside.kinetic alone, the same bits, where that takes less.
  virtual Real inside_kinetic() { return ledger(0).inside.kinetic; }
  // Begins to copy out what output() returns: the particles as they are now, whatever steps follow.
  virtual void start_output() = 0;
  virtual ParticleOutput output() = 0;
  virtual ShapePack pack_shapes() = 0;       // complete on rank 0
  virtual ContactLines contact_lines() = 0;  // where all are now
  // Those of these particles that this rank owns, where they are now, in any order.
  virtual std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) = 0;
  // What touches each carrier (bodies, then placed walls), and each of these planes at rest (indices into
  // Model::walls), where all are now. Complete on rank 0.
  virtual std::vector<ContactSum> carrier_contacts() = 0;
  // The same of each surface of SurfaceSet, its torque about its carrier's centre.
  virtual std::vector<ContactSum> surface_contacts() = 0;
  virtual std::vector<ContactSum> wall_contacts(std::span<const int> walls) = 0;
  // What the particles do to the triangles of meshes that they touch, where all are now. Complete on rank 0.
  virtual std::vector<TriangleLoad> triangle_loads() = 0;

 protected:
  // Before contacts with bodies are read.
  void need_loads() {
    if (!loads_found_) find_loads();
    loads_found_ = instants_ > 0;
  }

 private:
  // Contacts with bodies, where all are now.
  virtual void find_loads() = 0;

  int instants_ = 0;
  bool loads_found_ = false;  // in the instant that is there
};

}  // namespace scree
