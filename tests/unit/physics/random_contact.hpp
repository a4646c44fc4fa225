// Two spheres in contact with random motion, for properties that hold for all laws.
#pragma once

#include <random>

#include "physics/contact_law.hpp"

namespace scree {

// Numbers in [-1, 1), reproducible.
class RandomNumbers {
 public:
  Real operator()() { return static_cast<Real>(engine_()) / 2147483648.0 - 1; }
  Vec3 vector() {
    const Real x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }

 private:
  std::mt19937 engine_{12345};
};

struct RandomContact {
  MovingPair pair;
  ContactHistory history;
  Vec3 spin_i, spin_j;
};

// A contact of partners i and j of sizes around 1; swapped: the same contact seen from j. closeness: sum of
// the radii over the distance of the centres; below 1 the partners are apart.
inline RandomContact contact_of(RandomNumbers random, Real h, bool swapped, Real closeness = 1.05) {
  const Vec3 position[2] = {random.vector(), random.vector()};
  const Vec3 velocity[2] = {random.vector(), random.vector()}, spin[2] = {random.vector(), random.vector()};
  const Real mass[2] = {2 + random(), 2 + random()};
  const Real distance = norm(position[0] - position[1]), share = 0.5 + 0.3 * random();
  const Real radius[2] = {share * closeness * distance, (1 - share) * closeness * distance};
  const Vec3 along = random.vector();
  const int i = swapped, j = 1 - i;
  const auto partner = [&](int k) {
    return RotatingPartner{spin[k], radius[k], 0.4 * mass[k] * radius[k] * radius[k]};
  };
  RandomContact out{};
  const Vec3 relative = velocity[i] - velocity[j];
  const ContactGeometry geometry = sphere_pair(position[i] - position[j], radius[i] + radius[j]);
  out.pair = {{geometry, relative, {radius[i], radius[j], mass[i], mass[j]}},
              sphere_motion(geometry, h * relative, partner(i), partner(j), h)};
  const Vec3 spring = tangential_part(swapped ? -along : along, out.pair.motion.normal0);
  out.spin_i = spin[i], out.spin_j = spin[j];
  out.history = {10 * spring, Real(0.1) * (swapped ? -along : along), true};
  return out;
}

}  // namespace scree
