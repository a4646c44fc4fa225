// The contact stages on the device for the contact law of the run, which is chosen once at its start. All
// pointers are device pointers; everything is queued on a stream and nothing waits.
// src/dem/laws/contact_kernels.hpp is the CPU's counterpart.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "dem/contact/contact_items.hpp"
#include "dem/explicit/mixed_friction_items.hpp"
#include "dem/implicit/step_items.hpp"
#include "dem/laws/contact_kernels.hpp"
#include "dem/reports/escape_items.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "dependent_launch.cuh"
#include "device.cuh"
#include "device_list.cuh"
#include "for_each.cuh"
#include "sums.cuh"
#include "warp_rows.cuh"

namespace scree {

using DeviceViews = ContactViews<SlicedRows>;
using PrunedViews = ContactViews<PrunedRows<0>>;

// Views for a kernel that evaluates `kAtOnce` entries of a row at once, with the rows that the control block
// names.
template <int kAtOnce>
__device__ ContactViews<PrunedRows<kAtOnce>> views_for(const PrunedViews& in, RowUse use, Real margin) {
  const PrunedRows<0>& r = in.rows;
  return with_rows(in, PrunedRows<kAtOnce>{r.rows, r.counts, r.neighbors, use, margin, r.entry_indices});
}

// Views for a warp whose lanes share the contacts of its rows.
template <class Word, int kWords>
__device__ ContactViews<WarpRows<Word, kWords>> warp_views(const PrunedViews& in, RowUse use, Real margin,
                                                           WarpContacts<Word, kWords>* shared, bool idle) {
  const PrunedRows<0>& r = in.rows;
  return with_rows(in, WarpRows<Word, kWords>{
                           {r.rows, r.counts, r.neighbors, use, margin, r.entry_indices}, shared, idle});
}
template <class Word, int kWords>
__device__ ContactViews<WarpRows<Word, kWords>> warp_views(const DeviceViews& in,
                                                           WarpContacts<Word, kWords>* shared, bool idle) {
  return with_rows(in, WarpRows<Word, kWords>{{in.rows, nullptr, nullptr, RowUse::all, 0}, shared, idle});
}

// Forces and Newton matrix of the particles first ... end - 1 over an implicit step. Where particles do not
// rotate, the same kernel computes residual and norms.
struct DeviceStepSystem {
  DeviceViews in;
  Index first, end;
  StepSystem of;
  ResidualItem residual;
  StepNormsItem norms;
  StepNorms* largest;  // maxima over all particles so far
};

// Progress of a run of explicit steps, kept on the device: kernels that were queued past the end of the run
// read `stop` and change nothing.
struct VerletControl {
  static constexpr Real kNoRows = kInfinity;
  unsigned largest;  // bits of a float >= the largest squared displacement of this step [m^2]
  unsigned finished_blocks;
  Real bound;         // upper bound of the displacement of any item since the list was built [m]
  Real half_skin;     // displacement that the list covers [m]
  Real displacement;  // upper bound for any particle when the open step was opened [m]
  RowUse rows;        // that the open step walks
  Real margin;        // of the pruned rows [m]
  // Upper bound of the displacement of any particle since they were pruned [m]; `kNoRows`: there are none.
  Real moved;
  Index closed;    // closed steps since the start of the run
  Index last;      // the run stops when this many are closed
  Index substeps;  // particle steps per step of the bodies
  int parity[2];   // which of the two position and velocity arrays holds the open step
  int outside;     // whether a particle was outside the domain in a step of this run
  int stop;
  int alone;       // one rank: the last thread block closes the step; several ranks first reduce `shared`
  Real shared[2];  // the largest squared displacement of the step [m^2], and `outside`
  // Result of closing step `closed` and opening the next, for the last few steps: the host can read it
  // unchanged while the next step runs.
  struct Closed {
    bool expired;  // the list does not cover the open step
    bool leaves;   // the open step is the last of a step of the bodies, and a particle is outside
  };
  static constexpr int kClosedSteps = 4;
  Closed closed_steps[kClosedSteps];

