// Boxes of particles and bodies at random positions for tests, and their contacts found by brute force.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dem/backend/backend.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "model/data/model.hpp"
#include "model/derived/random.hpp"
#include "partition/halo.hpp"
#include "partition/subdomain.hpp"
#include "support/backends.hpp"
#include "support/catch.hpp"
#include "support/newton_loop.hpp"
#include "support/test_meshes.hpp"

namespace scree {

struct BoxCase {
  const char* name;
  int dimension;
  int periodic_axes;     // number of periodic axes, x first
  Real smallest_radius;  // relative to the largest
  bool walls;            // whether there are two planes
  bool bodies;
  int materials;
  Real exponent;
  bool tension;
  Real modulus = 0;  // E* of Hertz's law [Pa]; 0: a linear stiffness
};

inline const BoxCase kBoxes[] = {
    {"2D, equal, open", 2, 0, 1.0, false, false, 1, 1, false},
    {"2D, polydisperse, periodic", 2, 2, 0.2, false, false, 2, 1, true},
    {"2D, bodies and walls", 2, 0, 0.4, true, true, 2, 1.5, false},
    {"2D, bodies, periodic in x", 2, 1, 0.4, true, true, 1, 1, true},
    {"3D, equal, periodic", 3, 3, 1.0, false, false, 1, 1.5, false},
    {"3D, polydisperse, bodies, periodic", 3, 3, 0.3, false, true, 2, 1, false},
    {"3D, polydisperse, walls", 3, 0, 0.3, true, false, 1, 1, false},
    {"3D, Hertz, polydisperse, bodies and walls", 3, 1, 0.3, true, true, 2, 1, false, 2e4}};

inline constexpr Real kLargestRadius = 0.1;

inline Vec3 random_point(RandomNumbers& random, const Space& space) {
  const Real x = random.uniform(space.min.x, space.max.x), y = random.uniform(space.min.y, space.max.y);
  return {x, y, space.dimension == 3 ? random.uniform(space.min.z, space.max.z) : 0};
}

inline Vec3 random_velocity(RandomNumbers& random, int dimension) {
  const Real x = random.normal(), y = random.normal();
  return {x, y, dimension == 3 ? random.normal() : 0};
}

// All fields of a snapshot of a random box, as a backend returns them.
struct BoxOutput {
  explicit BoxOutput(Backend& backend) {
    backend.reports().start_output();
    all = backend.reports().output();
  }
  template <class T>
  const std::vector<T>& of(const char* name) const {
    for (std::size_t k = 0; k < output_fields().size(); ++k)
      if (std::string(output_fields()[k].head.name) == name)
        return std::get<std::vector<T>>(all.fields.at(k));
    throw std::logic_error(name);
  }

