// A sphere on the plane z = 0 with its static overlap: its motion along x at given times.
#pragma once

#include <numbers>
#include <vector>

#include "support/reference_table.hpp"
#include "verification/contact/leapfrog.hpp"

namespace scree {

// Stiff in comparison with the tables' loads: the normal spring only carries the weight.
inline constexpr Real kRestStiffness = 1e5;  // [N/m]

// Gravity of a plane inclined by this angle [rad], down along +x.
inline Vec3 inclined_gravity(Real angle) {
  constexpr Real g = 9.81;
  return {g * std::sin(angle), 0, -g * std::cos(angle)};
}

// Run of a sphere whose weight its normal spring carries from the start on.
template <class Law>
PlaneRun<Law> resting_run(const Law& law, Grain grain, Vec3 gravity, Real h) {
  grain.position = {0, 0, grain.radius + grain.mass * gravity.z / law.normal.normal_stiffness};
  PlaneRun<Law> run{.law = law, .grain = grain, .gravity = gravity, .h = h};
  run.start();
  return run;
}

struct OnPlane {
  Real t, x, v, w;     // [s], [m], [m/s], [rad/s]
  Real spring, force;  // spring: of the slider; force: with the dashpot, against +x [N]
  Real held, moment;  // held: of the rolling spring; moment: with the dashpot, against rolling along +x [N m]
};

template <class Law>
OnPlane on_plane(const PlaneRun<Law>& run, Real t) {
  const ContactOutcome& out = run.outcome;
  // The force has the torque R T about y; the remainder is the rolling law's.
  const Real of_force = -run.grain.radius * out.load.force.x;
  return {t,
          run.grain.position.x,
          run.velocity().x,
          run.spin().y,
          out.history.spring.x,
          -out.load.force.x,
          out.history.moment.y,
          of_force - out.load.torque_i.y};
}

inline Real between(Real share, Real a, Real b) { return a + share * (b - a); }
inline OnPlane between(Real share, const OnPlane& a, const OnPlane& b) {
  return {between(share, a.t, b.t),           between(share, a.x, b.x),
          between(share, a.v, b.v),           between(share, a.w, b.w),
          between(share, a.spring, b.spring), between(share, a.force, b.force),
          between(share, a.held, b.held),     between(share, a.moment, b.moment)};
}

// Period of a mass on a spring, the reference of step lengths [s].
inline Real swing_period(Real inertia, Real stiffness) {
  return 2 * std::numbers::pi_v<Real> * std::sqrt(inertia / stiffness);
}

// Calls visit(state) at increasing times, by linear interpolation between two steps.
template <class Law, class Visit>
void visit_times(PlaneRun<Law>& run, const std::vector<Real>& times, const Visit& visit) {
  OnPlane before = on_plane(run, 0), now = before;
  std::size_t next = 0;
  for (int step = 1; next < times.size(); ++step) {
    run.step();
    before = now, now = on_plane(run, step * run.h);
    for (; next < times.size() && times[next] <= now.t * (1 + 1e-12); ++next)
      visit(between((times[next] - before.t) / run.h, before, now));
  }
}

// Calls visit(state, row) for rows [first, second) of a table, whose column t increases there.
template <class Law, class Visit>
void visit_rows(PlaneRun<Law>& run, const ReferenceTable& table, std::pair<std::size_t, std::size_t> rows,
                const Visit& visit) {
  std::vector<Real> times;
  for (std::size_t k = rows.first; k < rows.second; ++k) times.push_back(table.rows().at(k)["t"]);
  std::size_t k = rows.first;
  visit_times(run, times, [&](const OnPlane& at) { visit(at, table.rows()[k++]); });
}

}  // namespace scree
