// Inserters and outlets of the deck: regions in which particles are born during a run, how many, when and of
// which kind, and regions in which they are removed.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/mat3.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"
#include "model/data/bodies.hpp"
#include "physics/birth_schedule.hpp"
#include "physics/outlet_region.hpp"

namespace scree {

class Mixture;  // model/derived/mixture.hpp

// What the schedule of an inserter counts: particles, their mass [kg], or their volume, in 2D their area
// [m^3, m^2].
enum class Amount { number, mass, volume };

// A region at t = 0, in the global frame; on a carrier it moves with it afterwards.
struct BirthRegion {
  InserterKind kind = InserterKind::box;
  Vec3 min, max;      // box: its corners; mesh: those of the box around it [m]
  Vec3 center;        // sphere, face [m]
  Vec3 ends[2];       // cylinder: of its axis [m]
  Real radius = 0;    // cylinder, sphere; face: of a disc, 0 for a rectangle [m]
  Vec3 half_side[2];  // face: from the centre to the middle of two sides; in 2D the second is 0 [m]
  int mesh = -1;      // index into Model::meshes
  Vec3 mesh_origin;   // position of the mesh's origin [m]
  Mat3 mesh_axes;     // rows: the mesh's axes
  // Volume of the region [m^3], in 2D its area [m^2]; of a face its area [m^2], in 2D its length [m].
  Real size = 0;
};

struct Inserter {
  std::string name;
  BirthRegion region;
  // The body or wall on which the region moves: an index of the bodies, then of the walls with a pose, or
  // kGround.
  int carrier = kGround;
  Vec3 velocity;  // of the particles at birth, at t = 0 in the global frame, relative to the carrier [m/s]
  Real random_velocity = 0;        // half-width of a random part of each component [m/s]
  Amount amount = Amount::number;  // the unit of the schedule
  std::int64_t seed = 0;
  BirthSchedule schedule = BirthSchedule::at_once(0, 0);
  Real interval = 0;  // births happen at start + k * interval [s]; 0: with each step
  std::shared_ptr<const Mixture> mixture;
  Real gap = 0;            // smallest distance to particles and surfaces at birth [m]
  std::int64_t tries = 0;  // positions tried for a particle at one instant
  BlockedPolicy blocked = BlockedPolicy::wait;
  std::int64_t most_waiting = std::numeric_limits<std::int64_t>::max();  // more of them end the run
  std::int64_t most_births = 0;                                          // until the end of the run
};

struct Outlet {
  std::string name;
  OutletRegion region;    // at t = 0, in the global frame; on a carrier it moves with it afterwards
  int carrier = kGround;  // as of an inserter
  // Particles are removed at start + k * interval, until `end` [s].
  Real start = 0, end = kInfinity, interval = 0;
};

}  // namespace scree
