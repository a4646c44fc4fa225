// The seam between the coupled step and the machine that computes the particles: the CPU, or one GPU.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/log.hpp"
#include "base/timer.hpp"
#include "base/types.hpp"
#include "dem/leaver_items.hpp"
#include "dem/particle_store.hpp"
#include "dem/shape_side.hpp"
#include "model/body_exchange.hpp"
#include "model/model.hpp"
#include "partition/decomposition.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Norms of one Newton iteration of the particles, scaled and dimensionless, maxima over all particles.
struct ParticleNorms {
  Real residual = 0;  // over the largest force on a particle, at the iterate and at the start of the step
  Real correction_bound = 0;  // of the position correction that the residual can still cause, over the radius
  bool overshoot = false;     // the last correction went too far along its direction
};

struct ParticleCorrection {
  Real correction = 0;  // largest position correction over the particle's radius
  int iterations = 0;   // of the linear solve
};

// Sums over all particles; order-independent.
struct ParticleLedger {
  Real kinetic = 0, gravitational = 0, contact_elastic = 0;  // [J]
  Real contact_loss = 0, integrator_loss = 0;                // since t = 0 [J]
  Vec3 momentum;                                             // [kg m/s]
  Vec3 angular_momentum;                                     // about the origin [kg m^2/s]
  std::int64_t contacts = 0;                                 // touching pairs, walls and body shapes included
  std::int64_t drifting = 0;                                 // particles outside that drift on
};

// From the sums of LedgerItem over the particles, indexed by LedgerTerm, and the shapes' shares.
ParticleLedger make_particle_ledger(const Real* sums, const ShapeSide& shapes);

// From the sums of WallContactItem over what touches a wall, indexed by WallTerm.
ContactSum make_wall_contact(const Real* sums);

inline bool is_verlet(const Model& model) {
  return model.integrator.particles == ParticleIntegrator::velocity_verlet;
}

// The particles' substep with velocity-Verlet [s]; 0 for HHT.
inline Real verlet_step(const Model& model) {
  return is_verlet(model) ? model.time.step / model.integrator.substeps : 0;
}

// What stands before and after the id of a particle that wrap_if_sound() refuses.
inline constexpr const char* kUnsoundPosition[] = {
    "stage sort_cells: the position of particle ",
    " is not finite, or it crossed the whole periodic space since the last list"};

// What countable() says of a rank's own particles, and of those with its ghosts.
inline constexpr const char* kTooManyParticles = "stage migrate: more particles";
inline constexpr const char* kTooManyItems = "stage exchange_halo: more particles and ghosts";

// One entry per particle of this rank, any order.
struct ParticlePack {
  std::vector<GlobalId> global_id;
  std::vector<Real> radius;
  std::vector<Vec3> position, velocity, force;  // force: contacts only
  std::vector<int> contacts;
};

// A particle whose motion is recorded.
struct TracedParticle {
  GlobalId global_id;
  Vec3 position, velocity;  // position inside the periodic box [m], [m/s]
};

// How far Backend::verlet_run came.
struct VerletRun {
  Index closed = 0;   // steps
  bool open = false;  // whether the step after the last of them is open
};

