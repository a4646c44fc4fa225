#include "dem/host/host_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "base/box.hpp"
#include "base/mat3.hpp"
#include "mesh/surface_mesh.hpp"

namespace scree {
namespace {

bool damps_by_mass(const NormalLawParameters& law) { return law.damping_ratio > 0; }

// J^-1 in the body's frame [1/(kg m^2)].
Sym3 inverse_inertia(const Body& body) {
  if (body.kind == BodyKind::spatial) return inverse(body.inertia_tensor);
  return {0, 0, 0, 0, 0, 1 / body.inertia};
}

// Calls visit(sum) for the merged sums of all ranks, in the order of their surfaces; on rank 0. In every step
// there may be many parts, of hundreds of bytes each: they stay where they are.
template <class Sums, class Visit>
void for_each_merged(const Ranks& ranks, const std::vector<Sums>& own, const Visit& visit) {
  const std::vector<Sums> gathered = ranks.alone() ? std::vector<Sums>{} : ranks.gather(own);
  std::vector<const Sums*> parts;
  parts.reserve(ranks.alone() ? own.size() : gathered.size());
  for (const Sums& part : ranks.alone() ? own : gathered) parts.push_back(&part);
  const auto before = [](const Sums* a, const Sums* b) { return a->key() < b->key(); };
  if (!std::is_sorted(parts.begin(), parts.end(), before))
    std::stable_sort(parts.begin(), parts.end(), before);
  for (auto part = parts.begin(); part != parts.end();) {
    Sums sum = **part;
    for (++part; part != parts.end() && (*part)->key() == sum.key(); ++part) sum.add(**part);
    visit(sum);
  }
}

}  // namespace

HostSurfaces::HostSurfaces(const Model& model, const Subdomain& subdomain, const Ranks& ranks)
    : model_(model),
      subdomain_(subdomain),
      ranks_(ranks),
      surfaces_(model),
      bodies_(model, surfaces_, subdomain),
      motion_(surfaces_.parents()),
      step_start_(motion_),
      start_before_(motion_),
      image_(static_cast<std::size_t>(size())),
      placed_(static_cast<std::size_t>(size())),
      extra_travel_(static_cast<std::size_t>(size())),
      step_(static_cast<std::size_t>(size())),
      step_rotation_(step_) {
  for (const ModelMesh& mesh : model.meshes)
    meshes_.push_back(mesh.surface->view()), boxes_.push_back(mesh.surface->box);
  has_axes_.resize(motion_.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    has_axes_[b] = model.bodies[b].kind == BodyKind::spatial;
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    if (surface.kind == SurfaceKind::sphere) continue;
    has_axes_[static_cast<std::size_t>(surface.parent)] = true;
    placed_[s].frame = static_cast<Index>(frames_.size());
    frames_.push_back({identity3(), identity3(), surface.normal, surface.mesh});
    if (surface.kind == SurfaceKind::mesh) span(surface, frames_.back());
    if (!surfaces_.is_on_body(s))
      frames_.back().surface_velocity =
          model.walls[static_cast<std::size_t>(surfaces_.number_of(s))].surface_velocity;
  }
  if (std::ranges::any_of(model.contact.laws, damps_by_mass))
    for (const Body& body : model.bodies) inverse_inertias_.push_back(inverse_inertia(body));
  plan_list(model.contact.skin, kNoMotion);
}

// Determines the periods that a mesh spans: one as long as the periodic domain continues through its sides.
void HostSurfaces::span(const Surface& surface, SurfaceFrame& frame) const {
  const MeshBox& box = boxes_[static_cast<std::size_t>(surface.mesh)];
  const auto parent = static_cast<std::size_t>(surface.parent);
  const Mat3 axes = parent < model_.bodies.size()
                        ? rotation_matrix(orientation(start_motion(model_.bodies[parent])))
                        : identity3();
  const auto length = [](Vec3 row, Vec3 size) {
    return std::abs(row.x) * size.x + std::abs(row.y) * size.y + std::abs(row.z) * size.z;
  };
  const Vec3 size = box.max - box.min, period = subdomain_.period();
  frame.middle = Real(0.5) * (box.min + box.max);
  frame.spanned = {length(axes.x, size) >= period.x ? period.x : 0,
                   length(axes.y, size) >= period.y ? period.y : 0,
                   length(axes.z, size) >= period.z ? period.z : 0};
}

void HostSurfaces::bring_into_box() {
  if (ranks_.is_root()) update_poses(), bodies_.pack_list(poses());
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    image_[s] = {};
    if (surface.kind == SurfaceKind::plane) continue;  // planes have no images
    subdomain_.wrap(point_with(motion_, s) + to_middle(s), image_[s]);
  }
}

