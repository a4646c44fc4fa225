#include "mbs/primitive_function.hpp"

namespace scree {

namespace {

// c        = al.d: displacement of the second point along a direction of the first body [m]
// c'       = al'.d + al.d'
// gradient = -al, a x g, al, s_2 x A_2^T al;  g = A_1^T d + s_1
// Hessian  = (r1,pi1) A_1 a~;  (r2,pi1) -A_1 a~;  (pi1,pi2) -a~ A_1^T A_2 s_2~; their transposes;
//            (pi1,pi1) a~ g~;  (pi2,pi2) s_2~ (A_2^T al)~
// second   = al''_0.d + 2 al'.d' + al.d''_0
class Dot2 final : public PrimitiveFunction {
 public:
  Dot2(const SpatialPair& pair, Vec3 a) : PrimitiveFunction(pair), a_(a), arm_(!(pair.point[1] == Vec3{})) {}

  bool is_angle() const override { return false; }
  Real value(const SpatialMotion& motion) const override {
    return dot(one(motion).turn(a_), gap(pair(), motion));
  }
  PairGradient gradient(const SpatialMotion& motion) const override {
    const Vec3 al = one(motion).turn(a_);
    return {-al, cross(a_, to_second_point(motion)), al, cross(pair().point[1], two(motion).rotate_back(al))};
  }
  Real second(const SpatialMotion& motion) const override {
    const SpatialPose& p = one(motion);
    return dot(p.rotated_second(a_), gap(pair(), motion)) +
           2 * dot(p.rotated_rate(a_), gap_rate(pair(), motion)) +
           dot(p.turn(a_), gap_second(pair(), motion));
  }
  void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& k) const override {
    const SpatialPose &p = one(motion), &q = two(motion);
    const Mat3 a = scale * tilde(a_), s = tilde(pair().point[1]), rotated = p.rotation * a;
    const Mat3 mixed = a * (transposed(p.rotation) * q.rotation * s);
    k[0][1] = k[0][1] + rotated;
    k[1][0] = k[1][0] + transposed(rotated);
    k[2][1] = k[2][1] - rotated;
    k[1][2] = k[1][2] - transposed(rotated);
    k[1][1] = k[1][1] + a * tilde(to_second_point(motion));
    k[1][3] = k[1][3] - mixed;
    k[3][1] = k[3][1] - transposed(mixed);
    k[3][3] = k[3][3] + scale * (s * tilde(q.rotate_back(p.turn(a_))));
  }
  bool has_block(int block) const override { return block < 3 || arm_; }
  bool has_block(int row, int column) const override {
    if (row == 3 || column == 3) return arm_ && row % 2 == 1 && column % 2 == 1;
    return row == 1 || column == 1;
  }

 private:
  const SpatialPose& one(const SpatialMotion& motion) const { return motion[pair().body[0]]; }
  const SpatialPose& two(const SpatialMotion& motion) const { return motion[pair().body[1]]; }
  // The vector g from the first body's centre to the second point, in the first body's frame [m].
  Vec3 to_second_point(const SpatialMotion& motion) const {
    return one(motion).rotate_back(gap(pair(), motion)) + pair().point[0];
  }

  Vec3 a_;
  bool arm_;  // the second point is not its body's centre
};

}  // namespace

std::unique_ptr<PrimitiveFunction> dot2_primitive(const SpatialPair& pair, Vec3 a) {
  return std::make_unique<Dot2>(pair, a);
}

}  // namespace scree
