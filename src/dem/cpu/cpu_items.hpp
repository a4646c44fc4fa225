// The items of one rank on the serial backend: what its objects share.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "dem/host/cpu_history.hpp"
#include "dem/host/cpu_surfaces.hpp"
#include "dem/host/surface_side.hpp"
#include "dem/laws/contact_kernels.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/neighbor_list.hpp"
#include "dem/search/pair_list.hpp"
#include "model/data/model.hpp"
#include "partition/halo.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

struct CpuItems {
  using Views = ContactViews<PackedRows>;
  static constexpr GlobalId kNone = std::numeric_limits<GlobalId>::max();

  CpuItems(const Model& of, const Ranks& on, std::unique_ptr<ContactKernels> law);
  CpuItems(const CpuItems&) = delete;  // `side` knows the address of `subdomain`
  CpuItems& operator=(const CpuItems&) = delete;

  Views views() { return views(store.position, store.velocity, store.angular_velocity); }
  // For an explicit step, which sees what pairs of particles remember in listed_pairs().
  Views step_views() { return views_of(store.position, store.velocity, store.angular_velocity); }
  Views views(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
              const std::vector<Vec4>& spin);
  void refresh_ghosts() {
    std::optional<std::span<Vec4>> spin;
    if (store.rotates) spin = store.angular_velocity;
    halo.update_motion(store.position, store.velocity, spin, layout.owned);
  }
  // Contacts with surfaces on bodies, where all are now: what forces and reports read next. h: of the
  // explicit step that ends now, and will be accepted [s]; 0: at this instant.
  void find_loads(Real h = 0) {
    const HistoryViews at = history.views();
    find_loads(store.position, store.velocity, store.angular_velocity, h > 0 ? at : at.only_read(), h);
  }
  // The same of particles there, with what the contacts remember.
  void find_loads(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                  const std::vector<Vec4>& spin, const HistoryViews& of, Real h);
  // Of the list as it is, where particles rotate, with what their contacts remember, until somebody looks at
  // the slots. Matched when they are first asked for.
  PairList& listed_pairs() {
    if (!store.rotates) return pairs;
    if (!pairs.is_current) pairs.match(list, store);
    if (!pairs.keeps_records) pairs.take_records(history.views().neighbors, history.records());
    return pairs;
  }
  // For `history`, while there is a list.
  CpuHistory::Listed listed() {
    leave_records();
    return {store, list, side.places(), surfaces.numbers()};
  }
  void reduce_wrench(std::vector<BodyWrench>& end) const { side.reduce(end); }
  bool any_outside() const;
  // Throws SimulationError naming the first particle, on all ranks, whose force is not finite.
  void report_not_finite(const std::vector<Vec3>& force) const;
  // The same of a particle that only some ranks know of; id: kNone without one.
  void fail_if_any(GlobalId id, const char* before, const char* after) const;

  void leave_records() {
    if (pairs.keeps_records) kernels->leave_records(pairs, history.views());
  }
  Views views_of(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                 const std::vector<Vec4>& spin);

  const Model& model;
  Ranks ranks;
  Subdomain subdomain;
  SurfaceSide side;
  std::unique_ptr<ContactKernels> kernels;
  CpuSurfaces surfaces;
  CpuHistory history;
  HhtCoefficients hht;

  ParticleStore store;
  Halo halo;
  NeighborList list;
  PairList pairs;  // of the list, where explicit steps have asked for them
  ItemLayout layout;
  // Explicit steps write here while neighbours are read. After a run: the velocities that the law saw last.
  std::vector<Vec4> spare_position, spare_velocity, spare_spin;
};

}  // namespace scree
