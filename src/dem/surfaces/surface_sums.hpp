// Sums over the contacts of a surface: forces and torques on its parent, and for implicit steps their
// derivatives. The sums are exact: they have the same bits for any order of the contacts and any distribution
// over ranks.
#pragma once

#include <algorithm>
#include <vector>

#include "base/exact_sum.hpp"
#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/body_exchange.hpp"
#include "physics/contact_law.hpp"
#include "physics/contact_losses.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// Response of one contact to an implicit step: what the step is solved with.
struct StepContact {
  StepContactForce step;  // force for the end of the step, see step_contact_force
  Real end_force;         // force of the law at the end of the step [N]
  Vec3 normal;            // at the end of the step
  ContactLosses losses;   // only where asked for
};

// One contact of a particle with a surface on a body at an instant; evaluated once for both.
struct SurfaceLoad {
  bool touches;                    // else all members below are undefined
  ContactLoadOf<Real, Vec3> load;  // on the particle
  ContactEnergy energy;
  Vec3 arm;                    // from the body's centre to the contact point [m]
  Vec3 particle_arm;           // contact_arm() on the particle's side [m]
  TangentialLosses by_kind{};  // parts of the dissipation over the step, for laws with `kNeedsMotion` [J]
  Real belt_power = 0;         // power of the force on a conveyor surface [W]

  SCREE_HD const TangentialLosses& losses() const { return by_kind; }
};

// One contact of a particle with a surface on a body over an implicit step.
struct SurfaceStep {
  bool touches;
  StepContact contact;
  Vec3 arm;               // at the end of the step [m]
  Vec3 contact_arm{};     // from the surface's point to the contact point, at the end of the step [m]
  bool is_sphere = true;  // whether the surface is a sphere
};

// Terms of one contact in the sums of its surface. kWrenchTerms: force and torque on the body about its
// centre, and belt power; kStepTerms: these at the end of the step and for the step, and the packed 6 x 6
// blocks of stiffness and damping.
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
  if (k == kBlockRows) return c.belt_power;
  const Vec3 force = -c.load.force;
  return component(force, cross(c.arm, force) + c.load.torque_j, k);
}

// Row and column of the k-th of kStepTerms in the blocks, which begin at 2 kWrenchTerms.
struct BlockIndex {
  bool is_stiffness;
  int row, column;
};
SCREE_HD BlockIndex block_index(int k) {
  const bool is_stiffness = k < 2 * kWrenchTerms + kBlockTerms;
  int column = k - 2 * kWrenchTerms - (is_stiffness ? 0 : kBlockTerms), row = 0;
  for (; column >= kBlockRows - row; ++row) column -= kBlockRows - row;
  return {is_stiffness, row, row + column};
}

// The wrench is -F w with w = (n, arm x n), the derivative of the overlap with respect to the body's motion.
SCREE_HD Real sum_term(const SurfaceStep& c, int k) {
  const Vec3 n = c.contact.normal, moment = cross(c.arm, n);
  if (k == kBlockRows || k == kWrenchTerms + kBlockRows)
    return 0;  // conveyor motion acts through friction only
  if (k < kWrenchTerms) return -c.contact.end_force * component(n, moment, k);
  if (k < 2 * kWrenchTerms) return -c.contact.step.force * component(n, moment, k - kWrenchTerms);
  const BlockIndex at = block_index(k);
  const Real slope = at.is_stiffness ? c.contact.step.stiffness : c.contact.step.damping;
  return slope * component(n, moment, at.row) * component(n, moment, at.column);
}

// Sums over the contacts of one surface.
template <int kTerms>
struct SurfaceSums {
  Index surface = 0;  // number among the placed surfaces
  Index contacts = 0;
  ExactSum sum[kTerms];

  Index key() const { return surface; }
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

// Sums ordered by key(), with equal ones merged.
template <class Sums>
std::vector<Sums> merged_by_key(std::vector<Sums> sums) {
  std::stable_sort(sums.begin(), sums.end(), [](const Sums& a, const Sums& b) { return a.key() < b.key(); });
  std::vector<Sums> out;
  for (const Sums& part : sums) {
    if (out.empty() || out.back().key() != part.key())
      out.push_back(part);
    else
      out.back().add(part);
  }
  return out;
}

}  // namespace scree
