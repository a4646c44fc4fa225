// Items of one rank on the serial backend: the data that its objects share.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "dem/host/cpu_history.hpp"
#include "dem/host/cpu_surfaces.hpp"
#include "dem/host/host_surfaces.hpp"
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
  CpuItems(const CpuItems&) = delete;  // `side` holds the address of `subdomain`
  CpuItems& operator=(const CpuItems&) = delete;

  Views views() { return views(store.position, store.velocity, store.angular_velocity); }
  // Views for an explicit step, in which the history of particle pairs is in `listed_pairs()`.
  Views step_views() { return views_of(store.position, store.velocity, store.angular_velocity); }
  Views views(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
              const std::vector<Vec4>& spin);
  void refresh_ghosts() {
    std::optional<std::span<Vec4>> spin;
    if (store.rotates) spin = store.angular_velocity;
    halo.update_motion(store.position, store.velocity, spin, layout.owned);
  }
  // Contacts with surfaces on bodies at the current positions, for forces and reports. h: length of the
  // explicit step that ends now and will be accepted [s]; 0: at this instant.
  void find_loads(Real h = 0) {
    const HistoryViews at = history.views();
    find_loads(store.position, store.velocity, store.angular_velocity, h > 0 ? at : at.only_read(), h);
  }
  // Contacts with surfaces of particles at these positions, with this history.
  void find_loads(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                  const std::vector<Vec4>& spin, const HistoryViews& of, Real h);
  // Pairs of the list where particles rotate, with their history until it is read at the slots. Built when
  // they are first used.
  PairList& listed_pairs() {
    if (!store.rotates) return pairs;
    if (!pairs.is_current) pairs.match(list, store);
    if (!pairs.has_records) pairs.fetch_records(history.views().neighbors, history.records());
    return pairs;
  }
  // Argument for functions of `history`, while there is a list.
  CpuHistory::Listed listed() {
    return_records();
    return {store, list, side.poses(), surfaces.numbers()};
  }
  void reduce_wrench(std::vector<BodyWrench>& end) const { side.reduce(end); }
  bool any_outside() const;
  bool any_outside(const RemainingSpace& space) const;
  // Throws a SimulationError on all ranks that names the first particle whose force is not finite.
  void report_not_finite(const std::vector<Vec3>& force) const;
  // Throws a SimulationError on all ranks that names the first particle. id: kNone without one on this rank.
  void fail_if_any(GlobalId id, const char* before, const char* after) const;

  void return_records() {
    if (pairs.has_records) kernels->return_records(pairs, history.views());
  }
  Views views_of(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                 const std::vector<Vec4>& spin);

  const Model& model;
  Ranks ranks;
  Subdomain subdomain;
  HostSurfaces side;
  std::unique_ptr<ContactKernels> kernels;
  CpuSurfaces surfaces;
  CpuHistory history;
  HhtCoefficients hht;

  ParticleStore store;
  Halo halo;
  NeighborList list;
  PairList pairs;  // pairs of the list, where explicit steps have used them
  ItemLayout layout;
  // Output of explicit steps while neighbours are read; after a run: the last velocities that the law used.
  std::vector<Vec4> spare_position, spare_velocity, spare_spin;
};

}  // namespace scree
