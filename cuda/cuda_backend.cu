// Particles, items and list of the GPU's backend. The steps are in cuda_implicit.cu and cuda_explicit.cu.
#include "backend_parts.cuh"
#include "base/countable.hpp"
#include "cuda_backend.cuh"
#include "dem/device.hpp"

namespace scree {

CudaBackend::CudaBackend(const Model& model, const Ranks& ranks)
    : model_(model),
      ranks_(ranks),
      subdomain_(model.space),
      side_(model, subdomain_),
      builder_(model, side_.shapes()),
      hht_(hht_coefficients(model.integrator.hht_alpha)),
      halo_(ranks, model.parallel.transport),
      results_(1),
      h_results_(1),
      solver_(1),
      h_solver_(1),
      mixed_(model.integrator.precision == Precision::mixed && side_.shapes().size() == 0),
      pack_(std::make_unique<PackArrays>()) {
  results_.zero(stream_);
  records_.resize_clean(kRecordsAtOnce, stream_);
  kernels_ = make_device_contact_kernels(model.contact);
  planes_.upload(wall_planes(model), stream_);
  std::vector<Index> offsets{0}, connected;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    for (const int other : side_.shapes().rule().kept_apart(static_cast<int>(b))) connected.push_back(other);
    offsets.push_back(static_cast<Index>(connected.size()));
  }
  connected_offsets_.upload(offsets, stream_), connected_.upload(connected, stream_);
}

CudaBackend::~CudaBackend() = default;

namespace {

class CudaStep : public ImplicitStep {
 public:
  CudaStep(CudaBackend& backend, Real h) : backend_(backend), h_(h) {}
  void predict() override { backend_.begin_step(h_); }
  Real step_displacement() override { return backend_.step_displacement(); }
  ParticleNorms contact_force() override { return backend_.contact_force(); }
  GlobalId worst_particle() override { return backend_.worst_particle(); }
  void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) override {
    backend_.reduce_wrench(step, end);
  }
  ParticleCorrection particle_correct() override { return backend_.particle_correct(); }
  void shorten_correction() override { backend_.shorten_correction(); }
  Real error() override { return backend_.error(); }
  void accept() override { backend_.accept(); }
  void undo() override { backend_.rollback(); }

 private:
  CudaBackend& backend_;
  Real h_;
};

class CudaRun : public ExplicitRun {
 public:
  CudaRun(CudaBackend& backend, Real h) : backend_(backend), h_(h) { backend.verlet_start(h); }
  StepsTaken take_steps(Index most, bool keep_open, StageTimers& timers) override {
    return backend_.verlet_run(h_, most, keep_open, timers);
  }
  void shape_contacts() override { backend_.shape_contacts(); }
  void reduce_wrench(std::vector<BodyWrench>& wrench) override { backend_.reduce_wrench(wrench); }

 private:
  CudaBackend& backend_;
  Real h_;
};

}  // namespace

std::unique_ptr<ImplicitStep> CudaBackend::open_step(Real h) { return std::make_unique<CudaStep>(*this, h); }

std::unique_ptr<ExplicitRun> CudaBackend::start_run(Real h) { return std::make_unique<CudaRun>(*this, h); }

std::string CudaBackend::description() const {
  const bool asked = model_.integrator.precision == Precision::mixed;
  const std::string precision = mixed_ ? "mixed" : asked ? "double, because bodies have shapes" : "double";
  const std::string ranks =
      ranks_.alone() ? "" : ", " + std::to_string(ranks_.size()) + " ranks, halo by " + halo_.transport();
  return "cuda (" + device_name() + ", precision " + precision + ranks + ")";
}

DeviceViews CudaBackend::views(const Vec4* position, const Vec4* velocity) const {
  return {position,      velocity,       now_.material.data(), list_.rows(), list_.wall_offsets(),
          list_.walls(), planes_.data(), layout_.first_shape};
}

void CudaBackend::load(const std::vector<Particle>& records, const ShapeLosses& shapes) {
  side_.losses() = ranks_.is_root() ? shapes : ShapeLosses{};
  owned_ = count_on_rank(records.size(), model_.particles.totals);
  now_.grow(records.size(), records.size(), 0, stream_);
  const auto at_once = static_cast<Index>(records_.size());
  for (Index first = 0; first < owned_; first += at_once) {
    const Index n = std::min(at_once, owned_ - first);
    copy_async(records_.data(), records.data() + first, static_cast<std::size_t>(n), stream_);
    for_each(device(), n, ArrivalItem{records_.data(), views_of(now_), first});
  }
  wait_for(stream_);
  layout_changed_ = true;
  // records() must work where no memory is left, and a kernel takes some when it is launched first.
  for_each(device(), std::min<Index>(owned_, 1), record_item(0));
}

