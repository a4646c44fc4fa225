// All choices of the deck: the enums that the model stores, and their words.
#pragma once

#include "deck/choice.hpp"

namespace scree {

// ---- the domain -------------------------------------------------------------------------------------------

enum class Boundary { open, wall, periodic };
template <>
inline constexpr auto kWords<Boundary> = std::to_array<Word<Boundary>>({{"open", Boundary::open},
                                                                        {"wall", Boundary::wall},
                                                                        {"periodic", Boundary::periodic}});

// Treatment of a particle whose centre leaves through an open side.
enum class OutsidePolicy {
  error,   // the simulation fails with a message that names the particle
  remove,  // removed and counted; its energy is accounted as carried out
  drift    // counted; ballistic: moves under gravity alone, excluded from contact detection
};
template <>
inline constexpr auto kWords<OutsidePolicy> =
    std::to_array<Word<OutsidePolicy>>({{"error", OutsidePolicy::error},
                                        {"remove", OutsidePolicy::remove},
                                        {"ballistic", OutsidePolicy::drift}});
template <>
inline constexpr auto kFormerWords<OutsidePolicy> =
    std::to_array<Word<OutsidePolicy>>({{"drift", OutsidePolicy::drift}});

// ---- time -------------------------------------------------------------------------------------------------

enum class StepControl { fixed, adaptive };
template <>
inline constexpr auto kWords<StepControl> =
    std::to_array<Word<StepControl>>({{"fixed", StepControl::fixed}, {"adaptive", StepControl::adaptive}});

enum class ParticleIntegrator { hht, velocity_verlet };
template <>
inline constexpr auto kWords<ParticleIntegrator> = std::to_array<Word<ParticleIntegrator>>(
    {{"hht", ParticleIntegrator::hht}, {"velocity-verlet", ParticleIntegrator::velocity_verlet}});

// Treatment of a contact that opens or closes within an implicit step.
enum class ContactEvents {
  resolved,    // the force acts over the part of the step in which the contact is closed
  end_of_step  // the force at the end of the step acts over the whole step, as in the paper
};
template <>
inline constexpr auto kWords<ContactEvents> = std::to_array<Word<ContactEvents>>(
    {{"resolved", ContactEvents::resolved}, {"end-of-step", ContactEvents::end_of_step}});

// Redundant constraint rows of joints and drivers.
enum class RedundantRows {
  error,  // the run is refused; the message names the rows
  share   // minimum-norm reactions: the least ones that hold the motion
};
template <>
inline constexpr auto kWords<RedundantRows> = std::to_array<Word<RedundantRows>>(
    {{"error", RedundantRows::error}, {"minimum-norm", RedundantRows::share}});
template <>
inline constexpr auto kFormerWords<RedundantRows> =
    std::to_array<Word<RedundantRows>>({{"share", RedundantRows::share}});

// Precision of the particles on a GPU. The CPU always computes in full precision.
enum class Precision {
  full,  // double throughout
  mixed  // state and sums at about double, contact forces in single
};
template <>
inline constexpr auto kWords<Precision> = std::to_array<Word<Precision>>({{"double", Precision::full},
                                                                          {"mixed", Precision::mixed}});

// Adhesion model of surfaces with a work of adhesion.
enum class Adhesion {
  jkr,  // the contact persists under tension up to the pull-off force: Johnson, Kendall, Roberts
  dmt   // a constant adhesive force while the surfaces touch: Derjaguin, Muller, Toporov
};
template <>
inline constexpr auto kWords<Adhesion> = std::to_array<Word<Adhesion>>({{"jkr", Adhesion::jkr},
                                                                        {"dmt", Adhesion::dmt}});

// The bodies' velocities at t = 0.
enum class StartVelocities {
  given,      // the run is refused where the velocities contradict joints and drivers
  consistent  // the velocities are corrected to agree with joints and drivers
};
template <>
inline constexpr auto kWords<StartVelocities> = std::to_array<Word<StartVelocities>>(
    {{"given", StartVelocities::given}, {"consistent", StartVelocities::consistent}});

// How the coefficients of a pair of materials that the deck does not give follow from the pairs of each
// material with itself.
enum class Mixing { none, geometric, arithmetic, harmonic, minimum, maximum };
template <>
inline constexpr auto kWords<Mixing> = std::to_array<Word<Mixing>>({{"none", Mixing::none},
                                                                    {"geometric", Mixing::geometric},
                                                                    {"arithmetic", Mixing::arithmetic},
                                                                    {"harmonic", Mixing::harmonic},
                                                                    {"minimum", Mixing::minimum},
                                                                    {"maximum", Mixing::maximum}});

// ---- bodies -----------------------------------------------------------------------------------------------

enum class BodyKind {
  planar,  // moves in a plane z = const, rotates about z
  spatial
};
template <>
inline constexpr auto kWords<BodyKind> = std::to_array<Word<BodyKind>>({{"planar", BodyKind::planar},
                                                                        {"spatial", BodyKind::spatial}});

// Homogeneous solids that define a body's mass properties; axes along z.
enum class SolidKind { sphere, box, cylinder, capsule, mesh };
template <>
inline constexpr auto kWords<SolidKind> = std::to_array<Word<SolidKind>>({{"sphere", SolidKind::sphere},
                                                                          {"box", SolidKind::box},
                                                                          {"cylinder", SolidKind::cylinder},
                                                                          {"capsule", SolidKind::capsule},
                                                                          {"mesh", SolidKind::mesh}});

// The solid that a mesh stands for.
enum class MeshInertia {
  exact,   // the volume that the mesh encloses
  convex,  // the volume of its convex hull
  shell    // a thin shell on the mesh
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
  screw,              // as cylindrical, and the displacement along the axis is lead times the revolutions
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

// The coordinates of a joint, on which drivers, motors, springs and couplers act.
enum class JointCoordinate {
  angle,         // angle of body 2 minus that of body 1, about the axis
  displacement,  // displacement of body 2's point along body 1's axis
  length,        // distance from body 1's point to body 2's point
  angle_1,       // universal joint: rotation of the cross relative to body 1, about body 1's arm
  angle_2        // universal joint: rotation of body 2 relative to the cross, about body 2's arm
};
template <>
inline constexpr auto kWords<JointCoordinate> =
    std::to_array<Word<JointCoordinate>>({{"angle", JointCoordinate::angle},
                                          {"displacement", JointCoordinate::displacement},
                                          {"length", JointCoordinate::length},
                                          {"angle_1", JointCoordinate::angle_1},
                                          {"angle_2", JointCoordinate::angle_2}});

// How the effort (generalized force) of a motor is determined.
enum class MotorKind {
  effort,   // a function of time
  line,     // linear torque-speed curve: falls linearly with the joint's rate
  speed,    // a controller of the rate
  position  // a servo: a controller of the position
};
template <>
inline constexpr auto kWords<MotorKind> = std::to_array<Word<MotorKind>>({{"effort", MotorKind::effort},
                                                                          {"torque-speed", MotorKind::line},
                                                                          {"speed", MotorKind::speed},
                                                                          {"position", MotorKind::position}});
template <>
inline constexpr auto kFormerWords<MotorKind> = std::to_array<Word<MotorKind>>({{"line", MotorKind::line}});

// How the force of a cylinder is determined.
enum class CylinderKind {
  force,  // a function of time
  speed,  // a controller of the rate of the length
  length  // a servo: a controller of the length
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

// Prescribed motion of a wall.
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

// Interpolation between the points of a table.
enum class Interpolation {
  natural,   // cubic spline, class C2; second derivative 0 at both ends
  clamped,   // cubic spline, class C2; the given rates at both ends
  monotone,  // quintic pieces, class C2; monotone between the points, and local
  linear     // class C0: the rate jumps, so it is not allowed for motions
};
template <>
inline constexpr auto kWords<Interpolation> =
    std::to_array<Word<Interpolation>>({{"natural", Interpolation::natural},
                                        {"clamped", Interpolation::clamped},
                                        {"monotone", Interpolation::monotone},
                                        {"linear", Interpolation::linear}});

// ---- output -----------------------------------------------------------------------------------------------

// Fields that snapshots have of each triangle of the meshes.
enum class SurfaceField { pressure, shear, impact_work, sliding_work, wear_depth };
template <>
inline constexpr auto kWords<SurfaceField> =
    std::to_array<Word<SurfaceField>>({{"pressure", SurfaceField::pressure},
                                       {"shear", SurfaceField::shear},
                                       {"impact_work", SurfaceField::impact_work},
                                       {"sliding_work", SurfaceField::sliding_work},
                                       {"wear_depth", SurfaceField::wear_depth}});

// Regions whose particles the history counts.
enum class RegionKind { box, sphere, cylinder };
template <>
inline constexpr auto kWords<RegionKind> = std::to_array<Word<RegionKind>>(
    {{"box", RegionKind::box}, {"sphere", RegionKind::sphere}, {"cylinder", RegionKind::cylinder}});

// ---- particles --------------------------------------------------------------------------------------------

// How the positions of a group of particles are given.
enum class GroupKind { list, row, lattice, random, file };
template <>
inline constexpr auto kWords<GroupKind> = std::to_array<Word<GroupKind>>({{"list", GroupKind::list},
                                                                          {"row", GroupKind::row},
                                                                          {"lattice", GroupKind::lattice},
                                                                          {"random", GroupKind::random},
                                                                          {"file", GroupKind::file}});

enum class DistributionKind { constant, uniform, normal, lognormal, rosin_rammler, table };
template <>
inline constexpr auto kWords<DistributionKind> =
    std::to_array<Word<DistributionKind>>({{"constant", DistributionKind::constant},
                                           {"uniform", DistributionKind::uniform},
                                           {"normal", DistributionKind::normal},
                                           {"lognormal", DistributionKind::lognormal},
                                           {"rosin_rammler", DistributionKind::rosin_rammler},
                                           {"table", DistributionKind::table}});

// The region in which an inserter's particles are born.
enum class InserterKind { box, cylinder, sphere, mesh, face };
template <>
inline constexpr auto kWords<InserterKind> =
    std::to_array<Word<InserterKind>>({{"box", InserterKind::box},
                                       {"cylinder", InserterKind::cylinder},
                                       {"sphere", InserterKind::sphere},
                                       {"mesh", InserterKind::mesh},
                                       {"face", InserterKind::face}});

// The region in which an outlet removes particles.
enum class OutletKind { box, cylinder, sphere, plane };
template <>
inline constexpr auto kWords<OutletKind> = std::to_array<Word<OutletKind>>({{"box", OutletKind::box},
                                                                            {"cylinder",
                                                                             OutletKind::cylinder},
                                                                            {"sphere", OutletKind::sphere},
                                                                            {"plane", OutletKind::plane}});

// What happens to a particle that finds no free position when it is due.
enum class BlockedPolicy {
  wait,  // it is tried again at the inserter's next instants
  drop,  // it is left out and counted
  error  // the run ends
};
template <>
inline constexpr auto kWords<BlockedPolicy> = std::to_array<Word<BlockedPolicy>>(
    {{"wait", BlockedPolicy::wait}, {"drop", BlockedPolicy::drop}, {"error", BlockedPolicy::error}});

// What a distribution, or the shares of a mixture, count.
enum class CountedBy { number, mass };
template <>
inline constexpr auto kWords<CountedBy> = std::to_array<Word<CountedBy>>({{"number", CountedBy::number},
                                                                          {"mass", CountedBy::mass}});

// How the components of a mixture follow each other: each as close to its share as possible, or at random.
enum class MixtureShares { exact, drawn };
template <>
inline constexpr auto kWords<MixtureShares> =
    std::to_array<Word<MixtureShares>>({{"exact", MixtureShares::exact}, {"drawn", MixtureShares::drawn}});

// ---- ranks and devices ------------------------------------------------------------------------------------

// How ghost data are sent between the GPUs of several ranks.
enum class Transport { automatic, peer, cuda_aware, nccl, staged };
template <>
inline constexpr auto kWords<Transport> = std::to_array<Word<Transport>>({{"auto", Transport::automatic},
                                                                          {"peer", Transport::peer},
                                                                          {"cuda-aware",
                                                                           Transport::cuda_aware},
                                                                          {"nccl", Transport::nccl},
                                                                          {"staged", Transport::staged}});

// The device that computes the particles of a run: --backend of the command line.
enum class BackendChoice { automatic, cpu, cuda };
template <>
inline constexpr auto kWords<BackendChoice> = std::to_array<Word<BackendChoice>>(
    {{"auto", BackendChoice::automatic}, {"cpu", BackendChoice::cpu}, {"cuda", BackendChoice::cuda}});

}  // namespace scree
