#include "dem/cpu/cpu_reports.hpp"

#include <algorithm>

#include "base/for_each.hpp"
#include "base/reproducible_sum.hpp"
#include "dem/backend/inside_energies.hpp"
#include "dem/reports/ledger_items.hpp"
#include "dem/reports/region_items.hpp"

namespace scree {

ParticleLedger CpuReports::ledger(Real verlet_step) {
  ParticleStore& store = items_.store;
  const Index n = store.owned;
  std::vector<Real> elastic(n), pairs(n);
  std::vector<Index> touching(n);
  std::vector<SpringEnergies> springs(store.rotates ? n : 0);
  const bool is_cohesive = items_.model.is_cohesive();
  std::vector<Real> cohesion(is_cohesive ? n : 0);
  need_loads();
  items_.kernels->run(
      items_.views(), n,
      EnergyOutputs{elastic.data(), touching.data(), pairs.data(), store.rotates ? springs.data() : nullptr,
                    is_cohesive ? cohesion.data() : nullptr});

  const LedgerItem item{views_of(store),           elastic.data(), pairs.data(), items_.model.gravity,
                        items_.subdomain.period(), verlet_step};
  Real sums[kLedgerTerms];
  reproducible_sums(n, item, sums, items_.ranks);
  ParticleLedger out = make_particle_ledger(sums, items_.side);
  Real inside[kInsideTerms];
  reproducible_sums(n, InsideItem{item.in, item.gravity, item.period, verlet_step}, inside, items_.ranks);
  out.inside = make_inside_energies(inside, items_.side);
  if (store.rotates) {
    Real of_rotation[kRotationTerms];
    reproducible_sums(n, RotationItem{views_of(store), springs.data()}, of_rotation, items_.ranks);
    out.rotation = make_rotation_energies(of_rotation, items_.side);
  }
  if (is_cohesive) {
    Real sum[1];
    reproducible_sums(n, CohesionItem{cohesion.data()}, sum, items_.ranks);
    out.cohesion += sum[0];
  }
  for (Index i = 0; i < n; ++i) out.drifting += store.drifting[i];
  out.drifting = items_.ranks.sum(out.drifting);
  return out;
}

Real CpuReports::inside_kinetic() {
  Real sum[1];
  reproducible_sums(items_.store.owned, InsideKineticItem{views_of(items_.store)}, sum, items_.ranks);
  return sum[0];
}

void CpuReports::start_output() {
  ParticleStore& store = items_.store;
  const Index n = store.owned;
  const OutputSource source = output_source(views_of(store), items_.model, items_.subdomain.period());
  ParticleOutput& out = output_ = {};
  for (Index i = 0; i < n; ++i) out.global_id.push_back(id_of(store.row_key[i]));
  out.position.resize(static_cast<std::size_t>(n));
  for_each(Serial{}, n, OwnOutputItem<PositionOutput>{source, nullptr, out.position.data()});
  need_loads();
  for (const OutputField& field : fields_) {
    OutputValues& values = out.fields.emplace_back(field.values(static_cast<std::size_t>(n)));
    void* const to = std::visit([](auto& v) -> void* { return v.data(); }, values);
    const OutputRequest request{source, nullptr, n, field.head.name, to};
    if (field.reads_contacts)
      items_.kernels->run(items_.views(), n, request);
    else
      with_own_output(request, [&](const auto& item) { for_each(Serial{}, n, item); });
  }
}

ShapePack CpuReports::pack_shapes() {
  need_loads();
  return items_.side.pack();
}

ContactLines CpuReports::contact_lines() {
  const ParticleStore& store = items_.store;
  const Index n = store.owned;
  need_loads();
  const std::vector<ShownContact> of_surfaces =
      items_.surfaces.shown(items_.side.poses(), store, items_.list.surfaces, items_.history.views());
  std::vector<Index> counts(static_cast<std::size_t>(n));
  ContactLines out;
  out.lines = scree::contact_lines(
      *items_.kernels, items_.views(),
      {store.row_key.data(), of_surfaces.data(), items_.model.space.min, items_.subdomain.period()}, counts);
  for (Index i = 0; i < n; ++i) out.global_id.push_back(id_of(store.row_key[i]));
  out.counts.assign(counts.begin(), counts.end());
  out.of_bodies = items_.side.contact_lines();
  return out;
}

RegionSums CpuReports::in_region(const RegionBounds& region) {
  Real sums[kRegionTerms];
  reproducible_sums(
      items_.store.owned,
      RegionItem{views_of(items_.store), region, items_.model.space.min, items_.subdomain.period()}, sums,
      items_.ranks);
  return {sums[kRegionNumber], sums[kRegionMass]};
}

std::vector<TracedParticle> CpuReports::traced(std::span<const GlobalId> requested) {
  const ParticleStore& store = items_.store;
  std::vector<GlobalId> ids(requested.begin(), requested.end());
  std::sort(ids.begin(), ids.end());
  std::vector<TracedParticle> found;
  for (Index i = 0; i < store.owned; ++i) {
    if (!std::binary_search(ids.begin(), ids.end(), id_of(store.row_key[i]))) continue;
    ImageCount unused;
    found.push_back({id_of(store.row_key[i]), items_.subdomain.wrap(xyz(store.position[i]), unused),
                     xyz(store.velocity[i]),
                     store.angular_velocity.empty() ? Vec3{} : xyz(store.angular_velocity[i])});
  }
  return found;
}

std::vector<ContactSum> CpuReports::parent_contacts() {
  need_loads();
  return items_.side.parent_contacts();
}

std::vector<ContactSum> CpuReports::surface_contacts() {
  need_loads();
  return items_.side.surface_contacts();
}

std::vector<TriangleLoad> CpuReports::triangle_loads() {
  need_loads();
  return items_.side.triangle_loads(items_.surfaces.triangle_sums(items_.list.surfaces));
}

std::vector<ContactSum> CpuReports::wall_contacts(std::span<const int> walls) {
  std::vector<ContactSum> contacts;
  need_loads();
  for (const int wall : walls) {
    Real sums[kWallTerms];
    items_.kernels->wall_sums(items_.views(), items_.layout.owned,
                              {wall, items_.model.space.min, items_.subdomain.period()}, items_.ranks, sums);
    contacts.push_back(make_wall_contact(sums));
    if (items_.ranks.is_root()) contacts.back() += items_.side.on_wall(wall);
  }
  return contacts;
}

}  // namespace scree