RecordItem CudaBackend::record_item(Index first) const {
  return {views_of(now_), first, model_.space.min, subdomain_.period(), records_.data()};
}

std::vector<Particle> CudaBackend::records() {
  if (migrating_) throw DeviceError("particles were on their way between ranks");
  std::vector<Particle> out(static_cast<std::size_t>(owned_));
  const auto at_once = static_cast<Index>(records_.size());
  for (Index first = 0; first < owned_; first += at_once) {
    const Index n = std::min(at_once, owned_ - first);
    for_each(device(), n, record_item(first));
    copy_async(out.data() + first, records_.data(), static_cast<std::size_t>(n), stream_);
  }
  wait_for(stream_);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.global_id < b.global_id; });
  return out;
}

void CudaBackend::place_bodies(std::span<const BodyMotion> motion) {
  side_.set_motion(motion);
  if (layout_changed_) return;
  side_.place(layout_);
  // An explicit run brings the shapes to the arrays of its open step itself.
  if (!in_run_) put_shapes(now_);
}

// Positions and velocities of the shape items, as side_ has placed them, into the arrays of all items.
void CudaBackend::put_shapes(ParticleArrays& arrays) {
  const auto n = static_cast<std::size_t>(shape_items());
  if (n == 0) return;
  const Vec4* places = stage_shapes();
  copy_async(arrays.position.data() + layout_.first_shape, places, n, stream_);
  copy_async(arrays.velocity.data() + layout_.first_shape, places + n, n, stream_);
  places_copied_.record(stream_);
}

// A copy in pinned memory, once the last one is used no longer.
const Vec4* CudaBackend::stage_shapes() {
  places_copied_.wait();
  const auto n = static_cast<std::size_t>(shape_items());
  h_shape_places_.resize(2 * n);
  std::copy(side_.position().begin(), side_.position().end(), h_shape_places_.data());
  std::copy(side_.velocity().begin(), side_.velocity().end(), h_shape_places_.data() + n);
  return h_shape_places_.data();
}

void CudaBackend::find_shape_contacts() {
  if (shape_items() == 0) return;
  const ShapePlaces places{now_.position.data() + layout_.first_shape,
                           now_.velocity.data() + layout_.first_shape};
  kernels_->shapes(device(), views(), places, shape_items(), h_shape_contacts_.data());
  fetch_shape_contacts(ContactSpan::instant, stream_);
}

// Waits for the stream.
void CudaBackend::fetch_shape_contacts(ContactSpan span, cudaStream_t stream) {
  wait_for(stream);
  side_.take_contacts(span, {h_shape_contacts_.data(), static_cast<std::size_t>(shape_items())});
}

void CudaBackend::reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) {
  side_.reduce(layout_, ranks_, step, end);
}

void CudaBackend::reduce_wrench(std::vector<BodyWrench>& end) { side_.reduce(layout_, ranks_, end); }

namespace {

// Wraps a particle into the periodic box. *bad: smallest id of a particle whose position is not sound.
struct WrapItem {
  ParticleViews in;
  Vec3 box_min, period;
  long long* bad;

  __device__ void operator()(Index i) const {
    Vec3 p = xyz(in.position[i]);
    if (!wrap_if_sound(box_min, period, in.drifting[i] != 0, p, in.image[i]))
      atomicMin(bad, static_cast<long long>(id_of(in.row_key[i])));
    in.position[i] = vec4(p, in.position[i].w);
  }
};

// Particles outside the search get the key past the last cell, those that have gone to other ranks the next.
struct CellKeyItem {
  const Vec4* position;
  const std::uint8_t* drifting;
  BrickGrid grid;
  unsigned outside;
  unsigned* keys;

  SCREE_HD void operator()(Index i) const {
    const CellPlace c = grid.cells.place(xyz(position[i]));
    keys[i] = drifting[i] == kGone          ? outside + 1
              : drifting[i] != 0 || c.x < 0 ? outside
                                            : static_cast<unsigned>(grid.key(c.x, c.y, c.z));
  }
};

// What the ghosts need once: their keys, and the fields that are copied.
struct GhostNameItem {
  const Ghost* ghosts;
  FieldArrays<GhostField> fields;
  SCREE_HD void operator()(Index entry) const {
    const Ghost ghost = ghosts[entry];
    for_each_array<kGhostCopies>([&](const auto& copy) { copy.put(entry, copy.field[ghost.source]); },
                                 fields);
    const GhostField<std::int64_t>& key = fields.row_key;
    key.put(entry, row_key(id_of(key.field[ghost.source]), ghost.image));
  }
};

// Shapes that reach no particle of this rank would crowd the edges of its cells: they are left out.
struct OtherKeyItem {
  const Vec4* position;  // of the first item that is no owned particle
  Index ghosts;
  BrickGrid grid;
  unsigned outside;
  unsigned* keys;
  SCREE_HD void operator()(Index k) const {
    const Vec3 p = xyz(position[k]);
    const CellPlace c = grid.cells.place(p);
    keys[k] = c.x < 0 || (k >= ghosts && !grid.cells.reaches(p))
                  ? outside
                  : static_cast<unsigned>(grid.key(c.x, c.y, c.z));
  }
};

struct OtherItem {
  const Index* order;
  Index first;
  Index* out;
  SCREE_HD void operator()(Index k) const { out[k] = first + order[k]; }
};

}  // namespace

