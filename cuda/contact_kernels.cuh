// The contact stages on the device for the law of this run, chosen once. All pointers are the device's;
// everything is queued and nothing waits. The CPU's counterpart is src/dem/laws/contact_kernels.hpp.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "dem/contact/contact_items.hpp"
#include "dem/explicit/mixed_rubbing_items.hpp"
#include "dem/implicit/step_items.hpp"
#include "dem/laws/contact_kernels.hpp"
#include "dem/reports/leaver_items.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "device.cuh"
#include "device_list.cuh"
#include "for_each.cuh"
#include "sums.cuh"
#include "warp_rows.cuh"

namespace scree {

using DeviceViews = ContactViews<SlicedRows>;
using PrunedViews = ContactViews<PrunedRows<0>>;

// For a kernel that evaluates so many entries of a row at once, with the rows that the control names.
template <int kAtOnce>
__device__ ContactViews<PrunedRows<kAtOnce>> views_for(const PrunedViews& in, RowUse use, Real margin) {
  const PrunedRows<0>& r = in.rows;
  return with_rows(in, PrunedRows<kAtOnce>{r.rows, r.counts, r.neighbors, use, margin, r.places});
}

// For a warp that shares out the contacts of its rows.
template <class Word, int kWords>
__device__ ContactViews<WarpRows<Word, kWords>> warp_views(const PrunedViews& in, RowUse use, Real margin,
                                                           WarpContacts<Word, kWords>* shared, bool idle) {
  const PrunedRows<0>& r = in.rows;
  return with_rows(
      in, WarpRows<Word, kWords>{{r.rows, r.counts, r.neighbors, use, margin, r.places}, shared, idle});
}
template <class Word, int kWords>
__device__ ContactViews<WarpRows<Word, kWords>> warp_views(const DeviceViews& in,
                                                           WarpContacts<Word, kWords>* shared, bool idle) {
  return with_rows(in, WarpRows<Word, kWords>{{in.rows, nullptr, nullptr, RowUse::all, 0}, shared, idle});
}

// Force, Newton matrix and residual of the particles [first, end).
struct SystemRequest {
  DeviceViews in;
  Index first, end;
  Vec3 gravity;
  NewtonWeights weights;
  StepStart start;
  StepForces forces;
  ContactMatrix matrix;
  StepViews step;
  Vec3* residual;
  Real* stiffening;
  Sym3* inverse_block;
  StepNorms* largest;  // maxima over these particles and those before
};

// The same where contacts rub: forces and torques alone, of the particles [first, end).
struct DeviceRubbingRequest {
  DeviceViews in;
  Index first, end;
  RubbingRequest of;
};

// Progress of a run of explicit steps, kept by the device: kernels that are queued behind the end of the run
// see `stop` and change nothing.
struct VerletControl {
  static constexpr Real kNoRows = kInfinity;
  unsigned
      largest;  // bits of the single that is at least the largest squared displacement of this step [m^2]
  unsigned finished_blocks;
  Real bound;         // displacement of any item since the list was built, at most [m]
  Real half_skin;     // what the list covers [m]
  Real displacement;  // of any particle when the open step was opened, at most [m]
  RowUse rows;        // of the open step
  Real margin;        // of the pruned rows [m]
  Real moved;    // displacement of any particle since they were pruned, at most [m]; kNoRows: there are none
  Index closed;  // steps, since the start of the run
  Index last;    // stop when so many are closed
  Index substeps;  // steps of the particles per step of the bodies
  int parity[2];   // which of the two position and velocity arrays holds the open step
  int outside;     // whether a particle of a step of this run was outside the space
  int stop;
  int alone;       // one rank: the last block closes the step. Several do so after the ranks have shared:
  Real shared[2];  // the largest squared displacement of the step [m^2], and outside
  // What was found when step `closed` was closed and the next opened, for the last steps: a host that looks
  // while the next step runs sees it unchanged.
  struct Closed {
    bool expired;  // the list does not cover the open step
    bool leaves;   // the open step ends a step of the bodies, and a particle is outside
  };
  static constexpr int kClosedSteps = 4;
  Closed closed_steps[kClosedSteps];