Vec3 HostSurfaces::to_middle(Index s) const {
  if (placed_[s].kind != SurfaceKind::mesh) return {};
  const SurfaceFrame& frame = frames_[static_cast<std::size_t>(placed_[s].frame)];
  const Mat3 axes = rotation_matrix(orientation(motion_[surfaces_.at(s).parent]));
  return snap(axes * frame.middle, subdomain_.snap_constant());
}

void HostSurfaces::find_shape_loads(Real h) {
  if (ranks_.is_root()) bodies_.find_loads(poses(), h);
}

void HostSurfaces::take_particle_loads(std::span<const InstantSums> sums) {
  loads_.assign(sums.begin(), sums.end());
  particle_loads_ = loads_.size();
  if (ranks_.is_root()) bodies_.add_sums(loads_);
}

void HostSurfaces::take_steps(std::span<const StepSums> of_particles, Real h) {
  steps_.assign(of_particles.begin(), of_particles.end());
  if (!ranks_.is_root()) return;
  bodies_.find_steps(poses(), h);
  bodies_.add_sums(steps_);
}

void HostSurfaces::reduce(ContactWrenches& step, std::vector<BodyWrench>& end) const {
  std::fill(step.wrench.begin(), step.wrench.end(), BodyWrench{});
  std::fill(end.begin(), end.end(), BodyWrench{});
  step.stiffness.clear();
  step.pairs = bodies_.pairs();  // of rank 0
  // Index of a body's blocks plus one; 0: none yet. A body may occur again, because meshes come after the
  // shapes of all bodies.
  std::vector<std::size_t> block_of(model_.bodies.size());
  for_each_merged(ranks_, steps_, [&](const StepSums& sums) {
    const int body = surfaces_.at(sums.surface).parent;
    end[body] += sums.wrench(), step.wrench[body] += sums.wrench(kWrenchTerms);
    if (!surfaces_.is_on_body(sums.surface)) return;
    std::size_t& own = block_of[static_cast<std::size_t>(body)];
    if (own == 0) step.stiffness.push_back({body, {}, {}}), own = step.stiffness.size();
    WrenchStiffness& blocks = step.stiffness[own - 1];
    for (int k = 0; k < kBlockTerms; ++k) {
      blocks.stiffness[k] += sums.sum[2 * kWrenchTerms + k].value();
      blocks.damping[k] += sums.sum[2 * kWrenchTerms + kBlockTerms + k].value();
    }
  });
}

void HostSurfaces::reduce(std::vector<BodyWrench>& end) const {
  std::vector<std::int64_t> unused;
  reduce(end, unused);
}

void HostSurfaces::reduce(std::vector<BodyWrench>& end, std::vector<std::int64_t>& contacts) const {
  std::fill(end.begin(), end.end(), BodyWrench{});
  contacts.assign(end.size(), 0);
  const auto parent = [this](const InstantSums& sums) {
    return static_cast<std::size_t>(surfaces_.at(sums.surface).parent);
  };
  for_each_merged(ranks_, loads_, [&](const InstantSums& sums) {
    end[parent(sums)] += sums.wrench(), contacts[parent(sums)] += sums.contacts;
  });
  for (std::size_t own = particle_loads_; own < loads_.size() && ranks_.is_root(); ++own)
    contacts[parent(loads_[own])] -= loads_[own].contacts;
}

