// Trial impact with friction in the implicit steps of a run; see trial_steps.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/step_friction.hpp"
#include "physics/trial_steps.hpp"

namespace scree {

// Impact in HHT steps of the relative motion in a plane. Friction rotates both partners about the same axis,
// and the slip depends only on the sum of the spins times the radii: this surface speed is the unknown, with
// the mass that resists it. As in a run, the Coulomb limit is lagged where Newton's method does not find in
// time whether the contact slides; a step that then has no solution is halved.
template <class Law>
class FrictionTrial {
 public:
  FrictionTrial(const Law& law, const TrialMethod& method, const TrialImpact& impact, Real gap)
      : law_(law), method_(method), impact_(impact) {
    const PairSize& size = impact.size;
    const auto share = [](Real radius, Real inertia) {
      return radius < kInfinity ? radius * radius / inertia : 0;
    };
    rotating_mass_ = 1 / (share(size.radius_i, impact.inertia_i) + share(size.radius_j, impact.inertia_j));
    at_.r = trial_start(impact, gap), at_.velocity = {impact.sliding, 0, -impact.approach};
  }

  bool step(Real h) {
    constexpr int kMostHalvings = 3;
    take(h, kMostHalvings);
    return geometry(at_.r).overlap > 0;
  }
  Real parting() const { return dot(at_.velocity, geometry(at_.r).normal()); }
  Real tangential_part() const { return scree::tangential_part(at_.velocity, geometry(at_.r).normal()).x; }

 private:
  // Motion of i relative to j, surface speed from rotation about y, and force at the instant.
  struct State {
    Vec3 r, velocity, acceleration{}, force{};
    Real surface = 0, surface_rate = 0;  // [m/s], [m/s^2]
    Vec3 spring{};
  };
  // Unknowns of Newton's method: the acceleration along x and z, and the surface acceleration between them.
  using Unknowns = Vec3;
  struct End {
    State state;
    Vec3 step_force{};                                       // force that the step is solved with
    Real start_couple = 0, step_couple = 0, end_couple = 0;  // torques on the surfaces over the radius [N]
    Real limit = -1;                                         // of the mean friction force [N]
    Unknowns residual{};                                     // [N]
    Real scale = 0;
  };

  ContactGeometry geometry(Vec3 r) const { return trial_geometry(impact_.size, r); }

  // State at the end of a step with these accelerations.
  End end_of(Real h, const Unknowns& a, Real lagged_limit) const {
    const HhtCoefficients& c = method_.hht;
    End end;
    State& s = end.state;
    s.acceleration = {a.x, 0, a.z}, s.surface_rate = a.y;
    const Vec3 displacement = newmark_displacement(c, h, at_.velocity, at_.acceleration, s.acceleration);
    s.r = at_.r + displacement;
    s.velocity = newmark_velocity(c, h, at_.velocity, at_.acceleration, s.acceleration);
    s.surface = newmark_velocity(c, h, at_.surface, at_.surface_rate, s.surface_rate);
    const Real rotated = newmark_displacement(c, h, at_.surface, at_.surface_rate, s.surface_rate);
    end.limit = lagged_limit;
    add_contact(h, displacement, rotated, end);
    const Vec3 move = hht_residual(c, impact_.mass, s.acceleration, end.step_force, at_.force);
    const Real rotation_residual = hht_residual(c, rotating_mass_, {0, s.surface_rate, 0},
                                                {0, end.step_couple, 0}, {0, end.start_couple, 0})
                                       .y;
    end.residual = {move.x, rotation_residual, move.z};
    end.scale =
        norm(end.step_force) + norm(at_.force) + hht_inertia_weight(c) * impact_.mass * norm(s.acceleration);
    return end;
  }

