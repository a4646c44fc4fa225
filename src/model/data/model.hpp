// What is simulated: constant after it was built from the deck. SI units.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"
#include "mesh/hull_corners.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/data/bodies.hpp"
#include "model/data/joint_forces.hpp"
#include "model/data/particles.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

enum Side { kXMin, kXMax, kYMin, kYMax, kZMin, kZMax, kSides };
inline constexpr std::array<const char*, kSides> kSideNames = {"x_min", "x_max", "y_min",
                                                               "y_max", "z_min", "z_max"};

struct Space {
  int dimension = 3;                        // 2: every z stays 0 and the z sides do not exist
  Vec3 min, max;                            // [m]; in 2D min.z = max.z = 0
  std::array<Boundary, kSides> boundary{};  // periodic comes in pairs
  int wall_material = 0;                    // of the sides that are walls
  Leaving leaving = Leaving::error;
};

// Of a wall; follows one of its coordinates less what that is at t = 0.
struct WallMotion {
  WallMotionKind kind = WallMotionKind::translation;
  Vec3 axis;                // unit: the direction, or the axis of the rotation
  Vec3 point;               // of that axis [m]
  TimeFunction coordinate;  // [m] or [rad]
};

// A surface of the ground. Half space, solid behind the plane; or triangles.
struct Wall {
  std::string name;
  Vec3 point;   // of the plane, or the origin of the mesh [m]
  Vec3 normal;  // unit, into the free side
  int material = 0;
  int mesh = -1;                      // index into Model::meshes; -1: a plane
  std::vector<WallMotion> motions{};  // one after the other; point and normal are those at t = 0
  Vec3 surface_velocity{};            // in the wall's frame, the global one at t = 0 [m/s]

  bool moves() const { return !motions.empty(); }
  bool runs() const { return surface_velocity != Vec3{}; }  // its surface, along itself
  // Whether its contacts are those of a surface that is placed: all but planes at rest.
  bool is_placed() const { return mesh >= 0 || moves() || runs(); }
};

// Triangles that walls and bodies refer to.
struct ModelMesh {
  std::string name;  // for messages
  std::shared_ptr<const SurfaceMesh> surface;
  std::vector<Real> solid_masses{};  // of solids that it stands for, each number once [kg]
  std::size_t triangles_before = 0;  // it was made coarser; else 0
  Real moved = 0;                    // the farthest that a vertex was then beside it [m]
  // How far facets lie from the surface that they stand for at the most [m]: exact for what is made from a
  // few numbers, else MeshCurvature::sag.
  Real deviation = 0;
  bool deviation_is_exact = false;
  std::string fitting{};   // "segments = 32": what fits the size of the particles; empty: nothing is known
  bool is_fitted = false;  // the deck leaves it out, and the mesh has it
  std::string crossing{};  // where its shells cross each other, for messages; empty: they do not
  // Corners of the convex hull in the mesh's frame; null: no body has the mesh, or there is no plane.
  std::shared_ptr<const HullCorners> corners{};
};

// A pair of materials that the deck does not give, made by contact.mixing.
struct CombinedPair {
  int material[2] = {0, 0};
  std::string keys;  // as they would stand in [[contact.pairs]]: "friction = 0.3, restitution = 0.8"
};

// One law per unordered pair of materials.
struct Contact {
  std::vector<std::string> material_names;
  std::vector<KelvinVoigt> laws;           // [i * materials + j], symmetric
  std::vector<Friction> friction;          // likewise; empty: no contact rubs
  std::vector<RollingResistance> rolling;  // likewise; empty: none resists rolling
  std::vector<Real> wear;                  // likewise: volume per work of friction [1/Pa]; empty: none wears
  std::vector<CombinedPair> combined;      // those of the pairs that are not the deck's
  Real reach = 0;                          // beyond touch, up to which partners are looked for [m]
  Real skin = 0;                           // neighbour list reaches this far past touching [m]
  bool connected_bodies_touch = false;

  int materials() const { return static_cast<int>(material_names.size()); }
  const KelvinVoigt& law(int i, int j) const { return laws[static_cast<std::size_t>(i * materials() + j)]; }
  // Of materials where some rub.
  const Friction& friction_of(int i, int j) const {
    return friction[static_cast<std::size_t>(i * materials() + j)];
  }
  RollingResistance rolling_of(int i, int j) const {
    return rolling.empty() ? RollingResistance{} : rolling[static_cast<std::size_t>(i * materials() + j)];
  }
};

struct TimeControl {
  Real end = 0;   // [s]
  Real step = 0;  // h, fixed or first [s]
  StepControl control = StepControl::fixed;
  Real min_step = 0, max_step = 0;  // [s]; min_step also bounds the retries of a fixed step
  Real tolerance = 2e-8;            // adaptive: local position error per step over the particle's radius
};

