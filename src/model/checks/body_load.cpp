#include "model/checks/body_load.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/surface_mesh.hpp"
#include "model/checks/limits.hpp"
#include "model/derived/connections.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

// Adds the contact of a particle of this size. The normal damping is that of a contact at the body's centre,
// where it is largest; in the tangential damping the mass of the body counts as infinite.
void add_contact(const Model& model, int particles, int surface, Real radius, Real surface_radius, Real mass,
                 PressedBody& body) {
  const NormalLawParameters& law = model.contact.law(particles, surface);
  const PairSize size{radius, surface_radius, mass, body.mass};
  body.stiffness = std::max(body.stiffness, typical_stiffness(law, size));
  body.damping = std::max(body.damping, law_of_size(law, size).normal_damping);
  if (!model.rotates()) return;
  const Friction& friction = model.contact.friction_of(particles, surface);
  const Real slip_stiffness = typical_slip_stiffness(friction, size);
  body.stiffness = std::max(body.stiffness, slip_stiffness);
  body.damping = std::max(body.damping, dashpot_of(friction.damping_ratio, mass, slip_stiffness));
}

// Adds the contacts of all particles with a surface of this material; radius: of the surface, infinite for a
// mesh.
void add_contacts(const Model& model, int surface, Real radius, PressedBody& body) {
  const ParticleTotals& totals = model.particles.totals;
  for (int particles = 0; particles < model.contact.materials(); ++particles) {
    const ParticleTotals::OfMaterial& of = totals.materials[static_cast<std::size_t>(particles)];
    if (of.count == 0 || !model.contact.law(particles, surface).acts()) continue;
    for (const Real size : {of.smallest_radius, totals.largest_radius})
      add_contact(model, particles, surface, size, radius, totals.largest_mass, body);
  }
}

// prescribed: contacts do not move the body.
PressedBody pressed_body(const Model& model, const Body& body, bool prescribed) {
  PressedBody pressed;
  pressed.mass = body.mass;
  const bool is_planar = body.kind == BodyKind::planar;  // it rotates about z only
  Real arm = 0;  // longest lever arm of a contact force; forces on discs and spheres without friction act
                 // through their centres
  for (const Shape& shape : body.shapes) {
    if (!prescribed) add_contacts(model, shape.material, shape.radius, pressed);
    const Real offset = is_planar ? std::hypot(shape.offset.x, shape.offset.y) : norm(shape.offset);
    pressed.reach = std::max(pressed.reach, offset + shape.radius);
    arm = std::max(arm, model.rotates() ? offset + shape.radius : offset);
  }
  for (const MeshShape& shape : body.meshes) {
    if (!prescribed) add_contacts(model, shape.material, kInfinity, pressed);
    const ModelMesh& mesh = model.meshes[static_cast<std::size_t>(shape.mesh)];
    const Real reach = farthest(mesh, shape.offset, is_planar ? 2 : 3);
    pressed.reach = std::max(pressed.reach, reach), arm = std::max(arm, reach);
  }
  pressed.least_mass = 1 / (1 / body.mass + arm * arm / body.inertia);
  return pressed;
}

Real triangle_area(const SurfaceMesh& mesh, const MeshTriangle& triangle) {
  const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(triangle.vertex[k])]; };
  return norm(cross(at(1) - at(0), at(2) - at(0))) / 2;
}

// Area of the surface [m^2]; in two dimensions length [m].
Real surface_of(const Model& model, const Body& body, Real particle_radius) {
  const bool discs = model.space.dimension == 2;
  Real size = 0;
  for (const Shape& shape : body.shapes) {
    const Real radius = shape.radius + particle_radius;
    size += discs ? 2 * std::numbers::pi_v<Real> * radius : 4 * std::numbers::pi_v<Real> * radius * radius;
  }
  for (const MeshShape& shape : body.meshes) {
    const SurfaceMesh& mesh = *model.meshes[static_cast<std::size_t>(shape.mesh)].surface;
    Real area = 0;
    for (const MeshTriangle& t : mesh.triangles) area += triangle_area(mesh, t);
    size += discs ? area / (mesh.box.max.z - mesh.box.min.z) : area;
  }
  return size;
}

}  // namespace

Real PressedBody::phase(std::int64_t contacts, Real h) const {
  return h * contact_frequency(static_cast<Real>(contacts) * stiffness, mass);
}

Real PressedBody::load(std::int64_t contacts, Real h) const {
  return static_cast<Real>(contacts) * h * (h * stiffness + damping) / least_mass;
}

std::vector<PressedBody> pressed_bodies(const Model& model) {
  std::vector<PressedBody> bodies;
  const std::vector<bool> prescribed = prescribed_bodies(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    bodies.push_back(pressed_body(model, model.bodies[b], prescribed[b]));
  return bodies;
}

std::int64_t most_contacts(const Model& model, int body) {
  const ParticleTotals& totals = model.particles.totals;
  const Real r = totals.smallest_radius;
  if (!(r > 0)) return 0;
  const Real size = surface_of(model, model.bodies[static_cast<std::size_t>(body)], r);
  // Area, or length, per particle in the densest layer.
  const Real of_one = model.space.dimension == 2 ? 2 * r : 2 * std::sqrt(Real(3)) * r * r;
  const Real most = std::ceil(size / of_one);
  return most < static_cast<Real>(totals.count) ? std::max<std::int64_t>(1, std::llround(most))
                                                : totals.count;
}

std::optional<LoadedStep> shortest_loaded_step(const Model& model) {
  std::optional<LoadedStep> shortest;
  const std::vector<PressedBody> bodies = pressed_bodies(model);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].stiffness == 0) continue;
    const std::int64_t contacts = most_contacts(model, static_cast<int>(b));
    const Real step = kGoodLoadedPhase / bodies[b].phase(contacts, 1);
    if (!shortest || step < shortest->step) shortest = {static_cast<int>(b), contacts, step};
  }
  return shortest;
}

}  // namespace scree
