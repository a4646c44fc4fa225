#include "mbs/constraints.hpp"

#include <utility>

namespace scree {

namespace {

// C            = d = r_2 + a_2 - r_1 - a_1
// C'           = v_2 + w_2 perp(a_2) - v_1 - w_1 perp(a_1)
// C_q          = [-1, -perp(a_1), 1, perp(a_2)]
// velocity_rhs = 0,  acceleration_rhs = w_2^2 a_2 - w_1^2 a_1
// (C_q^T lambda)_q: lambda.a_1 at (theta_1, theta_1), -lambda.a_2 at (theta_2, theta_2)
class CoincidenceConstraint final : public Constraint {
 public:
  explicit CoincidenceConstraint(const PointPair& pair) : pair_(pair), index_(point_coordinates(pair)) {}

  int rows() const override { return 2; }
  void value(const BodyPoses& poses, Real, Real* c) const override {
    const Vec2 gap = pair_geometry(pair_, poses).gap;
    c[0] = gap.x;
    c[1] = gap.y;
  }
  void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Vec2 turn1 = perp(g.arm[0]), turn2 = perp(g.arm[1]);
    out.add(row, index_[0], -1);
    out.add(row, index_[2], -turn1.x);
    out.add(row, index_[3], 1);
    out.add(row, index_[5], turn2.x);
    out.add(row + 1, index_[1], -1);
    out.add(row + 1, index_[2], -turn1.y);
    out.add(row + 1, index_[4], 1);
    out.add(row + 1, index_[5], turn2.y);
  }
  void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Vec2 force{lambda[0], lambda[1]};
    out.add(index_[2], index_[2], dot(force, g.arm[0]));
    out.add(index_[5], index_[5], -dot(force, g.arm[1]));
  }
  void velocity_rhs(Real, Real* rhs) const override { rhs[0] = rhs[1] = 0; }
  void acceleration_rhs(const BodyPoses& poses, Real, Real* rhs) const override {
    const Vec2 second = pair_geometry(pair_, poses).gap_second;
    rhs[0] = -second.x;
    rhs[1] = -second.y;
  }
  void add_reaction(const BodyPoses&, const Real* lambda, Vec3& force, Vec3&) const override {
    force.x -= lambda[0], force.y -= lambda[1];
  }
  Real power(Real, const Real*) const override { return 0; }

 private:
  PointPair pair_;
  PairCoordinates index_;
};

// Constraints with a prescribed motion f(t). They have one row.
// velocity_rhs = f',  acceleration_rhs = f'' - (second time derivative of g without accelerations)
class PrescribedConstraint : public Constraint {
 public:
  explicit PrescribedConstraint(ScalarFunction function) : function_(std::move(function)) {}

  void value(const BodyPoses& poses, Real t, Real* c) const override {
    *c = coordinate(poses) - function_(t).value;
  }
  void velocity_rhs(Real t, Real* rhs) const override { *rhs = function_(t).rate; }
  void acceleration_rhs(const BodyPoses& poses, Real t, Real* rhs) const override {
    *rhs = function_(t).acceleration - coordinate_second(poses);
  }
  Real power(Real t, const Real* lambda) const override { return -*lambda * function_(t).rate; }

 private:
  virtual Real coordinate(const BodyPoses& poses) const = 0;         // g
  virtual Real coordinate_second(const BodyPoses& poses) const = 0;  // g'' without accelerations

  ScalarFunction function_;
};

// C   = theta_2 - theta_1 - f
// C'  = w_2 - w_1 - f'
// C_q = [0, -1, 0, 1],  g'' without accelerations = 0,  (C_q^T lambda)_q = 0
class AngleConstraint final : public PrescribedConstraint {
 public:
  AngleConstraint(const PointPair& pair, ScalarFunction angle)
      : PrescribedConstraint(std::move(angle)),
        body_{pair.body[0], pair.body[1]},
        index_(pair_coordinates(pair)) {}

  bool is_angle() const override { return true; }
  void jacobian(const BodyPoses&, int row, SparseTerm& out) const override {
    out.add(row, index_[2], -1);
    out.add(row, index_[5], 1);
  }
  void hessian(const BodyPoses&, const Real*, SparseTerm&) const override {}
  void add_reaction(const BodyPoses&, const Real* lambda, Vec3&, Vec3& torque) const override {
    torque.z -= *lambda;
  }

 private:
  Real coordinate(const BodyPoses& poses) const override {
    return poses.planar[body_[1]].angle - poses.planar[body_[0]].angle;
  }
  Real coordinate_second(const BodyPoses&) const override { return 0; }

  int body_[2];
  PairCoordinates index_;
};

// u rotates with body 1: u' = w_1 p, p = perp(u), and p' = -w_1 u.
// C   = u.d - f
// C'  = u.d' + w_1 p.d - f'
// C_q = [-u, -u.perp(a_1) + p.d, u, u.perp(a_2)]
// g'' without accelerations = u.d''_0 + 2 w_1 p.d' - w_1^2 u.d,  d''_0 = w_1^2 a_1 - w_2^2 a_2
// (C_q^T lambda)_q = lambda times:
//   -p at (r_1, theta_1), p at (r_2, theta_1), p.perp(a_2) at (theta_1, theta_2),
//   -u.d - 2 p.perp(a_1) + u.a_1 at (theta_1, theta_1), -u.a_2 at (theta_2, theta_2); symmetric
class AxisConstraint final : public PrescribedConstraint {
 public:
  AxisConstraint(const PointPair& pair, Vec2 axis, ScalarFunction displacement)
      : PrescribedConstraint(std::move(displacement)),
        pair_(pair),
        axis_(axis),
        index_(pair_coordinates(pair)) {
    index_[5] = point_coordinates(pair)[5];
  }

