#include "mbs/force_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

namespace {

void add_at(std::vector<Real>& force, int index, Real value) {
  if (index >= 0) force[static_cast<std::size_t>(index)] += value;
}

// l = |d|, e = d / l, p = perp(e), tension T = k (l - l_0) + c l' + actuator(t).
// Q   = -T J,  J = l_q = [-e, -e.perp(a_1), e, e.perp(a_2)],  l' = J q'
// -Q_q  = J (k J + c l'_q)^T + T H,  l'_q = H q'
// -Q_q' = c J J^T
// H = l_qq = G G^T / l + diag,  G = [-p, -p.perp(a_1), p, p.perp(a_2)],
//   diag: e.a_1 at theta_1, -e.a_2 at theta_2
class SpringDamperElement final : public ForceElement {
 public:
  SpringDamperElement(const SpringDamper& element, const BodyLayout& layout, Real end)
      : name_(element.name),
        pair_(point_pair(layout, element.body, element.point)),
        index_(point_coordinates(pair_)),
        stiffness_(element.stiffness),
        damping_(element.damping),
        free_length_(element.free_length),
        actuator_(element.actuator, fmt::format("spring-damper '{}'", element.name), end) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (index_[k] < 0) continue;
      active_.push_back(k);
      coordinates_.push_back(index_[k]);
    }
  }

  Real add_force(const BodyPoses& poses, Real t, Real length, std::vector<Real>& force) override {
    line_ = line_at(poses, t);
    const std::array<Real, 6> gradient = gap_gradient(line_.geometry, line_.direction);
    for (const std::size_t k : active_) {
      force[static_cast<std::size_t>(index_[k])] -= line_.tension * gradient[k];
    }
    return std::abs(line_.tension) * length;
  }

  void add_derivatives(const BodyPoses& poses, Real, SparseTerm& stiffness,
                       SparseTerm& damping) const override {
    const Line& line = line_;
    const PairGeometry& g = line.geometry;
    const Vec2 e = line.direction;
    const std::array<Real, 6> along = gap_gradient(g, e), across = gap_gradient(g, perp(e));
    const Real bend1 = dot(e, g.arm[0]), bend2 = -dot(e, g.arm[1]);
    const Real line_spin = dot(perp(e), g.gap_rate) / line.length;
    std::array<Real, 6> tension_gradient;
    for (std::size_t k = 0; k < 6; ++k) {
      tension_gradient[k] = stiffness_ * along[k] + damping_ * line_spin * across[k];
    }
    tension_gradient[2] += damping_ * bend1 * poses.planar[pair_.body[0]].spin;
    tension_gradient[5] += damping_ * bend2 * poses.planar[pair_.body[1]].spin;
    std::array<Real, 6> transverse, damped;
    for (std::size_t k = 0; k < 6; ++k) {
      transverse[k] = line.tension / line.length * across[k];
      damped[k] = damping_ * along[k];
    }
    const auto& active = active_;
    stiffness.add_block(coordinates_, [&](std::size_t i, std::size_t j) {
      return along[active[i]] * tension_gradient[active[j]] + transverse[active[i]] * across[active[j]];
    });
    damping.add_block(coordinates_,
                      [&](std::size_t i, std::size_t j) { return damped[active[i]] * along[active[j]]; });
    stiffness.add(index_[2], index_[2], line.tension * bend1);
    stiffness.add(index_[5], index_[5], line.tension * bend2);
  }

  void add_powers(const BodyPoses& poses, Real t, Powers& powers) const override {
    const Line line = line_at(poses, t);
    powers.dissipated += damping_ * line.rate * line.rate;
    powers.applied -= actuator_(t).value * line.rate;
  }

  Real effort(const BodyPoses& poses, Real t) const override { return line_at(poses, t).tension; }
  Real elastic_energy(const BodyPoses& poses) const override {
    const Real stretch = norm(pair_geometry(pair_, poses).gap) - free_length_;
    return stiffness_ / 2 * stretch * stretch;
  }
  Real elastic_scale(Real length) const override { return stiffness_ * length * length; }

 private:
  struct Line {
    PairGeometry geometry;
    Real length, rate, tension;
    Vec2 direction;
  };

  Line line_at(const BodyPoses& poses, Real t) const {
    Line line;
    line.geometry = pair_geometry(pair_, poses);
    line.length = norm(line.geometry.gap);
    if (line.length == 0) {
      throw SimulationError(
          fmt::format("mbs_correct, rank 0: the two points of spring-damper '{}' coincide", name_));
    }
    line.direction = (1 / line.length) * line.geometry.gap;
    line.rate = dot(line.direction, line.geometry.gap_rate);
    line.tension = stiffness_ * (line.length - free_length_) + damping_ * line.rate + actuator_(t).value;
    return line;
  }

  std::string name_;
  PointPair pair_;
  PairCoordinates index_;
  std::vector<std::size_t> active_;  // entries of index_ that are coordinates
  std::vector<int> coordinates_;     // the values of index_ there
  Real stiffness_, damping_, free_length_;
  ScalarFunction actuator_;
  Line line_;  // of the last add_force()
};