  // Books the displacement with which the open step was opened.
  SCREE_HD void move(Real largest) {
    displacement = largest;
    bound += largest, moved += largest;
    choose_rows();
  }
  SCREE_HD void choose_rows() {
    constexpr Real kPrunedSteps = 32;           // that pruned rows should last
    constexpr Real kLeastShare = Real(1) / 32;  // of the skin: particles nearly at rest start to move, too
    constexpr Real kMostShare = Real(1) / 2;    // of the skin: more would save too little
    if (moved < margin / 2) {
      rows = RowUse::pruned;
      return;
    }
    const Real wanted = kPrunedSteps * displacement, least = kLeastShare * half_skin;
    margin = 2 * (wanted > least ? wanted : least);
    rows = margin < kMostShare * 2 * half_skin ? RowUse::prune : RowUse::all;
    moved = rows == RowUse::prune ? 0 : kNoRows;
  }
  // The step is closed and the next one open.
  SCREE_HD void close(Real largest_squared) {
    move(std::sqrt(largest_squared));
    ++closed;
    parity[0] ^= 1, parity[1] ^= 1;
    judge(outside != 0);
  }
  // Decides whether the run goes on.
  SCREE_HD void judge(bool is_outside) {
    const Closed now{!(bound < half_skin), is_outside && (closed + 1) % substeps == 0};
    closed_steps[closed % kClosedSteps] = now;
    stop = now.expired || now.leaves || closed == last;
  }
};

inline constexpr int kStepBlock = 128;  // threads of a block of an explicit step

// The particles of a launch: one or more blocks of kStepBlock of them.
struct StepRows {
  const Index* blocks;  // their numbers; null: those from first_block on
  Index first_block;
  unsigned launched;     // blocks of the launch
  Index end;             // of all particles
  bool follows;          // the step before, on the same stream: the launch is all of its step
  unsigned step_blocks;  // of all launches of the step; the last one to end closes it

  // Of this thread; from `end` on there is none.
  __device__ Index particle() const {
    const auto launched_block = static_cast<Index>(blockIdx.x);
    const Index block = blocks != nullptr ? blocks[launched_block] : first_block + launched_block;
    return block * kStepBlock + static_cast<Index>(threadIdx.x);
  }
};

// Two arrays each for position, velocity and angular velocity: a step reads one and writes the other.
struct VerletRequest {
  PrunedViews in;  // but for position and velocity
  StepRows rows;
  Index active;  // the others drift outside: the list need not cover their motion
  Vec3 gravity;
  Vec4 *position[2], *velocity[2], *spin[2];  // spin: null where particles do not rotate
  VerletViews state;                          // likewise
  Vec3* force;
  OpenBox box;
  const std::uint8_t* drifting;
  VerletControl* control;
  const Real* first_step;  // HistoryViews::step when the run began; null where nothing is remembered
};

// The same in mixed precision. in.position: the double state, as it was converted.
struct MixedRequest {
  PrunedViews in;
  StepRows rows;
  Index active;
  Vec3 gravity;
  MixedViews state;
  Quaternion* orientation;  // null where particles do not rotate
  QuantumGrid grid;
  Real h;
  OpenBox box;
  const std::uint8_t* drifting;
  VerletControl* control;
  const Real* first_step;
};

// Contacts with placed surfaces at rest, as the steps of a run see them: the device alone knows which arrays
// hold the open one.
struct OpenStepLook {
  const VerletControl* control;
  const Real* first_step;  // as in VerletRequest
  const Vec4 *position[2], *velocity[2], *spin[2];
  HistoryViews history[2];  // they change arrays as the velocities do

