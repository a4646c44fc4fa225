#include "dem/surface_contact/body_pairs.hpp"

#include "dem/surface_contact/friction_surfaces.hpp"

namespace scree {

// The relative motion of both bodies at the contact point determines the force: the blocks are those of
// `sum_term(SurfaceFriction)`, with the other body's motion and the opposite sign.
void BodyPairs::add(const TouchedBody& one, const TouchedBody& other, const ContactSlopes& slopes) {
  if (other.body < one.body) return add(other, one, slopes);  // the blocks are even in the normal
  PairStiffness& sum = blocks_[{one.body, other.body}];
  sum.first = one.body, sum.second = other.body;
  const Vec3 n = slopes.normal, t = slopes.direction;
  const bool rolls = slopes.rolling.rolling > 0 || slopes.rolling.twisting > 0;
  for (int row = 0; row < kBlockRows; ++row)
    for (int column = 0; column < kBlockRows; ++column) {
      const Vec3 a = unit_displacement(one.arm, row), b = unit_displacement(other.arm, column);
      const Real along = dot(n, a) * dot(n, b);
      const auto at = static_cast<std::size_t>(kBlockRows * row + column);
      sum.stiffness[at] -=
          slopes.stiffness * along + slopes.shear * (dot(a, b) - along - dot(t, a) * dot(t, b));
      if (rolls && row >= 3 && column >= 3)
        sum.stiffness[at] -= turning_stiffness(slopes.rolling, n, unit_axis(row - 3), unit_axis(column - 3));
      sum.damping[at] -= slopes.damping * along;
    }
}

std::vector<PairStiffness> BodyPairs::blocks() const {
  std::vector<PairStiffness> blocks;
  for (const auto& [bodies, block] : blocks_) blocks.push_back(block);
  return blocks;
}

}  // namespace scree
