#include "mbs/spatial_constraints.hpp"

#include <utility>

namespace scree {

namespace {

// C            = d = P_2 - P_1
// C'           = v_2 - A_2 s_2~ w_2 - v_1 + A_1 s_1~ w_1
// C_q          = [-1, A_1 s_1~, 1, -A_2 s_2~]
// velocity_rhs = 0,  acceleration_rhs = -d''_0 = A_1 w_1~^2 s_1 - A_2 w_2~^2 s_2
// (C_q^T lambda)_q: -s_1~ (A_1^T lambda)~ at (pi1, pi1), s_2~ (A_2^T lambda)~ at (pi2, pi2)
class Coincidence final : public Constraint {
 public:
  explicit Coincidence(const SpatialPair& pair) : pair_(pair) {}

  int rows() const override { return 3; }
  void value(const BodyPoses& poses, Real, Real* c) const override { write(gap(pair_, poses.spatial), c); }
  void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const override {
    for (int i = 0; i < 2; ++i) {
      const Real sign = i == 0 ? -1 : 1;
      const int first = pair_.column[i];
      if (first < 0) continue;
      for (int k = 0; k < 3; ++k) out.add(row + k, first + k, sign);
      if (depends_on_rotation(i))
        add_block(out, row, first + 3,
                  -sign * (poses.spatial[pair_.body[i]].rotation * tilde(pair_.point[i])));
    }
  }
  void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const override {
    const Vec3 force{lambda[0], lambda[1], lambda[2]};
    for (int i = 0; i < 2; ++i) {
      if (!depends_on_rotation(i)) continue;
      const Real sign = i == 0 ? -1 : 1;
      const int first = pair_.column[i] + 3;
      add_block(out, first, first,
                sign * (tilde(pair_.point[i]) * tilde(poses.spatial[pair_.body[i]].rotate_back(force))));
    }
  }
  void velocity_rhs(Real, Real* rhs) const override { write({}, rhs); }
  void acceleration_rhs(const BodyPoses& poses, Real, Real* rhs) const override {
    write(-gap_second(pair_, poses.spatial), rhs);
  }
  void add_reaction(const BodyPoses&, const Real* lambda, Vec3& force, Vec3&) const override {
    force -= {lambda[0], lambda[1], lambda[2]};
  }
  Real power(Real, const Real*) const override { return 0; }

 private:
  static void write(Vec3 v, Real* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
  // Whether body i is not the ground and its point not its centre.
  bool depends_on_rotation(int i) const { return pair_.column[i] >= 0 && !(pair_.point[i] == Vec3{}); }

  SpatialPair pair_;
};

// velocity_rhs = f',  acceleration_rhs = f'' - (c'' without accelerations)
class PrimitiveConstraint final : public Constraint {
 public:
  PrimitiveConstraint(std::unique_ptr<PrimitiveFunction> c, ScalarFunction f)
      : c_(std::move(c)), f_(std::move(f)) {}

  bool is_angle() const override { return c_->is_angle(); }
  void value(const BodyPoses& poses, Real t, Real* c) const override {
    *c = c_->value(poses.spatial) - f_(t).value;
  }
  void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const override {
    add_gradient(*c_, c_->gradient(poses.spatial), row, out);
  }
  void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const override {
    PairHessian k{};
    c_->add_hessian(poses.spatial, *lambda, k);
    add_hessian(*c_, k, out);
  }
  void velocity_rhs(Real t, Real* rhs) const override { *rhs = f_(t).rate; }
  void acceleration_rhs(const BodyPoses& poses, Real t, Real* rhs) const override {
    *rhs = f_(t).acceleration - c_->second(poses.spatial);
  }
  // The gradient by the second body's pose gives a force, and a torque about its centre in its own frame.
  void add_reaction(const BodyPoses& poses, const Real* lambda, Vec3& force, Vec3& torque) const override {
    const PairGradient g = c_->gradient(poses.spatial);
    const SpatialPair& pair = c_->pair();
    const SpatialPose& two = poses.spatial[pair.body[1]];
    const Vec3 own = -*lambda * g[2];
    force += own;
    torque += two.turn(-*lambda * g[3]) - cross(two.turn(pair.point[1]), own);
  }
  Real power(Real t, const Real* lambda) const override { return -*lambda * f_(t).rate; }

 private:
  std::unique_ptr<PrimitiveFunction> c_;
  ScalarFunction f_;
};

}  // namespace

std::unique_ptr<Constraint> coincidence_constraint(const SpatialPair& pair) {
  return std::make_unique<Coincidence>(pair);
}

std::unique_ptr<Constraint> primitive_constraint(std::unique_ptr<PrimitiveFunction> c, ScalarFunction f) {
  return std::make_unique<PrimitiveConstraint>(std::move(c), std::move(f));
}

}  // namespace scree
