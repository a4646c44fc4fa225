// Force elements of spatial bodies.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "mbs/force_elements.hpp"
#include "mbs/primitive_function.hpp"
#include "model/derived/scalar_function.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

void add_at(std::vector<Real>& force, int first, Vec3 value) {
  if (first < 0) return;
  Real* f = &force[static_cast<std::size_t>(first)];
  f[0] += value.x, f[1] += value.y, f[2] += value.z;
}

// T = k (c - c_0) + k_d c' + actuator(t) along a primitive function c with gradient g and Hessian H.
// Q = -T g,  -Q_q = g (k g + k_d H^T v)^T + T H,  -Q_v = k_d g g^T
class PrimitiveSpring final : public ForceElement {
 public:
  struct Law {
    Real stiffness = 0, damping = 0, free_value = 0;
    ScalarFunction actuator;
  };
  PrimitiveSpring(std::string title, std::unique_ptr<PrimitiveFunction> c, Law law)
      : title_(std::move(title)), c_(std::move(c)), law_(std::move(law)) {}

  Real add_force(const BodyPoses& poses, Real t, Real length, std::vector<Real>& force) override {
    if (!c_->is_angle() && c_->value(poses.spatial) == 0)
      throw SimulationError(fmt::format("mbs_correct, rank 0: the two points of {} coincide", title_));
    const PairGradient g = c_->gradient(poses.spatial);
    const Real tension = tension_at(poses, t);
    for (int k = 0; k < 4; ++k) add_at(force, c_->column(k), -tension * g[static_cast<std::size_t>(k)]);
    return std::abs(tension) * (c_->is_angle() ? 1 : length);
  }

  void add_derivatives(const BodyPoses& poses, Real t, SparseTerm& stiffness,
                       SparseTerm& damping) const override {
    const SpatialMotion& motion = poses.spatial;
    const PairGradient g = c_->gradient(motion);
    PairHessian hessian{};
    c_->add_hessian(motion, 1, hessian);
    const Real tension = tension_at(poses, t);
    for (std::size_t i = 0; i < 4; ++i) {
      const int row = c_->column(static_cast<int>(i));
      for (std::size_t j = 0; j < 4; ++j) {
        const int column = c_->column(static_cast<int>(j));
        if (row < 0 || column < 0 || !c_->has_block(static_cast<int>(i)) ||
            !c_->has_block(static_cast<int>(j)))
          continue;
        Vec3 bend = law_.stiffness * g[j];
        for (std::size_t m = 0; m < 4; ++m)
          bend += law_.damping * transposed_times(hessian[m][j], velocity(motion, static_cast<int>(m)));
        add_block(stiffness, row, column, outer(1, g[i], bend) + tension * hessian[i][j]);
        const Vec3 along =
            j % 2 == 0 ? g[j] : transposed_times(pose(motion, static_cast<int>(j)).inverse_tangent, g[j]);
        add_block(damping, row, column, outer(law_.damping, g[i], along));
      }
    }
  }

  void add_powers(const BodyPoses& poses, Real t, Powers& powers) const override {
    const Real rate = primitive_rate(*c_, poses.spatial);
    powers.dissipated += law_.damping * rate * rate;
    powers.applied -= law_.actuator(t).value * rate;
  }
  Real effort(const BodyPoses& poses, Real t) const override { return tension_at(poses, t); }
  Real elastic_energy(const BodyPoses& poses) const override {
    const Real stretch = c_->value(poses.spatial) - law_.free_value;
    return law_.stiffness / 2 * stretch * stretch;
  }
  Real elastic_scale(Real length) const override {
    return law_.stiffness * (c_->is_angle() ? 1 : length * length);
  }

 private:
  Real tension_at(const BodyPoses& poses, Real t) const {
    return law_.stiffness * (c_->value(poses.spatial) - law_.free_value) +
           law_.damping * primitive_rate(*c_, poses.spatial) + law_.actuator(t).value;
  }
  const SpatialPose& pose(const SpatialMotion& motion, int block) const {
    return motion[c_->pair().body[block / 2]];
  }
  Vec3 velocity(const SpatialMotion& motion, int block) const {
    return block % 2 == 0 ? pose(motion, block).velocity : pose(motion, block).spin;
  }

