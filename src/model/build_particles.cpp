// Groups of particles: where they stand, how large, heavy and fast they are.
#include <fmt/format.h>

#include <algorithm>

#include "model/build_parts.hpp"
#include "model/connections.hpp"
#include "model/generators.hpp"
#include "model/particle_file.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

namespace {

// One group while it is built. Random numbers are drawn in the order radius, mass, position, velocity.
class Group {
 public:
  Group(const DeckTable& table, const ModelNames& names, const Model& model)
      : table_(table),
        model_(model),
        random_(static_cast<std::uint64_t>(table.integer("seed"))),
        kind_(table.text("kind")),
        material_(find_material(names, table, "material")),
        density_(names.densities[static_cast<std::size_t>(material_)]) {}

  void append_to(ParticleSet& particles);

 private:
  void place_regular();
  void place_random(const std::vector<Real>& radius);
  std::vector<Real> radii(std::size_t count);
  std::vector<Real> masses(const std::vector<Real>& radius);
  std::vector<Real> masses_from_density(const std::vector<Real>& radius);
  std::vector<Vec3> velocities(std::size_t count);
  std::array<std::int64_t, 3> lattice_size() const;
  Vec3 lattice_origin() const;
  std::vector<Vec3> vectors_of(const std::string& prefix) const;

  const DeckTable& table_;
  const Model& model_;
  RandomNumbers random_;
  std::string kind_;
  int material_;
  Real density_;
  ParticleColumns columns_;  // of a file
  std::vector<Vec3> position_;
};

void Group::append_to(ParticleSet& particles) {
  const bool counted = kind_ == "row" || kind_ == "random";
  if (counted && !table_.has("count")) table_.fail("count", "missing; it must be an integer of at least 1");
  if (kind_ == "file") columns_ = read_particle_file(table_.text("file"), model_.space.dimension);
  if (kind_ != "random") place_regular();
  const std::size_t n =
      kind_ == "random" ? static_cast<std::size_t>(table_.integer("count")) : position_.size();
  const std::vector<Real> radius = radii(n), mass = masses(radius);
  if (kind_ == "random") place_random(radius);
  const std::vector<Vec3> velocity = velocities(n);
  particles.position.insert(particles.position.end(), position_.begin(), position_.end());
  particles.velocity.insert(particles.velocity.end(), velocity.begin(), velocity.end());
  particles.radius.insert(particles.radius.end(), radius.begin(), radius.end());
  particles.mass.insert(particles.mass.end(), mass.begin(), mass.end());
  particles.material.insert(particles.material.end(), n, material_);
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
  if (table_.has("origin") == table_.has("center")) {
    table_.fail("origin", "exactly one of the keys origin and center must be given");
  }
  if (table_.has("origin")) return table_.vector("origin");
  const std::array<std::int64_t, 3> size = lattice_size();
  const Vec3 spacing = table_.vector("spacing");
  const auto half = [](std::int64_t places) { return static_cast<Real>(places - 1) / 2; };
  return table_.vector("center") -
         Vec3{half(size[0]) * spacing.x, half(size[1]) * spacing.y, half(size[2]) * spacing.z};
}

void Group::place_regular() {
  if (kind_ == "list") {
    position_ = table_.vectors("positions");
  } else if (kind_ == "row") {
    if (!table_.has("origin")) table_.fail("origin", "missing; it must be the centre of the first particle");
    for (std::int64_t i = 0; i < table_.integer("count"); ++i) {
      position_.push_back(table_.vector("origin") + static_cast<Real>(i) * table_.vector("spacing"));
    }
  } else if (kind_ == "lattice") {
    const std::array<std::int64_t, 3> size = lattice_size();
    const std::int64_t places = size[0] * size[1] * size[2];
    const std::int64_t count = table_.has("count") ? table_.integer("count") : places;
    if (count > places)
      table_.fail("count", fmt::format("must be at most {}, the places of the lattice", places));
    position_ = lattice_positions(lattice_origin(), table_.vector("spacing"), size, count);
  } else {
    position_ = vectors_of("");
  }
}

void Group::place_random(const std::vector<Real>& radius) {
  PackingBox box{table_.vector("min"), table_.vector("max"), model_.space.dimension, table_.real("gap"),
                 table_.integer("tries")};
  Obstacles obstacles{model_.particles.position, model_.particles.radius};
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    for (const Shape& shape : model_.bodies[b].shapes) {
      obstacles.position.push_back(to_global_point(model_, static_cast<int>(b), shape.offset));
      obstacles.radius.push_back(shape.radius);
    }
  }
  position_ = random_packing(box, radius, obstacles, random_);
  if (position_.size() == radius.size()) return;
  table_.fail("count",
              fmt::format("only {} particles found a place in {} tries each; a larger box (min, max), "
                          "fewer or smaller particles are needed",
                          position_.size(), box.tries));
}

