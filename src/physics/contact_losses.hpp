// Energy accounting of a contact over an implicit step: the dissipation of its law, and the energy error of
// the time integration.
#pragma once

#include "base/hd.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// Energy that one or several contacts lose over one or several steps.
struct ContactLosses {
  Real dissipated = 0;  // dissipation of the law; never negative [J]
  Real integrator = 0;  // energy taken out by the time integration; negative where it adds energy [J]

  SCREE_HD void add(const ContactLosses& part, Real share) {
    dissipated += share * part.dissipated, integrator += share * part.integrator;
  }
};

// Work of the damper with a rate that is linear in time, in contact and not cut: the mean damping C times the
// integral of rate^2 [J].
SCREE_HD Real damper_work(Real damping, const ContactStep& c) {
  return damping * c.h / 3 * (c.rate0 * c.rate0 + c.rate0 * c.rate1 + c.rate1 * c.rate1);
}

// Dissipation for overlaps that are linear in time, d_dot = (d1 - d0) / h, as in `step_contact_force()` [J].
// In contact the damper dissipates C d_dot times the change of the overlap, C being the mean damping over
// that change. A force that is cut at zero (F = 0 while d > 0, below the overlap at which the elastic force
// equals -C d_dot) dissipates the elastic energy that is left there.
template <class NormalLaw>
SCREE_HD Real straight_dissipation(const NormalLaw& law, const ContactStep& c) {
  const bool changes = c.change.kind != Changeover::Kind::none;
  const Real start = changes          ? c.changing_from()
                     : c.overlap0 > 0 ? c.overlap0
                                      : 0,
             end = changes          ? c.changing_to()
                   : c.overlap1 > 0 ? c.overlap1
                                    : 0;
  const auto damper_force = [&](Real damping) { return damping / c.h * std::abs(c.overlap1 - c.overlap0); };
  if (end >= start) return damper_force(law.mean_damping(start, end)) * (end - start);
  Real cut = end;  // overlap below which the force is cut
  if (!law.tension) {
    const Real damper_force_at_start = damper_force(law.damping(start));
    cut = law.elastic(start) <= damper_force_at_start ? start : law.cut(start, damper_force_at_start);
  }
  if (!(cut > end)) return damper_force(law.mean_damping(end, start)) * (start - end);
  if (cut > start) cut = start;
  return damper_force(law.mean_damping(cut, start)) * (start - cut) + (law.energy(cut) - law.energy(end));
}

// Dissipation of the normal law over a step [J].
template <class NormalLaw>
SCREE_HD Real step_dissipation(const NormalLaw& law, const ContactStep& c) {
  const auto is_active = [&](Real overlap, Real rate) {  // closed, with a force that is not cut
    return overlap > 0 && (law.tension || contact_force(law, overlap, rate).force > 0);
  };
  if (c.change.kind == Changeover::Kind::none && is_active(c.overlap0, c.rate0) &&
      is_active(c.overlap1, c.rate1))
    return damper_work(law.mean_damping(c.overlap0, c.overlap1), c);
  return straight_dissipation(law, c);
}

// Energy accounting of one contact over a step. work: of the contact force on both partners, by the
// trapezoidal rule [J]; the part of it that is neither elastic energy nor dissipation is the error of the
// integrator. A contact that changes over hands its elastic energy on to the other contact.
template <class NormalLaw>
SCREE_HD ContactLosses contact_losses(const NormalLaw& law, const ContactStep& c, Real work) {
  const bool changes = c.change.kind != Changeover::Kind::none;
  const Real start = changes ? c.changing_from() : c.overlap0, end = changes ? c.changing_to() : c.overlap1;
  const Real before = start > 0 ? law.energy(start) : 0;
  const Real after = end > 0 ? law.energy(end) : 0;
  const Real dissipated = step_dissipation(law, c);
  return {dissipated, (before - after) - work - dissipated};
}

}  // namespace scree
