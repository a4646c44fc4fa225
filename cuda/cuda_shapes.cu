#include "cuda_shapes.cuh"

namespace scree {
namespace {

// Brings a shape from pinned memory to its places among the items: sooner done than two copies.
struct PlaceItem {
  const Vec4* places;  // positions, then velocities
  Index shapes;
  Vec4 *position, *velocity;

  SCREE_HD void operator()(Index s) const { position[s] = places[s], velocity[s] = places[shapes + s]; }
};

}  // namespace

CudaShapes::CudaShapes(CudaItems& items) : items_(items), side_(items.model, items.subdomain) {
  std::vector<Index> offsets{0}, connected;
  for (std::size_t b = 0; b < items.model.bodies.size(); ++b) {
    for (const int other : side_.shapes().rule().kept_apart(static_cast<int>(b))) connected.push_back(other);
    offsets.push_back(static_cast<Index>(connected.size()));
  }
  connected_offsets_.upload(offsets, items.stream), connected_.upload(connected, items.stream);
}

void CudaShapes::name() {
  const ItemLayout& layout = items_.layout;
  const auto n = static_cast<std::size_t>(count());
  std::vector<int> material, body;
  std::vector<std::int64_t> keys;
  for (Index item = layout.first_shape; item < layout.items; ++item) {
    const ShapeItem& shape = side_.shapes().items()[layout.shape_of(item)];
    material.push_back(shape.material), body.push_back(shape.body);
    keys.push_back(side_.row_key_of(layout, item));
  }
  if (n > 0) {
    require_cuda(cudaMemcpyAsync(items_.now.material.data() + layout.first_shape, material.data(),
                                 n * sizeof(int), cudaMemcpyHostToDevice, items_.stream),
                 "cudaMemcpyAsync");
    require_cuda(cudaMemcpyAsync(items_.now.row_key.data() + layout.first_shape, keys.data(),
                                 n * sizeof(std::int64_t), cudaMemcpyHostToDevice, items_.stream),
                 "cudaMemcpyAsync");
    body_.upload(body, items_.stream);
  }
  h_contacts_.resize(n), h_books_.resize(n);
}

bool CudaShapes::covered_by(Real skin) const {
  Real squared = 0;
  const DisplacementItem moved{list_places_.data(), side_.position().data()};
  for (Index s = 0; s < count(); ++s) squared = std::max(squared, moved(s));
  return squared < skin * skin / 4;
}

void CudaShapes::put() {
  const auto n = static_cast<std::size_t>(count());
  if (n == 0) return;
  const Index first = items_.layout.first_shape;
  const Vec4* places = stage();
  copy_async(items_.now.position.data() + first, places, n, items_.stream);
  copy_async(items_.now.velocity.data() + first, places + n, n, items_.stream);
  places_copied_.record(items_.stream);
}

// A copy of the places in pinned memory, once the last one is used no longer.
const Vec4* CudaShapes::stage() {
  places_copied_.wait();
  const auto n = static_cast<std::size_t>(count());
  h_places_.resize(2 * n);
  std::copy(side_.position().begin(), side_.position().end(), h_places_.data());
  std::copy(side_.velocity().begin(), side_.velocity().end(), h_places_.data() + n);
  return h_places_.data();
}

const Vec3* CudaShapes::upload_steps() {
  step_.upload(side_.step(), items_.stream);
  return step_.data();
}

// Waits for the stream.
void CudaShapes::take_contacts(ContactSpan span, cudaStream_t stream) {
  wait_for(stream);
  side_.take_contacts(span, {h_contacts_.data(), static_cast<std::size_t>(count())});
}

void CudaShapes::find_contacts() {
  if (count() == 0) return;
  const Index first = items_.layout.first_shape;
  const ShapePlaces places{items_.now.position.data() + first, items_.now.velocity.data() + first};
  items_.kernels->shapes(items_.device(), items_.views(), places, count(), h_contacts_.data());
  take_contacts(ContactSpan::instant, items_.stream);
}

void CudaShapes::find_contacts(const StepStart& start) {
  if (count() == 0) return;
  items_.kernels->shapes(items_.device(), items_.views(), count(), start, h_contacts_.data());
  take_contacts(ContactSpan::step, items_.stream);
}

void CudaShapes::book_step(const StepStart& start) {
  if (count() == 0) return;
  items_.kernels->shape_books(items_.device(), items_.views(), count(), start, h_books_.data());
  wait_for(items_.stream);
  side_.book_step({h_books_.data(), static_cast<std::size_t>(count())});
}

void CudaShapes::queue_contacts(Vec4* position, Vec4* velocity, const Event& ready) {
  const Index first = items_.layout.first_shape;
  const ShapePlaces places{position + first, velocity + first};
  for_each({stream_}, count(), PlaceItem{stage(), count(), position + first, velocity + first});
  places_copied_.record(stream_);
  ready.hold(stream_);
  items_.kernels->shapes({stream_}, items_.views(position, velocity), places, count(), h_contacts_.data());
}

void CudaShapes::find_contacts_beside(const Vec4* position, const Vec4* velocity) {
  const auto n = static_cast<std::size_t>(count());
  if (n == 0) return;
  places_.resize(2 * n);
  copy_async(places_.data(), stage(), 2 * n, stream_);
  places_copied_.record(stream_);
  items_.kernels->shapes({stream_}, items_.views(position, velocity), {places_.data(), places_.data() + n},
                         count(), h_contacts_.data());
  take_contacts();
}

}  // namespace scree