// Components PREFIXx, PREFIXy, PREFIXz of the file.
std::vector<Vec3> Group::vectors_of(const std::string& prefix) const {
  const std::vector<Real>&x = columns_.at(prefix + "x"), &y = columns_.at(prefix + "y");
  std::vector<Vec3> vectors(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    vectors[i] = {x[i], y[i], model_.space.dimension == 3 ? columns_.at(prefix + "z")[i] : 0};
  }
  return vectors;
}

std::vector<Real> Group::radii(std::size_t count) {
  if (columns_.contains("radius")) {
    if (table_.has("radius")) table_.fail("radius", "not used: the file has a column radius");
    return columns_.at("radius");
  }
  if (!table_.has("radius"))
    table_.fail("radius", "missing; it must be a number above 0 [m] or a distribution");
  return draw(table_.table("radius"), count, random_);
}

std::vector<Real> Group::masses(const std::vector<Real>& radius) {
  if (table_.has("mass") && table_.has("density")) table_.fail("density", "not used together with mass");
  if (columns_.contains("mass")) {
    for (const char* key : {"mass", "density"}) {
      if (table_.has(key)) table_.fail(key, "not used: the file has a column mass");
    }
    return columns_.at("mass");
  }
  return table_.has("mass") ? draw(table_.table("mass"), radius.size(), random_)
                            : masses_from_density(radius);
}

std::vector<Real> Group::masses_from_density(const std::vector<Real>& radius) {
  if (!table_.has("density") && density_ == 0) {
    table_.fail("mass", "missing; the group needs mass or density, or a material with a density");
  }
  std::vector<Real> mass = table_.has("density") ? draw(table_.table("density"), radius.size(), random_)
                                                 : std::vector<Real>(radius.size(), density_);
  const Real thickness = table_.real("thickness");
  for (std::size_t i = 0; i < radius.size(); ++i) {
    mass[i] = model_.space.dimension == 3 ? sphere_mass(radius[i], mass[i])
                                          : disc_mass(radius[i], thickness, mass[i]);
  }
  return mass;
}

std::vector<Vec3> Group::velocities(std::size_t count) {
  std::vector<Vec3> velocity = columns_.contains("vx") ? vectors_of("v") : std::vector<Vec3>(count);
  const Real bound = table_.real("random_velocity");
  for (Vec3& v : velocity) {
    v += table_.vector("velocity");
    if (bound == 0) continue;
    const Real x = random_.uniform(-bound, bound), y = random_.uniform(-bound, bound);
    v += Vec3{x, y, model_.space.dimension == 3 ? random_.uniform(-bound, bound) : 0};
  }
  return velocity;
}

}  // namespace

void build_particles(const DeckTable& deck, Model& model, const ModelNames& names) {
  for (const DeckTable& table : deck.tables("particles"))
    Group(table, names, model).append_to(model.particles);
}

}  // namespace scree
