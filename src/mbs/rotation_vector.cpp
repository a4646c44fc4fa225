#include "mbs/primitive_function.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

// theta    = rotation vector of R = M_1^T A_1^T A_2 M_2, M_i the frame's orientation in body i
// c        = e_k.theta
// theta'   = P_1 w_1 + P_2 w_2,  P_1 = -T^-T M_1^T,  P_2 = T^-1 M_2^T;  T^-T(u) = T^-1(-u) = T^-1(u) R^T
// gradient = 0, -M_1 T^-1 e_k, 0, M_2 T^-T e_k
// Hessian  = (pi1,pij) -M_1 D(theta, e_k) P_j;  (pi2,pij) -M_2 D(-theta, e_k) P_j;  D of T^-1
class RotationVectorComponent final : public PrimitiveFunction {
 public:
  RotationVectorComponent(const SpatialPair& pair, const Quaternion (&frame)[2], int k)
      : PrimitiveFunction(pair), frame_{rotation_matrix(frame[0]), rotation_matrix(frame[1])}, k_(k) {
    axis_ = row_of(identity3(), k);
  }

  bool is_angle() const override { return true; }
  Real value(const SpatialMotion& motion) const override { return component(theta(motion), k_); }
  PairGradient gradient(const SpatialMotion& motion) const override {
    const Mat3 inverse = inverse_tangent(theta(motion));
    return {Vec3{}, -(frame_[0] * (inverse * axis_)), Vec3{}, frame_[1] * transposed_times(inverse, axis_)};
  }
  Real second(const SpatialMotion& motion) const override {
    PairHessian k{};
    add_hessian(motion, 1, k);
    Real sum = 0;
    for (std::size_t i : {1, 3})
      for (std::size_t j : {1, 3}) sum += dot(spin(motion, i), k[i][j] * spin(motion, j));
    return sum;
  }
  void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& k) const override {
    const Vec3 u = theta(motion);
    const Mat3 inverse = inverse_tangent(u);
    const Mat3 by[2] = {Real(-1) * (transposed(inverse) * transposed(frame_[0])),
                        inverse * transposed(frame_[1])};
    const Mat3 bend[2] = {-scale * (frame_[0] * inverse_tangent_change(u, axis_)),
                          -scale * (frame_[1] * inverse_tangent_change(-u, axis_))};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) k[2 * i + 1][2 * j + 1] = k[2 * i + 1][2 * j + 1] + bend[i] * by[j];
  }
  bool has_block(int block) const override { return block % 2 == 1; }
  bool has_block(int row, int column) const override { return row % 2 == 1 && column % 2 == 1; }

 private:
  Vec3 theta(const SpatialMotion& motion) const {
    const Mat3 one = motion[pair().body[0]].rotation * frame_[0],
               two = motion[pair().body[1]].rotation * frame_[1];
    return rotation_vector(quaternion_of(transposed(one) * two));
  }
  Vec3 spin(const SpatialMotion& motion, std::size_t block) const {
    return motion[pair().body[block / 2]].spin;
  }

  Mat3 frame_[2];
  int k_;
  Vec3 axis_;
};

}  // namespace

std::unique_ptr<PrimitiveFunction> rotation_vector_primitive(const SpatialPair& pair,
                                                             const Quaternion (&frame)[2], int k) {
  return std::make_unique<RotationVectorComponent>(pair, frame, k);
}

}  // namespace scree