  // Adds the displacement with which the open step was opened.
  SCREE_HD void move(Real largest) {
    displacement = largest;
    bound += largest, moved += largest;
    choose_rows();
  }
  SCREE_HD void choose_rows() {
    constexpr Real kMostSteps = 32, kFewestSteps = 6;  // lifetime aimed at for pruned rows [steps]
    constexpr Real kMinFraction = Real(1) / 32;     // of the skin: particles nearly at rest will also start
                                                    // to move
    constexpr Real kMaxFraction = Real(1) / 2;      // of the skin: with more, pruning saves too little
    constexpr Real kFractionOfShort = Real(1) / 5;  // of the skin, if the list lasts fewer than 64 steps
    if (moved < margin / 2) {
      rows = RowUse::pruned;
      return;
    }
    const Real target = kMostSteps * displacement, least = kMinFraction * half_skin,
               wanted = target > least ? target : least;
    margin = 2 * (wanted < kMaxFraction * half_skin ? wanted : kFractionOfShort * half_skin);
    rows = margin > 2 * kFewestSteps * displacement ? RowUse::prune : RowUse::all;
    moved = rows == RowUse::prune ? 0 : kNoRows;
  }
  // Closes the step and opens the next.
  SCREE_HD void close(Real largest_squared) {
    move(std::sqrt(largest_squared));
    ++closed;
    parity[0] ^= 1, parity[1] ^= 1;
    judge(outside != 0);
  }
  // Decides whether the run continues.
  SCREE_HD void judge(bool is_outside) {
    const Closed now{!(bound < half_skin), is_outside && (closed + 1) % substeps == 0};
    closed_steps[closed % kClosedSteps] = now;
    stop = now.expired || now.leaves || closed == last;
  }
};

inline constexpr int kStepBlock = 128;  // threads per block of an explicit step

// The particles of a launch: one or more blocks of `kStepBlock` particles.
struct StepRows {
  const Index* blocks;  // numbers of the blocks; null: consecutive from first_block on
  Index first_block;
  unsigned launched;     // number of blocks of the launch
  Index end;             // number of all particles
  bool follows;          // the previous step on the same stream: this launch is the whole step
  unsigned step_blocks;  // over all launches of the step; the last one to end closes the step

  // The particle of this thread; there is none from `end` on.
  __device__ Index particle() const {
    const auto launched_block = static_cast<Index>(blockIdx.x);
    const Index block = blocks != nullptr ? blocks[launched_block] : first_block + launched_block;
    return block * kStepBlock + static_cast<Index>(threadIdx.x);
  }
};

// Position, velocity and angular velocity have two arrays each: a step reads one and writes the other.
struct VerletRequest {
  PrunedViews in;  // all but position and velocity
  StepRows rows;
  Index active;  // number of particles that the list covers; the others are outside, drifting
  Vec3 gravity;
  Vec4 *position[2], *velocity[2], *spin[2];  // spin: null where particles do not rotate
  VerletViews state;                          // also null where particles do not rotate
  Vec3* force;
  OpenBox box;
  const std::uint8_t* drifting;
  VerletControl* control;
  const Real* first_step;  // `HistoryViews::step` when the run began; null where contacts have no history
};

// The same in mixed precision. in.position: the double state from which the mixed one was converted.
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
  Real *rolling_loss, *twisting_loss;  // null where contacts do not resist rolling
};

// Poses of surfaces with prescribed motion at the ends of the next steps of a run. The rows are a ring: a
// step has the row of the number of steps closed before it.
struct PosesInRun {
  const SurfacePose* placed = nullptr;   // [rows][surfaces]; null: the surfaces are static
  const SurfaceFrame* frames = nullptr;  // [rows][frame_count]
  Index surfaces = 0, frame_count = 0, rows = 1;
  Index* opened = nullptr;  // row of the step whose contacts were evaluated last; -1: the run had stopped

  // Points `in` at the row of the open step. Kernels beside those that close the step read *opened.
  __device__ void open(SurfaceViews& in, const VerletControl& control) const {
    if (placed == nullptr) return;
    const Index row = control.stop ? -1 : control.closed % rows;
    if (blockIdx.x == 0 && threadIdx.x == 0) *opened = row;
    if (row < 0) return;
    in.placed = placed + row * surfaces, in.frames = frames + row * frame_count;
  }
};

// State of the open step for contacts with surfaces in a run: only the device knows which arrays hold it.
struct OpenStepQuery {
  const VerletControl* control;
  const Real* first_step;  // as in VerletRequest
  const Vec4 *position[2], *velocity[2], *spin[2];
  HistoryViews history[2];  // the double-buffered history, which switches with the velocities
  PosesInRun poses;

