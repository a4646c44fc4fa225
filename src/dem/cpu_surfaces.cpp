#include "dem/cpu_surfaces.hpp"

namespace scree {
namespace {

// Per surface that something touches.
template <class Sums, class Contact>
std::vector<Sums> sums_of(const std::vector<Contact>& contacts, const SurfaceRows& rows, Index ground) {
  std::vector<Sums> sums;
  for (const Index entry : rows.by_surface) {
    if (!contacts[entry].touches) continue;
    const Index surface = rows.surfaces[entry] - ground;
    if (sums.empty() || sums.back().surface != surface) sums.emplace_back().surface = surface;
    sums.back().add_contact(contacts[entry]);
  }
  return sums;
}

}  // namespace

CpuSurfaces::CpuSurfaces(const Model& model, const Subdomain& subdomain, SurfaceSide& side,
                         const ContactKernels& kernels)
    : side_(side), kernels_(kernels), planes_(wall_planes(model)), period_(subdomain.period()) {}

SurfaceViews CpuSurfaces::entry_views(const ParticleStore& store, const SurfaceRows& rows,
                                      const SurfaceLook& look) const {
  return {look.position,  look.velocity,         store.material.data(),
          rows.entries(), side_.placed().data(), side_.surfaces().ground(),
          period_,        look.history,          look.spin,
          look.h};
}

void CpuSurfaces::find_loads(const ParticleStore& store, const SurfaceRows& rows, const SurfaceLook& look) {
  if (side_.size() == 0) return;
  loads_.resize(rows.surfaces.size());
  kernels_.surface_loads(entry_views(store, rows, look), static_cast<Index>(rows.by_surface.size()),
                         loads_.data());
  side_.take_loads(sums_of<InstantSums>(loads_, rows, side_.surfaces().ground()));
}

void CpuSurfaces::find_steps(const ParticleStore& store, const SurfaceRows& rows, const StepStart& start) {
  if (side_.size() == 0) return;
  steps_.resize(rows.surfaces.size());
  kernels_.surface_steps(
      entry_views(store, rows, {store.position.data(), store.velocity.data(), nullptr, {}}),
      static_cast<Index>(rows.by_surface.size()), start, side_.start().data(), steps_.data());
  side_.take_steps(sums_of<StepSums>(steps_, rows, side_.surfaces().ground()), start.h);
}

void CpuSurfaces::find_rubs(const ParticleStore& store, const SurfaceRows& rows, const RubbingStart& start,
                            const HistoryViews& history) {
  if (side_.size() == 0) return;
  rubs_.resize(rows.surfaces.size());
  kernels_.surface_rubs(
      entry_views(store, rows,
                  {store.position.data(), store.velocity.data(), store.angular_velocity.data(), history}),
      static_cast<Index>(rows.by_surface.size()), start, side_.start().data(), rubs_.data());
  side_.take_steps(sums_of<StepSums>(rubs_, rows, side_.surfaces().ground()), start.step.h);
}

ContactViews<PackedRows> CpuSurfaces::views(const ParticleStore& store, const std::vector<Vec4>& position,
                                            const std::vector<Vec4>& velocity, const PackedRows& neighbors,
                                            const SurfaceRows& rows) const {
  return {position.data(),     velocity.data(),      store.material.data(), neighbors,
          rows.offsets.data(), rows.surfaces.data(), planes_.data(),        side_.surfaces().ground(),
          loads_.data(),       steps_.data()};
}

}  // namespace scree
