// What one particle puts into a snapshot, or into the history.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "dem/reports.hpp"
#include "particle_arrays.cuh"

namespace scree {

// Besides the global ids.
template <template <class> class Array>
struct SnapshotArrays {
  Array<Real> radius{};
  Array<Vec3> position{}, velocity{}, force{};  // position inside the periodic box; force: contacts only
  Array<Index> contacts{};
};

// Calls visit(a.name, b.name, ...) for each of the arrays of each of the sets.
template <class Visit, class... Sets>
void for_each_column(const Visit& visit, Sets&... sets) {
  visit(sets.radius...), visit(sets.position...), visit(sets.velocity...), visit(sets.force...);
  visit(sets.contacts...);
}

struct PackItem {
  ParticleViews in;
  const Index* order;     // by global id
  const Index* contacts;  // of ContactEnergyItem
  Vec3 gravity, box_min, period;
  SnapshotArrays<Pointer> out;

  SCREE_HD void operator()(Index k) const {
    const Index i = order[k];
    ImageCount unused;
    const Vec4 x = in.position[i], v = in.velocity[i];
    out.radius[k] = x.w, out.position[k] = wrap(box_min, period, xyz(x), unused);
    out.velocity[k] = xyz(v), out.force[k] = in.force[i] - v.w * gravity;
    out.contacts[k] = contacts[i];
  }
};

// Writes a particle to the place that its id has among the sorted ids; the others write nothing.
struct TraceItem {
  ParticleViews in;
  const GlobalId* ids;
  Index count;
  Vec3 box_min, period;
  TracedParticle* out;

  SCREE_HD void operator()(Index i) const {
    const GlobalId id = id_of(in.row_key[i]);
    Index low = 0, high = count;  // its place is in [low, high)
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      (ids[middle] <= id ? low : high) = middle;
    }
    if (ids[low] != id) return;
    ImageCount unused;
    out[low] = {id, wrap(box_min, period, xyz(in.position[i]), unused), xyz(in.velocity[i])};
  }
};

}  // namespace scree
