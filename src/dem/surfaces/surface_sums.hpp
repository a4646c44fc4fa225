// What the contacts of a surface sum to: forces and torques on the body that carries it, and for implicit
// steps their derivatives. Exact sums: the same bits in any order of the contacts and for any split over
// ranks.
#pragma once

#include <algorithm>
#include <vector>

#include "base/exact_sum.hpp"
#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/body_exchange.hpp"
#include "physics/contact_books.hpp"
#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// What the step solves with, of one contact.
struct StepContact {
  StepContactForce step;  // what the step's end must hold for the step to be right: see step_contact_force
  Real end_force;         // at the end itself [N]
  Vec3 normal;            // there
};

// One contact of a particle with a surface on a body at an instant; evaluated once, for both.
struct SurfaceLoad {
  bool touches;                    // else nothing below has a meaning
  ContactLoadOf<Real, Vec3> load;  // on the particle
  ContactEnergy energy;
  Vec3 arm;                // from the body's centre to where they touch [m]
  Vec3 particle_arm;       // contact_arm() of the particle
  RubbingLosses losses{};  // of laws that move
  Real slide_power = 0;    // of the force on a surface that runs along itself [W]
};

// The same over an implicit step.
struct SurfaceStep {
  bool touches;
  StepContact contact;
  ContactBooks books;
  Vec3 arm;               // at the end
  Vec3 contact_arm{};     // from the surface's point to where they touch, at the end [m]
  bool is_sphere = true;  // the surface
};

// Terms of one contact in the sums of its surface. kWrench: force and torque on the body about its centre,
// and slide_power; kStepTerms: at the end of the step, for the step, and the packed 6 x 6 blocks of stiffness
// and damping.
inline constexpr int kBlockRows = 6, kWrenchTerms = kBlockRows + 1, kBlockTerms = 21;
inline constexpr int kStepTerms = 2 * kWrenchTerms + 2 * kBlockTerms;

SCREE_HD Real component(Vec3 force, Vec3 torque, int k) {
  return k == 0   ? force.x
         : k == 1 ? force.y
         : k == 2 ? force.z
         : k == 3 ? torque.x
         : k == 4 ? torque.y
                  : torque.z;
}

SCREE_HD Real sum_term(const SurfaceLoad& c, int k) {
  if (k == kBlockRows) return c.slide_power;
  const Vec3 force = -c.load.force;
  return component(force, cross(c.arm, force) + c.load.torque_j, k);
}

// Place of the k-th of kStepTerms in the blocks, from 2 kWrenchTerms on.
struct BlockPlace {
  bool is_stiffness;
  int row, column;
};
SCREE_HD BlockPlace block_place(int k) {
  const bool is_stiffness = k < 2 * kWrenchTerms + kBlockTerms;
  int column = k - 2 * kWrenchTerms - (is_stiffness ? 0 : kBlockTerms), row = 0;
  for (; column >= kBlockRows - row; ++row) column -= kBlockRows - row;
  return {is_stiffness, row, row + column};
}

// The wrench is -F w with w = (n, arm x n), along which the overlap grows with the body's motion.
SCREE_HD Real sum_term(const SurfaceStep& c, int k) {
  const Vec3 n = c.contact.normal, moment = cross(c.arm, n);
  if (k == kBlockRows || k == kWrenchTerms + kBlockRows) return 0;  // a surface's own motion only rubs
  if (k < kWrenchTerms) return -c.contact.end_force * component(n, moment, k);
  if (k < 2 * kWrenchTerms) return -c.contact.step.force * component(n, moment, k - kWrenchTerms);
  const BlockPlace at = block_place(k);
  const Real slope = at.is_stiffness ? c.contact.step.stiffness : c.contact.step.damping;
  return slope * component(n, moment, at.row) * component(n, moment, at.column);
}

// Of the contacts of one surface.
template <int kTerms>
struct SurfaceSums {
  Index surface = 0;  // of the placed ones
  Index contacts = 0;
  ExactSum sum[kTerms];

  Index place() const { return surface; }
  template <class Contact>
  SCREE_HD void add_contact(const Contact& contact) {
    ++contacts;
    for (int k = 0; k < kTerms; ++k) sum[k].add(sum_term(contact, k));
  }
  SCREE_HD void add(const SurfaceSums& part) {
    contacts += part.contacts;
    for (int k = 0; k < kTerms; ++k) sum[k].add(part.sum[k]);
  }
  BodyWrench wrench(int first = 0) const {
    const auto at = [&](int k) { return sum[first + k].value(); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, at(kBlockRows)};
  }
};
using InstantSums = SurfaceSums<kWrenchTerms>;
using StepSums = SurfaceSums<kStepTerms>;

// Ordered by place(), one entry each.
template <class Sums>
std::vector<Sums> merged_by_place(std::vector<Sums> sums) {
  std::stable_sort(sums.begin(), sums.end(),
                   [](const Sums& a, const Sums& b) { return a.place() < b.place(); });
  std::vector<Sums> out;
  for (const Sums& part : sums) {
    if (out.empty() || out.back().place() != part.place())
      out.push_back(part);
    else
      out.back().add(part);
  }
  return out;
}

}  // namespace scree