// theta = theta_2 - theta_1, torque on body 2: -(k (theta - theta_0) + c theta'), opposite on body 1.
// -Q_q = k J J^T, -Q_q' = c J J^T, J = theta_q = (-1, 1)
class TorsionalElement final : public ForceElement {
 public:
  TorsionalElement(const TorsionalSpringDamper& element, const BodyLayout& layout) : element_(element) {
    const PairCoordinates index = pair_coordinates(point_pair(layout, element.body, {{}, {}}));
    index_[0] = index[2], index_[1] = index[5];
  }

  Real add_force(const BodyPoses& poses, Real, Real, std::vector<Real>& force) override {
    const Real torque = effort(poses, 0);
    add_at(force, index_[0], -torque);
    add_at(force, index_[1], torque);
    return std::abs(torque);
  }
  void add_derivatives(const BodyPoses&, Real, SparseTerm& stiffness, SparseTerm& damping) const override {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        const Real sign = i == j ? 1 : -1;
        stiffness.add(index_[i], index_[j], sign * element_.stiffness);
        damping.add(index_[i], index_[j], sign * element_.damping);
      }
    }
  }
  void add_powers(const BodyPoses& poses, Real, Powers& powers) const override {
    powers.dissipated += element_.damping * rate(poses) * rate(poses);
  }
  Real effort(const BodyPoses& poses, Real) const override {
    return -(element_.stiffness * angle(poses) + element_.damping * rate(poses));
  }
  Real elastic_energy(const BodyPoses& poses) const override {
    return element_.stiffness / 2 * angle(poses) * angle(poses);
  }
  Real elastic_scale(Real) const override { return element_.stiffness; }

 private:
  Real angle(const BodyPoses& poses) const {
    return poses.planar[element_.body[1]].angle - poses.planar[element_.body[0]].angle - element_.free_angle;
  }
  Real rate(const BodyPoses& poses) const {
    return poses.planar[element_.body[1]].spin - poses.planar[element_.body[0]].spin;
  }

  TorsionalSpringDamper element_;
  int index_[2];
};

// F global or, if it follows the body, A f; torque about the centre of mass: T + a x F, a = A s.
// -Q_q: global F: a.F at (theta, theta); following F: -perp(F) at (x, theta), (y, theta).  -Q_q' = 0
class AppliedForceElement final : public ForceElement {
 public:
  AppliedForceElement(const AppliedForce& element, const BodyLayout& layout, Real end)
      : body_(element.body),
        column_(layout.column(element.body)),
        point_(planar(element.point)),
        follows_body_(element.follows_body),
        fx_(element.fx, owner(element), end),
        fy_(element.fy, owner(element), end),
        torque_(element.torque, owner(element), end) {}

  Real add_force(const BodyPoses& poses, Real t, Real length, std::vector<Real>& force) override {
    const Vec2 f = force_at(poses, t);
    const Real moment = moment_at(poses, t);
    add_at(force, column_, f.x);
    add_at(force, column_ + 1, f.y);
    add_at(force, column_ + 2, moment);
    return std::max(norm(f) * length, std::abs(moment));
  }
  void add_derivatives(const BodyPoses& poses, Real t, SparseTerm& stiffness, SparseTerm&) const override {
    const int angle = column_ + 2;
    const Vec2 f = force_at(poses, t);
    if (follows_body_) {
      stiffness.add(column_, angle, f.y);
      stiffness.add(column_ + 1, angle, -f.x);
    } else {
      stiffness.add(angle, angle, dot(poses.planar[body_].turn(point_), f));
    }
  }
  void add_powers(const BodyPoses& poses, Real t, Powers& powers) const override {
    powers.applied += dot(force_at(poses, t), poses.planar[body_].velocity) +
                      moment_at(poses, t) * poses.planar[body_].spin;
  }

 private:
  static std::string owner(const AppliedForce& element) {
    return fmt::format("applied force '{}'", element.name);
  }
  Vec2 force_at(const BodyPoses& poses, Real t) const {
    const Vec2 f{fx_(t).value, fy_(t).value};
    return follows_body_ ? poses.planar[body_].turn(f) : f;
  }
  Real moment_at(const BodyPoses& poses, Real t) const {
    return torque_(t).value + dot(perp(poses.planar[body_].turn(point_)), force_at(poses, t));
  }

  int body_, column_;
  Vec2 point_;
  bool follows_body_;
  ScalarFunction fx_, fy_, torque_;
};

}  // namespace

std::unique_ptr<ForceElement> make_force_element(const SpringDamper& element, const BodyLayout& layout,
                                                 Real end) {
  return std::make_unique<SpringDamperElement>(element, layout, end);
}

std::unique_ptr<ForceElement> make_force_element(const TorsionalSpringDamper& element,
                                                 const BodyLayout& layout) {
  return std::make_unique<TorsionalElement>(element, layout);
}

std::unique_ptr<ForceElement> make_force_element(const AppliedForce& element, const BodyLayout& layout,
                                                 Real end) {
  return std::make_unique<AppliedForceElement>(element, layout, end);
}

}  // namespace scree
