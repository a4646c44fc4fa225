#include "dem/host/cpu_surfaces.hpp"

#include <utility>

#include "base/for_each.hpp"
#include "dem/surface_contact/mesh_step_touches.hpp"

namespace scree {
namespace {

// Sums per surface in contact.
template <class Sums, class Contact>
std::vector<Sums> sums_of(const std::vector<Contact>& contacts, const SurfaceRows& rows,
                          const SurfaceNumbers& numbers) {
  std::vector<Sums> sums;
  for (const Index entry : rows.by_surface) {
    if (!contacts[entry].touches) continue;
    const Index surface = numbers.placed(rows.surfaces[entry]);
    if (sums.empty() || sums.back().surface != surface) sums.emplace_back().surface = surface;
    sums.back().add_contact(contacts[entry]);
  }
  return sums;
}

// The planes under the particles are scattered in memory: each is prefetched some groups ahead of its use.
template <bool kHasRange, bool kOpenSurfaces>
void touch_with_prefetch(const MeshTouchItem<kHasRange, kOpenSurfaces>& item, Index groups) {
  constexpr Index kAhead = 8;
  const SurfaceViews& in = item.in;
  for (Index g = 0; g < groups; ++g) {
    if (const Index ahead = g + kAhead; ahead < groups && item.cached_contacts[ahead].feature >= 0) {
      const SurfacePose& surface = in.placed[in.surface_of(in.meshes.groups[ahead].entry)];
      const MeshView& mesh = in.meshes.meshes[in.frames[surface.frame].mesh];
      if (const Index feature = item.cached_contacts[ahead].feature; is_face(mesh, feature))
        __builtin_prefetch(&mesh.parts[feature]);
    }
    item(g);
  }
}

}  // namespace

CpuSurfaces::CpuSurfaces(const Model& model, const Subdomain& subdomain, const ContactKernels& kernels,
                         Real interaction_range, std::vector<Real> masses)
    : kernels_(kernels),
      masses_(std::move(masses)),
      planes_(wall_planes(model)),
      interaction_range_(interaction_range),
      open_surfaces_(has_open_surfaces(model)),
      box_{model.space.min, subdomain.period()},
      works_(model),
      work_sums_(works_.sums({})),
      moves_(model.rotates()) {}

SurfaceViews CpuSurfaces::entry_views(const SurfacePoses& poses, const ParticleStore& store,
                                      const SurfaceRows& rows, const SurfaceQuery& query) const {
  return {query.position,
          query.velocity,
          store.material.data(),
          rows.entries(),
          poses.placed.data(),
          poses.frames.data(),
          numbers(),
          {rows.groups.data(), rows.triangles.data(), poses.meshes.data()},
          touches_.data(),
          touches_before_.data(),
          box_,
          query.history,
          records_of(kernels_.traits().history),
          query.spin,
          query.h,
          interaction_range_,
          masses_.empty() ? nullptr : masses_.data(),
          law_radii(),
          poses.free_bodies.empty() ? nullptr : poses.free_bodies.data(),
          free_shapes()};
}

void CpuSurfaces::find_loads(const SurfacePoses& poses, const ParticleStore& store, SurfaceRows& rows,
                             const SurfaceQuery& query) {
  loads_.resize(rows.surfaces.size());
  if (!rows.groups.empty()) {
    touches_.resize(rows.surfaces.size());
    const SurfaceViews views = entry_views(poses, store, rows, query);
    const auto groups = static_cast<Index>(rows.groups.size());
    if (interaction_range_ > 0 && open_surfaces_)
      touch_with_prefetch(MeshTouchItem<true, true>{views, touches_.data(), rows.cached_contacts.data()},
                          groups);
    else if (interaction_range_ > 0)
      touch_with_prefetch(MeshTouchItem<true, false>{views, touches_.data(), rows.cached_contacts.data()},
                          groups);
    else if (open_surfaces_)
      touch_with_prefetch(MeshTouchItem<false, true>{views, touches_.data(), rows.cached_contacts.data()},
                          groups);
    else
      touch_with_prefetch(MeshTouchItem<false, false>{views, touches_.data(), rows.cached_contacts.data()},
                          groups);
  }
  kernels_.surface_loads(entry_views(poses, store, rows, query), static_cast<Index>(rows.by_surface.size()),
                         loads_.data());
}

void CpuSurfaces::touch_over_step(const SurfaceViews& views, const SurfaceRows& rows, const StepStart& start,
                                  const SurfacePose* start_surface_poses) {
  const auto groups = static_cast<Index>(rows.groups.size());
  if (open_surfaces_)
    for_each(Serial{}, groups,
             MeshStepTouchItem<true>{views, start.position, start_surface_poses, touches_.data(),
                                     touches_before_.data()});
  else
    for_each(Serial{}, groups,
             MeshStepTouchItem<false>{views, start.position, start_surface_poses, touches_.data(),
                                      touches_before_.data()});
}

void CpuSurfaces::reserve_entries(const SurfaceRows& rows) {
  if (!rows.groups.empty())
    touches_.resize(rows.surfaces.size()), touches_before_.resize(rows.surfaces.size());
}

void CpuSurfaces::find_steps(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows,
                             const FrictionStart& start, const HistoryViews& history) {
  moves_ ? friction_steps_.resize(rows.surfaces.size()) : steps_.resize(rows.surfaces.size());
  reserve_entries(rows);
  const SurfaceViews views =
      entry_views(poses, store, rows,
                  {store.position.data(), store.velocity.data(), store.angular_velocity.data(), history});
  touch_over_step(views, rows, start.step, poses.start.data());
  kernels_.surface_steps(views, static_cast<Index>(rows.by_surface.size()), start, poses.start.data(),
                         {steps_.data(), friction_steps_.data()});
}

std::vector<InstantSums> CpuSurfaces::load_sums(const SurfaceRows& rows) const {
  return sums_of<InstantSums>(loads_, rows, numbers());
}
std::vector<StepSums> CpuSurfaces::step_sums(const SurfaceRows& rows) const {
  return moves_ ? sums_of<StepSums>(friction_steps_, rows, numbers())
                : sums_of<StepSums>(steps_, rows, numbers());
}

std::vector<ShownContact> CpuSurfaces::shown(const SurfacePoses& poses, const ParticleStore& store,
                                             const SurfaceRows& rows, const HistoryViews& history) const {
  std::vector<ShownContact> shown(rows.surfaces.size());
  const SurfaceViews views =
      entry_views(poses, store, rows,
                  {store.position.data(), store.velocity.data(), store.angular_velocity.data(), history});
  kernels_.shown_surfaces(views, static_cast<Index>(rows.by_surface.size()), loads_.data(), shown.data());
  return shown;
}

std::vector<TriangleSums> CpuSurfaces::triangle_sums(const SurfaceRows& rows) const {
  return scree::triangle_sums({rows.groups, rows.surfaces, touches_, loads_}, numbers());
}

template <class Works>
void CpuSurfaces::accumulate(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows,
                             const Works& works) {
  if (!works_.exist()) return;
  struct Add {
    static void add(std::int64_t& limb, std::int64_t term) { limb += term; }
  };
  const TriangleWorkTable table{works_.first().data(), works_.wear().empty() ? nullptr : works_.wear().data(),
                                works_.materials()};
  if (!terms_.take(static_cast<std::int64_t>(rows.surfaces.size())))
    for_each(Serial{}, static_cast<Index>(works_.triangles()), NormalizeItem{work_sums_.data()});
  for_each(
      Serial{}, static_cast<Index>(rows.groups.size()),
      TriangleWorkItem<Works, Add>{entry_views(poses, store, rows, {}), table, works, work_sums_.data()});
}

void CpuSurfaces::accumulate_load_works(const SurfacePoses& poses, const ParticleStore& store,
                                        const SurfaceRows& rows, Real h) {
  accumulate(poses, store, rows, ExplicitWorks{loads_.data(), h, moves_});
}

void CpuSurfaces::accumulate_step_works(const SurfacePoses& poses, const ParticleStore& store,
                                        const SurfaceRows& rows) {
  if (moves_)
    accumulate(poses, store, rows, ImplicitFrictionWorks{friction_steps_.data()});
  else
    accumulate(poses, store, rows, ImplicitWorks{steps_.data()});
}

ContactViews<PackedRows> CpuSurfaces::views(const ParticleStore& store, const std::vector<Vec4>& position,
                                            const std::vector<Vec4>& velocity, const PackedRows& neighbors,
                                            const SurfaceRows& rows) const {
  ContactViews<PackedRows> views{position.data(), velocity.data(),     store.material.data(),
                                 neighbors,       rows.offsets.data(), rows.surfaces.data(),
                                 numbers(),       loads_.data(),       steps_.data()};
  views.law_radius = law_radii(), views.free_shapes = free_shapes();
  return views;
}

}  // namespace scree
