#include "dem/cpu/cpu_items.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/error.hpp"

namespace scree {

CpuItems::CpuItems(const Model& of, const Ranks& on, std::unique_ptr<ContactKernels> law)
    : model(of),
      ranks(on),
      subdomain(of.space),
      side(of, subdomain, on),
      kernels(std::move(law)),
      surfaces(of, subdomain, *kernels, of.contact.interaction_range),
      history(packed_content(of, kernels->traits().history), {of.space.min, subdomain.period()}),
      hht(hht_coefficients(of.integrator.hht_alpha)) {
  static_cast<FieldsThere&>(store) = fields_there(of);
}

CpuItems::Views CpuItems::views(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                                const std::vector<Vec4>& spin) {
  return_records();
  return views_of(position, velocity, spin);
}

CpuItems::Views CpuItems::views_of(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                                   const std::vector<Vec4>& spin) {
  Views views =
      surfaces.views(store, position, velocity, {list.offsets.data(), list.neighbors.data()}, list.surfaces);
  views.history = history.views(), views.spin = spin.data(),
  views.interaction_range = model.contact.interaction_range;
  return views;
}

void CpuItems::find_loads(const std::vector<Vec4>& position, const std::vector<Vec4>& velocity,
                          const std::vector<Vec4>& spin, const HistoryViews& of, Real h) {
  if (side.size() == 0) return;
  surfaces.find_loads(side.poses(), store, list.surfaces,
                      {position.data(), velocity.data(), spin.data(), of, h});
  const bool in_step = h > 0;
  if (in_step && side.surfaces().is_static()) return;  // static surfaces do not need the sums
  side.take_loads(surfaces.load_sums(list.surfaces), h);
}

bool CpuItems::any_outside() const {
  for (Index i = 0; i < store.owned; ++i)
    if (!store.drifting[i] && !subdomain.inside(xyz(store.position[i]))) return true;
  return false;
}

bool CpuItems::any_outside(const RemainingSpace& space) const {
  for (Index i = 0; i < store.owned; ++i)
    if (!store.drifting[i] && !space.holds(xyz(store.position[i]))) return true;
  return false;
}

void CpuItems::fail_if_any(GlobalId id, const char* before, const char* after) const {
  const GlobalId first = ranks.min(id);
  if (first != kNone) throw SimulationError(before + std::to_string(first) + after);
}

void CpuItems::report_not_finite(const std::vector<Vec3>& force) const {
  GlobalId bad = kNone;
  for (Index i = 0; i < layout.owned; ++i)
    if (!is_finite(force[i])) bad = std::min(bad, id_of(store.row_key[i]));
  fail_if_any(bad, "stage contact_force: the force on particle ", " is not finite");
}

}  // namespace scree
