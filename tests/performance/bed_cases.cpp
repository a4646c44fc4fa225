#include "bed_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "coupling/coupled_step.hpp"
#include "dem/particles/particle_store.hpp"
#include "model/builder/particle_file.hpp"
#include "physics/step_limits.hpp"
#include "support/particle_columns.hpp"

namespace scree {
namespace {

constexpr Real kSphereTile = 25, kSphereRadius = 0.5, kSphereDiameter = 1;  // width of the tile [m]
constexpr int kDiscRow = 100;
constexpr Real kDiscRadius = 0.05, kDiscSpacing = 0.102, kDiscTile = kDiscRow * kDiscSpacing;  // [m]
constexpr int kRowBodies = 20;
// The plough's distance from the walls at its start and its end, its height, deep within the bed [m], and
// its speed [m/s].
constexpr Real kPloughMargin = 3, kPloughHeight = 5, kPloughSpeed = 2;

std::int64_t tiles_of(std::int64_t particles) {
  if (particles < kTileParticles || particles % kTileParticles != 0)
    throw InputError(fmt::format("--particles {}: must be a multiple of {}", particles, kTileParticles));
  return particles / kTileParticles;
}

void add_particle(Model& model, Vec3 position, Real radius) {
  ParticleSet& set = model.particles;
  set.position.push_back(position), set.velocity.push_back({});
  set.radius.push_back(radius), set.mass.push_back(1), set.material.push_back(0);
}

// Makes the side of the domain a wall.
void add_side(Model& model, Side side, Vec3 point, Vec3 normal) {
  model.space.boundary[side] = Boundary::wall;
  model.walls.push_back({fmt::format("side {}", static_cast<int>(side)), point, normal, 0});
}

Model disc_model(std::int64_t tiles, Real step, Real damping) {
  Model model;
  model.space.dimension = 2;
  model.space.min = {0, 0, 0}, model.space.max = {static_cast<Real>(tiles) * kDiscTile, 1.5 * kDiscTile, 0};
  model.space.boundary = {Boundary::periodic, Boundary::periodic, Boundary::wall, Boundary::wall};
  model.gravity = {0, -9.8066, 0};
  model.contact.material_names = {"disc"};
  model.contact.laws = {{1e7, damping, 1, false}};
  model.contact.skin = 0.2 * kDiscRadius;
  model.walls = {{"floor", {0, 0, 0}, {0, 1, 0}, 0}};
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.integrator.substeps = 10;
  model.time.end = 1, model.time.step = model.integrator.substeps * step;
  return model;
}

// Position of body b of a row along x in the middle of the bed.
Real row_x(const Model& bed, int b) {
  return 0.5 * (bed.space.min.x + bed.space.max.x) + (b - 0.5 * (kRowBodies - 1)) * kSphereDiameter;
}

// Spheres connected by spring-dampers, in place of the particles at their positions.
void add_row(Model& bed, Real y, Real z) {
  for (int b = 0; b < kRowBodies; ++b) {
    Body body;
    body.name = fmt::format("row.{}", b);
    body.mass = 1, body.inertia = 0.1;
    body.position = {row_x(bed, b), y, z};
    body.shapes = {{{0, 0, 0}, kSphereRadius, 0}};
    bed.bodies.push_back(body);
  }
  for (int b = 0; b + 1 < kRowBodies; ++b) {
    SpringDamper cord;
    cord.name = fmt::format("cord.{}", b);
    cord.body[0] = b, cord.body[1] = b + 1;
    cord.stiffness = 1e5, cord.damping = 100, cord.free_length = 0.999 * kSphereDiameter;  // taut
    bed.spring_dampers.push_back(cord);
  }
  const auto in_the_way = [&](const Vec3& p) {
    return std::any_of(bed.bodies.begin(), bed.bodies.end(), [&](const Body& body) {
      const Vec3 r = p - body.position;
      return dot(r, r) < kSphereDiameter * kSphereDiameter;
    });
  };
  // All particles are equal: the arrays besides the positions are only shortened.
  ParticleSet& set = bed.particles;
  set.position.erase(std::remove_if(set.position.begin(), set.position.end(), in_the_way),
                     set.position.end());
  const std::size_t left = set.position.size();
  set.velocity.resize(left), set.radius.resize(left), set.mass.resize(left), set.material.resize(left);
  count_particles(set, bed.contact.materials());
}

// Between the ground and body b at its position, and along y if it has an axis; returns its index.
int add_joint(Model& bed, JointKind kind, int b) {
  Joint joint;
  joint.name = fmt::format("joint.{}", b);
  joint.kind = kind, joint.body[1] = b, joint.axis = {0, 1, 0};
  joint.point[0] = bed.bodies[static_cast<std::size_t>(b)].position;
  bed.joints.push_back(joint);
  return static_cast<int>(bed.joints.size()) - 1;
}

}  // namespace

Model sphere_bed(const std::string& tile, std::int64_t particles, const Share& share) {
  const std::int64_t tiles = tiles_of(particles);
  std::int64_t rows = static_cast<std::int64_t>(std::sqrt(static_cast<double>(tiles)));
  while (tiles % rows != 0) --rows;
  const ParticleColumns columns = read_particle_file(tile, 3);
  const std::vector<Real>&x = columns.at("x"), &y = columns.at("y"), &z = columns.at("z");
  if (static_cast<std::int64_t>(x.size()) != kTileParticles)
    throw InputError(fmt::format("{}: {} particles; must be {}", tile, x.size(), kTileParticles));

  Model model;
  const Real width = kSphereTile * static_cast<Real>(tiles / rows),
             depth = kSphereTile * static_cast<Real>(rows);
  // The centres fill the tile up to its edges.
  model.space.min = {-kSphereRadius, -kSphereRadius, 0};
  model.space.max = {width + kSphereRadius, depth + kSphereRadius, 20};
  add_side(model, kXMin, model.space.min, {1, 0, 0});
  add_side(model, kXMax, model.space.max, {-1, 0, 0});
  add_side(model, kYMin, model.space.min, {0, 1, 0});
  add_side(model, kYMax, model.space.max, {0, -1, 0});
  add_side(model, kZMin, model.space.min, {0, 0, 1});
  model.gravity = {0, 0, -1};
  model.contact.material_names = {"sphere"};
  model.contact.laws = {{2e5, 25, 1, false}};
  model.contact.skin = 0.1;
  model.time.end = 1, model.time.step = kSphereStep;
  model.integrator.hht_alpha = -0.05;  // as the default of decks
  const IdRange part = share.part(particles);
  model.particles.first_id = part.first;
  // Column by column: with several ranks their parts are near their boxes.
  for (GlobalId id = part.first; id < part.last; ++id) {
    const std::int64_t at = id / kTileParticles;
    const auto i = static_cast<std::size_t>(id % kTileParticles);
    add_particle(model,
                 {x[i] + kSphereTile * static_cast<Real>(at / rows),
                  y[i] + kSphereTile * static_cast<Real>(at % rows), z[i]},
                 kSphereRadius);
  }
  count_particles(model.particles, model.contact.materials(), share);
  return model;
}

Real implicit_sphere_step(const Model& bed) {
  return 1.2 / contact_frequency(bed.contact.laws[0].normal_stiffness, bed.particles.mass[0]);
}

void add_net(Model& bed) {
  const Vec3 middle = 0.5 * (bed.space.min + bed.space.max);
  // The height at which body b touches the particle at p from above; 0 where it passes beside it.
  const auto touching_height = [&](int b, const Vec3& p) {
    const Real dx = p.x - row_x(bed, b), dy = p.y - middle.y,
               height2 = kSphereDiameter * kSphereDiameter - dx * dx - dy * dy;
    return height2 > 0 ? p.z + std::sqrt(height2) : 0;
  };
  Real level = 0;
  for (const Vec3& p : bed.particles.position)
    for (int b = 0; b < kRowBodies; ++b) level = std::max(level, touching_height(b, p));
  add_row(bed, middle.y, level - kSphereDiameter);
  // Bodies move in planes of constant z, to which gravity is normal here: the net is loaded sideways
  // instead.
  for (int b = 0; b < kRowBodies; ++b) {
    AppliedForce weight;
    weight.name = fmt::format("weight.{}", b);
    weight.body = b;
    weight.fy.value = -5;
    bed.applied_forces.push_back(weight);
  }
  for (const int b : {0, kRowBodies - 1}) add_joint(bed, JointKind::revolute, b);
}

void add_plough(Model& bed) {
  add_row(bed, bed.space.min.y + kPloughMargin, kPloughHeight);
  for (Body& body : bed.bodies) body.velocity.y = kPloughSpeed;
  for (const int b : {0, kRowBodies - 1}) {
    Driver drive;
    drive.name = fmt::format("drive.{}", b);
    drive.joint = add_joint(bed, JointKind::translational, b);
    drive.motion.kind = TimeFunction::Kind::ramp, drive.motion.rate = kPloughSpeed;
    bed.drivers.push_back(drive);
  }
  bed.time.end = (bed.space.max.y - bed.space.min.y - 2 * kPloughMargin) / kPloughSpeed;
}

std::string contact_text(const BedContact& contact) {
  std::string text;
  if (contact.hertz) text += ", Hertz";
  if (contact.friction > 0) text += fmt::format(", friction {}", contact.friction);
  if (contact.rolling > 0) text += fmt::format(", rolling {}", contact.rolling);
  if (contact.materials > 1) text += fmt::format(", {} materials", contact.materials);
  return text;
}

void set_contact(Model& bed, const BedContact& contact, const Share& share) {
  Contact& laws = bed.contact;
  // Stiffness of the tangential spring over that of the normal one: 2/7, with Mindlin 4 G* / E*.
  constexpr Real kModulus = 4e7, kShearModulus = kModulus / 14, kDampingRatio = 0.04;
  const Friction friction = contact.hertz
                                ? Friction{contact.friction, 0, kShearModulus, 0}
                                : Friction{contact.friction, Real(2) / 7 * laws.laws[0].normal_stiffness};
  if (contact.hertz) laws.laws = {{0, 0, 1, false, kModulus, kDampingRatio}};
  const auto pairs =
      static_cast<std::size_t>(contact.materials) * static_cast<std::size_t>(contact.materials);
  laws.laws.assign(pairs, NormalLawParameters(laws.laws[0]));
  if (contact.friction > 0) {
    laws.friction.assign(pairs, friction);
    bed.particles.dimension = bed.space.dimension;
  }
  if (contact.rolling > 0) {
    const bool discs = bed.space.dimension == 2;
    laws.rolling.assign(pairs,
                        {contact.rolling, discs ? 3 : Real(2.25), 0, 0, 0, discs ? 0 : contact.friction});
  }
  for (int m = 1; m < contact.materials; ++m)
    laws.material_names.push_back(fmt::format("{}.{}", laws.material_names[0], m));
  ParticleSet& set = bed.particles;
  for (std::size_t i = 0; i < set.material.size(); ++i)
    set.material[i] = static_cast<int>((set.first_id + static_cast<GlobalId>(i)) % contact.materials);
  if (contact.materials > 1) count_particles(set, contact.materials, share);
}

Model disc_bed(const std::vector<Vec3>& tile, std::int64_t particles) {
  const std::int64_t tiles = tiles_of(particles);
  Model model = disc_model(tiles, kDiscStep, 100);
  for (std::int64_t t = 0; t < tiles; ++t)
    for (const Vec3& p : tile)
      add_particle(model, p + Vec3{static_cast<Real>(t) * kDiscTile, 0, 0}, kDiscRadius);
  count_particles(model.particles, model.contact.materials());
  return model;
}

std::vector<Vec3> settled_discs() {
  constexpr Real kStep = 1e-4;
  constexpr int kSteps = 20000;
  Model model = disc_model(1, kStep, 700);
  std::mt19937 engine(1);
  const auto jitter = [&] { return 1e-3 * (static_cast<Real>(engine()) / 4294967296.0 - 0.5); };
  for (int row = 0; row < kDiscRow; ++row) {
    for (int column = 0; column < kDiscRow; ++column) {
      const Real x = (column + 0.25 + 0.5 * (row % 2)) * kDiscSpacing + jitter();
      add_particle(model, {x, kDiscRadius + 0.09 * row + jitter(), 0}, kDiscRadius);
    }
  }
  count_particles(model.particles, model.contact.materials());
  StageTimers timers;
  const std::unique_ptr<Backend> backend = make_cpu_backend(model);
  backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
  BodyCoupling link(model);
  CoupledStep step(model, *backend, link, timers);
  MultibodyState bodies;
  step.start(bodies);
  const std::vector<Real> times(static_cast<std::size_t>(kSteps / model.integrator.substeps));
  step.explicit_steps(bodies, times, model.time.step, times.back() + model.time.step);
  const ParticleLedger ledger = backend->reports().ledger(0);
  fmt::print("settled tile: kinetic energy {:.2e} J per disc, {:.2f} contacts per disc\n",
             ledger.kinetic / kTileParticles, 2 * static_cast<Real>(ledger.contacts) / kTileParticles);
  std::vector<Vec3> out;
  for (const Particle& record : backend->particles().records()) out.push_back(record.position);
  return out;
}

}  // namespace scree