  // Adds the contact to `end`. rotated: displacement of the surfaces by rotation [m]; end.limit: the lagged
  // limit, if >= 0.
  void add_contact(Real h, Vec3 displacement, Real rotated, End& end) const {
    State& s = end.state;
    const ContactGeometry g0 = geometry(at_.r), g1 = geometry(s.r);
    if (!(g0.overlap > 0 || g1.overlap > 0 || end.limit > 0)) return;
    const PairSize& size = impact_.size;
    const Vec3 n0 = g0.normal(), n1 = g1.normal(), y{0, 1, 0};
    const RotatingPartner i{(rotated / (h * size.radius_i)) * y, size.radius_i, impact_.inertia_i},
        j{{}, on_plane(size) ? 0 : size.radius_j, impact_.inertia_j};
    FrictionStep step{};
    step.step = {g0.overlap, -dot(n0, at_.velocity), g1.overlap, -dot(n1, s.velocity), h};
    step.motion = on_plane(size) ? face_motion(g1, n1, displacement, i, j, h)
                                 : sphere_motion(g1, displacement, i, j, h);
    step.lever_arm_ratio0 = on_plane(size) ? 1 : step.motion.lever_arm_ratio * g1.distance / g0.distance;
    const auto slip_rate = [&](Real lever_arm_ratio, const State& at, Vec3 n) {
      return scree::tangential_part(lever_arm_ratio * at.velocity - at.surface * cross(y, n), n);
    };
    step.slip_rate0 = slip_rate(step.lever_arm_ratio0, at_, n0);
    step.slip_rate1 = slip_rate(step.motion.lever_arm_ratio, s, n1);
    const auto normal = law_.normal.of_pair(size);
    const TrialForce force = trial_force(normal, step.step, method_.resolve_events);
    step.size = size, step.lagged_limit = end.limit;
    step.start_force = g0.overlap > 0 ? contact_force(normal, g0.overlap, step.step.rate0).force : 0;
    step.end_force = force.at_end, step.step_force = force.step.force;
    const StepFriction friction = step_friction(law_, step, at_.spring);
    s.spring = friction.spring, end.limit = friction.limit;
    end.step_force = force.step.force * n1 - step.motion.lever_arm_ratio * friction.step;
    s.force = force.at_end * n1 - step.motion.lever_arm_ratio * friction.end;
    end.start_couple = cross(n0, friction.start).y;
    end.step_couple = cross(n1, friction.step).y, end.end_couple = cross(n1, friction.end).y;
  }

  void take(Real h, int halvings) {
    constexpr int kFollowingLimit = 12, kLaggedLimit = 40;  // iterations
    End end = end_of(h, {at_.acceleration.x, at_.surface_rate, at_.acceleration.z}, -1);
    if (!solve(h, kFollowingLimit, -1, end) && !solve(h, kLaggedLimit, std::max(end.limit, Real(0)), end) &&
        halvings > 0) {
      take(h / 2, halvings - 1), take(h / 2, halvings - 1);
      return;
    }
    at_ = end.state, largest_force_ = std::max(largest_force_, end.scale);
    at_.acceleration += hht_event_acceleration(method_.hht, impact_.mass, end.step_force, at_.force);
    at_.surface_rate +=
        hht_event_acceleration(method_.hht, rotating_mass_, {0, end.step_couple, 0}, {0, end.end_couple, 0})
            .y;
  }

  // Newton's method from `end` with difference quotients as derivatives; a correction is halved while the
  // residual grows. Returns whether it converged.
  bool solve(Real h, int most_iterations, Real lagged_limit, End& end) const {
    constexpr int kMostShortenings = 6;
    constexpr Real kTolerance = 1e-8, kDifference = 1e-7;
    const auto size = [](const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    Unknowns a = unknowns_of(end);
    end = end_of(h, a, lagged_limit);
    for (int k = 0; k < most_iterations; ++k) {
      if (size(end.residual) <= kTolerance * (end.scale + largest_force_)) return true;
      const Real little = kDifference * (size(a) + norm(at_.velocity) / h);
      const auto slope = [&](Vec3 along) {
        return (1 / little) * (end_of(h, a + little * along, lagged_limit).residual - end.residual);
      };
      const Vec3 correction = solution(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1}), -end.residual);
      Real share = 1;
      End next = end_of(h, a + correction, lagged_limit);
      for (int s = 0; s < kMostShortenings && !(size(next.residual) < size(end.residual)); ++s)
        share /= 2, next = end_of(h, a + share * correction, lagged_limit);
      a += share * correction, end = next;
    }
    return false;
  }
  static Unknowns unknowns_of(const End& end) {
    return {end.state.acceleration.x, end.state.surface_rate, end.state.acceleration.z};
  }
  // Solves x u + y v + z w = b by Cramer's rule.
  static Vec3 solution(Vec3 u, Vec3 v, Vec3 w, Vec3 b) {
    const Real all = dot(u, cross(v, w));
    return {dot(b, cross(v, w)) / all, dot(u, cross(b, w)) / all, dot(u, cross(v, b)) / all};
  }

  const Law& law_;
  TrialMethod method_;
  TrialImpact impact_;
  Real rotating_mass_;  // [kg]
  State at_;
  Real largest_force_ = 0;  // over the steps so far [N]
};

}  // namespace scree
