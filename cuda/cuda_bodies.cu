#include "cuda_bodies.cuh"

namespace scree {

using Loads = DeviceSurfaces::Loads;

void CudaBodies::put() { items_.surfaces.upload(items_.device(), side_.poses()); }

SurfaceMoves CudaBodies::upload_moves() {
  step_.upload(side_.step(), items_.stream), step_rotation_.upload(side_.step_rotation(), items_.stream);
  return {step_.data(), step_rotation_.data()};
}

void CudaBodies::find_loads() {
  if (!have_surfaces()) return;
  const Device on = items_.device();
  items_.surfaces.find_loads(on, Follows::anything, *items_.kernels, Loads::of_step,
                             {items_.now.position.data(), items_.now.velocity.data(),
                              items_.now.angular_velocity.data(), items_.history.views().only_read()});
  wait_for(items_.stream);
  side_.take_loads(items_.surfaces.load_sums().touched(), 0);
}

const ShownContact* CudaBodies::find_shown() {
  return items_.surfaces.find_shown(items_.device(), *items_.kernels,
                                    {items_.now.position.data(), items_.now.velocity.data(),
                                     items_.now.angular_velocity.data(), items_.history.views().only_read()});
}

void CudaBodies::find_steps(const FrictionStart& start) {
  if (!have_surfaces()) return;
  items_.surfaces.find_steps(items_.device(), *items_.kernels, start,
                             {items_.now.position.data(), items_.now.velocity.data(),
                              items_.now.angular_velocity.data(), items_.history.views()});
}

void CudaBodies::take_steps(Real h) {
  if (!have_surfaces()) return;
  wait_for(items_.stream);
  side_.take_steps(items_.surfaces.step_sums(), h);
}

// On a stream where nothing else waits to be done between the poses and the contacts.
void CudaBodies::send_and_find(cudaStream_t on, Loads which, const SurfaceQuery& query,
                               const ControlReport& report) {
  items_.surfaces.send({on}, side_.poses());
  items_.surfaces.find_loads({on}, Follows::kernel, *items_.kernels, which, query, report);
  loads_on_ = on;
}

void CudaBodies::queue_loads(const SurfaceQuery& query, const ControlReport& report) {
  if (items_.surfaces.any_near()) send_and_find(items_.stream, Loads::of_step, query, report);
}

void CudaBodies::queue_loads_after(const Event& ready, const SurfaceQuery& query,
                                   const ControlReport& report) {
  if (!items_.surfaces.any_near()) return;
  const Device on{stream_};
  items_.surfaces.send(on, side_.poses());
  ready.hold(stream_);
  items_.surfaces.find_loads(on, Follows::anything, *items_.kernels, Loads::of_step, query, report);
  loads_on_ = stream_;
  loads_found_.record(stream_);
}

// The shapes' contacts are found while the device evaluates those of the particles.
void CudaBodies::take_loads(Real h) {
  side_.find_shape_loads(h);
  items_.surfaces.load_sums().await(loads_on_);
  side_.take_particle_loads(items_.surfaces.load_sums().touched());
}

// The next query on this stream overwrites what the accumulation of works still reads, and so does the next
// list, on the particles' stream.
void CudaBodies::accumulate_load_works(Real h) {
  if (!items_.surfaces.works().exist()) return;
  items_.surfaces.load_sums().await(loads_on_);
  items_.surfaces.accumulate_load_works({stream_}, *items_.kernels, h);
  works_accumulated_.record(stream_), works_accumulated_.hold(items_.stream);
}

void CudaBodies::find_loads_concurrently(const SurfaceQuery& query, const std::function<void()>& meanwhile) {
  if (!have_surfaces()) return;
  if (!items_.surfaces.any_near()) return side_.take_loads({}, query.h);
  send_and_find(stream_, Loads::of_query, query, {});
  meanwhile();
  take_loads(query.h);
}

}  // namespace scree
