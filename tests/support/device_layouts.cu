#include "dem/particles/particle_fields.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/escape_items.hpp"
#include "dem/surface_contact/friction_surfaces.hpp"
#include "dem/surfaces/mesh_rows.hpp"
#include "device.cuh"
#include "partition/halo.hpp"
#include "physics/eepa.hpp"
#include "support/device_layouts.hpp"

namespace scree {
namespace {

// Address of an element as the code of any kernel computes it.
template <class T>
__global__ void address_kernel(T* array, Index index, T** at) {
  *at = array + index;
}

template <class T>
Layout layout_of(const char* name) {
  const Stream stream;
  DeviceArray<T*> at(1);
  address_kernel<T><<<1, 1, 0, stream>>>(nullptr, 1, at.data());
  require_cuda(cudaGetLastError(), "layouts");
  return {name, sizeof(T), reinterpret_cast<std::size_t>(at.download(stream)[0])};
}

}  // namespace

std::vector<Layout> layouts_on_device() {
  return {layout_of<ContactHistory>("ContactHistory"),
          layout_of<ContactHistoryOf<EepaState>>("ContactHistoryOf<EepaState>"),
          layout_of<FrictionLosses>("FrictionLosses"),
          layout_of<SurfaceFriction>("SurfaceFriction"),
          layout_of<SurfaceStep>("SurfaceStep"),
          layout_of<SurfaceLoad>("SurfaceLoad"),
          layout_of<SurfacePose>("SurfacePose"),
          layout_of<SurfaceFrame>("SurfaceFrame"),
          layout_of<FreeBody>("FreeBody"),
          layout_of<MeshTouch>("MeshTouch"),
          layout_of<MeshTouchBefore>("MeshTouchBefore"),
          layout_of<SpringEnergies>("SpringEnergies"),
          layout_of<ShownContact>("ShownContact"),
          layout_of<ContactLine>("ContactLine"),
          layout_of<EscapedParticle>("EscapedParticle"),
          layout_of<Particle>("Particle"),
          layout_of<Ghost>("Ghost")};
}

}  // namespace scree
