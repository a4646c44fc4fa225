#include "mbs/body_coupling.hpp"

#include <array>
#include <span>

#include "base/mat3.hpp"

namespace scree {

namespace {

using Block = std::array<Real, 36>;  // row by row, (x, y, z, rx, ry, rz)

Real& at(Block& block, int row, int column) { return block[static_cast<std::size_t>(6 * row + column)]; }
Real at(const Block& block, int row, int column) { return block[static_cast<std::size_t>(6 * row + column)]; }

Block transposed(const Block& block) {
  Block out;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) at(out, j, i) = at(block, i, j);
  return out;
}

// block (1, rotation): the columns of rotations, multiplied by `turn` from the right.
Block with_rotated_columns(Block block, const Mat3& turn) {
  for (int i = 0; i < 6; ++i) {
    const Vec3 row = transposed_times(turn, {at(block, i, 3), at(block, i, 4), at(block, i, 5)});
    at(block, i, 3) = row.x, at(block, i, 4) = row.y, at(block, i, 5) = row.z;
  }
  return block;
}

// The coordinates of a body, and the global directions that they stand for: one for each of its columns.
struct Columns {
  int first;
  std::span<const int> of;
};

class Pair {
 public:
  Pair(const std::vector<Body>& bodies, const BodyLayout& layout, const BodyPoses& poses,
       SystemDerivatives& derivatives)
      : bodies_(bodies), layout_(layout), poses_(poses), out_(derivatives.coupling) {}

  // Adds the derivative of the wrench on body a by the motion of body b.
  void add(int a, int b, Block stiffness, Block damping) const {
    if (is_spatial(b)) {
      const SpatialPose& pose = poses_.spatial[b];
      stiffness = with_rotated_columns(stiffness, pose.rotation);
      damping = with_rotated_columns(damping, pose.rotation * pose.inverse_tangent);
    }
    if (is_spatial(a))
      for (Block* block : {&stiffness, &damping})
        *block = transposed(with_rotated_columns(transposed(*block), poses_.spatial[a].rotation));
    const Columns rows = columns_of(a), columns = columns_of(b);
    for (std::size_t i = 0; i < rows.of.size(); ++i)
      for (std::size_t j = 0; j < columns.of.size(); ++j)
        out_.push_back({rows.first + static_cast<int>(i), columns.first + static_cast<int>(j),
                        at(stiffness, rows.of[i], columns.of[j]), at(damping, rows.of[i], columns.of[j])});
  }

 private:
  bool is_spatial(int body) const {
    return bodies_[static_cast<std::size_t>(body)].kind == BodyKind::spatial;
  }
  Columns columns_of(int body) const {
    static constexpr int kAll[] = {0, 1, 2, 3, 4, 5}, kPlanar[] = {0, 1, 5};
    return {layout_.column(body), is_spatial(body) ? std::span<const int>(kAll) : kPlanar};
  }

  const std::vector<Body>& bodies_;
  const BodyLayout& layout_;
  const BodyPoses& poses_;
  std::vector<CoupledEntry>& out_;
};

}  // namespace

void add_coupling(const PairStiffness& pair, const std::vector<Body>& bodies, const BodyLayout& layout,
                  const BodyPoses& poses, SystemDerivatives& derivatives) {
  const Pair to(bodies, layout, poses, derivatives);
  to.add(pair.first, pair.second, pair.stiffness, pair.damping);
  to.add(pair.second, pair.first, transposed(pair.stiffness), transposed(pair.damping));
}

}  // namespace scree
