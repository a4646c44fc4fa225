// Groups of particles: positions, sizes, masses and velocities.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>

#include "deck/choices.hpp"
#include "model/builder/build_parts.hpp"
#include "model/builder/fill_region.hpp"
#include "model/builder/mean_mass.hpp"
#include "model/builder/particle_file.hpp"
#include "model/checks/plausibility.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/generators.hpp"
#include "model/derived/posed_meshes.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

namespace {

// One group while it is built: this rank's part of it. Random numbers are drawn in the order radius, mass,
// position, velocity, for all particles on every rank: a particle does not depend on its owner.
class Group {
 public:
  Group(const DeckTable& table, const ModelNames& names, const Model& model)
      : table_(table),
        model_(model),
        names_(names),
        random_(static_cast<std::uint64_t>(table.integer("seed"))),
        kind_(table.choice<GroupKind>("kind")),
        material_(find_material(names, table, "material")),
        density_(names.densities[static_cast<std::size_t>(material_)]),
        count_(count_of()) {}

  std::int64_t count() const { return count_; }
  std::string name_or(std::int64_t number) const {
    return table_.has("name") ? table_.text("name") : std::to_string(number);
  }
  std::optional<MeanMass> expected_mass() const {
    return has_column("mass") ? std::nullopt : mean_mass(table_, density_, model_.space.dimension);
  }
  bool is_random() const { return kind_ == GroupKind::random; }
  void note_thickness(DiscThickness& discs) const;
  void warn_if_empty(Log& log) const;
  // Adds the particles of `part`, indices within the group. placed: the items that a random group must avoid.
  void append_to(ParticleSet& particles, IdRange part, const std::vector<StartItem>& placed);

 private:
  std::int64_t count_of();
  std::int64_t lattice_count() const;
  void place_regular();
  void place_row();
  void place_lattice();
  void place_random(const std::vector<StartItem>& placed, RandomNumbers before_radii);
  // Values of the quantity `key` of the particles `part`. mass_power: as of Distribution.
  std::vector<Real> drawn(const char* key, int mass_power, IdRange part, RandomNumbers& random) const {
    return draw(read_distribution(table_.table(key), mass_power), count_, part, random);
  }
  std::vector<Real> radii();
  std::vector<Real> masses(const std::vector<Real>& radius);
  std::vector<Real> masses_from_density(const std::vector<Real>& radius);
  std::vector<Vec3> velocities();
  Vec3 common_angular_velocity() const;
  std::vector<Vec3> angular_velocities() const;
  std::vector<Real> inertia_factors() const;
  std::array<std::int64_t, 3> lattice_size() const;
  Vec3 lattice_origin() const;
  std::vector<Vec3> vectors_of(const std::string& prefix) const;
  const char* mass_key() const {
    return has_column("mass") ? "file" : table_.has("mass") ? "mass" : "radius";
  }
  bool has_column(const std::string& name) const { return file_ && file_->has(name); }