void CudaBackend::wrap_positions() {
  require_cuda(cudaMemsetAsync(result(&Results::worst_id), 0x7f, sizeof(long long), stream_),
               "cudaMemsetAsync");
  for_each(device(), owned_,
           WrapItem{views_of(now_), model_.space.min, subdomain_.period(), result(&Results::worst_id)});
  if (const long long bad = smallest_id(); bad < kNoId)
    throw SimulationError(kUnsoundPosition[0] + std::to_string(bad) + kUnsoundPosition[1]);
}

// particles: of all ranks.
void CudaBackend::sort_cells(Real skin, std::int64_t particles) {
  grid_ = make_brick_grid(ranks_.alone()
                              ? builder_.cells(skin, particles)
                              : builder_.cells(skin, particles, decomposition_.box(ranks_.rank(), subdomain_),
                                               owned_ + side_.shapes().size()));
  const auto outside = static_cast<unsigned>(grid_.count());
  for_each(device(), owned_,
           CellKeyItem{now_.position.data(), now_.drifting.data(), grid_, outside,
                       particle_sort_.keys(static_cast<std::size_t>(owned_))});
  particle_sort_.sort(device(), owned_, outside + 1);
  copy_async(&h_results_.data()->interior, particle_sort_.starts() + grid_.cells_of(grid_.interior), 1,
             stream_);
  copy_async(&h_results_.data()->active, particle_sort_.starts() + outside, 1, stream_);
  copy_async(&h_results_.data()->staying, particle_sort_.starts() + outside + 1, 1, stream_);
  wait_for(stream_);
  reorder(particle_sort_.order(), h_results_[0].staying);
  migrating_ = false;
  interior_ = h_results_[0].interior / kStepBlock * kStepBlock;
  layout_.owned = owned_, layout_.active = h_results_[0].active;
}

// Particle i becomes the one that was order[i]; n of them stay.
void CudaBackend::reorder(const Index* order, Index n) {
  const auto size = static_cast<std::size_t>(n);
  other_.grow(std::max(size, now_.position.size()), size, 0, stream_);
  for_each(device(), n, ReorderItem{views_of(now_), views_of(other_), order});
  std::swap(now_, other_);
  owned_ = n;
}

// Lays out all items, makes room for them, and names the ghosts among them.
void CudaBackend::find_ghosts(Real width) {
  halo_.count(device(), HaloPlan(ranks_, decomposition_, subdomain_, width), now_.position.data(),
              layout_.active);
  layout_.shapes_meet = ranks_.is_root();
  ranks_.together([&] {
    layout_.first_shape =
        countable(static_cast<std::size_t>(owned_) + static_cast<std::size_t>(halo_.size()), kTooManyItems);
    side_.lay_out(width, layout_);
    halo_.list(device(), now_.position.data(), layout_.active);
    const auto items = static_cast<std::size_t>(layout_.items), owned = static_cast<std::size_t>(owned_);
    now_.grow(items, owned, owned, stream_), other_.grow(items, owned, 0, stream_);
  });
  name_ghosts();
}

void CudaBackend::name_ghosts() {
  constexpr unsigned kKinds = kNames | kGhostCopies;
  GhostNameItem item{halo_.ghosts(), {}};
  std::vector<HaloMessage> messages;
  for_each_array<kKinds>(
      [&](auto& copy, auto& array) {
        copy = halo_.field(static_cast<int>(messages.size()), array.data(), owned_);
        messages.push_back(copy.message());
      },
      item.fields, now_);
  for_each(device(), halo_.entries(), item);
  halo_.exchange(device(), messages);
}