struct Integrator {
  Real hht_alpha = 0;
  bool corrected_start = true;  // of spatial bodies, against the first-order disturbance of the multipliers
  RedundantRows redundant = RedundantRows::error;
  ParticleIntegrator particles = ParticleIntegrator::hht;
  // hht: a contact that opens or closes within a step acts over the part of the step that it is closed; else
  // the force at the end of the step stands for all of it, as in the paper.
  bool resolve_events = true;
  int substeps = 1;                       // of velocity-verlet per multibody step
  Precision precision = Precision::full;  // mixed: velocity-verlet only
  Real residual_tolerance = 1e-8;         // scaled, both sides
  Real correction_tolerance = 1e-8;       // scaled by radius (particles) or length scale (bodies)
  int max_iterations = 50;                // of the Newton-like loop
};

// What a history records the contacts of.
struct ContactTarget {
  std::string name;
  std::vector<int> bodies;  // indices into Model::bodies: one, or those of a row
  bool row = false;
  int wall = -1;  // index into Model::walls, or -1
  int mesh = -1;  // index into the body's meshes, which it is about; -1: all of the body
};

struct Output {
  std::string directory;
  Real snapshot_interval = 0;         // [s]; 0: none but the first and last state
  Real history_interval = 0;          // [s]; 0: every step
  Real checkpoint_interval = 0;       // [s] of simulated time; 0: none of these
  Real checkpoint_wall_interval = 0;  // [s] of the run's own time without a checkpoint; 0: none of these
  bool history_csv = false;
  bool contacts = false, links = true;   // whether snapshots show them as lines
  int compression = 0;                   // of particles in snapshots and checkpoints: 0, or deflate's level
  std::int64_t history_reactions = 100;  // joints and drivers, the first so many
  std::int64_t history_efforts = 100;    // motors and all else on joints, the first so many
  std::int64_t history_coordinates = 0;  // joints with coordinates, the first so many
  std::int64_t history_bushings = 100;   // the first so many
  std::vector<std::string> fields;       // of particles in snapshots: names in dem/reports/output_fields.hpp
  std::vector<SurfaceField> surface_fields;  // of triangles in snapshots, each once
  std::vector<int> history_bodies;           // indices into Model::bodies
  std::vector<GlobalId> history_particles;   // global ids
  std::vector<ContactTarget> history_contacts;

  bool shows(SurfaceField field) const {
    return std::ranges::find(surface_fields, field) != surface_fields.end();
  }
  // Whether what contacts lose at triangles is added up as time goes on.
  bool adds_up_works() const {
    return shows(SurfaceField::impact_work) || shows(SurfaceField::sliding_work) ||
           shows(SurfaceField::wear_depth);
  }
};

// Of the discs of a 2D model whose masses follow from densities; 0 where there are none.
struct DiscThickness {
  Real smallest = 0, largest = 0;  // [m]
};

// How the particles are spread over the ranks; no result depends on it.
struct Parallel {
  Real imbalance = 0.2;  // boxes are cut anew past it: largest work of a rank over the mean, less 1
  Transport transport = Transport::automatic;
};

struct Model {
  std::string title;
  Space space;
  Vec3 gravity;  // [m/s^2]
  Contact contact;
  std::vector<Wall> walls;  // the deck's planes, then the sides of the space that are walls
  std::vector<ModelMesh> meshes;
  ParticleSet particles;  // start state; this rank's part
  DiscThickness disc_thickness;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Driver> drivers;
  std::vector<SpringDamper> spring_dampers;
  std::vector<TorsionalSpringDamper> torsional_spring_dampers;
  std::vector<Bushing> bushings;
  std::vector<AppliedForce> applied_forces;
  std::vector<Motor> motors;
  std::vector<JointSpring> joint_springs;
  std::vector<JointLimit> joint_limits;
  std::vector<JointFriction> joint_frictions;
  std::vector<Coupler> couplers;
  TimeControl time;
  Integrator integrator;
  Output output;
  Parallel parallel;
  bool consistent_velocities = false;  // the bodies' at t = 0 are changed to agree with joints and drivers

  // Whether particles rotate: only contacts that rub turn them.
  bool rotates() const { return !contact.friction.empty(); }
  // Whether contacts resist rolling or twisting.
  bool rolls() const { return !contact.rolling.empty(); }
  bool attracts() const {
    return std::ranges::any_of(contact.laws, [](const KelvinVoigt& law) { return law.attracts(); });
  }
};

}  // namespace scree
