#include "mbs/primitive_function.hpp"

namespace scree {

namespace {

// c        = |d| = l, e = d / l [m]
// c'       = e.d'
// gradient = D^T e,  D = [-1, A_1 s_1~, 1, -A_2 s_2~]: -e, -s_1 x A_1^T e, e, s_2 x A_2^T e
// Hessian  = D^T (1 - e e^T) D / l;  (pi1,pi1) -s_1~ (A_1^T e)~;  (pi2,pi2) +s_2~ (A_2^T e)~
// second   = (d'^2 - (e.d')^2) / l + e.d''_0
class Distance final : public PrimitiveFunction {
 public:
  explicit Distance(const SpatialPair& pair)
      : PrimitiveFunction(pair), arm_{!(pair.point[0] == Vec3{}), !(pair.point[1] == Vec3{})} {}

  bool is_angle() const override { return false; }
  Real value(const SpatialMotion& motion) const override { return norm(gap(pair(), motion)); }
  PairGradient gradient(const SpatialMotion& motion) const override {
    const Vec3 e = direction(motion);
    return {-e, -cross(pair().point[0], one(motion).rotate_back(e)), e,
            cross(pair().point[1], two(motion).rotate_back(e))};
  }
  Real second(const SpatialMotion& motion) const override {
    const Vec3 e = direction(motion), rate = gap_rate(pair(), motion);
    const Real along = dot(e, rate);
    return (dot(rate, rate) - along * along) / value(motion) + dot(e, gap_second(pair(), motion));
  }
  void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& k) const override {
    const SpatialPose &p = one(motion), &q = two(motion);
    const Vec3 e = direction(motion);
    const Mat3 s1 = tilde(pair().point[0]), s2 = tilde(pair().point[1]);
    const Mat3 across = (scale / value(motion)) * (identity3() - outer(1, e, e));
    const Mat3 d[4] = {Real(-1) * identity3(), p.rotation * s1, identity3(), Real(-1) * (q.rotation * s2)};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) k[i][j] = k[i][j] + transposed(d[i]) * (across * d[j]);
    k[1][1] = k[1][1] - scale * (s1 * tilde(p.rotate_back(e)));
    k[3][3] = k[3][3] + scale * (s2 * tilde(q.rotate_back(e)));
  }
  bool has_block(int block) const override { return block % 2 == 0 || arm_[block / 2]; }
  bool has_block(int row, int column) const override { return has_block(row) && has_block(column); }

 private:
  const SpatialPose& one(const SpatialMotion& motion) const { return motion[pair().body[0]]; }
  const SpatialPose& two(const SpatialMotion& motion) const { return motion[pair().body[1]]; }
  Vec3 direction(const SpatialMotion& motion) const {
    const Vec3 d = gap(pair(), motion);
    return (1 / norm(d)) * d;
  }

  bool arm_[2];  // the point is not its body's centre
};

}  // namespace

std::unique_ptr<PrimitiveFunction> distance_primitive(const SpatialPair& pair) {
  return std::make_unique<Distance>(pair);
}

}  // namespace scree