void CudaBackend::lay_out_items(Real skin) {
  find_ghosts(builder_.cutoff(skin));
  const auto n = static_cast<std::size_t>(shape_items());
  std::vector<int> material, body;
  std::vector<std::int64_t> keys;
  for (Index item = layout_.first_shape; item < layout_.items; ++item) {
    const ShapeItem& shape = side_.shapes().items()[layout_.shape_of(item)];
    material.push_back(shape.material), body.push_back(shape.body);
    keys.push_back(side_.row_key_of(layout_, item));
  }
  if (n > 0) {
    require_cuda(cudaMemcpyAsync(now_.material.data() + layout_.first_shape, material.data(), n * sizeof(int),
                                 cudaMemcpyHostToDevice, stream_),
                 "cudaMemcpyAsync");
    require_cuda(cudaMemcpyAsync(now_.row_key.data() + layout_.first_shape, keys.data(),
                                 n * sizeof(std::int64_t), cudaMemcpyHostToDevice, stream_),
                 "cudaMemcpyAsync");
    shape_body_.upload(body, stream_);
  }
  h_shape_contacts_.resize(n), h_shape_books_.resize(n);
  refresh_ghosts(now_.position.data(), now_.velocity.data());
  side_.place(layout_);
  put_shapes(now_);
}

// Ghosts and shapes by cell.
void CudaBackend::index_others() {
  const Index others = layout_.items - owned_;
  if (others == 0) return;
  const auto outside = static_cast<unsigned>(grid_.count());
  for_each(device(), others,
           OtherKeyItem{now_.position.data() + owned_, halo_.size(), grid_, outside,
                        other_sort_.keys(static_cast<std::size_t>(others))});
  other_sort_.sort(device(), others, outside);
  other_items_.resize(static_cast<std::size_t>(others));
  for_each(device(), others, OtherItem{other_sort_.order(), owned_, other_items_.data()});
}

void CudaBackend::search(Real skin) {
  ListInput in;
  in.position = now_.position.data(), in.row_key = now_.row_key.data();
  in.grid = grid_;
  in.particle_starts = particle_sort_.starts();
  const bool others = layout_.items > owned_;
  in.other_starts = others ? other_sort_.starts() : nullptr;
  in.other_items = others ? other_items_.data() : nullptr;
  in.bodies = {shape_body_.data(), connected_offsets_.data(), connected_.data()};
  in.planes = planes_.data(), in.walls = static_cast<Index>(planes_.size());
  in.active = layout_.active, in.owned = owned_, in.first_shape = layout_.first_shape;
  in.first_image = layout_.first_shape + layout_.shapes, in.items = layout_.items;
  in.shapes_meet = layout_.shapes_meet;
  in.skin = skin;
  list_.build(device(), in);
}

// What of the list each rank makes alone: what takes most of the memory.
void CudaBackend::find_rows(Real skin) {
  index_others();
  search(skin);
  const auto items = static_cast<std::size_t>(layout_.items);
  list_position_.resize(items);
  copy_async(list_position_.data(), now_.position.data(), items, stream_);
  if (!ranks_.alone()) {
    row_length_.resize(static_cast<std::size_t>(owned_));
    copy_async(row_length_.data(), list_.rows().counts, row_length_.size(), stream_);
  }
  if (model_.integrator.particles == ParticleIntegrator::hht)
    size_step_arrays();
  else
    list_.pruned_rows(layout_.first_shape);  // makes room for them
}

// Where an allocation fails the particles stay what they were. Phases in which that is likely end `together`:
// all ranks then fail, and can write their last good state.
void CudaBackend::build(Real skin, StageTimers& timers) {
  settle();
  layout_changed_ = true;
  std::int64_t particles = 0;
  {
    const auto scope = timers.time(Stage::migrate);
    particles = ranks_.sum(static_cast<std::int64_t>(owned_));
    wrap_positions();
    if (!ranks_.alone()) migrate();
  }
  {
    const auto scope = timers.time(Stage::sort_cells);
    sort_cells(skin, particles);
  }
  {
    const auto scope = timers.time(Stage::exchange_halo);
    lay_out_items(skin);
  }
  const auto scope = timers.time(Stage::neighbors);
  ranks_.together([&] { find_rows(skin); });
  h_list_shapes_ = side_.position();
  list_skin_ = skin;
  bound_ = 0, new_list_ = true;
  level_ = Level::state;
  layout_changed_ = false;
  ++list_builds_;
  measure_balance();
}

Real CudaBackend::displacement() {
  if (layout_changed_) return 2;
  settle();
  const DisplacementItem moved{list_position_.data(), now_.position.data()};
  const DisplacementItem shapes{moved.from + layout_.first_shape, moved.to + layout_.first_shape};
  max_over(device(), layout_.active, moved, result(&Results::largest));
  max_over(device(), shape_items(), shapes, result(&Results::displacement));
  Real squared[2] = {fetch(&Results::largest), fetch(&Results::displacement)};
  ranks_.max(squared);
  if (!std::isfinite(squared[0]) || !std::isfinite(squared[1])) return 2;
  bound_ = std::sqrt(std::max(squared[0], squared[1]));
  return bound_ / (list_skin_ / 2);
}

}  // namespace scree