  const DeckTable& table_;
  const Model& model_;
  const ModelNames& names_;
  RandomNumbers random_;
  GroupKind kind_;
  int material_;
  Real density_;
  std::optional<ParticleFile> file_;
  std::int64_t count_;
  IdRange part_;
  ParticleColumns columns_;  // this rank's part of the file
  std::vector<Vec3> position_;
};

// Number of particles in the whole group.
std::int64_t Group::count_of() {
  switch (kind_) {
    case GroupKind::list:
      return std::ssize(table_.vectors("positions"));
    case GroupKind::row:
    case GroupKind::random:
      if (!table_.has("count")) table_.fail("count", "missing; it must be an integer of at least 1");
      return table_.integer("count");
    case GroupKind::lattice:
      return lattice_count();
    case GroupKind::file:
      return file_.emplace(table_.text("file"), model_.space.dimension).count();
  }
  throw std::logic_error("a group of particles of no kind");
}

std::int64_t Group::lattice_count() const {
  const std::array<std::int64_t, 3> size = lattice_size();
  const std::int64_t places = size[0] * size[1] * size[2];
  const std::int64_t count = table_.has("count") ? table_.integer("count") : places;
  if (count > places)
    table_.fail("count", fmt::format("must be at most {}, the number of lattice sites", places));
  return count;
}

void Group::warn_if_empty(Log& log) const {
  if (file_ && count_ == 0)
    log.warning(fmt::format("{}.file = \"{}\": the file has no rows; the group has no particles",
                            table_.path(), table_.text("file")));
  if (kind_ == GroupKind::list && count_ == 0)
    log.warning(fmt::format("{}.positions = []: the group has no particles", table_.path()));
}

void Group::note_thickness(DiscThickness& discs) const {
  if (model_.space.dimension == 3 || count_ == 0 || has_column("mass") || table_.has("mass")) return;
  const Real thickness = table_.real("thickness");
  discs.smallest = discs.largest == 0 ? thickness : std::min(discs.smallest, thickness);
  discs.largest = std::max(discs.largest, thickness);
}

void Group::append_to(ParticleSet& particles, IdRange part, const std::vector<StartItem>& placed) {
  part_ = part;
  if (file_) columns_ = file_->read(part);
  if (!is_random()) place_regular();
  const RandomNumbers before_radii = random_;
  const std::vector<Real> radius = radii(), mass = masses(radius);
  for (const Real r : radius) check_normal(table_, has_column("radius") ? "file" : "radius", r);
  for (const Real m : mass) check_normal(table_, mass_key(), m);
  if (is_random()) place_random(placed, before_radii);
  const std::vector<Vec3> velocity = velocities();
  const std::size_t before = particles.position.size();
  particles.position.insert(particles.position.end(), position_.begin(), position_.end());
  particles.velocity.insert(particles.velocity.end(), velocity.begin(), velocity.end());
  const std::vector<Vec3> spin = angular_velocities();
  if (!spin.empty()) particles.angular_velocity.resize(before);
  particles.angular_velocity.insert(particles.angular_velocity.end(), spin.begin(), spin.end());
  if (!particles.angular_velocity.empty()) particles.angular_velocity.resize(particles.position.size());
  const std::vector<Real> factors = inertia_factors();
  const Real solid = solid_inertia_factor(model_.space.dimension);
  if (!factors.empty()) particles.inertia_factor.resize(before, solid);
  particles.inertia_factor.insert(particles.inertia_factor.end(), factors.begin(), factors.end());
  if (!particles.inertia_factor.empty()) particles.inertia_factor.resize(particles.position.size(), solid);
  particles.radius.insert(particles.radius.end(), radius.begin(), radius.end());
  particles.mass.insert(particles.mass.end(), mass.begin(), mass.end());
  particles.material.insert(particles.material.end(), radius.size(), material_);
}

std::array<std::int64_t, 3> Group::lattice_size() const {
  const std::vector<std::int64_t>& size = table_.integers("size");
  const auto axes = static_cast<std::size_t>(model_.space.dimension);
  if (size.size() != axes) table_.fail("size", fmt::format("must have {} entries", axes));
  constexpr Real kMost = 1e9;
  Real places = 1;
  for (const std::int64_t along : size) places *= static_cast<Real>(along);
  if (places > kMost) table_.fail("size", fmt::format("must have at most {} places", kMost));
  return {size[0], size[1], axes == 3 ? size[2] : 1};
}

Vec3 Group::lattice_origin() const {
  if (table_.has("origin") == table_.has("center"))
    table_.fail("origin", "exactly one of the keys origin and center must be given");
  if (table_.has("origin")) return table_.vector("origin");
  const std::array<std::int64_t, 3> size = lattice_size();
  const Vec3 spacing = table_.vector("spacing");
  const auto half = [](std::int64_t places) { return static_cast<Real>(places - 1) / 2; };
  return table_.vector("center") -
         Vec3{half(size[0]) * spacing.x, half(size[1]) * spacing.y, half(size[2]) * spacing.z};
}

void Group::place_regular() {
  switch (kind_) {
    case GroupKind::list:
      position_.assign(table_.vectors("positions").begin() + part_.first,
                       table_.vectors("positions").begin() + part_.last);
      return;
    case GroupKind::row:
      return place_row();
    case GroupKind::lattice:
      return place_lattice();
    case GroupKind::file:
      position_ = vectors_of("");
      return;
    case GroupKind::random:
      break;  // done by place_random
  }
  throw std::logic_error("a group of particles without an order");
}

void Group::place_row() {
  if (!table_.has("origin")) table_.fail("origin", "missing; it must be the centre of the first particle");
  const Vec3 origin = table_.vector("origin"), spacing = table_.vector("spacing");
  position_.reserve(static_cast<std::size_t>(part_.size()));
  for (std::int64_t i = part_.first; i < part_.last; ++i)
    position_.push_back(origin + static_cast<Real>(i) * spacing);
}

void Group::place_lattice() {
  const std::array<std::int64_t, 3> size = lattice_size();
  const Vec3 origin = lattice_origin(), spacing = table_.vector("spacing");
  position_.reserve(static_cast<std::size_t>(part_.size()));
  for (std::int64_t i = part_.first; i < part_.last; ++i)
    position_.push_back(lattice_position(origin, spacing, size, i));
}

// Each position depends on all earlier ones: every rank computes all of them and keeps its part.
void Group::place_random(const std::vector<StartItem>& placed, RandomNumbers before_radii) {
  const FillRegion region(table_, model_, names_);
  PackingBox box = region.packing(table_.real("gap"), table_.integer("tries"));
  const PosedMeshes meshes(model_);
  const auto clear = [&](Vec3 p, Real r, Real gap) {
    return is_clear_of_planes(model_, p, r) && meshes.is_clear(p, r, gap);
  };
  if (!region.is_box()) box.share = region.share([&](Vec3 p, Real r) { return clear(p, r, 0); });
  if (box.share == 0)
    table_.fail("count",
                fmt::format("the {} has no room in the space that is free of walls, meshes and bodies",
                            region.name()));
  const std::vector<Real> radius = drawn("radius", model_.space.dimension, {0, count_}, before_radii);
  if (const std::string trouble = packing_trouble(box, radius, region.name()); !trouble.empty())
    table_.fail("count", trouble);
  const auto is_free = [&](Vec3 p, Real r) { return region.holds(p, r) && clear(p, r, box.gap); };
  const std::vector<Vec3> places = random_packing(box, radius, placed, is_free, random_);
  if (places.size() < radius.size())
    table_.fail("count",
                fmt::format("only {} particles found a position in {} tries each in the {}; a larger {}, "
                            "fewer or smaller particles are needed",
                            places.size(), box.tries, region.name(), region.is_box() ? "box" : "region"));
  position_.assign(places.begin() + part_.first, places.begin() + part_.last);
}

// Components PREFIXx, PREFIXy, PREFIXz from the file.
std::vector<Vec3> Group::vectors_of(const std::string& prefix) const {
  const std::vector<Real>&x = columns_.at(prefix + "x"), &y = columns_.at(prefix + "y");
  std::vector<Vec3> vectors(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    vectors[i] = {x[i], y[i], model_.space.dimension == 3 ? columns_.at(prefix + "z")[i] : 0};
  return vectors;
}

std::vector<Real> Group::radii() {
  if (has_column("radius")) {
    if (table_.has("radius")) table_.fail("radius", "not used: the file has a column radius");
    return columns_.at("radius");
  }
  if (!table_.has("radius")) table_.fail("radius", "missing; it must be a number [m] or a distribution");
  return drawn("radius", model_.space.dimension, part_, random_);
}

std::vector<Real> Group::masses(const std::vector<Real>& radius) {
  if (table_.has("mass") && table_.has("density")) table_.fail("density", "not used together with mass");
  if (has_column("mass")) {
    for (const char* key : {"mass", "density"})
      if (table_.has(key)) table_.fail(key, "not used: the file has a column mass");
    return columns_.at("mass");
  }
  return table_.has("mass") ? drawn("mass", 1, part_, random_) : masses_from_density(radius);
}

std::vector<Real> Group::masses_from_density(const std::vector<Real>& radius) {
  if (!table_.has("density") && density_ == 0)
    table_.fail("mass", "missing; the group needs mass or density, or a material with a density");
  std::vector<Real> mass = table_.has("density") ? drawn("density", 1, part_, random_)
                                                 : std::vector<Real>(radius.size(), density_);
  const Real thickness = table_.real("thickness");
  for (std::size_t i = 0; i < radius.size(); ++i)
    mass[i] = model_.space.dimension == 3 ? sphere_mass(radius[i], mass[i])
                                          : disc_mass(radius[i], thickness, mass[i]);
  return mass;
}

std::vector<Vec3> Group::velocities() {
  std::vector<Vec3> velocity(static_cast<std::size_t>(part_.size()));
  if (has_column("vx")) velocity = vectors_of("v");
  for (Vec3& v : velocity) v += table_.vector("velocity");
  const Real bound = table_.real("random_velocity");
  for (std::int64_t i = 0; bound > 0 && i < count_; ++i) {
    const Real x = random_.uniform(-bound, bound), y = random_.uniform(-bound, bound);
    const Real z = model_.space.dimension == 3 ? random_.uniform(-bound, bound) : 0;
    if (i >= part_.first && i < part_.last) velocity[static_cast<std::size_t>(i - part_.first)] += {x, y, z};
  }
  return velocity;
}

// Angular velocities of this rank's part [rad/s]; empty: zero.
std::vector<Vec3> Group::angular_velocities() const {
  const Vec3 common = common_angular_velocity();
  const auto count = static_cast<std::size_t>(part_.size());
  if (!has_column("wz")) return std::vector<Vec3>(common == Vec3{} ? 0 : count, common);
  std::vector<Vec3> spin(count, common);
  const bool planar = model_.space.dimension == 2;
  for (std::size_t i = 0; i < count; ++i)
    spin[i] += planar ? Vec3{0, 0, columns_.at("wz")[i]}
                      : Vec3{columns_.at("wx")[i], columns_.at("wy")[i], columns_.at("wz")[i]};
  return spin;
}

// Angular velocity of all particles of the group [rad/s].
Vec3 Group::common_angular_velocity() const {
  const std::vector<Real>& given = table_.reals("angular_velocity");
  if (given.empty()) return {};
  const std::size_t axes = model_.space.dimension == 2 ? 1 : 3;
  if (given.size() != axes)
    table_.fail("angular_velocity",
                fmt::format("must have {} {}", axes, axes == 1 ? "entry, about z" : "entries"));
  return axes == 1 ? Vec3{0, 0, given[0]} : Vec3{given[0], given[1], given[2]};
}

// I / (m R^2); empty: solid spheres or discs.
std::vector<Real> Group::inertia_factors() const {
  if (has_column("inertia_factor")) {
    if (table_.has("inertia_factor"))
      table_.fail("inertia_factor", "not used: the file has a column inertia_factor");
    return columns_.at("inertia_factor");
  }
  if (!table_.has("inertia_factor")) return {};
  return std::vector<Real>(static_cast<std::size_t>(part_.size()), table_.real("inertia_factor"));
}

// The items that a random group must avoid: all ranks' particles and the bodies' shapes.
std::vector<StartItem> placed_items(const Model& model, const Share& share) {
  std::vector<StartItem> items;
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    items.push_back({model.particles.position[i], model.particles.radius[i]});
  items = share.all_gather(std::move(items));
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      items.push_back({to_global_point(model, static_cast<int>(b), shape.offset), shape.radius});
  return items;
}

// The part of `range` in a group whose first particle has the id `first`, as indices within the group.
IdRange part_of_group(IdRange range, GlobalId first, std::int64_t count) {
  const auto within = [&](GlobalId id) { return std::clamp<GlobalId>(id - first, 0, count); };
  return {within(range.first), within(range.last)};
}

// Number of particles of random groups and of all groups before the last of them, which they must avoid.
std::int64_t avoided_particles(const std::vector<Group>& groups) {
  std::int64_t before = 0, avoided = 0;
  for (const Group& group : groups) {
    before += group.count();
    if (group.is_random()) avoided = before;
  }
  return avoided;
}

// A group without a name has its number as name in outputs, which no other group may have.
void check_group_names(const std::vector<DeckTable>& tables) {
  std::set<std::string> numbers;
  for (std::size_t k = 0; k < tables.size(); ++k)
    if (!tables[k].has("name")) numbers.insert(std::to_string(k));
  for (const DeckTable& table : tables)
    if (table.has("name") && numbers.contains(table.text("name")))
      table.fail("name",
                 "is the number of a group without a name, which goes by it in outputs; name that one");
}

}  // namespace

void build_particles(const DeckTable& deck, Model& model, const ModelNames& names, ModelSize& size,
                     const Share& share, Log& log) {
  // Counts of 10^9 per group cannot overflow for any number of groups that a deck can have.
  std::vector<Group> groups;
  std::int64_t count = 0;
  share.collectively([&] {
    for (const DeckTable& table : deck.tables("particles"))
      count += groups.emplace_back(table, names, model).count();
    check_group_names(deck.tables("particles"));
  });
  for (const Group& group : groups) group.warn_if_empty(log), group.note_thickness(model.disc_thickness);
  model.particles.totals.count = size.particles = count;
  const IdRange own = share.part(count);
  check_memory(size, bytes_to_build_particles(own.size(), avoided_particles(groups)),
               "building the particles", share);
  model.particles.first_id = own.first, model.particles.dimension = model.space.dimension;
  GlobalId first = 0;
  for (Group& group : groups) {
    const std::vector<StartItem> placed =
        group.is_random() ? placed_items(model, share) : std::vector<StartItem>{};
    share.collectively(
        [&] { group.append_to(model.particles, part_of_group(own, first, group.count()), placed); });
    std::vector<ParticleGroup>& named = model.particles.groups;
    named.push_back({group.name_or(std::ssize(named)), first, group.expected_mass()});
    first += group.count();
  }
  count_particles(model.particles, model.contact.materials(), share);
}

}  // namespace scree