  ParticleOutput all;
};

inline Space random_space(const BoxCase& box) {
  Space space;
  space.dimension = box.dimension;
  space.min = {-1.1, -0.7, box.dimension == 3 ? 0.3 : 0.0},
  space.max = {0.9, 0.8, box.dimension == 3 ? 1.6 : 0.0};
  for (int side = 0; side < 2 * box.periodic_axes; ++side)
    space.boundary[static_cast<std::size_t>(side)] = Boundary::periodic;
  space.leaving = OutsidePolicy::drift;
  return space;
}

inline Body random_body(RandomNumbers& random, const BoxCase& box, const Space& space, int shapes) {
  Body body;
  body.mass = 2, body.inertia = 0.01;
  body.position = random_point(random, space), body.velocity = random_velocity(random, box.dimension);
  body.angle = random.uniform(-3, 3), body.angular_velocity = random.normal();
  for (int s = 0; s < shapes; ++s)
    body.shapes.push_back(
        {{0.08 * s, -0.05 * s, 0}, kLargestRadius * random.uniform(0.5, 1), s % box.materials});
  return body;
}

// Five bodies: the first three in a chain of a spring and a joint, one of them with three shapes.
inline void add_bodies(RandomNumbers& random, const BoxCase& box, Model& model) {
  for (const int shapes : {1, 2, 1, 3, 1})
    model.bodies.push_back(random_body(random, box, model.space, shapes));
  model.bodies[1].position = model.bodies[0].position + Vec3{0.1, 0, 0};
  model.bodies[3].position = model.bodies[2].position + Vec3{0, 0.1, 0};
  SpringDamper spring;
  spring.body[0] = 0, spring.body[1] = 1;
  model.spring_dampers.push_back(spring);
  Joint joint;
  joint.body[0] = 2, joint.body[1] = 1;
  model.joints.push_back(joint);
}

// Particles overlap at random: a contact everywhere, of every size.
inline Model random_box(const BoxCase& box, int particles, std::uint64_t seed) {
  RandomNumbers random(seed);
  Model model;
  model.space = random_space(box);
  model.gravity = {0.5, -9.8, box.dimension == 3 ? 0.3 : 0.0};
  for (const OutputField& field : output_fields()) model.output.fields.emplace_back(field.head.name);
  model.contact.material_names.assign(static_cast<std::size_t>(box.materials), "material");
  for (int k = 0; k < box.materials * box.materials; ++k) {
    const int i = k / box.materials, j = k % box.materials;
    NormalLawParameters law{1e3 * (1 + i + j), 5.0 + i * j, box.exponent, box.tension};
    if (box.modulus > 0) law = {0, 0, 1, box.tension, box.modulus * (1 + i + j), 0.1 + 0.1 * i * j};
    model.contact.laws.push_back(law);
  }
  for (int i = 0; i < particles; ++i) {
    const Real radius = kLargestRadius * random.uniform(box.smallest_radius, 1);
    model.particles.position.push_back(random_point(random, model.space));
    model.particles.velocity.push_back(random_velocity(random, box.dimension));
    model.particles.radius.push_back(radius);
    model.particles.mass.push_back(1e3 * radius * radius * radius);
    model.particles.material.push_back(i % box.materials);
  }
  count_particles(model.particles, box.materials);
  if (box.walls) {
    model.walls.push_back({"slope", {0, -0.6, 0}, {0.6, 0.8, 0}, 0});
    model.walls.push_back({"side", {0.85, 0, 0}, {-1, 0, 0}, box.materials - 1});
  }
  if (box.bodies) add_bodies(random, box, model);
  return model;
}

// Adds a wavy wall of triangles through the middle of the domain.
inline void add_floor(Model& model, int squares) {
  const Vec3 min = model.space.min, size = model.space.max - min;
  const TriangleMesh grid = mapped(unit_grid(squares, squares), [&](Vec3 v) {
    return min +
           Vec3{v.x * size.x, v.y * size.y, (0.5 + 0.05 * std::sin(9 * v.x) * std::cos(7 * v.y)) * size.z};
  });
  Wall floor{"floor", {}, {}};
  floor.mesh = static_cast<int>(model.meshes.size());
  model.meshes.push_back({"floor", std::make_shared<const SurfaceMesh>(sheet_mesh(grid))});
  model.walls.push_back(floor);
}

// A larger box with some ten neighbours per particle, for any number of particles.
inline Model dense_box(const BoxCase& box, ParticleIntegrator integrator, int particles) {
  constexpr Real kInSmallBox = 3000;
  Model model = random_box(box, particles, 33);
  const Real scale =
      (box.dimension == 2 ? 3.5 : 2) * std::pow(particles / kInSmallBox, Real(1) / box.dimension);
  for (Vec3* corner : {&model.space.min, &model.space.max}) *corner = scale * *corner;
  for (Vec3& position : model.particles.position) position = scale * position;
  model.integrator.particles = integrator;
  return model;
}

inline std::vector<BodyMotion> motion_of(const std::vector<Body>& bodies) {
  std::vector<BodyMotion> motion;
  for (const Body& b : bodies) motion.push_back(start_motion(b));
  return motion;
}

// Motion of all bodies and walls with surfaces; walls are static.
inline std::vector<BodyMotion> carriers_of(const Model& model) {
  std::vector<BodyMotion> motion = motion_of(model.bodies);
  BodyMotion wall;
  wall.kind = BodyKind::spatial;
  motion.resize(SurfaceSet(model).parents(), wall);
  return motion;
}

// A model on a backend with its list built and its first forces computed.
struct LoadedBox {
  explicit LoadedBox(const Model& of, Real skin = 0.02,
                     std::unique_ptr<Backend> (*make)(const Model&, const Ranks&) = make_test_backend)
      : model(of),
        records(initial_records(model.particles, Subdomain(model.space))),
        motion(carriers_of(model)),
        backend(make(model, {})) {
    backend->particles().load(records, {});
    backend->list().set_body_motion(motion);
    backend->list().build(skin, timers);
    backend->particles().initial_forces();
  }
  LoadedBox(const LoadedBox&) = delete;
  LoadedBox& operator=(const LoadedBox&) = delete;

  Model model;
  std::vector<Particle> records;
  std::vector<BodyMotion> motion;
  std::unique_ptr<Backend> backend;
  StageTimers timers;
};

// A run of explicit steps with the bodies held at `motion`; returns the number of steps taken.
inline Index verlet_steps(LoadedBox& box, Real h, Index steps) {
  const std::unique_ptr<ExplicitRun> run = box.backend->start_run(h);
  box.backend->list().set_body_motion(box.motion);
  return run->take_steps(steps, false, box.timers).closed;
}

// A particle or a shape in the search by brute force.
// Inertia of a body in the orientation of its start.
inline FreeBody free_body(const Body& body) {
  const Real inverse_mass = 1 / body.mass;
  FreeBody out{{inverse_mass, inverse_mass, 0}, {0, 0, 0, 0, 0, 1 / body.inertia}};
  if (body.kind != BodyKind::spatial) return out;
  const Mat3 axes = rotation_matrix(orientation(start_motion(body)));
  const Mat3 of = axes * full(inverse(body.inertia_tensor)) * transposed(axes);
  out.inverse_mass.z = inverse_mass;
  out.inverse_inertia = {of.x.x, of.x.y, of.x.z, of.y.y, of.y.z, of.z.z};
  return out;
}

struct BruteItem {
  Vec3 position, velocity;
  Real radius, mass;
  int material;
  int body;  // -1: a particle
  FreeShape free{};
};

inline std::vector<BruteItem> brute_items(const LoadedBox& box) {
  std::vector<BruteItem> items;
  for (std::size_t i = 0; i < box.records.size(); ++i)
    items.push_back({box.records[i].position, box.records[i].velocity, box.model.particles.radius[i],
                     box.model.particles.mass[i], box.model.particles.material[i], -1});
  const Subdomain subdomain(box.model.space);
  for (std::size_t b = 0; b < box.motion.size(); ++b) {
    const FreeBody free = free_body(box.model.bodies[b]);
    for (const Shape& shape : box.model.bodies[b].shapes) {
      const PointMotion point = point_motion(box.motion[b], shape.offset);
      ImageCount unused;
      items.push_back({subdomain.wrap(snap(point.position, subdomain.snap_constant()), unused),
                       point.velocity,
                       shape.radius,
                       box.model.bodies[b].mass,
                       shape.material,
                       static_cast<int>(b),
                       {point.position - box.motion[b].position, free}});
    }
  }
  return items;
}

}  // namespace scree
