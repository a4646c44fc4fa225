// The backend of one GPU: the paper's GMAP. The schedule of src/dem/cpu_backend.hpp as kernels; arithmetic
// stays in src/physics, items in src/dem.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cell_sort.cuh"
#include "contact_kernels.cuh"
#include "dem/backend.hpp"
#include "dem/ledger_items.hpp"
#include "dem/line_search.hpp"
#include "device_halo.cuh"
#include "device_list.cuh"
#include "pack_items.cuh"
#include "particle_arrays.cuh"
#include "step_graph.cuh"
#include "sums.cuh"

namespace scree {

// Progress of a linear solve: written by the last block of each product.
struct SolverControl {
  Real tolerance;  // on the largest |residual| [N]
  Real largest;    // squared, of this product
  unsigned finished_blocks;
  int products;
  int stop;
  int alone;  // the last block decides; else the ranks do, together, after the product
};

class CudaBackend : public Backend, public RankParticles, public RankList, public Reports {
 public:
  CudaBackend(const Model& model, const Ranks& ranks);
  ~CudaBackend() override;
  std::string description() const override;
  RankParticles& particles() override { return *this; }
  RankList& list() override { return *this; }
  Reports& reports() override { return *this; }
  std::unique_ptr<ImplicitStep> open_step(Real h) override;
  std::unique_ptr<ExplicitRun> start_run(Real h) override;

  void load(const std::vector<Particle>& records, const ShapeLosses& shapes) override;
  std::vector<Particle> records() override;
  ShapeLosses shape_losses() const override { return side_.losses(); }

  void place_bodies(std::span<const BodyMotion> motion) override;
  Real displacement() override;
  void build(Real skin, StageTimers& timers) override;
  std::int64_t entries() const override { return list_.entries(); }
  std::int64_t builds() const override { return list_builds_; }
  LoadBalance balance() const override { return balance_; }
  void initial_forces() override;

  void begin_step(Real h);
  void rollback();
  Real step_displacement();
  ParticleNorms contact_force();
  GlobalId worst_particle();
  void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end);
  void reduce_wrench(std::vector<BodyWrench>& end) override;
  ParticleCorrection particle_correct();
  void shorten_correction();
  Real error();
  void accept();

  void verlet_start(Real h);
  StepsTaken verlet_run(Real h, Index most, bool keep_open, StageTimers& timers);
  void shape_contacts();

