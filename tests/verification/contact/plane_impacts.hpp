// Impacts of a sphere on the plane z = 0, without gravity: rows of the tables.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "physics/normal_laws.hpp"
#include "physics/restitution.hpp"
#include "physics/tangential_laws.hpp"
#include "support/reference_table.hpp"
#include "support/restitution.hpp"
#include "verification/contact/leapfrog.hpp"

namespace scree {

// x along the plane, y the axis of rolling along +x.
struct PlaneImpact {
  Grain grain;  // moving down, at any position
  Vec3 velocity_after{}, spin_after{};
  Real contact_time = 0;  // estimate, the unit of step lengths [s]
};

// speed [m/s] at an angle from the normal [rad].
inline Vec3 oblique(Real speed, Real angle) { return {speed * std::sin(angle), 0, -speed * std::cos(angle)}; }

inline Real radians(Real degrees) { return degrees * std::numbers::pi_v<Real> / 180; }

// Rows of oblique_linear.csv: 1 m/s, no spin.
struct LinearImpact : PlaneImpact {
  Real stiffness, damping_ratio, slip_stiffness, friction;

  explicit LinearImpact(const ReferenceTable::Row& row)
      : PlaneImpact{{.velocity = oblique(1, radians(row["angle_deg"])), .radius = row["R"], .mass = row["m"]},
                    {row["vt"], 0, row["vn"]},
                    {0, row["w"], 0},
                    std::numbers::pi_v<Real> * std::sqrt(row["m"] / row["K"])},
        stiffness(row["K"]),
        damping_ratio(row["z_cut"]),
        slip_stiffness(row["kt"]),
        friction(row["mu"]) {}

  auto law() const {
    const Real damping = contact_damping(damping_ratio, grain.mass, stiffness, 1);
    return ContactLaw<LinearLaw, LinearSlider>{LinearLaw(stiffness, damping, false),
                                               {slip_stiffness, friction}};
  }
};

// Error of a rebound by steps of contact_time / parts, the first touch `phase` steps after the start, over
// the speed of approach of the surfaces: the largest of the components of the velocity and of radius times
// spin.
template <class Impact>
Real rebound_error(const Impact& impact, Real parts, Real phase) {
  PlaneRun<decltype(impact.law())> run{.law = impact.law(), .grain = impact.grain};
  run.h = impact.contact_time / parts;
  run.grain.position = {0, 0, run.grain.radius - phase * run.h * run.grain.velocity.z};
  if (!run_impact(run, static_cast<int>(100 * parts))) return std::numeric_limits<Real>::quiet_NaN();
  const Vec3 v = run.grain.velocity - impact.velocity_after;
  const Vec3 w = run.grain.radius * (run.grain.spin - impact.spin_after);
  const Real speed = norm(impact.grain.velocity - impact.grain.radius * cross(impact.grain.spin, {0, 0, 1}));
  return std::max(
             {std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(w.x), std::abs(w.y), std::abs(w.z)}) /
         speed;
}

}  // namespace scree