// The particles of one rank on their machine. With several ranks, each has a backend, and all functions but
// the simple getters (description, records, shape_losses, list_entries, list_builds, balance, pack_particles,
// traced)
// are collective: every rank calls them in the same order, and what they return is the same on every rank,
// except where a comment says otherwise. So are the errors.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string description() const = 0;

  // State of the particle side: what a checkpoint stores. load: of particles that this rank's part of the
  // model has; the first list brings them to the ranks that own them; records: of those that this rank owns.
  // Shapes' losses are rank 0's.
  virtual void load(const std::vector<Particle>& records, const ShapeLosses& shapes) = 0;
  virtual std::vector<Particle> records() const = 0;  // ordered by global id
  virtual ShapeLosses shape_losses() const = 0;

  // Neighbour list. Displacement: of any item since the list was built, over half the skin that the list
  // covers; past 1 the list has expired.
  virtual void place_bodies(std::span<const BodyMotion> motion) = 0;
  virtual Real list_displacement() = 0;
  virtual void build_list(Real skin, StageTimers& timers) = 0;
  virtual std::int64_t list_entries() const = 0;  // of this rank
  virtual std::int64_t list_builds() const = 0;   // since the backend was made
  virtual LoadBalance balance() const { return {}; }

  // Start: forces and accelerations of the loaded positions and velocities.
  virtual void initial_forces() = 0;

  // Implicit step. begin_step saves the state and predicts; rollback undoes it.
  virtual void begin_step(Real h) = 0;
  virtual void rollback() = 0;
  virtual Real step_displacement() = 0;  // largest of a particle or shape since the step's start [m]
  virtual ParticleNorms contact_force() = 0;
  // The particle with the largest residual in the last contact_force; -1 without particles.
  virtual GlobalId worst_particle() const = 0;
  // Contact wrenches on the bodies: after contact_force, what the implicit step needs, and at its end (equal
  // unless contacts open or close within it); else, where the shapes are. On rank 0; zero elsewhere.
  virtual void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) = 0;
  virtual void reduce_wrench(std::vector<BodyWrench>& end) = 0;
  virtual ParticleCorrection particle_correct() = 0;
  // Takes part of the last correction back, after contact_force has reported an overshoot.
  virtual void shorten_correction() = 0;
  virtual Real error() = 0;  // local position error of the step over the radius
  virtual void accept() = 0;

  // Explicit steps. verlet_start opens the first. verlet_run closes up to `most` and opens the one after
  // each, the last of them only if keep_open; it renews the list where needed. Bodies stay where they were
  // placed, so that with bodies `most` is 1. Every Integrator::substeps from verlet_start a step of the
  // bodies ends: there it stops, closed, if a particle is outside the space.
  virtual void verlet_start(Real h) = 0;
  virtual VerletRun verlet_run(Real h, Index most, bool keep_open, StageTimers& timers) = 0;
  // Contacts of the bodies' shapes, where they are placed now, with the particles as they were when the last
  // step was closed; for reduce_wrench.
  virtual void shape_contacts() = 0;

  // The particles that are outside the space now and not known to drift, ordered by global id.
  virtual std::vector<Leaver> outside() const = 0;
  // Takes them out of the search, and their contacts out of what the next step starts from: they drift from
  // now on or are removed, as the deck says. The list must then be built anew.
  virtual void take_out(const std::vector<Leaver>& leavers) = 0;
  // verlet_step: 0 for HHT, else the substep whose energy shift belongs to the state [s]. Complete on rank 0.
  virtual ParticleLedger ledger(Real verlet_step) = 0;
  // Begins to copy out what pack_particles returns: the particles as they are now, whatever steps follow.
  virtual void start_pack() = 0;
  virtual ParticlePack pack_particles() = 0;
  virtual ShapePack pack_shapes() = 0;  // complete on rank 0
  // Those of these particles that this rank owns, where they are now, in any order.
  virtual std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) const = 0;
  // What touches each body, and each of these walls (indices into Model::walls), where all are now; the
  // bodies' on rank 0.
  virtual std::vector<ContactSum> body_contacts() = 0;
  virtual std::vector<ContactSum> wall_contacts(std::span<const int> walls) = 0;

  // Whether steps go on while the host does something else.
  virtual bool computes_asynchronously() const { return false; }
  // Whether explicit steps get their contact forces in single precision. The step that verlet_run closes
  // without opening another gets them in double even so: where runs end changes bits.
  virtual bool is_mixed() const { return false; }
  // Called by backends that compute asynchronously where they would only wait: from within verlet_run and
  // particle_correct. It must not change the backend.
  void set_idle_work(std::function<void()> work) { idle_work_ = std::move(work); }

 protected:
  std::function<void()> idle_work_;
};

// Both throw SimulationError naming stage and global id on values that are not finite.
std::unique_ptr<Backend> make_cpu_backend(const Model& model, const Ranks& ranks = {});

}  // namespace scree
