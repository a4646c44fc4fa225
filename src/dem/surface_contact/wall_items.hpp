// Loads of one particle on a wall. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/contact/contact_items.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Sums over the contacts of a wall at one instant.
enum WallTerm {
  kWallForce,                    // three terms, on the wall [N]
  kWallTorque = kWallForce + 3,  // three terms, about the wall's point [N m]
  kWallContacts = kWallTorque + 3,
  kWallTerms
};

struct WallTerms {
  Real value[kWallTerms];
};

// Selected wall and periodic box: torques must not depend on when a particle was last wrapped.
struct WallChoice {
  Index wall;        // index into Model::walls
  Vec3 min, period;  // of the domain [m]
};

// A contact from the side of the wall: force on the item, and its contact point.
struct WallLoad {
  Vec3 force;    // [N]
  Vec3 to_wall;  // from the item's centre to the point of contact [m]
};

struct EvaluateWallLoad {
  template <class Law, class Pair>
  SCREE_HD WallLoad operator()(const Law& law, const Pair& pair, const typename Law::History& old) const {
    return {law.respond(pair, old).load.force, -pair.geometry.distance * pair.geometry.direction};
  }
  // Bodies account for their loads on walls themselves.
  template <class Views>
  SCREE_HD const WallLoad* stored(const Views&, Index) const {
    return nullptr;
  }
};

template <class Laws, class Rows>
struct WallContactItem {
  ContactWalk<Laws, Rows> walk;
  WallChoice choice;

  SCREE_HD WallTerms operator()(Index i) const {
    const auto self = walk.self(i);
    WallTerms sum{};
    walk.surfaces(self, EvaluateWallLoad{}, [&](const WallLoad& load, Index wall) {
      if (wall == choice.wall) sum = terms(self.p, load);
    });
    return sum;
  }

  SCREE_HD WallTerms terms(Vec4 p, const WallLoad& load) const {
    const Vec3 force = -load.force;
    ImageCount unused;
    const Vec3 point = wrap(choice.min, choice.period, xyz(p), unused) + load.to_wall;
    const Vec3 torque = cross(point - walk.in.numbers.planes[choice.wall].point, force);
    return {{force.x, force.y, force.z, torque.x, torque.y, torque.z, 1}};
  }
};

}  // namespace scree
