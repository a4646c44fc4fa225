// Reports of a backend on the current state of its particles: sums and output values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/host/host_surfaces.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/output_fields.hpp"
#include "model/data/history_region.hpp"

namespace scree {

// Rotational part of the energies of a ParticleLedger; zero where particles do not rotate [J].
struct RotationEnergies {
  Real kinetic = 0;                                // rotational kinetic energy
  Real friction_springs = 0, rolling_springs = 0;  // parts of contact_elastic, see `SpringEnergies`
  TangentialLosses losses{};                       // parts of contact_loss

  friend bool operator==(const RotationEnergies&, const RotationEnergies&) = default;
};

// Energies of the particles inside the domain [J]; integrator_loss includes that of bodies' contacts.
struct InsideEnergies {
  Real kinetic = 0, gravitational = 0, integrator_loss = 0;
};

// Sums over all particles, independent of their order.
struct ParticleLedger {
  Real kinetic = 0, gravitational = 0, contact_elastic = 0;  // [J]
  Real contact_loss = 0, integrator_loss = 0;                // since t = 0 [J]
  InsideEnergies inside;                                     // equal bit for bit to the sums above without
                                                             // escaped particles
  Vec3 momentum;                                             // [kg m/s]
  Vec3 angular_momentum;                                     // about the origin, with spins [kg m^2/s]
  RotationEnergies rotation;
  Real cohesion = 0;          // part of contact_elastic, with adhesion: ContactEnergy [J]
  std::int64_t contacts = 0;  // contacts, with walls and body shapes included
  std::int64_t drifting = 0;  // escaped particles in ballistic motion
};

// Ledger from the sums of LedgerItem over the particles, indexed by LedgerTerm, and the contacts of bodies.
ParticleLedger make_particle_ledger(const Real* sums, const HostSurfaces& bodies);
// Rotational energies from the sums of RotationItem, indexed by RotationTerm, and the contacts of bodies.
RotationEnergies make_rotation_energies(const Real* sums, const HostSurfaces& bodies);

// One entry per particle of this rank, any order.
struct ParticleOutput {
  std::vector<GlobalId> global_id;
  std::vector<Vec3> position;        // inside the periodic box [m]
  std::vector<OutputValues> fields;  // of computed_fields()
};

// Contacts of this rank's particles; those with other particles on the rank of the first one only.
struct ContactLines {
  std::vector<GlobalId> global_id;   // of the particles, any order
  std::vector<std::int64_t> counts;  // lines of each
  std::vector<ContactLine> lines;    // in the order of global_id; those of a particle in the order of its row
  // Contacts of bodies' shapes with each other and with surfaces, ordered by the number of the first; first
  // is a surface_id(). On rank 0.
  std::vector<ContactLine> of_bodies;
};

// A particle whose motion is recorded in the history.
struct TracedParticle {
  GlobalId global_id;
  Vec3 position, velocity;     // position inside the periodic box [m], [m/s]
  Vec3 angular_velocity = {};  // along the global axes [rad/s]; 0 where particles do not rotate
};

// All functions but output() and traced() are collective (see Backend).
class Reports {
 public:
  // While an object exists, all reports refer to one instant, for which contacts with bodies are evaluated
  // once: nothing may move, and no list may be built. Nested objects refer to the same instant.
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
  // ParticleLedger::inside.kinetic, bit for bit, at less cost.
  virtual Real inside_kinetic() { return ledger(0).inside.kinetic; }
  // Starts the copy of the current particles for output(), independent of later steps.
  virtual void start_output() = 0;
  virtual ParticleOutput output() = 0;
  virtual ShapePack pack_shapes() = 0;       // complete on rank 0
  virtual ContactLines contact_lines() = 0;  // at the current positions
  // Sums over the particles inside the domain whose centres are in the region.
  virtual RegionSums in_region(const RegionBounds& region) = 0;
  // The particles among `requested` that this rank owns, in any order.
  virtual std::vector<TracedParticle> traced(std::span<const GlobalId> requested) = 0;
  // Contact sums of each parent (bodies, then placed walls), and of these static planes (indices into
  // Model::walls). Complete on rank 0.
  virtual std::vector<ContactSum> parent_contacts() = 0;
  // Contact sums of each surface of SurfaceSet, with torques about its parent's centre.
  virtual std::vector<ContactSum> surface_contacts() = 0;
  virtual std::vector<ContactSum> wall_contacts(std::span<const int> walls) = 0;
  // Loads of the contacts on the triangles of meshes. Complete on rank 0.
  virtual std::vector<TriangleLoad> triangle_loads() = 0;

 protected:
  // Called before contacts with bodies are read.
  void need_loads() {
    if (!loads_found_) find_loads();
    loads_found_ = instants_ > 0;
  }

 private:
  // Evaluates the contacts with bodies at the current positions.
  virtual void find_loads() = 0;

  int instants_ = 0;
  bool loads_found_ = false;  // for the current Instant
};

}  // namespace scree
