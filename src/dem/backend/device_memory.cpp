// Device memory of a model, counted from the arrays of cuda/. A GPU test compares it with the actual usage.
#include <fmt/format.h>

#include <algorithm>

#include "dem/backend/backend.hpp"
#include "dem/backend/device.hpp"
#include "dem/explicit/mixed_items.hpp"
#include "dem/history/packed_history.hpp"
#include "dem/host/host_surfaces.hpp"
#include "dem/implicit/rotation_items.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/output_fields.hpp"
#include "dem/reports/triangle_works.hpp"
#include "dem/search/neighbor_list.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/choose_law.hpp"
#include "partition/halo.hpp"

namespace scree {
namespace {

// Bytes per particle or item, by the array groups of cuda/cuda_*.cuh.
constexpr double kItemFields = bytes_in_arrays<kItemArrays>();
constexpr double kSecondMotion = bytes_in_arrays<kMotion>();
constexpr double kOwnedFields = bytes_in_arrays<kOwnedArrays>();
constexpr double kSpinFields = bytes_in_arrays<kSpins>();  // where particles rotate; twice
constexpr double kOwnedSpinFields = bytes_in_arrays<kOwnedSpins>();
constexpr double kRollingFields = bytes_in_arrays<kOwnedRolling>();  // where contacts resist rolling
// Of implicit steps; twice where particles rotate.
constexpr double kStartAcceleration = sizeof(Vec3);
constexpr double kRowArrays = 2 * sizeof(Index);  // lengths of rows, and offsets of the surfaces' rows
// With the sorted keys and their order.
constexpr double kGhostArrays = sizeof(Ghost) + 4 * sizeof(Index) + sizeof(Index);
constexpr double kStepArrays =
    5 * sizeof(Vec3) + 2 * sizeof(Real) + sizeof(Index) + 2 * sizeof(Sym3) + 2 * sizeof(Vec4);
// SixFreedomArrays, in place of matrix and solver arrays, for implicit steps with friction.
constexpr double kFrictionArrays = 6 * sizeof(Vec3) + 3 * sizeof(Real) + 2 * sizeof(Index) + sizeof(Vec4) +
                                   sizeof(ScaledMass) + sizeof(Block6f) + sizeof(Twist) + 3 * sizeof(Twistf);
constexpr double kMixedArrays = sizeof(MixedFraction) + sizeof(MixedRest);
constexpr double kStepArraysPerSlot = sizeof(ContactEntry);
constexpr double kFrictionArraysPerSlot =
    sizeof(FrictionEntry::Normal) + sizeof(FrictionEntry::SlipDirection) + sizeof(FrictionEntry::Shear) +
    sizeof(Real);                                               // the last: lagged limits
constexpr double kRollingArraysPerSlot = sizeof(RollingEntry);  // of laws with rolling resistance
constexpr double kReportArrays = 2 * sizeof(Real) + 3 * sizeof(Index) + 2 * sizeof(GlobalId) +
                                 sizeof(GlobalId) + sizeof(Index);  // the last two: the library's buffers
constexpr double kSpinReportArrays = sizeof(SpringEnergies);
constexpr double kCohesionReportArrays = sizeof(Real);  // where contacts have adhesion
// Bytes per placed surface, and per entry of the surfaces' rows where there are any: DeviceSurfaces.
constexpr double kSurfaceArrays =
    2 * sizeof(SurfacePose) + sizeof(SurfaceFrame) + sizeof(FreeBody) + 2 * sizeof(Vec3);
// The same for walls with prescribed motion and conveyors, in explicit steps: the rows of DrivenSurfaces.
constexpr double kDrivenArrays = 128 * (sizeof(SurfacePose) + sizeof(SurfaceFrame));
constexpr double kEntryArrays = 2 * sizeof(Index) + sizeof(std::int8_t) + 4 * sizeof(Index) +
                                2 * sizeof(SurfaceLoad) + sizeof(SurfaceStep) +
                                (sizeof(InstantSums) + 5 * sizeof(Index)) / 32.0;  // per warp of entries
// Bytes per entry, group and triangle with meshes: DeviceMeshes.
constexpr double kTouchArrays = sizeof(MeshTouch), kTouchArraysOverStep = sizeof(MeshTouchBefore);
// Some two particles are near a box of a mesh's tree where one has a group.
constexpr double kGroupArrays = 3 * 2 * sizeof(Index) + sizeof(MeshGroup) + sizeof(CachedContact),
                 kRowOfTriangle = sizeof(Index);
constexpr double kSpareCapacity = 1.125;  // capacity over size of arrays that may grow with every list
constexpr double kFilledSlots = 0.8;      // of a list of a settled bed; only these have a contact history
constexpr double kCellBytes = sizeof(Index);
constexpr double kCellBlockMargin = 1.1;  // cells that fill up the last cell blocks

// Bytes per particle of a snapshot.
double output_bytes(const Output& output) {
  double bytes = sizeof(Vec3);
  for (const OutputField& field : computed_fields(output)) bytes += static_cast<double>(field.bytes);
  return bytes;
}

struct Sizes {
  double particles, ghosts, items, cells, slots;
  bool on_bodies;                     // whether there are placed surfaces
  double entries, groups, triangles;  // of the surfaces' rows
};

bool equal_radii(const Model& model) {
  const auto [smallest, largest] =
      std::minmax_element(model.particles.radius.begin(), model.particles.radius.end());
  return model.particles.size() == 0 || *largest <= 1.2 * *smallest;
}

// Slots of a list in slices of 32 rows, for the initial particles.
double slots_at_start(const ParticleStore& store, const ItemLayout& layout, NeighborBuilder& builder,
                      Real skin) {
  constexpr Index kSlice = 32;
  NeighborList list;
  builder.build(store, layout, builder.cells(skin, layout.owned), {}, skin, list);
  double slots = 0;
  for (Index first = 0; first < layout.owned; first += kSlice) {
    Index width = 0;
    for (Index i = first; i < std::min(first + kSlice, layout.owned); ++i)
      width = std::max(width, list.offsets[i + 1] - list.offsets[i]);
    slots += static_cast<double>(width) * kSlice;
  }
  return slots;
}

// Surface rows of the initial particles and bodies.
SurfaceRows rows_at_start(const Model& model, const ParticleStore& store, const ItemLayout& layout,
                          NeighborBuilder& builder) {
  const Subdomain subdomain(model.space);
  HostSurfaces side(model, subdomain, Ranks());
  std::vector<BodyMotion> motion;
  for (const Body& body : model.bodies) motion.push_back(start_motion(body));
  motion.resize(side.surfaces().parents());  // walls start at their initial poses
  side.set_motion(motion);
  side.bring_into_box(), side.update_poses();
  SurfaceRows rows;
  builder.build_surfaces(store, layout, builder.cells(model.contact.skin, layout.owned), {side.poses()},
                         model.contact.skin, rows);
  return rows;
}

// Device memory of a mesh [B], with or without contacts: the arrays of a MeshView.
double bytes_of_mesh(const SurfaceMesh& mesh) {
  const auto of = [](const auto& values) {
    return static_cast<double>(values.size() * sizeof(values.front()));
  };
  return of(mesh.vertices) + of(mesh.triangles) + of(mesh.parts) + of(mesh.features) + of(mesh.tests) +
         of(mesh.patches) + of(mesh.first_neighbour) + of(mesh.neighbours) + of(mesh.boxes);
}

Sizes sizes_of(const Model& model) {
  const Subdomain subdomain(model.space);
  NeighborBuilder builder(model);
  const Real skin = model.contact.skin;
  const bool periodic = subdomain.period() != Vec3{}, equal = equal_radii(model);
  const Index particles = count_on_rank(model.particles.size(), model.particles.totals);
  Sizes sizes{};
  sizes.on_bodies = SurfaceSet(model).placed() > 0;
  sizes.particles = static_cast<double>(particles);
  ParticleStore store;  // filled only where needed, because it is as large as the model
  if (periodic || !equal || sizes.on_bodies) store.load(initial_records(model.particles, subdomain));
  ItemLayout layout;
  layout.owned = layout.active = layout.items = store.owned;
  if (periodic) {
    const HaloPlan halo({}, {}, subdomain, builder.cutoff(skin));
    for (const Vec4& p : store.position)
      halo.for_each_target(xyz(p), [&](const HaloTarget&) { ++sizes.ghosts; });
  }
  sizes.items = sizes.particles + sizes.ghosts;
  sizes.cells = kCellBlockMargin * static_cast<double>(builder.grid(skin, particles).count());
  sizes.slots = slots_per_particle(model) * sizes.particles;
  if (sizes.on_bodies) {
    const SurfaceRows rows = rows_at_start(model, store, layout, builder);
    sizes.entries = static_cast<double>(rows.surfaces.size());
    sizes.groups = static_cast<double>(rows.groups.size());
    sizes.triangles = static_cast<double>(rows.triangles.size());
  }
  if (!equal) sizes.slots = std::max(sizes.slots, kListSlack * slots_at_start(store, layout, builder, skin));
  // Inserters' particles, as if all of them were on this rank.
  const double born = static_cast<double>(model.particles.totals.count - model.particles.totals.at_start);
  sizes.particles += born, sizes.items += born, sizes.slots += slots_per_particle(model) * born;
  return sizes;
}

// Scratch memory of explicit steps beside the list: `DeviceArena`.
double bytes_of_steps(const Model& model, const Sizes& n) {
  // Row indices of the inner pair list; they alias the forces if they fit.
  const double row_indices = history_of(model.contact) > 0 ? n.slots * sizeof(std::uint16_t) : 0;
  double of_steps = n.particles * sizeof(Vec3) + n.slots * sizeof(Index);
  if (row_indices > n.particles * sizeof(Vec3)) of_steps += row_indices;
  // Where particles rotate, these alias arrays of the instant.
  if (model.integrator.precision == Precision::mixed && !n.on_bodies && !model.rotates() &&
      !model.is_cohesive())
    of_steps += n.particles * kMixedArrays;
  return of_steps;
}

// The list, the contact history at its entries, and the scratch memory that explicit steps share with the
// packed history, as far as that does not fit into the second arrays.
double list_bytes(const Model& model, const Sizes& n, bool explicit_steps) {
  const int numbers = history_of(model.contact);
  double bytes = n.particles * kRowArrays + n.slots * sizeof(Index) +
                 n.cells * kCellBytes * (n.items > n.particles ? 2 : 1);
  if (numbers > 0) {
    const double at_once = std::min<double>(n.particles, kRowsAtOnce) * kContactsPerRow;
    bytes += kFilledSlots * n.slots * records_of(numbers) * sizeof(Vec4) + 3 * n.particles * sizeof(Index) +
             at_once * (sizeof(std::int64_t) + static_cast<double>(numbers) * sizeof(Real));
  }
  const double second = n.items * (kSecondMotion + (model.rotates() ? kSpinFields : 0)),
               packed = std::max(0.0, n.particles * history_bytes(numbers, 0) - second);
  if (!explicit_steps) return bytes + packed + n.particles * sizeof(Vec3);
  return bytes + n.particles * sizeof(Index) + std::max(packed, bytes_of_steps(model, n));
}

double field_bytes(const Model& model, const Sizes& n, bool explicit_steps) {
  const double spare = n.ghosts > 0 ? 1.125 : 1;  // arrays that grow when ghosts are found
  double bytes = n.items * (kItemFields * spare + kSecondMotion) + n.particles * kOwnedFields;
  if (model.rotates())
    bytes += n.items * kSpinFields * (spare + 1) + n.particles * (kOwnedSpinFields + kSpinReportArrays);
  if (model.rolls()) bytes += n.particles * kRollingFields;
  if (model.is_cohesive()) bytes += n.particles * kCohesionReportArrays;
  if (!explicit_steps) bytes += n.particles * kStartAcceleration * (model.rotates() ? 2 : 1);
  return bytes;
}

double friction_bytes_per_slot(const Model& model) {
  return kFrictionArraysPerSlot + (model.rolls() || model.is_cohesive() ? kRollingArraysPerSlot : 0);
}

// Placed surfaces, their contacts, and the history of these.
double surface_bytes(const Model& model, const Sizes& n) {
  if (!n.on_bodies) return 0;
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  double per_entry = kSpareCapacity * kEntryArrays;
  if (implicit && model.rotates())
    per_entry += kSpareCapacity * sizeof(SurfaceFriction) + friction_bytes_per_slot(model);
  if (model.output.contacts) per_entry += kSpareCapacity * sizeof(ShownContact);
  if (const HistoryContent content = packed_content(model, history_of(model.contact)); content.exists())
    per_entry += kSpareCapacity * (3 * records_of(content.values) * sizeof(Vec4) + 2 * sizeof(Index));
  const SurfaceSet surfaces(model);
  const bool driven = !implicit && model.bodies.empty() && !surfaces.is_static();
  const double bytes =
      (kSurfaceArrays + (driven ? kDrivenArrays : 0)) * static_cast<double>(surfaces.placed());
  if (!model.meshes.empty())
    per_entry += kSpareCapacity * (kTouchArrays + (implicit ? kTouchArraysOverStep : 0));
  return bytes + per_entry * n.entries +
         kSpareCapacity * (kGroupArrays * n.groups + kRowOfTriangle * n.triangles);
}

}  // namespace

// Slots per particle of a settled bed of equal particles: a slice of 32 rows is as wide as its longest row.
double slots_per_particle(const Model& model) {
  constexpr double kDiscs = 8, kSpheres = 9.5, kPerDiameter = 15, kMost = 16;
  if (model.space.dimension == 2) return kDiscs;
  const Real range = model.contact.skin + model.contact.interaction_range,
             diameter = 2 * model.particles.totals.largest_radius;
  return diameter > 0 ? std::min(kMost, kSpheres + kPerDiameter * range / diameter) : kSpheres;
}

std::size_t device_memory_of_meshes(const Model& model) {
  double bytes = static_cast<double>(TriangleWorks(model).triangles() * sizeof(TriangleWork));
  for (const ModelMesh& mesh : model.meshes) bytes += sizeof(MeshView) + bytes_of_mesh(*mesh.surface);
  return static_cast<std::size_t>(bytes);
}

std::size_t device_memory_near_mesh(const Model& model) {
  constexpr double kTrianglesInRow = 10;  // with triangles of the particle's size
  Sizes none{};
  none.on_bodies = true;
  Sizes one = none;
  one.entries = one.groups = 1, one.triangles = kTrianglesInRow;
  return static_cast<std::size_t>(surface_bytes(model, one) - surface_bytes(model, none));
}

std::size_t device_memory(const Model& model) {
  const Sizes n = sizes_of(model);
  const bool explicit_steps = model.integrator.particles == ParticleIntegrator::velocity_verlet;
  double bytes = field_bytes(model, n, explicit_steps) + kSpareCapacity * n.ghosts * kGhostArrays +
                 list_bytes(model, n, explicit_steps);
  if (!explicit_steps)
    bytes += model.rotates() ? n.items * kFrictionArrays + n.slots * friction_bytes_per_slot(model)
                             : n.items * kStepArrays + n.slots * kStepArraysPerSlot;
  bytes += surface_bytes(model, n) + static_cast<double>(device_memory_of_meshes(model));
  bytes += n.particles * (kReportArrays + output_bytes(model.output)) +
           static_cast<double>(kRecordsAtOnce) * sizeof(Particle);
  if (model.output.contacts)
    bytes += n.particles * sizeof(Index) + static_cast<double>(kLinesAtOnce) * sizeof(ContactLine);
  return static_cast<std::size_t>(bytes);
}

// The ranks of a GPU may read its free memory at different times: the smallest value counts.
DeviceLoad load_of_device(std::span<const DeviceClaim> claims, int own) {
  const DeviceClaim& own_claim = claims[static_cast<std::size_t>(own)];
  DeviceLoad load{.free = own_claim.free};
  for (const DeviceClaim& claim : claims) {
    if (claim.device != own_claim.device) continue;
    load.needed += claim.needed, load.free = std::min(load.free, claim.free), ++load.ranks;
  }
  return load;
}

std::string device_memory_trouble(std::span<const DeviceClaim> claims, int own, const std::string& name) {
  const DeviceLoad load = load_of_device(claims, own);
  if (load.needed <= load.free) return "";
  const std::string subject = load.ranks == 1
                                  ? "the model needs about "
                                  : fmt::format("{} ranks share a GPU and together need about ", load.ranks);
  return fmt::format("{}{} MB of device memory, {} MB are free on {}", subject, load.needed / 1000000,
                     load.free / 1000000, name);
}

}  // namespace scree
