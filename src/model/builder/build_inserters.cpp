// Inserters: regions, schedules and the particles that are born there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/box.hpp"
#include "base/mat3.hpp"
#include "model/builder/build_parts.hpp"
#include "model/builder/carriers.hpp"
#include "model/builder/fill_region.hpp"
#include "model/builder/read_mixture.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/frames.hpp"
#include "model/derived/mixture.hpp"
#include "model/derived/space_box.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

namespace {

constexpr Real kMostBirths = 1e9;
// Solid fractions of a stream or region: above the first few random positions are free, above the second
// none is.
constexpr Real kDenseStream = 0.25, kFullStream = 0.55;

// The two sides of a rectangular face, each half of it [m].
void set_face(const DeckTable& table, int dimension, BirthRegion& region) {
  const Vec3 velocity = table.vector("velocity");
  if (velocity == Vec3{}) table.fail("velocity", "missing; particles pass a face with a velocity");
  const bool round = table.has("region_radius");
  if (round == table.has("width"))
    table.fail("width", "exactly one of the keys width and region_radius must be given for a face");
  const Vec3 normal = table.has("normal") ? read_direction(table, "normal") : (1 / norm(velocity)) * velocity;
  if (!(dot(normal, velocity) > 0)) table.fail("normal", "must point to the side that velocity leads to");
  if (dimension == 2) {
    if (round) table.fail("region_radius", "not used in 2D: a face is a line of the length width");
    for (const char* key : {"height", "width_axis"})
      if (table.has(key)) table.fail(key, "not used in 2D: a face is a line of the length width");
    region.half_side[0] = (table.real("width") / 2) * Vec3{-normal.y, normal.x, 0};
    region.size = table.real("width");
    return;
  }
  const Mat3 frame = frame_about(normal);
  Vec3 across = frame.x;
  if (table.has("width_axis")) {
    across = read_direction(table, "width_axis");
    across -= dot(across, normal) * normal;
    if (!(norm(across) > 0)) table.fail("width_axis", "must not be along the normal");
    across = (1 / norm(across)) * across;
  }
  const Vec3 upward = cross(normal, across);
  if (round) {
    const Real radius = table.real("region_radius");
    region.radius = radius, region.half_side[0] = radius * across, region.half_side[1] = radius * upward;
    region.size = std::numbers::pi_v<Real> * radius * radius;
    return;
  }
  const Real width = table.real("width"), height = table.has("height") ? table.real("height") : width;
  region.half_side[0] = (width / 2) * across, region.half_side[1] = (height / 2) * upward;
  region.size = width * height;
}

BirthRegion region_of(const DeckTable& table, const Model& model, const ModelNames& names) {
  constexpr Real pi = std::numbers::pi_v<Real>;
  const int dimension = model.space.dimension;
  BirthRegion region;
  region.kind = table.choice<InserterKind>("kind");
  switch (region.kind) {
    case InserterKind::box: {
      region.min = table.vector("min"), region.max = table.vector("max");
      const Vec3 extent = region.max - region.min;
      if (!(extent.x > 0 && extent.y > 0 && (dimension == 2 || extent.z > 0)))
        table.fail("max", "must be larger than min in every component");
      region.size = extent.x * extent.y * (dimension == 2 ? 1 : extent.z);
      break;
    }
    case InserterKind::cylinder: {
      if (dimension == 2) table.fail("kind", "a cylinder needs 3D; a circle is kind = \"sphere\"");
      region.ends[0] = table.vectors("ends")[0], region.ends[1] = table.vectors("ends")[1];
      region.radius = table.real("region_radius");
      const Real length = norm(region.ends[1] - region.ends[0]);
      if (!(length > 0)) table.fail("ends", "must not coincide");
      region.size = pi * region.radius * region.radius * length;
      break;
    }
    case InserterKind::sphere: {
      region.center = table.vector("center"), region.radius = table.real("region_radius");
      const Real area = pi * region.radius * region.radius;
      region.size = dimension == 2 ? area : Real(4) / 3 * area * region.radius;
      break;
    }
    case InserterKind::mesh: {
      const ClosedMesh closed = closed_mesh(table, model, names);
      region.mesh = closed.mesh, region.mesh_origin = to_global_point(model, closed.body, closed.offset);
      region.mesh_axes = closed.body == kGround ? identity3() : global_frame(model, closed.body, {});
      region.min = closed.min, region.max = closed.max, region.size = dimension == 3 ? closed.volume : 0;
      break;
    }
    case InserterKind::face:
      region.center = table.vector("center");
      set_face(table, dimension, region);
      break;
  }
  return region;
}

Vec3 smaller(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 larger(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

// The box around a region at t = 0 [m].
Box box_around(const BirthRegion& region) {
  const Vec3 a = region.half_side[0], b = region.half_side[1];
  const Vec3 around{std::abs(a.x) + std::abs(b.x), std::abs(a.y) + std::abs(b.y),
                    std::abs(a.z) + std::abs(b.z)};
  const Vec3 r{region.radius, region.radius, region.radius};
  switch (region.kind) {
    case InserterKind::box:
    case InserterKind::mesh:
      return {region.min, region.max};
    case InserterKind::cylinder:
      return {smaller(region.ends[0], region.ends[1]) - r, larger(region.ends[0], region.ends[1]) + r};
    case InserterKind::sphere:
      return {region.center - r, region.center + r};
    case InserterKind::face:
      break;
  }
  return {region.center - around, region.center + around};
}

// Refuses a region in which no position is free for the largest particles, or that is outside the domain.
void check_room(const DeckTable& table, const Model& model, const Inserter& inserter) {
  const BirthRegion& region = inserter.region;
  const bool planar = model.space.dimension == 2;
  const Real radius = inserter.mixture->largest_radius();
  const Vec3 extent = region.max - region.min;
  Real room = kInfinity;  // for a radius
  if (region.kind == InserterKind::box || region.kind == InserterKind::mesh)
    room = std::min({extent.x, extent.y, planar ? kInfinity : extent.z}) / 2;
  if (region.kind == InserterKind::sphere || region.kind == InserterKind::cylinder) room = region.radius;
  if (region.kind == InserterKind::cylinder) room = std::min(room, norm(region.ends[1] - region.ends[0]) / 2);
  if (radius > room)
    table.fail("kind",
               fmt::format("the largest particles, of radius {} m, do not fit into the region; it has "
                           "room for radii up to {:.4g} m",
                           radius, room));
  if (inserter.carrier != kGround) return;
  const Box box = box_around(region);
  const Box domain = open_box(model.space);
  for (Real Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
    if (box.max.*axis < domain.min.*axis || box.min.*axis > domain.max.*axis)
      table.fail("kind", "the region is outside the domain of [space]");
}

// The end of the births [s].
Real end_of(const DeckTable& table, bool at_once) {
  const Real start = table.real("start");
  if (!table.has("end")) return at_once ? start : kInfinity;
  if (table.real("end") <= start) table.fail("end", fmt::format("must be above start = {} s", start));
  return table.real("end");
}

// The total that the deck gives, in the unit of the amount; infinite where it gives none.
Real total_of(const DeckTable& table, const BirthRegion& region, Amount amount) {
  switch (amount) {
    case Amount::number:
      return table.has("number") ? static_cast<Real>(table.integer("number")) : kInfinity;
    case Amount::mass:
      return table.has("mass_total") ? table.real("mass_total") : kInfinity;
    case Amount::volume:
      break;
  }
  return table.real("solid_fraction") * region.size;
}

Amount amount_of(const DeckTable& table, const BirthRegion& region) {
  const bool numbers = table.has("number") || table.has("number_rate"),
             masses = table.has("mass_total") || table.has("mass_rate"), fills = table.has("solid_fraction");
  if (numbers + masses + fills != 1)
    table.fail(
        "number",
        "exactly one measure of the births must be given: number or number_rate or both, mass_total or "
        "mass_rate or both, or solid_fraction");
  if (fills && region.kind == InserterKind::face)
    table.fail("solid_fraction", "not used for a face, which has no volume");
  if (fills && region.size == 0)
    table.fail("solid_fraction", "not used for a mesh in 2D; number or mass_total gives its particles");
  return numbers ? Amount::number : masses ? Amount::mass : Amount::volume;
}

std::vector<Real> rate_times(const DeckTable& table, const std::vector<Real>& factors) {
  const std::vector<Real>& times = table.reals("rate_times");
  if (times.size() != factors.size())
    table.fail("rate_factors", fmt::format("must have as many entries as rate_times: {}", times.size()));
  if (times.size() == 1) table.fail("rate_times", "must have at least two entries");
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(times[k] > times[k - 1])) table.fail("rate_times", "must increase");
  for (const char* key : {"start", "end"})
    if (!times.empty() && table.gives(key)) table.fail(key, "not used together with rate_times");
  if (!times.empty() && times.front() < 0) table.fail("rate_times", "must not be negative");
  return times;
}

BirthSchedule schedule_of(const DeckTable& table, const Inserter& inserter) {
  const Real total = total_of(table, inserter.region, inserter.amount);
  const char* const key = inserter.amount == Amount::mass ? "mass_rate" : "number_rate";
  const bool has_rate = table.has("number_rate") || table.has("mass_rate");
  std::vector<Real> rates = table.reals("rate_factors"), times = rate_times(table, rates);
  if (!has_rate) {
    if (!times.empty()) table.fail("rate_times", "needs number_rate or mass_rate");
    const Real start = table.real("start"), end = end_of(table, true);
    if (end <= start) return BirthSchedule::at_once(start, total);
    return BirthSchedule::by_rate({start, end}, {total / (end - start), total / (end - start)}, total);
  }
  const Real rate = table.real(key);
  if (times.empty())
    return BirthSchedule::by_rate({table.real("start"), end_of(table, false)}, {rate, rate}, total);
  for (Real& factor : rates) factor *= rate;
  return BirthSchedule::by_rate(std::move(times), std::move(rates), total);
}

// The key `interval`, or its default (see the manual) [s].
Real interval_of(const DeckTable& table, const Model& model, const Inserter& inserter) {
  if (table.has("interval")) return table.real("interval");
  const Mixture& mixture = *inserter.mixture;
  if (inserter.region.kind == InserterKind::face)
    return 2 * mixture.largest_radius() / norm(inserter.velocity);
  const Real g = norm(model.gravity);
  if (g == 0) table.fail("interval", "missing; without gravity it must be a number of at least 0 [s]");
  return std::sqrt(4 * mixture.smallest_radius() / g);
}

// A bound for the number of particles until the end of the run, from the smallest particles.
std::int64_t most_births(const DeckTable& table, const Model& model, const Inserter& inserter) {
  const Mixture& mixture = *inserter.mixture;
  const Real amount = inserter.schedule.due(model.time.end);
  const Real smallest = inserter.amount == Amount::number ? 1
                        : inserter.amount == Amount::mass
                            ? mixture.smallest_mass()
                            : solid_size(mixture.smallest_radius(), model.space.dimension);
  const Real births = std::floor(amount / smallest * (1 + 1e-9));
  if (!(births <= kMostBirths))
    table.fail(inserter.amount == Amount::number ? "number_rate" : "mass_rate",
               fmt::format("up to {:.3g} particles would be born until time.end; at most {:.3g} may be",
                           births, kMostBirths));
  return static_cast<std::int64_t>(births);
}

// Refuses a stream that is denser than a packing, and warns of one in which positions are rarely free.
void check_density(const DeckTable& table, const Inserter& inserter, int dimension, Log& log) {
  const BirthRegion& region = inserter.region;
  const Mixture& mixture = *inserter.mixture;
  Real fraction = 0;
  if (region.kind == InserterKind::face) {
    const Real each =
        inserter.amount == Amount::mass ? mixture.mean_volume() / mixture.mean_mass() : mixture.mean_volume();
    const Vec3 across = dimension == 2 ? Vec3{0, 0, 1} : region.half_side[1];
    const Vec3 normal = cross(region.half_side[0], across);
    const Real through = std::abs(dot(inserter.velocity, normal)) / norm(normal);
    fraction = inserter.schedule.largest_rate() * each / (region.size * through);
  } else if (inserter.schedule.largest_rate() == kInfinity) {
    const Real total = inserter.schedule.total();
    fraction = (inserter.amount == Amount::volume   ? total
                : inserter.amount == Amount::number ? total * mixture.mean_volume()
                                                    : total / mixture.mean_mass() * mixture.mean_volume()) /
               region.size;
  }
  const char* const remedy = region.kind == InserterKind::face
                                 ? "a larger face, a higher velocity or a lower rate is needed"
                                 : "a larger region or fewer particles are needed";
  const std::string what = fmt::format("the particles would take {:.2g} of the {}", fraction,
                                       region.kind == InserterKind::face ? "stream's volume" : "region");
  if (fraction > kFullStream)
    table.fail("kind",
               fmt::format("{}, more than random positions can fill ({}); {}", what, kFullStream, remedy));
  if (fraction > kDenseStream)
    log.warning(fmt::format("{}: {}: above {} many random positions are occupied, and births are late; {}",
                            table.label(), what, kDenseStream, remedy));
}

// Adds the particles of an inserter to the totals of the model.
void declare(const Inserter& inserter, Model& model) {
  const Mixture& mixture = *inserter.mixture;
  const int dimension = model.space.dimension;
  const Box box = box_around(inserter.region);
  for (int c = 0; c < std::ssize(mixture.components()); ++c) {
    const MixtureComponent& component = mixture.components()[static_cast<std::size_t>(c)];
    BornParticles born;
    born.smallest_radius = component.radius.smallest(), born.largest_radius = component.radius.largest();
    born.smallest_mass = mixture.smallest_mass_of(c), born.largest_mass = mixture.largest_mass_of(c);
    // Of the smallest and the largest particle, which need not be the extremes where masses are given.
    const Real ends[] = {born.smallest_mass / sphere_mass(born.smallest_radius, 1),
                         born.largest_mass / sphere_mass(born.largest_radius, 1)};
    born.smallest_density = std::min(ends[0], ends[1]), born.largest_density = std::max(ends[0], ends[1]);
    born.smallest_inertia_factor =
        component.inertia_factor > 0 ? component.inertia_factor : solid_inertia_factor(dimension);
    born.most_speed =
        norm(inserter.velocity) + std::sqrt(static_cast<Real>(dimension)) * inserter.random_velocity;
    born.lowest = box.min, born.highest = box.max, born.material = component.material;
    born.count =
        std::llround(std::ceil(mixture.share_of_component(c) * static_cast<Real>(inserter.most_births)));
    add_births(model.particles.totals, born);
  }
  model.particles.totals.count += inserter.most_births;
}

}  // namespace

void build_inserters(const DeckTable& deck, Model& model, const ModelNames& names, Log& log) {
  for (const DeckTable& table : deck.tables("inserters")) {
    Inserter inserter;
    inserter.name = table.text("name");
    for (const ParticleGroup& group : model.particles.groups)
      if (group.name == inserter.name)
        table.fail("name", "is the name of a group of particles or of another inserter");
    inserter.carrier = carrier_of(table, model, names);
    inserter.velocity = table.vector("velocity");
    inserter.random_velocity = table.real("random_velocity");
    inserter.region = region_of(table, model, names);
    inserter.amount = amount_of(table, inserter.region);
    inserter.seed = table.integer("seed");
    inserter.mixture = std::make_shared<const Mixture>(read_mixture(table, names, model.space.dimension));
    inserter.schedule = schedule_of(table, inserter);
    inserter.interval = checked_interval(table, model, interval_of(table, model, inserter));
    inserter.gap = table.real("gap"), inserter.tries = table.integer("tries");
    inserter.blocked = table.choice<BlockedPolicy>("blocked");
    if (table.has("most_waiting") && inserter.blocked != BlockedPolicy::wait)
      table.fail("most_waiting", "used with blocked = \"wait\" only");
    if (table.has("most_waiting")) inserter.most_waiting = table.integer("most_waiting");
    inserter.most_births = most_births(table, model, inserter);
    if (inserter.most_births == 0)  // a part of a longer run may end before
      log.warning(
          fmt::format("{}: no particle is born until time.end = {} s", table.label(), model.time.end));
    check_room(table, model, inserter);
    check_density(table, inserter, model.space.dimension, log);
    declare(inserter, model);
    model.particles.groups.push_back({inserter.name, model.particles.totals.at_start});
    model.inserters.push_back(std::move(inserter));
  }
  model.particles.inserters = static_cast<int>(model.inserters.size());
}

}  // namespace scree