  std::string title_;
  std::unique_ptr<PrimitiveFunction> c_;
  Law law_;
};

// F and T global or, if they follow the body, A f and A t, f and t along its axes or a marker's; torque in
// the body's frame A^T T + s x A^T F. -Q_q: global: -(A^T T)~ - s~ (A^T F)~ at (pi, pi); following F: A f~ at
// (r, pi).  -Q_v = 0
class AppliedForceElement final : public ForceElement {
 public:
  AppliedForceElement(const AppliedForce& element, const BodyLayout& layout, Real end)
      : body_(element.body),
        column_(layout.column(element.body)),
        point_(element.point),
        follows_body_(element.follows_body),
        axes_(rotation_matrix(element.axes)),
        force_{{element.fx, owner(element), end},
               {element.fy, owner(element), end},
               {element.fz, owner(element), end}},
        torque_{{element.torque_x, owner(element), end},
                {element.torque_y, owner(element), end},
                {element.torque, owner(element), end}} {}

  Real add_force(const BodyPoses& poses, Real t, Real length, std::vector<Real>& force) override {
    const Loads own = loads_at(poses, t);
    const Vec3 moment = own.torque + cross(point_, own.force);
    add_at(force, column_, poses.spatial[body_].turn(own.force));
    add_at(force, column_ + 3, moment);
    return std::max(norm(own.force) * length, norm(moment));
  }
  void add_derivatives(const BodyPoses& poses, Real t, SparseTerm& stiffness, SparseTerm&) const override {
    const Loads own = loads_at(poses, t);
    if (follows_body_)
      add_block(stiffness, column_, column_ + 3, poses.spatial[body_].rotation * tilde(own.force));
    else
      add_block(stiffness, column_ + 3, column_ + 3,
                Real(-1) * (tilde(own.torque) + tilde(point_) * tilde(own.force)));
  }
  void add_powers(const BodyPoses& poses, Real t, Powers& powers) const override {
    const Loads own = loads_at(poses, t);
    const SpatialPose& pose = poses.spatial[body_];
    powers.applied +=
        dot(pose.turn(own.force), pose.velocity) + dot(own.torque + cross(point_, own.force), pose.spin);
  }

 private:
  struct Loads {
    Vec3 force, torque;  // in the body's frame
  };
  static std::string owner(const AppliedForce& element) {
    return fmt::format("applied force '{}'", element.name);
  }
  Loads loads_at(const BodyPoses& poses, Real t) const {
    const Vec3 f{force_[0](t).value, force_[1](t).value, force_[2](t).value},
        m{torque_[0](t).value, torque_[1](t).value, torque_[2](t).value};
    if (follows_body_) return {axes_ * f, axes_ * m};
    const SpatialPose& pose = poses.spatial[body_];
    return {pose.rotate_back(f), pose.rotate_back(m)};
  }

  int body_, column_;
  Vec3 point_;
  bool follows_body_;
  Mat3 axes_;  // from the marker's axes to the body's
  ScalarFunction force_[3], torque_[3];
};

}  // namespace

std::unique_ptr<ForceElement> make_spatial_element(const SpringDamper& element, const BodyLayout& layout,
                                                   Real end) {
  const std::string title = fmt::format("spring-damper '{}'", element.name);
  return std::make_unique<PrimitiveSpring>(
      title, distance_primitive(spatial_pair(layout, element.body, element.point)),
      PrimitiveSpring::Law{element.stiffness, element.damping, element.free_length,
                           ScalarFunction(element.actuator, title, end)});
}

std::unique_ptr<ForceElement> make_spatial_element(const AppliedForce& element, const BodyLayout& layout,
                                                   Real end) {
  return std::make_unique<AppliedForceElement>(element, layout, end);
}

}  // namespace scree
