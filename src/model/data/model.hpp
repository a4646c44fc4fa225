// The simulated system, constant after it was built from the deck. SI units.
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
#include "model/data/bodies.hpp"
#include "model/data/history_region.hpp"
#include "model/data/inserters.hpp"
#include "model/data/joint_forces.hpp"
#include "model/data/particles.hpp"
#include "model/data/stop_condition.hpp"
#include "physics/contact_parameters.hpp"

namespace scree {

struct HullCorners;  // mesh/hull_corners.hpp
struct SurfaceMesh;  // mesh/surface_mesh.hpp

enum Side { kXMin, kXMax, kYMin, kYMax, kZMin, kZMax, kSides };
inline constexpr std::array<const char*, kSides> kSideNames = {"x_min", "x_max", "y_min",
                                                               "y_max", "z_min", "z_max"};

struct Space {
  int dimension = 3;                        // 2: every z stays 0 and the z sides do not exist
  Vec3 min, max;                            // [m]; in 2D min.z = max.z = 0
  std::array<Boundary, kSides> boundary{};  // periodic sides come in pairs
  int wall_material = 0;                    // material of the sides that are walls
  OutsidePolicy leaving = OutsidePolicy::error;
};

// Prescribed motion of a wall: one coordinate, relative to its value at t = 0.
struct WallMotion {
  WallMotionKind kind = WallMotionKind::translation;
  Vec3 axis;                // unit vector: the direction, or the axis of the rotation
  Vec3 point;               // a point of the rotation axis [m]
  TimeFunction coordinate;  // [m] or [rad]
};

// A surface of the ground: a plane with solid behind it (half space), or triangles.
struct Wall {
  std::string name;
  Vec3 point;   // point of the plane, or origin of the mesh [m]
  Vec3 normal;  // unit vector into the free side
  int material = 0;
  int mesh = -1;                      // index into Model::meshes; -1: a plane
  std::vector<WallMotion> motions{};  // applied one after the other; point and normal are those at t = 0
  Vec3 surface_velocity{};  // tangential velocity in the wall's frame, the global one at t = 0 [m/s]

  bool moves() const { return !motions.empty(); }
  bool is_conveyor() const { return surface_velocity != Vec3{}; }  // tangential surface velocity
  // Whether its contacts are computed from the surface's pose: all surfaces but static planes.
  bool has_pose() const { return mesh >= 0 || moves() || is_conveyor(); }
};

// Triangles that walls and bodies refer to.
struct ModelMesh {
  std::string name;  // for messages
  std::shared_ptr<const SurfaceMesh> surface;
  std::vector<Real> solid_masses{};  // masses of the solids that the mesh stands for, each value once [kg]
  std::size_t triangles_before = 0;  // number before coarsening; 0: not coarsened
  Real moved = 0;  // largest distance of a vertex of the file from the coarsened surface [m]
  // Largest distance between the facets and the surface that they approximate [m]: exact for parametric
  // shapes, otherwise MeshCurvature::sag.
  Real deviation = 0;
  bool deviation_is_exact = false;
  std::string fitting{};   // "segments = 32": the value that fits the size of the particles; empty: not known
  bool is_fitted = false;  // the deck leaves the key out, and the fitting value is used
  std::string crossing{};  // where shells of the mesh intersect, for messages; empty: nowhere
  // Vertices of the convex hull in the mesh's frame; null where no body has the mesh, or there is no plane.
  std::shared_ptr<const HullCorners> corners{};
};

// A pair of materials that the deck does not give, combined by contact.mixing.
struct CombinedPair {
  int material[2] = {0, 0};
  std::string keys;  // as in [[contact.pairs]]: "friction = 0.3, restitution = 0.8"
};

// One law per unordered pair of materials.
struct Contact {
  std::vector<std::string> material_names;
  std::vector<NormalLawParameters> laws;   // [i * materials + j], symmetric
  std::vector<Friction> friction;          // [i * materials + j]; empty: no contact has friction
  std::vector<RollingParameters> rolling;  // [i * materials + j]; empty: no contact has rolling resistance
  std::vector<Real> wear;  // [i * materials + j], volume per dissipation of friction [1/Pa]; empty: no wear
  std::vector<CombinedPair> combined;  // the pairs that the deck does not give
  Real interaction_range = 0;          // largest distance between surfaces at which a force acts [m]
  Real skin = 0;  // distance between surfaces up to which the neighbour list has pairs [m]
  bool connected_bodies_touch = false;
  bool skin_is_default = false;  // the deck names none: explicit steps in double choose it as they go

