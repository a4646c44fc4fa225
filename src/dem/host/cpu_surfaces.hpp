// Contacts with placed surfaces on the host: of the serial backend's particles, and of the shapes of bodies.
#pragma once

#include <utility>
#include <vector>

#include "dem/laws/contact_kernels.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/reports/triangle_works.hpp"
#include "dem/search/surface_rows.hpp"
#include "dem/surfaces/triangle_sums.hpp"
#include "partition/subdomain.hpp"

namespace scree {

class CpuSurfaces {
 public:
  // interaction_range, masses: see `SurfaceViews`; empty masses: null.
  CpuSurfaces(const Model& model, const Subdomain& subdomain, const ContactKernels& kernels,
              Real interaction_range, std::vector<Real> masses = {});
  // Radii of the items that laws use instead of the items' own [m]; empty: their own.
  void set_law_radii(std::vector<Real> radii) { law_radii_ = std::move(radii); }
  // The items as shapes of bodies, see `SurfaceViews`; empty: particles.
  void set_free_shapes(std::vector<FreeShape> shapes) { free_shapes_ = std::move(shapes); }
  SurfaceNumbers numbers() const { return {planes_.data(), static_cast<Index>(planes_.size())}; }

  // Finds the loads for views(), at the current poses of the surfaces, of the store's particles in the state
  // of `query`.
  void find_loads(const SurfacePoses& poses, const ParticleStore& store, SurfaceRows& rows,
                  const SurfaceQuery& query);
  // Contacts over an implicit step of the store's particles; history: with what the accepted step will store.
  void find_steps(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows,
                  const FrictionStart& start, const HistoryViews& history);
  // Sums of the last evaluation, per surface in contact.
  std::vector<InstantSums> load_sums(const SurfaceRows& rows) const;
  std::vector<StepSums> step_sums(const SurfaceRows& rows) const;
  // Calls visit(particle, placed surface, contact point relative to the parent's centre, slopes) for the
  // contacts over the step that was evaluated last.
  template <class Visit>
  void for_each_slope(const SurfaceRows& rows, const Visit& visit) const {
    for (const Index entry : rows.by_surface) {
      const auto show = [&](const auto& contact, Vec3 place) {
        if (contact.touches)
          visit(rows.particles[entry], numbers().placed(rows.surfaces[entry]), place, slopes_of(contact));
      };
      if (moves_)
        show(friction_steps_[entry],
             friction_steps_[entry].arm +
                 friction_steps_[entry].radius * friction_steps_[entry].contact.normal.normal);
      else
        show(steps_[entry], steps_[entry].arm);
    }
  }
  // Output of the contacts of the last find_loads() at an instant; per entry.
  std::vector<ShownContact> shown(const SurfacePoses& poses, const ParticleStore& store,
                                  const SurfaceRows& rows, const HistoryViews& history) const;
  // Sums per triangle of the last find_loads().
  std::vector<TriangleSums> triangle_sums(const SurfaceRows& rows) const;
  // Accumulates at the triangles the dissipation of the contacts that were evaluated last, over a closed
  // step: the explicit one of length h, or the implicit one.
  void accumulate_load_works(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows,
                             Real h);
  void accumulate_step_works(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows);
  std::vector<std::int64_t> works() const {
    return works_.exist() ? works_.limbs(work_sums_) : std::vector<std::int64_t>{};
  }
  void load_works(const std::vector<std::int64_t>& words) { work_sums_ = works_.sums(words); }
  // Per entry, of the last find_steps() where particles rotate.
  const SurfaceFriction* friction_steps() const { return friction_steps_.data(); }

  // Views of particles at these positions, with the contacts that were evaluated last.
  ContactViews<PackedRows> views(const ParticleStore& store, const std::vector<Vec4>& position,
                                 const std::vector<Vec4>& velocity, const PackedRows& neighbors,
                                 const SurfaceRows& rows) const;

 private:
  const Real* law_radii() const { return law_radii_.empty() ? nullptr : law_radii_.data(); }
  const FreeShape* free_shapes() const { return free_shapes_.empty() ? nullptr : free_shapes_.data(); }
  SurfaceViews entry_views(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows,
                           const SurfaceQuery& query) const;
  template <class Works>
  void accumulate(const SurfacePoses& poses, const ParticleStore& store, const SurfaceRows& rows,
                  const Works& works);
  void reserve_entries(const SurfaceRows& rows);  // for contacts with meshes
  // Finds the contacts with meshes at both ends of a step that began at start_surface_poses.
  void touch_over_step(const SurfaceViews& views, const SurfaceRows& rows, const StepStart& start,
                       const SurfacePose* start_surface_poses);

  const ContactKernels& kernels_;
  std::vector<Real> masses_, law_radii_;
  std::vector<FreeShape> free_shapes_;
  std::vector<WallPlane> planes_;
  Real interaction_range_;  // [m]
  bool open_surfaces_;
  PeriodicBox box_;
  std::vector<MeshTouch> touches_;  // per entry; empty without meshes
  std::vector<MeshTouchBefore> touches_before_;
  std::vector<SurfaceLoad> loads_;  // per entry
  std::vector<SurfaceStep> steps_;
  std::vector<SurfaceFriction> friction_steps_;
  TriangleWorks works_;
  std::vector<TriangleWork> work_sums_;
  TermCount terms_;
  bool moves_;  // whether particles rotate
};

}  // namespace scree
