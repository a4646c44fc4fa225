#include "mbs/primitive_function.hpp"

namespace scree {

namespace {

// c        = al.be: the cosine of the angle between two directions
// c'       = al'.be + al.be'
// gradient = 0, a x A_1^T be, 0, b x A_2^T al
// Hessian  = (pi1,pi1) a~ (A_1^T be)~;  (pi2,pi2) b~ (A_2^T al)~;  (pi1,pi2) -a~ A_1^T A_2 b~, and its
// transpose second   = al''_0.be + be''_0.al + 2 al'.be'
class Dot1 final : public PrimitiveFunction {
 public:
  Dot1(const SpatialPair& pair, Vec3 a, Vec3 b) : PrimitiveFunction(pair), a_(a), b_(b) {}

  bool is_angle() const override { return true; }
  Real value(const SpatialMotion& motion) const override {
    return dot(one(motion).turn(a_), two(motion).turn(b_));
  }
  PairGradient gradient(const SpatialMotion& motion) const override {
    return {Vec3{}, cross(a_, one(motion).rotate_back(two(motion).turn(b_))), Vec3{},
            cross(b_, two(motion).rotate_back(one(motion).turn(a_)))};
  }
  Real second(const SpatialMotion& motion) const override {
    const SpatialPose &p = one(motion), &q = two(motion);
    return dot(p.rotated_second(a_), q.turn(b_)) + dot(q.rotated_second(b_), p.turn(a_)) +
           2 * dot(p.rotated_rate(a_), q.rotated_rate(b_));
  }
  void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& k) const override {
    const SpatialPose &p = one(motion), &q = two(motion);
    const Mat3 a = scale * tilde(a_), b = tilde(b_);
    const Mat3 mixed = a * (transposed(p.rotation) * q.rotation * b);
    k[1][1] = k[1][1] + a * tilde(p.rotate_back(q.turn(b_)));
    k[3][3] = k[3][3] + scale * (b * tilde(q.rotate_back(p.turn(a_))));
    k[1][3] = k[1][3] - mixed;
    k[3][1] = k[3][1] - transposed(mixed);
  }
  bool has_block(int block) const override { return block % 2 == 1; }
  bool has_block(int row, int column) const override { return row % 2 == 1 && column % 2 == 1; }

 private:
  const SpatialPose& one(const SpatialMotion& motion) const { return motion[pair().body[0]]; }
  const SpatialPose& two(const SpatialMotion& motion) const { return motion[pair().body[1]]; }

  Vec3 a_, b_;
};

}  // namespace

std::unique_ptr<PrimitiveFunction> dot1_primitive(const SpatialPair& pair, Vec3 a, Vec3 b) {
  return std::make_unique<Dot1>(pair, a, b);
}

}  // namespace scree
