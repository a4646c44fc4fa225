// What a contact over an implicit step adds to the energy ledger: what its law dissipates, and what the time
// integration does to it.
#pragma once

#include "base/hd.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// Of one contact over one step, or of several.
struct ContactBooks {
  Real dissipated = 0;  // by the law; never negative [J]
  Real integrator = 0;  // taken out by the time integration; negative where that adds energy [J]

  SCREE_HD void add(const ContactBooks& part, Real share) {
    dissipated += share * part.dissipated, integrator += share * part.integrator;
  }
};

// With the rate linear in time, in contact and not cut: the mean damping C times the integral of rate^2 [J].
SCREE_HD Real damper_work(Real damping, const ContactStep& c) {
  return damping * c.h / 3 * (c.rate0 * c.rate0 + c.rate0 * c.rate1 + c.rate1 * c.rate1);
}

// The same along the straight line between the overlaps at both ends, d_dot = (d1 - d0) / h, which
// step_contact_force() takes, too: over its part in contact the damper takes C d_dot times the way, C its
// mean there. A force that is cut at zero (F = 0 while d > 0, from the overlap down at which the elastic
// force is -C d_dot) loses the elastic energy left then.
template <class NormalLaw>
SCREE_HD Real straight_dissipation(const NormalLaw& law, const ContactStep& c) {
  const bool changes = c.change.kind != Changeover::Kind::none;
  const Real start = changes          ? c.changing_from()
                     : c.overlap0 > 0 ? c.overlap0
                                      : 0,
             end = changes          ? c.changing_to()
                   : c.overlap1 > 0 ? c.overlap1
                                    : 0;
  const auto pull = [&](Real damping) { return damping / c.h * std::abs(c.overlap1 - c.overlap0); };
  if (end >= start) return pull(law.mean_damping(start, end)) * (end - start);
  Real cut = end;  // the overlap from which on the force is cut
  if (!law.tension) {
    const Real pull_at_start = pull(law.damping(start));
    cut = law.elastic(start) <= pull_at_start ? start : law.cut(start, pull_at_start);
  }
  if (!(cut > end)) return pull(law.mean_damping(end, start)) * (start - end);
  if (cut > start) cut = start;
  return pull(law.mean_damping(cut, start)) * (start - cut) + (law.energy(cut) - law.energy(end));
}

// What the law dissipates over a step [J].
template <class NormalLaw>
SCREE_HD Real step_dissipation(const NormalLaw& law, const ContactStep& c) {
  const auto holds = [&](Real overlap, Real rate) {  // the contact is closed there and its force not cut
    return overlap > 0 && (law.tension || contact_force(law, overlap, rate).force > 0);
  };
  if (c.change.kind == Changeover::Kind::none && holds(c.overlap0, c.rate0) && holds(c.overlap1, c.rate1))
    return damper_work(law.mean_damping(c.overlap0, c.overlap1), c);
  return straight_dissipation(law, c);
}

// One that changes over hands its energy there on to the other contact.
// work: of the contact on its two partners, by the trapezoidal rule [J]. What of it is neither elastic energy
// nor dissipation the integrator has taken out of the contact.
template <class NormalLaw>
SCREE_HD ContactBooks contact_books(const NormalLaw& law, const ContactStep& c, Real work) {
  const bool changes = c.change.kind != Changeover::Kind::none;
  const Real start = changes ? c.changing_from() : c.overlap0, end = changes ? c.changing_to() : c.overlap1;
  const Real before = start > 0 ? law.energy(start) : 0;
  const Real after = end > 0 ? law.energy(end) : 0;
  const Real dissipated = step_dissipation(law, c);
  return {dissipated, (before - after) - work - dissipated};
}

}  // namespace scree