  void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Vec2 u = direction(poses);
    out.add(row, index_[0], -u.x);
    out.add(row, index_[1], -u.y);
    out.add(row, index_[2], dot(perp(u), g.gap) - dot(u, perp(g.arm[0])));
    out.add(row, index_[3], u.x);
    out.add(row, index_[4], u.y);
    out.add(row, index_[5], dot(u, perp(g.arm[1])));
  }
  void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Vec2 u = direction(poses), p = *lambda * perp(u);
    const auto add_both = [&](int row, int column, Real value) {
      out.add(row, column, value);
      out.add(column, row, value);
    };
    add_both(index_[0], index_[2], -p.x);
    add_both(index_[1], index_[2], -p.y);
    add_both(index_[3], index_[2], p.x);
    add_both(index_[4], index_[2], p.y);
    add_both(index_[5], index_[2], dot(p, perp(g.arm[1])));
    out.add(index_[2], index_[2], *lambda * (dot(u, g.arm[0]) - dot(u, g.gap)) - 2 * dot(p, perp(g.arm[0])));
    out.add(index_[5], index_[5], -*lambda * dot(u, g.arm[1]));
  }
  void add_reaction(const BodyPoses& poses, const Real* lambda, Vec3& force, Vec3&) const override {
    const Vec2 along = *lambda * direction(poses);
    force.x -= along.x, force.y -= along.y;
  }

 private:
  Vec2 direction(const BodyPoses& poses) const { return poses.planar[pair_.body[0]].turn(axis_); }
  Real coordinate(const BodyPoses& poses) const override {
    return dot(direction(poses), pair_geometry(pair_, poses).gap);
  }
  Real coordinate_second(const BodyPoses& poses) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Vec2 u = direction(poses);
    const Real w = poses.planar[pair_.body[0]].spin;
    return dot(u, g.gap_second) + 2 * w * dot(perp(u), g.gap_rate) - w * w * dot(u, g.gap);
  }

  PointPair pair_;
  Vec2 axis_;
  PairCoordinates index_;
};

// l = |d|, e = d / l, p = perp(e).
// C   = l - f
// C'  = e.d' - f'
// C_q = [-e, -e.perp(a_1), e, e.perp(a_2)]
// g'' without accelerations = (p.d')^2 / l + e.d''_0,  d''_0 = w_1^2 a_1 - w_2^2 a_2
// (C_q^T lambda)_q = lambda (G G^T / l + diag), G = [-p, -p.perp(a_1), p, p.perp(a_2)],
//   diag: e.a_1 at theta_1, -e.a_2 at theta_2
class LengthConstraint final : public PrescribedConstraint {
 public:
  LengthConstraint(const PointPair& pair, ScalarFunction length)
      : PrescribedConstraint(std::move(length)), pair_(pair), index_(point_coordinates(pair)) {}

  void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const std::array<Real, 6> gradient = gap_gradient(g, (1 / norm(g.gap)) * g.gap);
    for (std::size_t k = 0; k < 6; ++k) out.add(row, index_[k], gradient[k]);
  }
  void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Real length = norm(g.gap);
    const Vec2 e = (1 / length) * g.gap;
    const std::array<Real, 6> across = gap_gradient(g, perp(e));
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        out.add(index_[i], index_[j], *lambda / length * across[i] * across[j]);
      }
    }
    out.add(index_[2], index_[2], *lambda * dot(e, g.arm[0]));
    out.add(index_[5], index_[5], -*lambda * dot(e, g.arm[1]));
  }
  void add_reaction(const BodyPoses& poses, const Real* lambda, Vec3& force, Vec3&) const override {
    const Vec2 gap = pair_geometry(pair_, poses).gap;
    const Vec2 along = (*lambda / norm(gap)) * gap;
    force.x -= along.x, force.y -= along.y;
  }

 private:
  Real coordinate(const BodyPoses& poses) const override { return norm(pair_geometry(pair_, poses).gap); }
  Real coordinate_second(const BodyPoses& poses) const override {
    const PairGeometry g = pair_geometry(pair_, poses);
    const Real length = norm(g.gap);
    const Vec2 e = (1 / length) * g.gap;
    const Real across = dot(perp(e), g.gap_rate);
    return across * across / length + dot(e, g.gap_second);
  }

  PointPair pair_;
  PairCoordinates index_;
};

}  // namespace

std::unique_ptr<Constraint> coincidence_constraint(const PointPair& pair) {
  return std::make_unique<CoincidenceConstraint>(pair);
}

std::unique_ptr<Constraint> angle_constraint(const PointPair& pair, ScalarFunction angle) {
  return std::make_unique<AngleConstraint>(pair, std::move(angle));
}

std::unique_ptr<Constraint> axis_constraint(const PointPair& pair, Vec2 axis, ScalarFunction displacement) {
  return std::make_unique<AxisConstraint>(pair, axis, std::move(displacement));
}

std::unique_ptr<Constraint> length_constraint(const PointPair& pair, ScalarFunction length) {
  return std::make_unique<LengthConstraint>(pair, std::move(length));
}

}  // namespace scree