  std::vector<Leaver> outside() override;
  void take_out(const std::vector<Leaver>& leavers) override;
  ParticleLedger ledger(Real verlet_step) override;
  void start_pack() override;
  ParticlePack pack_particles() override;
  ShapePack pack_shapes() override;
  std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) override;
  std::vector<ContactSum> body_contacts() override;
  std::vector<ContactSum> wall_contacts(std::span<const int> walls) override;
  bool computes_asynchronously() const override { return true; }
  bool is_mixed() const override { return mixed_; }

 private:
  // Small results that the device writes and the host reads.
  struct Results {
    StepNorms norms;
    Real displacement, largest;
    ExactSums<1> slope;
    ExactSums<kLedgerTerms> ledger;
    // All blocks of a step add to its first members and read the others. Here a line of the cache ends within
    // it; where it stood in one line, an explicit step of 1e6 particles took 4 % (double) and 10 % (mixed)
    // longer on an H200.
    VerletControl control;
    long long worst_id;
    Index index;
    Index leavers;
    Index interior, active,
        staying;  // particles in the interior, in the search, and on this rank from now on
    ExactSums<kWallTerms> wall;
  };
  Device device() const { return {stream_}; }
  // Copies one member of the results to the host, once what is queued is done.
  template <class T>
  const T& fetch(T Results::*member) const;
  template <class T>
  T* result(T Results::*member) const {
    return &(results_.data()->*member);
  }

  DeviceViews views() const { return views(now_.position.data(), now_.velocity.data()); }
  DeviceViews views(const Vec4* position, const Vec4* velocity) const;
  StepViews step_views();
  StepForces step_forces();
  StepStart step_start() const;
  ContactMatrix matrix();
  Index shape_items() const { return layout_.items - layout_.first_shape; }

  // Sums of terms over the particles of all ranks: queued, and complete once the device's part is on the
  // host.
  template <int N, class Item>
  void queue_sums(const Item& item, ExactSums<N> Results::*sums) const;
  template <int N>
  std::array<Real, N> totals(const ExactSums<N>& sums) const;
  // The smallest of the ids that kernels have put into worst_id on any rank.
  long long smallest_id() const;

  // Parts of build_list, in their order.
  void wrap_positions();
  void migrate();
  void decompose();
  std::vector<Particle> pack_migrants(Index* leaving, Index count);
  void add_migrants(const std::vector<Particle>& arriving);
  void sort_cells(Real skin, std::int64_t particles);
  void reorder(const Index* order, Index n);
  void find_ghosts(Real width);
  void name_ghosts();
  void lay_out_items(Real skin);
  void index_others();
  void search(Real skin);
  void find_rows(Real skin);
  void measure_balance();
  void size_step_arrays();

  void refresh_ghosts(Vec4* position, Vec4* velocity) {
    halo_.update_motion(device(), position, velocity, owned_);
  }
  // What is queued on the stream of the halo from now on comes after the rows queued so far, and the reverse.
  // One rank alone does not use that stream.
  void halo_after_rows() {
    if (!ranks_.alone()) rows_done_.record(stream_), rows_done_.hold(halo_stream_);
  }
  void rows_after_halo() {
    if (!ranks_.alone()) halo_done_.record(halo_stream_), halo_done_.hold(stream_);
  }
  template <class QueueGhosts, class QueueRows>
  void queue_beside_halo(const QueueGhosts& queue_ghosts, const QueueRows& queue_rows, HaloClock* clock);
  void put_shapes(ParticleArrays& arrays);
  const Vec4* stage_shapes();
  void find_shape_contacts();
  void fetch_shape_contacts(ContactSpan span, cudaStream_t stream);
  void report_not_finite(const Vec3* force) const;
  void take_contacts_out();

  // Parts of the implicit step.
  CorrectItem correct_item(Real share);
  void subtract_shape_steps(SubtractMatrixItem<SlicedRows> matrix);
  int solve(const SubtractMatrixItem<SlicedRows>& matrix, Real tolerance);

  // Parts of an explicit run.
  PrunedViews pruned_views(const Vec4* position);
  StepRows step_rows(Index first, Index end) const;
  VerletRequest verlet_request(Real h);
  void settle();
  static constexpr Index kEndless = std::numeric_limits<Index>::max();
  void resume_control(Index last = kEndless);
  const VerletControl& wait_for_control();
  Index steps_ahead(const VerletControl& control) const;
  void queue_steps(Real h, Index steps);
  template <class QueueGhosts, class QueueRows>
  void queue_in_turn(const std::string& key, Index steps, const QueueGhosts& queue_ghosts,
                     const QueueRows& queue_rows);
  MixedViews mixed_views();
  void convert_to_mixed(Real h);
  void convert_from_mixed();
  void finish(Real h);
  bool renew_list(StageTimers& timers);
  StepsTaken run_alone(Real h, Index most, bool keep_open, StageTimers& timers);
  StepsTaken run_with_shapes(Real h, Index most, bool keep_open, StageTimers& timers);
  bool step_with_shapes(Real h, bool keep_open, StageTimers& timers);
  bool shapes_covered() const;
  void queue_shape_contacts();

  const Model& model_;
  Ranks ranks_;
  Subdomain subdomain_;
  ShapeSide side_;
  NeighborBuilder builder_;  // its grid and reach; the search is the device's
  HhtCoefficients hht_;
  // Everything that follows the particles; contacts of shapes, and the halo, beside an explicit step; output.
  mutable Stream stream_, shape_stream_{Priority::urgent}, halo_stream_{Priority::urgent}, copy_stream_;

  std::unique_ptr<DeviceContactKernels> kernels_;
  DeviceArray<WallPlane> planes_;

  // `now_` holds the state. `other_` is what sorting writes, the start of an open implicit step, or what the
  // open explicit step reads or writes.
  mutable ParticleArrays now_;
  ParticleArrays other_;
  Index owned_ = 0;
  bool migrating_ = false;  // some are on their way between ranks
  ItemLayout layout_;       // without its list of ghosts
  Decomposition decomposition_;
  DeviceArray<DomainCut> cuts_;
  LoadBalance balance_;
  DeviceArray<Index> row_length_;  // of the particles in the last list, with several ranks
  Index interior_ = 0;  // the first so many particles, whole blocks of them, meet no ghosts and are none
  mutable DeviceHalo halo_;
  HaloClock halo_clock_;
  DeviceArray<Index> other_items_;
  mutable DeviceArray<unsigned char> space_;  // of library calls
  CellSort particle_sort_, other_sort_;
  BrickGrid grid_;
  DeviceList list_;
  Real list_skin_ = 0;
  DeviceArray<Vec4> list_position_;  // of all items when the list was built
  DeviceArray<Index> shape_body_, connected_offsets_, connected_;
  DeviceArray<Vec4> shape_places_;  // positions, then velocities, where they are not those of all items
  DeviceArray<Vec3> shape_step_;
  PinnedArray<Vec4> h_shape_places_;
  std::vector<Vec4> h_list_shapes_;  // positions of the shapes when the list was built
  Event places_copied_, step_queued_;
  Event rows_done_, halo_done_;
  PinnedArray<ShapeContact> h_shape_contacts_;  // written by the device: few, and awaited
  PinnedArray<ContactBooks> h_shape_books_;     // likewise
  bool layout_changed_ = true;  // particles left since the list was built, or it is not finished
  std::int64_t list_builds_ = 0;

  mutable DeviceArray<Results> results_;
  mutable PinnedArray<Results> h_results_;
  mutable DeviceArray<Leaver> leavers_;

  // Workspace of the implicit step.
  Real h_ = 0;
  bool in_implicit_step_ = false;
  bool ghosts_stale_ = false;  // the next contact_force refreshes them
  DeviceArray<Vec3> step_force_, end_force_, residual_, right_hand_side_, correction_;
  DeviceArray<Real> force_magnitude_, stiffening_;
  DeviceArray<Index> matrix_count_;
  DeviceArray<ContactEntry> matrix_entries_;
  DeviceArray<Sym3> matrix_diagonal_, inverse_block_;
  DeviceArray<Vec4> direction_[2];
  DeviceArray<SolverControl> solver_;
  PinnedArray<SolverControl> h_solver_;
  Real largest_stiffening_ = 0, force_scale_ = 0;
  Real right_hand_side_norm_ = 0;
  LineSearch line_search_;  // along correction_

  // Explicit run.
  bool in_run_ = false;     // whether a step is open
  int parity_[2] = {0, 0};  // of the open step's position and velocity: 0 in now_, 1 in other_
  Real bound_ = 0;          // displacement of any item since the list was built, at most [m]
  bool new_list_ = false;   // built since the control was told
  // Where the particles as the last step left them are, with the velocities that the law saw: in the state
  // itself, or where a step closed by opening the next, or closed alone, has left them.
  enum class Level { state, opened, finished } level_ = Level::state;
  Index closed_ = 0;  // with bodies: steps since verlet_start
  StepGraph graph_;
  bool mixed_;             // explicit runs are in mixed precision
  bool in_mixed_ = false;  // where the open step is: in the arrays below, or in now_ and other_
  Real mixed_h_ = 0;       // [s]
  Index mixed_start_ = 0;  // steps closed when the open step was brought there
  QuantumGrid quanta_;
  DeviceArray<MixedPlace> mixed_place_[2];
  DeviceArray<MixedMotion> mixed_motion_[2];
  DeviceArray<MixedFraction> mixed_fraction_;
  DeviceArray<MixedRest> mixed_rest_;

  // Output.
  RecordItem record_item(Index first) const;
  mutable DeviceArray<Particle> records_;  // on their way to the host
  mutable DeviceArray<GlobalId> traced_ids_;
  mutable DeviceArray<TracedParticle> traced_;
  struct PackArrays;
  std::unique_ptr<PackArrays> pack_;
};

}  // namespace scree