  // `in` as the open step has it; false where the run has stopped.
  __device__ bool open(SurfaceViews& in) const {
    if (control->stop) return false;
    const int p = control->parity[0], v = control->parity[1];
    in.position = p == 0 ? position[0] : position[1];
    in.velocity = v == 0 ? velocity[0] : velocity[1];
    in.spin = v == 0 ? spin[0] : spin[1];
    in.history = v == 0 ? history[0] : history[1];
    if (first_step != nullptr) in.history.step = *first_step + control->closed;
    return true;
  }
};

// Entries of one surface on a body, by_surface[first ... end - 1]: what a thread block evaluates and sums up.
struct SurfaceChunk {
  Index surface;  // counts from the first surface on a body
  Index first, end;
};
struct SurfaceChunks {
  const SurfaceChunk* chunks;
  Index count;
};

// Where an implicit step started: particles and surfaces on bodies.
struct SurfaceStart {
  StepStart particles;
  const PlacedSurface* placed;
};

// The same where contacts rub, and where what is found goes.
struct SurfaceRubRequest {
  RubbingStart particles;
  const PlacedSurface* placed;
  SurfaceRub* rubs;  // per entry
};

class DeviceContactKernels {
 public:
  virtual ~DeviceContactKernels() = default;
  virtual int history() const = 0;  // how many numbers the law remembers of a contact
  // Why steps cannot be in mixed precision with this law; empty if they can.
  virtual const char* mixed_trouble() const = 0;
  virtual void forces(Device device, const DeviceViews& in, Vec3 gravity, Index n, Vec3* force,
                      Real* loss_power, Vec3* angular_acceleration) const = 0;
  virtual void system(Device device, const SystemRequest& request) const = 0;
  // Contacts of particles with surfaces on bodies, at an instant and over an implicit step, and what they sum
  // to in each chunk.
  virtual void surface_loads(Device device, const SurfaceViews& in, const SurfaceChunks& chunks,
                             SurfaceLoad* loads, InstantSums* sums) const = 0;
  // The same, for the first n entries by_surface, of whatever step is open when the kernel runs; nothing is
  // summed up.
  virtual void surface_loads_in_run(Device device, const SurfaceViews& in, const OpenStepLook& look, Index n,
                                    SurfaceLoad* loads) const = 0;
  virtual void surface_steps(Device device, const SurfaceViews& in, const SurfaceChunks& chunks,
                             const SurfaceStart& start, SurfaceStep* steps, StepSums* sums) const = 0;
  // Queues the sums over the first n items of WallContactItem; share: as exact_sums() wants it.
  virtual void wall_sums(Device device, const DeviceViews& in, Index n, const WallChoice& choice,
                         ExactSums<kWallTerms>* sums, const std::function<void(Real*)>& share) const = 0;
  virtual void energies(Device device, const DeviceViews& in, Index n, const EnergyOutputs& out) const = 0;
  // An output field that reads contacts.
  virtual void output(Device device, const DeviceViews& in, const OutputRequest& request) const = 0;
  // See ContactKernels; of the particles [first, end).
  virtual void shown_surfaces(Device device, const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                              ShownContact* shown) const = 0;
  virtual void contact_lines(Device device, const DeviceViews& in, Index first, Index end,
                             const LineRequest& request) const = 0;
  // What the contacts of the particles add to the ledger over an accepted implicit step.
  virtual void books(Device device, const DeviceViews& in, Index n, const StepStart& start,
                     Real* contact_loss, Real* integrator_loss) const = 0;
  // The same where contacts rub: see ContactKernels.
  virtual void surface_rubs(Device device, const SurfaceViews& in, const SurfaceChunks& chunks,
                            const SurfaceRubRequest& request, StepSums* sums) const = 0;
  virtual void rubbing_system(Device device, const DeviceRubbingRequest& request) const = 0;
  virtual void rubbing_books(Device device, const DeviceViews& in, Index n, const RubbingStart& start,
                             const RubbingBooksTo& to) const = 0;
  virtual void freeze(Device device, const DeviceViews& in, Index n, const RubbingStart& start,
                      const FrozenLimits& to) const = 0;
  // n particles that leave, and what they leave to all others: see the items.
  virtual void leavers(Device device, const DeviceViews& in, const OpenBox& box, Index n,
                       Leaver* leavers) const = 0;
  virtual void departures(Device device, const DeviceViews& in, Vec3 gravity, const OpenBox& box, Index n,
                          const StartViews& start) const = 0;
  // One explicit step, closed and the next opened; does nothing once the control says stop.
  virtual void verlet_advance(Device device, const VerletRequest& request) const = 0;
  virtual void mixed_advance(Device device, const MixedRequest& request) const = 0;
  // The last step, closed. *largest: the square of the largest acceleration; a NaN if one is not finite.
  virtual void verlet_finish(Device device, const VerletRequest& request, Real* largest) const = 0;
};

// Of one type of law, each compiled in a source file of its own: contact_kernels_*.cu.
template <class Law>
std::unique_ptr<DeviceContactKernels> device_kernels(const std::vector<Law>& laws, int materials);

std::unique_ptr<DeviceContactKernels> make_device_contact_kernels(const Contact& contact);

}  // namespace scree
