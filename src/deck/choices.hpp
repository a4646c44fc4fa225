// Every choice of the deck, once: the enum that the model keeps, and its words.
#pragma once

#include "deck/choice.hpp"

namespace scree {

// ---- the space
// -----------------------------------------------------------------------------------------------

enum class Boundary { open, wall, periodic };
template <>
inline constexpr auto kWords<Boundary> = std::to_array<Word<Boundary>>({{"open", Boundary::open},
                                                                        {"wall", Boundary::wall},
                                                                        {"periodic", Boundary::periodic}});

// What happens to a particle whose centre leaves through an open side.
enum class Leaving {
  error,   // the simulation fails and names it
  remove,  // taken out of the simulation, counted, its energy booked as carried out
  drift    // counted; goes on under gravity alone, kept out of the pair search
};
template <>
inline constexpr auto kWords<Leaving> = std::to_array<Word<Leaving>>({{"error", Leaving::error},
                                                                      {"remove", Leaving::remove},
                                                                      {"drift", Leaving::drift}});

// ---- time
// ----------------------------------------------------------------------------------------------------

enum class StepControl { fixed, adaptive };
template <>
inline constexpr auto kWords<StepControl> =
    std::to_array<Word<StepControl>>({{"fixed", StepControl::fixed}, {"adaptive", StepControl::adaptive}});

enum class ParticleIntegrator { hht, velocity_verlet };
template <>
inline constexpr auto kWords<ParticleIntegrator> = std::to_array<Word<ParticleIntegrator>>(
    {{"hht", ParticleIntegrator::hht}, {"velocity-verlet", ParticleIntegrator::velocity_verlet}});

// How an implicit step meets a contact that opens or closes within it.
enum class ContactEvents {
  resolved,    // it acts over the part of the step that it is closed
  end_of_step  // the force at the end of the step stands for all of it, as in the paper
};
template <>
inline constexpr auto kWords<ContactEvents> = std::to_array<Word<ContactEvents>>(
    {{"resolved", ContactEvents::resolved}, {"end-of-step", ContactEvents::end_of_step}});

// Rows of the joints and drivers that repeat others.
enum class RedundantRows {
  error,  // the run is refused and names them
  share   // they share the load: the least reactions of those that hold the motion
};
template <>
inline constexpr auto kWords<RedundantRows> =
    std::to_array<Word<RedundantRows>>({{"error", RedundantRows::error}, {"share", RedundantRows::share}});

// Of the particles on a GPU. The CPU always computes in full precision.
enum class Precision {
  full,  // double throughout
  mixed  // state and sums at about double, contact forces in single
};
template <>
inline constexpr auto kWords<Precision> = std::to_array<Word<Precision>>({{"double", Precision::full},
                                                                          {"mixed", Precision::mixed}});

// Of surfaces with a work of adhesion.
enum class Adhesion {
  jkr,  // a neck that holds beyond touch: Johnson, Kendall, Roberts
  dmt   // a constant pull while they touch: Derjaguin, Muller, Toporov
};
template <>
inline constexpr auto kWords<Adhesion> = std::to_array<Word<Adhesion>>({{"jkr", Adhesion::jkr},
                                                                        {"dmt", Adhesion::dmt}});

// The bodies' velocities at t = 0.
enum class StartVelocities {
  given,      // the run is refused where they contradict joints and drivers
  consistent  // changed to agree with them
};
template <>
inline constexpr auto kWords<StartVelocities> = std::to_array<Word<StartVelocities>>(
    {{"given", StartVelocities::given}, {"consistent", StartVelocities::consistent}});

// Of a pair of materials that the deck does not give: how coefficients follow from those of each with itself.
enum class Mixing { none, geometric, arithmetic, harmonic, minimum, maximum };
template <>
inline constexpr auto kWords<Mixing> = std::to_array<Word<Mixing>>({{"none", Mixing::none},
                                                                    {"geometric", Mixing::geometric},
                                                                    {"arithmetic", Mixing::arithmetic},
                                                                    {"harmonic", Mixing::harmonic},
                                                                    {"minimum", Mixing::minimum},
                                                                    {"maximum", Mixing::maximum}});

// ---- bodies
// --------------------------------------------------------------------------------------------------

enum class BodyKind {
  planar,  // moves in a plane z = const, turns about z
  spatial
};
template <>
inline constexpr auto kWords<BodyKind> = std::to_array<Word<BodyKind>>({{"planar", BodyKind::planar},
                                                                        {"spatial", BodyKind::spatial}});

// Homogeneous solids that a body is made of; axes along z.
enum class SolidKind { sphere, box, cylinder, capsule, mesh };
template <>
inline constexpr auto kWords<SolidKind> = std::to_array<Word<SolidKind>>({{"sphere", SolidKind::sphere},
                                                                          {"box", SolidKind::box},
                                                                          {"cylinder", SolidKind::cylinder},
                                                                          {"capsule", SolidKind::capsule},
                                                                          {"mesh", SolidKind::mesh}});

// What a mesh that is a solid stands for.
enum class MeshInertia {
  exact,   // what it encloses
  convex,  // what its convex hull encloses
  shell    // a skin on it
};
template <>
inline constexpr auto kWords<MeshInertia> = std::to_array<Word<MeshInertia>>({{"exact", MeshInertia::exact},
                                                                              {"convex", MeshInertia::convex},
                                                                              {"shell", MeshInertia::shell}});

enum class MeshKind {
  file,
  box,
  cylinder,
  cone,
  sphere,
  capsule,
  plate,
  pipe,
  drum,
  screw,
  funnel,
  hopper,
  rectangle,
  line
};
template <>
inline constexpr auto kWords<MeshKind> = std::to_array<Word<MeshKind>>({{"file", MeshKind::file},
                                                                        {"box", MeshKind::box},
                                                                        {"cylinder", MeshKind::cylinder},
                                                                        {"cone", MeshKind::cone},
                                                                        {"sphere", MeshKind::sphere},
                                                                        {"capsule", MeshKind::capsule},
                                                                        {"plate", MeshKind::plate},
                                                                        {"pipe", MeshKind::pipe},
                                                                        {"drum", MeshKind::drum},
                                                                        {"screw", MeshKind::screw},
                                                                        {"funnel", MeshKind::funnel},
                                                                        {"hopper", MeshKind::hopper},
                                                                        {"rectangle", MeshKind::rectangle},
                                                                        {"line", MeshKind::line}});

enum class JointKind {
  revolute,           // the two points coincide, in space the axes are parallel too
  translational,      // body 2's point stays on body 1's axis, no relative rotation
  fixed,              // the two points coincide, no relative rotation
  distance,           // the two points keep their distance
  spherical,          // the two points coincide
  cylindrical,        // body 2's point stays on body 1's axis, the axes are parallel
  screw,              // the same, and the displacement along the axis is lead times the turns about it
  universal,          // the two points coincide, an arm of either body perpendicular to that of the other one
  constant_velocity,  // the two points coincide, equal rates of rotation about two axes
  planar,             // body 2's point stays in body 1's plane, the normals are parallel
  point_on_line,      // body 2's point stays on body 1's axis
  point_on_plane,     // body 2's point stays in body 1's plane
  parallel,           // the axes are parallel
  perpendicular,      // the axes are perpendicular
  orientation         // no relative rotation
};
template <>
inline constexpr auto kWords<JointKind> =
    std::to_array<Word<JointKind>>({{"revolute", JointKind::revolute},
                                    {"translational", JointKind::translational},
                                    {"fixed", JointKind::fixed},
                                    {"distance", JointKind::distance},
                                    {"spherical", JointKind::spherical},
                                    {"cylindrical", JointKind::cylindrical},
                                    {"screw", JointKind::screw},
                                    {"universal", JointKind::universal},
                                    {"constant-velocity", JointKind::constant_velocity},
                                    {"planar", JointKind::planar},
                                    {"point-on-line", JointKind::point_on_line},
                                    {"point-on-plane", JointKind::point_on_plane},
                                    {"parallel", JointKind::parallel},
                                    {"perpendicular", JointKind::perpendicular},
                                    {"orientation", JointKind::orientation}});

// What a joint leaves free that can be driven, pushed and coupled.
enum class JointCoordinate {
  angle,         // of body 2 less that of body 1, about the axis
  displacement,  // of body 2's point along body 1's axis
  length,        // from body 1's point to body 2's
  angle_1,       // of a universal joint: of its cross against body 1, about body 1's arm
  angle_2        // of body 2 against the cross, about body 2's arm
};
template <>
inline constexpr auto kWords<JointCoordinate> =
    std::to_array<Word<JointCoordinate>>({{"angle", JointCoordinate::angle},
                                          {"displacement", JointCoordinate::displacement},
                                          {"length", JointCoordinate::length},
                                          {"angle_1", JointCoordinate::angle_1},
                                          {"angle_2", JointCoordinate::angle_2}});

// What makes the effort of a motor.
enum class MotorKind {
  effort,   // a function of time
  line,     // falls in a straight line with the joint's rate
  speed,    // a controller that wants a rate
  position  // a servo: a controller that wants a position
};
template <>
inline constexpr auto kWords<MotorKind> = std::to_array<Word<MotorKind>>({{"effort", MotorKind::effort},
                                                                          {"line", MotorKind::line},
                                                                          {"speed", MotorKind::speed},
                                                                          {"position", MotorKind::position}});

// What moves a cylinder.
enum class CylinderKind {
  force,  // a function of time
  speed,  // a controller that wants a rate of the length
  length  // a servo that wants a length
};
template <>
inline constexpr auto kWords<CylinderKind> = std::to_array<Word<CylinderKind>>(
    {{"force", CylinderKind::force}, {"speed", CylinderKind::speed}, {"length", CylinderKind::length}});

enum class CouplerKind { gear, belt, rack_and_pinion, differential, sum };
template <>
inline constexpr auto kWords<CouplerKind> =
    std::to_array<Word<CouplerKind>>({{"gear", CouplerKind::gear},
                                      {"belt", CouplerKind::belt},
                                      {"rack-and-pinion", CouplerKind::rack_and_pinion},
                                      {"differential", CouplerKind::differential},
                                      {"sum", CouplerKind::sum}});

// How a wall moves.
enum class WallMotionKind { translation, rotation };
template <>
inline constexpr auto kWords<WallMotionKind> = std::to_array<Word<WallMotionKind>>(
    {{"translation", WallMotionKind::translation}, {"rotation", WallMotionKind::rotation}});

enum class TimeFunctionKind { constant, ramp, sine, step, table };
template <>
inline constexpr auto kWords<TimeFunctionKind> =
    std::to_array<Word<TimeFunctionKind>>({{"constant", TimeFunctionKind::constant},
                                           {"ramp", TimeFunctionKind::ramp},
                                           {"sine", TimeFunctionKind::sine},
                                           {"step", TimeFunctionKind::step},
                                           {"table", TimeFunctionKind::table}});

// How a table is read between its points.
enum class Interpolation {
  natural,   // cubic spline, class C2; second derivative 0 at both ends
  clamped,   // cubic spline, class C2; the given rates at both ends
  monotone,  // quintic, class C2; rises, falls and stands still only where the points do, and is local
  linear     // class C0: its rate jumps, so no motion can follow it
};
template <>
inline constexpr auto kWords<Interpolation> =
    std::to_array<Word<Interpolation>>({{"natural", Interpolation::natural},
                                        {"clamped", Interpolation::clamped},
                                        {"monotone", Interpolation::monotone},
                                        {"linear", Interpolation::linear}});

// ---- output
// --------------------------------------------------------------------------------------------------

// What snapshots tell of each triangle of the meshes.
enum class SurfaceField { pressure, shear, impact_work, sliding_work, wear_depth };
template <>
inline constexpr auto kWords<SurfaceField> =
    std::to_array<Word<SurfaceField>>({{"pressure", SurfaceField::pressure},
                                       {"shear", SurfaceField::shear},
                                       {"impact_work", SurfaceField::impact_work},
                                       {"sliding_work", SurfaceField::sliding_work},
                                       {"wear_depth", SurfaceField::wear_depth}});

// ---- particles
// -----------------------------------------------------------------------------------------------

// Where a group of particles comes from.
enum class GroupKind { list, row, lattice, random, file };
template <>
inline constexpr auto kWords<GroupKind> = std::to_array<Word<GroupKind>>({{"list", GroupKind::list},
                                                                          {"row", GroupKind::row},
                                                                          {"lattice", GroupKind::lattice},
                                                                          {"random", GroupKind::random},
                                                                          {"file", GroupKind::file}});

enum class DistributionKind { constant, uniform, normal, table };
template <>
inline constexpr auto kWords<DistributionKind> =
    std::to_array<Word<DistributionKind>>({{"constant", DistributionKind::constant},
                                           {"uniform", DistributionKind::uniform},
                                           {"normal", DistributionKind::normal},
                                           {"table", DistributionKind::table}});

// ---- ranks and devices
// ---------------------------------------------------------------------------------------

// How ghosts travel between the GPUs of several ranks.
enum class Transport { automatic, cuda_aware, nccl, staged };
template <>
inline constexpr auto kWords<Transport> = std::to_array<Word<Transport>>({{"auto", Transport::automatic},
                                                                          {"cuda-aware",
                                                                           Transport::cuda_aware},
                                                                          {"nccl", Transport::nccl},
                                                                          {"staged", Transport::staged}});

// Where the particles of a run are computed: --backend of the command line.
enum class BackendChoice { automatic, cpu, cuda };
template <>
inline constexpr auto kWords<BackendChoice> = std::to_array<Word<BackendChoice>>(
    {{"auto", BackendChoice::automatic}, {"cpu", BackendChoice::cpu}, {"cuda", BackendChoice::cuda}});

}  // namespace scree