// count: number of sums; where: maps a surface to its sum.
template <class Where>
std::vector<ContactSum> HostSurfaces::contacts_of(std::size_t count, const Where& where) const {
  std::vector<ContactSum> contacts(count);
  for_each_merged(ranks_, loads_, [&](const InstantSums& sums) {
    ContactSum& sum = contacts[static_cast<std::size_t>(where(sums.surface))];
    const BodyWrench wrench = sums.wrench();
    sum.force += wrench.force, sum.torque += wrench.torque, sum.contacts += sums.contacts;
  });
  return contacts;
}

std::vector<ContactSum> HostSurfaces::parent_contacts() const {
  return contacts_of(motion_.size(), [this](Index surface) { return surfaces_.at(surface).parent; });
}

std::vector<ContactSum> HostSurfaces::surface_contacts() const {
  return contacts_of(static_cast<std::size_t>(surfaces_.placed()), [](Index surface) { return surface; });
}

std::vector<TriangleLoad> HostSurfaces::triangle_loads(std::vector<TriangleSums> contacts) const {
  std::vector<TriangleLoad> loads;
  const std::vector<TriangleSums> of_shapes = bodies_.triangle_sums();  // of rank 0
  contacts.insert(contacts.end(), of_shapes.begin(), of_shapes.end());
  for_each_merged(ranks_, contacts, [&](const TriangleSums& sums) {
    const ExactSum* const t = sums.tangential;
    loads.push_back(
        {sums.surface, sums.triangle, sums.normal.value(), {t[0].value(), t[1].value(), t[2].value()}});
  });
  return loads;
}

void HostSurfaces::accumulate_losses(Real h) {
  if (!ranks_.is_root()) return;
  const BodyContactTotals step = bodies_.totals();
  if (h > 0) bodies_.accumulate_load_works(poses(), h);
  if (model_.rotates()) {
    losses_.contact_loss += h * step.loss_power;
    if (h > 0) losses_.tangential.add(step.losses);
    return;
  }
  losses_.contact_loss += h / 2 * (losses_.loss_power + step.loss_power);
  losses_.loss_power = step.loss_power;
}

void HostSurfaces::book_step() {
  if (!ranks_.is_root()) return;
  const BodyStep step = bodies_.step_totals();
  losses_.contact_loss += step.losses.dissipated, losses_.integrator_loss += step.losses.integrator;
  losses_.tangential.add(step.tangential);
  bodies_.accumulate_step_works(poses());
  bodies_.accept();
}

void HostSurfaces::load(const ShapeLosses& losses) {
  losses_ = ranks_.is_root() ? losses : ShapeLosses{};
  bodies_.load({}), bodies_.clear_works();
}

void HostSurfaces::add_works(std::vector<std::int64_t>& words) const {
  if (ranks_.is_root()) scree::add_works(bodies_.works(), words);
}

ShapeContacts HostSurfaces::shape_contacts() {
  if (!ranks_.is_root()) return {};
  update_poses();
  return bodies_.contacts(poses());
}

std::vector<ContactLine> HostSurfaces::contact_lines() {
  return ranks_.is_root() ? bodies_.lines(poses()) : std::vector<ContactLine>{};
}
ShapePack HostSurfaces::pack() const {
  ShapePack pack;
  std::vector<std::size_t> row(placed_.size(), placed_.size());  // row of each sphere in the pack
  for (Index s = 0; s < size(); ++s) {
    const Surface& surface = surfaces_.at(s);
    if (surface.kind != SurfaceKind::sphere) continue;
    row[s] = pack.body.size();
    pack.body.push_back(surface.parent);
    pack.radius.push_back(surface.radius);
    const PointMotion point = point_motion(motion_[surface.parent], surface.point);
    ImageCount unused;
    pack.position.push_back(subdomain_.wrap(point.position, unused));
    pack.velocity.push_back(point.velocity);
  }
  pack.force.resize(pack.body.size()), pack.contacts.resize(pack.body.size());
  for_each_merged(ranks_, loads_, [&](const InstantSums& sums) {
    const std::size_t at = row[sums.surface];
    if (at == placed_.size()) return;
    pack.force[at] = sums.wrench().force;
    pack.contacts[at] = static_cast<int>(sums.contacts);
  });
  return pack;
}

}  // namespace scree