  int materials() const { return static_cast<int>(material_names.size()); }
  const NormalLawParameters& law(int i, int j) const {
    return laws[static_cast<std::size_t>(i * materials() + j)];
  }
  // Only where some pair has friction.
  const Friction& friction_of(int i, int j) const {
    return friction[static_cast<std::size_t>(i * materials() + j)];
  }
  RollingParameters rolling_of(int i, int j) const {
    return rolling.empty() ? RollingParameters{} : rolling[static_cast<std::size_t>(i * materials() + j)];
  }
};

struct TimeControl {
  Real end = 0;   // [s]
  Real step = 0;  // fixed, or of the first step [s]
  StepControl control = StepControl::fixed;
  Real min_step = 0, max_step = 0;  // [s]; min_step also bounds retried steps with fixed control
  Real tolerance = 2e-8;  // adaptive: local error of a position per step, relative to the particle's radius
};

struct Integrator {
  Real hht_alpha = 0;
  bool corrected_start = true;  // spatial bodies: avoids a first-order error of the multipliers
  RedundantRows redundant = RedundantRows::error;
  ParticleIntegrator particles = ParticleIntegrator::hht;
  // hht: a contact that opens or closes within a step acts over the part of the step in which it is closed;
  // otherwise the force at the end of the step acts over the whole step, as in the paper.
  bool resolve_events = true;
  int substeps = 1;                       // velocity-verlet steps per multibody step
  Precision precision = Precision::full;  // mixed: velocity-verlet only
  Real residual_tolerance = 1e-8;         // scaled, for both sides
  Real correction_tolerance = 1e-8;       // relative to the radius (particles) or length scale (bodies)
  int max_iterations = 50;                // of the Newton loop
};

// An object whose contacts the history records.
struct ContactTarget {
  std::string name;
  std::vector<int> bodies;  // indices into Model::bodies: one body, or those of a row
  bool row = false;
  int wall = -1;  // index into Model::walls, or -1
  int mesh = -1;  // index into the body's meshes; -1: the whole body
};

struct Output {
  std::string directory;
  Real snapshot_interval = 0;    // [s]; 0: only the first and the last state
  Real history_interval = 0;     // [s]; 0: every step
  Real checkpoint_interval = 0;  // [s] of simulated time; 0: none at such intervals
  // Wall-clock time since the last checkpoint [s]; 0: none at such intervals.
  Real checkpoint_wall_interval = 0;
  bool history_csv = false;
  bool contacts = false, links = true;   // whether snapshots have them as line segments
  int compression = 0;                   // deflate level for particles in snapshots and checkpoints; 0: none
  std::int64_t history_reactions = 100;  // number of joints and drivers recorded
  std::int64_t history_efforts = 100;    // number of motors, springs, limits and frictions of joints recorded
  std::int64_t history_coordinates = 0;  // number of joints recorded whose coordinates are
  std::int64_t history_bushings = 100;   // number of bushings recorded
  std::vector<std::string> fields;       // of particles in snapshots; names in dem/reports/output_fields.hpp
  std::vector<SurfaceField> surface_fields;  // of triangles in snapshots, each once
  std::vector<int> history_bodies;           // indices into Model::bodies
  std::vector<GlobalId> history_particles;   // global ids
  std::vector<ContactTarget> history_contacts;
  std::vector<HistoryRegion> history_regions;

  bool shows(SurfaceField field) const {
    return std::ranges::find(surface_fields, field) != surface_fields.end();
  }
  // Whether the dissipation of contacts is summed at each triangle.
  bool adds_up_works() const {
    return shows(SurfaceField::impact_work) || shows(SurfaceField::sliding_work) ||
           shows(SurfaceField::wear_depth);
  }
};

// Thickness of the discs of a 2D model whose masses follow from densities; 0 where there are none.
struct DiscThickness {
  Real smallest = 0, largest = 0;  // [m]
};

// Distribution of the particles over the ranks; results do not depend on it.
struct Parallel {
  Real imbalance = 0.2;  // limit for rebalancing: largest work of a rank over the mean, minus 1
  Transport transport = Transport::automatic;
};

struct Model {
  std::string title;
  Space space;
  Vec3 gravity;  // [m/s^2]
  Contact contact;
  std::vector<Wall> walls;  // the planes of the deck, then the sides of the domain that are walls
  std::vector<ModelMesh> meshes;
  ParticleSet particles;  // initial state of this rank's particles
  std::vector<Inserter> inserters;
  std::vector<Outlet> outlets;
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
  std::vector<StopCondition> stop_conditions;
  Parallel parallel;
  // Initial velocities of bodies are corrected to agree with joints and drivers.
  bool consistent_velocities = false;

  // Whether particles rotate: only where contacts have friction.
  bool rotates() const { return !contact.friction.empty(); }
  // Whether contacts resist rolling or twisting.
  bool rolls() const { return !contact.rolling.empty(); }
  bool is_cohesive() const {
    return std::ranges::any_of(contact.laws,
                               [](const NormalLawParameters& law) { return law.is_cohesive(); });
  }
};

}  // namespace scree
