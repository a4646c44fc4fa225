// What one particle, or one shape of a body, does to a wall. One text for the CPU and CUDA.
#pragma once

#include "dem/contact_items.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Sums over what touches a wall, at one instant.
enum WallTerm {
  kWallForce,                    // three terms, on the wall [N]
  kWallTorque = kWallForce + 3,  // three terms, about the wall's point [N m]
  kWallContacts = kWallTorque + 3,
  kWallTerms
};

struct WallTerms {
  Real value[kWallTerms];
};

// The wall in question, and what brings positions into the periodic box: torques must not depend on when a
// particle was last wrapped.
struct WallChoice {
  Index wall;        // index into Model::walls
  Index owned;       // particles; the shapes of bodies follow them in the sum
  Vec3 min, period;  // of the space [m]
};

template <class Elastic, class Laws, class Rows>
struct WallContactItem {
  ContactViews<Rows> in;
  Laws laws;
  WallChoice choice;

  SCREE_HD WallTerms operator()(Index k) const {
    const Index i = k < choice.owned ? k : in.first_shape + (k - choice.owned);
    WallTerms sum{};
    for (Index slot = in.wall_offsets[i]; slot < in.wall_offsets[i + 1]; ++slot)
      if (in.walls[slot] == choice.wall) add(i, in.planes[choice.wall], sum);
    return sum;
  }

  SCREE_HD void add(Index i, const WallPlane& wall, WallTerms& sum) const {
    const Vec4 p = in.position[i];
    const Overlap o = wall_overlap(p, wall);
    if (o.overlap <= 0) return;
    const ContactForce c = contact_force<Elastic>(laws.get(in.material[i], wall.material), o.overlap,
                                                  -dot(o.normal, xyz(in.velocity[i])));
    const Vec3 force = -c.force * o.normal;
    ImageCount unused;
    const Vec3 point = wrap(choice.min, choice.period, xyz(p), unused) - o.distance * o.normal;
    const Vec3 torque = cross(point - wall.point, force);
    sum = {{force.x, force.y, force.z, torque.x, torque.y, torque.z, 1}};
  }
};

}  // namespace scree
