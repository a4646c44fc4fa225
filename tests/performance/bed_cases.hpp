// The settled beds measured by bed.cpp: a tile of 10,000 particles, repeated to the size wanted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/data/model.hpp"
#include "model/data/share.hpp"

namespace scree {

inline constexpr std::int64_t kTileParticles = 10000;

// Spheres of diameter 1 and mass 1 on the floor z = 0 under gravity 1, walls at the sides. tile: file with
// the centres in a square that repeats in x and y. particles: a multiple of kTileParticles, laid out as a
// rectangle of tiles that is as near to a square as the number permits. share: the part of them to make.
Model sphere_bed(const std::string& tile, std::int64_t particles, const Share& share = {});
inline constexpr Real kSphereStep = 1e-4;  // step of velocity-Verlet [s]
// h sqrt(K/m) = 1.2: the length of an implicit step [s].
Real implicit_sphere_step(const Model& bed);
// A taut row of 20 spheres connected by spring-dampers, its ends pinned, within the surface of the bed: one
// diameter below the surface; the particles at its position are removed. A constant sideways force on each
// sphere keeps it moving among the particles.
void add_net(Model& bed);
// The row deep within the bed, drawn through it by its ends at constant speed, a fifth of a diameter in a
// thousand steps. The bed's time ends where the plough comes near the wall.
void add_plough(Model& bed);

// Contact laws of a bed beyond those that it is settled with.
struct BedContact {
  Real friction = 0;   // with a tangential stiffness of 2/7 of the normal one; 0: the particles do not rotate
  Real rolling = 0;    // coefficient, with twisting resistance, as decks have it; 0: neither
  bool hertz = false;  // Hertz and Mindlin, about as stiff as the linear law at the bottom of the bed
  int materials = 1;   // all alike; particles take turns
};
// ", Hertz, friction 0.5, rolling 0.1, 2 materials"
std::string contact_text(const BedContact& contact);
void set_contact(Model& bed, const BedContact& contact, const Share& share = {});

// Discs, periodic in x, tiles in a row. tile: of settled_discs.
Model disc_bed(const std::vector<Vec3>& tile, std::int64_t particles);
inline constexpr Real kDiscStep = 1e-5;  // step of velocity-Verlet [s]
// 100 x 100 discs settled on the CPU; takes some ten seconds.
std::vector<Vec3> settled_discs();

}  // namespace scree
