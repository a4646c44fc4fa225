// Impacts of two free spheres in space: rows of pair_oblique_3d.csv.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "physics/normal_laws.hpp"
#include "physics/restitution.hpp"
#include "physics/tangential_laws.hpp"
#include "support/reference_table.hpp"
#include "support/restitution.hpp"
#include "verification/contact/leapfrog.hpp"

namespace scree {

inline Vec3 vector(const ReferenceTable::Row& row, const std::string& name) {
  return {row[name + "x"], row[name + "y"], row[name + "z"]};
}

// An impact from touch to separation.
struct PairImpact {
  Grain i, j;
  Grain i_after, j_after;  // their velocities and spins
  Vec3 normal;             // at the start, from j to i
  Real time, loss;         // duration of the force [s]; dissipation [J]

  explicit PairImpact(const ReferenceTable::Row& row)
      : i(grain(row, "i", "0")),
        j(grain(row, "j", "0")),
        i_after(grain(row, "i", "")),
        j_after(grain(row, "j", "")),
        normal(vector(row, "n")),
        time(row["time"]),
        loss(row["loss"]) {}

 private:
  static Grain grain(const ReferenceTable::Row& row, const std::string& name, const std::string& when) {
    return {.velocity = vector(row, "v" + name + when),
            .spin = vector(row, "w" + name + when),
            .radius = row["R_" + name],
            .mass = row["m_" + name]};
  }
};

// F = K d + c d_dot, spring k_t.
struct LinearPairImpact : PairImpact {
  ContactLaw<LinearLaw, LinearSlider> law;

  explicit LinearPairImpact(const ReferenceTable::Row& row) : PairImpact(row) {
    const Real mass = PairSize{1, 1, i.mass, j.mass}.effective_mass();
    const Real damping = contact_damping(damping_ratio_of(row["e"], false), mass, row["K"], 1);
    law = {LinearLaw(row["K"], damping, false), {row["kt"], row["mu"]}};
  }
};

// F = K d^(3/2) + c d^(1/4) d_dot, spring k_t sqrt(d).
struct MindlinPairImpact : PairImpact {
  ContactLaw<HertzLaw, MindlinSlider> law;

  explicit MindlinPairImpact(const ReferenceTable::Row& row) : PairImpact(row) {
    const Real root = std::sqrt(PairSize{i.radius, j.radius, 1, 1}.effective_radius());
    const Real ratio = damping_ratio_of(row["e"], false);
    law = {HertzLaw(row["K"] / root, std::sqrt(Real(5)) * ratio, false), {row["kt"] / (8 * root), row["mu"]}};
  }
};

// Runs with steps of time / parts, the first touch `phase` steps after the start.
template <class Impact>
auto pair_run(const Impact& impact, Real parts, Real phase) {
  PairRun<decltype(impact.law)> run{
      .law = impact.law, .i = impact.i, .j = impact.j, .h = impact.time / parts};
  run.i.position = (run.i.radius + run.j.radius) * impact.normal;
  for (Grain* grain : {&run.i, &run.j}) grain->position -= phase * run.h * grain->velocity;
  return run;
}

// The largest of the differences of velocities, and of spins times radii [m/s].
inline Real difference(const Grain& a, const Grain& b) {
  return std::max(norm(a.velocity - b.velocity), a.radius * norm(a.spin - b.spin));
}

}  // namespace scree