  // Points `in` at the open step's arrays; false where the run has stopped.
  __device__ bool open(SurfaceViews& in) const {
    poses.open(in, *control);
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

// Entries of one surface on a body, by_surface[first ... end - 1], which one thread block evaluates or sums;
// at most kChunkEntries.
inline constexpr int kChunkEntries = 128;
struct SurfaceChunk {
  Index surface;  // number among the surfaces on bodies
  Index first, end;
};
struct SurfaceChunks {
  const SurfaceChunk* chunks;
  Index count;
};

// The same for loads at an instant or over an explicit step, which one warp evaluates, at most one entry per
// lane: a step waits for them, and each takes long. first_part, parts: all chunks of the surface.
inline constexpr int kLoadLanes = 32;
struct LoadChunk {
  SurfaceChunk of;
  Index first_part, parts;
};
struct LoadChunks {
  const LoadChunk* chunks;
  Index count;
};
// A copy of the control block for the host, which kernels make; from: null for none.
struct ControlReport {
  const VerletControl* from = nullptr;
  VerletControl* to = nullptr;  // in the memory of the host
};
// Where the sums of loads are written.
struct LoadSumOutputs {
  InstantSums* of_chunks;  // scratch
  unsigned* finished;      // per surface: number of its chunks that are summed
  // In the memory of the host, per surface: its sums, and then the number of this evaluation.
  InstantSums* of_surfaces;
  unsigned* written_by;
  unsigned evaluation;
  ControlReport report;
};

// State at the start of an implicit step: particles and surfaces on bodies.
struct SurfaceStart {
  FrictionStart particles;
  const SurfacePose* placed;
};

class DeviceContactKernels {
 public:
  virtual ~DeviceContactKernels() = default;
  virtual LawTraits traits() const = 0;
  // Applies the item of the request to n particles.
  virtual void run(Device device, const DeviceViews& in, Index n, const ContactRequest& request) const = 0;
  // Contacts of particles with surfaces on bodies at an instant or over an explicit step, and their sums over
  // each surface that has chunks.
  virtual void surface_loads(Device device, Follows follows, const SurfaceViews& in, const LoadChunks& chunks,
                             SurfaceLoad* loads, const LoadSumOutputs& sums) const = 0;
  // At an instant, for the first n entries by_surface, of the step that is open when the kernel runs; without
  // sums.
  virtual void surface_loads_in_run(Device device, Follows follows, const SurfaceViews& in,
                                    const OpenStepQuery& query, Index n, SurfaceLoad* loads) const = 0;
  // Over an implicit step, and their sums over each chunk.
  virtual void surface_steps(Device device, const SurfaceViews& in, const SurfaceChunks& chunks,
                             const SurfaceStart& start, const SurfaceStepsTo& to, StepSums* sums) const = 0;
  // Queues the sums of `WallContactItem` over the first n particles; share: the reduction over the ranks that
  // `exact_sums` calls.
  virtual void wall_sums(Device device, const DeviceViews& in, Index n, const WallChoice& choice,
                         ExactSums<kWallTerms>* sums, const std::function<void(Real*)>& share) const = 0;
  // As in `ContactKernels`.
  virtual void shown_surfaces(Device device, const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                              ShownContact* shown) const = 0;
  // Forces and Newton matrix of an implicit step.
  virtual void system(Device device, const DeviceStepSystem& request) const = 0;
  // Closes one explicit step and opens the next; does nothing once the control block says stop.
  virtual void verlet_advance(Device device, const VerletRequest& request) const = 0;
  virtual void mixed_advance(Device device, const MixedRequest& request) const = 0;
  // Closes the last step. *largest: square of the largest acceleration; NaN if any is not finite.
  virtual void verlet_finish(Device device, const VerletRequest& request, Real* largest) const = 0;
};

// Kernels of one type of law. Each type is compiled in a source file of its own, which is generated from
// law.cu.in, because compilation takes long.
template <class Law>
std::unique_ptr<DeviceContactKernels> device_kernels(const std::vector<Law>& laws, int materials);

std::unique_ptr<DeviceContactKernels> make_device_contact_kernels(const Contact& contact);

}  // namespace scree
