// Checks the deck's steps against contacts, bodies and speeds.
#include <fmt/format.h>

#include <algorithm>

#include "model/checks/deck_checks.hpp"
#include "model/checks/explicit_step.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/checks/limits.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/mesh_corners.hpp"
#include "model/derived/surface_speeds.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

// For n = 1 the limit is exact, and exceeding it an error; for other exponents it is an estimate, and
// exceeding it a warning.
void check_explicit_step(const DeckTable& deck, const Model& model, const std::vector<PairLimit>& limits,
                         Log& log) {
  const std::optional<PairLimit> tightest = smallest_explicit_step(limits);
  const Real step = model.time.step / model.integrator.substeps;
  if (!tightest || step <= tightest->explicit_step) return;
  const std::vector<std::string>& names = model.contact.material_names;
  const auto a = static_cast<std::size_t>(tightest->material[0]),
             b = static_cast<std::size_t>(tightest->material[1]);
  const std::string problem = fmt::format(
      "a velocity-verlet step of step / substeps = {:.4g} s is unstable in dense contacts of \"{}\" and "
      "\"{}\"; it must be at most {:.4g} s",
      step, names[a], names[b], tightest->explicit_step);
  if (tightest->law.exponent == 1) deck.table("time").fail("step", problem + default_step_text(model));
  log.warning("time.step: " + problem + " (estimated for an overlap of 1 % of the radius)" +
              default_step_text(model));
}

// Effective masses of a body at a contact [kg]: for forces along the normal, and for tangential friction; 0:
// no contact.
struct MassesOnContact {
  Real pushed = 0, frictional = 0;
  bool beside_particle = false;  // otherwise only other bodies or walls are touched
};

// The effective masses of the lightest body of material a in contact with material b: with a particle,
// another body or a surface. The motion of particles is not included: they have substeps of their own.
MassesOnContact masses_on_contact(const Model& model, const std::vector<MaterialUse>& uses, int a, int b) {
  const MaterialUse &body = uses[static_cast<std::size_t>(a)], &other = uses[static_cast<std::size_t>(b)];
  const bool beside_particle = other.particles > 0;
  const MassesOnContact alone{body.smallest_body_mass, body.smallest_frictional_mass, beside_particle};
  if (alone.pushed == 0 || !can_touch(model, uses, a, b)) return {};
  if (!bodies_can_touch(model, uses, a, b) || (beside_particle && !model.rotates()))
    return beside_particle || (body.shapes > 0 && other.is_of_surfaces()) ? alone : MassesOnContact{};
  if (other.smallest_body_mass == 0) return alone;  // all other objects have infinite mass
  return {reduced_mass(body.smallest_body_mass, other.smallest_body_mass),
          reduced_mass(body.smallest_frictional_mass, other.smallest_frictional_mass), beside_particle};
}

}  // namespace

Real BodyStepLimit::good_step() const {
  return good_frequency > 0 ? kGoodBodyPhase / good_frequency : kInfinity;
}

// Bodies take the contact force at the end of their step while the particles take substeps: the scheme is
// staggered, and stable only for steps that are short relative to the oscillation of a body on its contacts.
// For exponents other than 1 the limit is an estimate.
BodyStepLimit body_step_limit(const Model& model) {
  const std::vector<MaterialUse> uses = material_uses(model);
  BodyStepLimit limit{0, kMostBodyPhase, 0, true};
  for (int a = 0; a < model.contact.materials(); ++a) {
    for (int b = 0; b < model.contact.materials(); ++b) {
      const MassesOnContact masses = masses_on_contact(model, uses, a, b);
      if (masses.pushed == 0) continue;
      const PairSize size =
          smallest_partners(uses[static_cast<std::size_t>(a)], uses[static_cast<std::size_t>(b)]);
      const NormalLawParameters& law = model.contact.law(a, b);
      Real frequency = contact_frequency(typical_stiffness(law, size), masses.pushed);
      if (model.rotates())
        frequency = std::max(frequency,
                             contact_frequency(typical_slip_stiffness(model.contact.friction_of(a, b), size),
                                               masses.frictional));
      const Real allowed = masses.beside_particle || model.rotates() ? kMostBodyPhase : kMostAmongBodies;
      limit.good_frequency = std::max(limit.good_frequency, frequency);
      if (frequency / allowed > limit.frequency / limit.most_phase)
        limit.frequency = frequency, limit.most_phase = allowed,
        limit.is_exact = law_of_size(law, size).exponent == 1;
    }
  }
  return limit;
}

namespace {

void check_body_step(const DeckTable& deck, const Model& model, Log& log) {
  if (model.integrator.particles != ParticleIntegrator::velocity_verlet) return;
  const BodyStepLimit limit = body_step_limit(model);
  const std::string finding = fmt::format(
      "a body on a contact oscillates with {:.4g} rad/s; with velocity-verlet particles the bodies' step "
      "must be at most {:.3g} s",
      limit.frequency, limit.most_step());
  if (model.time.step > limit.most_step() && limit.is_exact)
    deck.table("time").fail("step", finding + default_step_text(model));
  if (model.time.step > limit.good_step())
    log.warning(fmt::format("time.step: {}, and should be at most {:.3g} s{}", finding, limit.good_step(),
                            default_step_text(model)));
}

// Advice for a step in which something moves by more than a radius. A fixed implicit step has no default.
std::string slower_than_radius(const Model& model) {
  if (model.integrator.particles == ParticleIntegrator::velocity_verlet) return default_step_text(model);
  const Real most = two_digits_below(unnoticed_step(model));
  return model.time.control == StepControl::adaptive ? fmt::format("; left out, it is at most {:g} s", most)
                                                     : fmt::format("; it should be at most {:g} s", most);
}

// Warns where something moves by more than a radius in a step [s] and may pass others. Neither a contact law
// nor an error estimate detects this: uniform motion is integrated without error.
void warn_where_unnoticed(const Model& model, Real step, Real radii, const std::string& what,
                          const std::string& of_what, Log& log) {
  if (radii <= 1) return;
  const bool is_fixed = model.time.control == StepControl::fixed;
  log.warning(fmt::format(
      "{}: in a step of {}{:.4g} s{} {} moves by {:.3g} times {}, and may pass others unnoticed{}",
      is_fixed ? "time.step" : "time.max_step", model.integrator.substeps > 1 ? "step / substeps = " : "",
      step, is_fixed ? "" : ", the longest allowed,", what, radii, of_what, slower_than_radius(model)));
}

void check_speeds(const Model& model, Real step, Log& log) {
  const ParticleTotals& particles = model.particles.totals;
  if (particles.count == 0) return;
  warn_where_unnoticed(model, step, particles.most_radii_per_second * step, "a particle",
                       "its radius with its speed at t = 0", log);
  const Real speed = ImpactSpeeds(model).fastest_surface();
  warn_where_unnoticed(model, step, speed * step / particles.smallest_radius,
                       "a surface that motions, drivers or motors move",
                       fmt::format("the smallest radius at its fastest, {:.3g} m/s", speed), log);
}

// Checks the step against the oscillation of bodies on the vertices of their meshes, of which a face has
// many. A body that a joint holds may never touch a plane: too long a step is then a warning, not an error.
void check_corner_step(const DeckTable& deck, const Model& model, Log& log) {
  if (model.integrator.particles != ParticleIntegrator::velocity_verlet) return;
  const Real most = model.rotates() ? kMostBodyPhase : kMostAmongBodies;
  for (const bool held : {false, true}) {
    const CornerOscillation on = fastest_on_corners(model, held);
    const Real phase = on.frequency * model.time.step;
    const std::string finding = fmt::format(
        "a body on a plane, with all vertices of a face of its mesh, oscillates with {:.4g} rad/s; with "
        "velocity-verlet particles the bodies' step must be at most {:.3g} s",
        on.frequency, most / on.frequency);
    if (phase > most && on.is_exact && !held)
      deck.table("time").fail("step", finding + default_step_text(model));
    if (phase > (held ? most : kGoodBodyPhase))
      log.warning(fmt::format("time.step: {}, and should be at most {:.3g} s{}", finding,
                              kGoodBodyPhase / on.frequency, default_step_text(model)));
  }
}

// Warns of a driver that rotates its joint by a large angle within a step. The mechanism may then pass a dead
// point into another configuration, in which Newton's method converges as well, without an error.
void check_driven_angles(const Model& model, Log& log) {
  constexpr Real kMost = 1;  // [rad]
  if (model.time.control != StepControl::fixed) return;
  for (const Driver& driver : model.drivers) {
    const Joint& joint = model.joints[static_cast<std::size_t>(driver.joint)];
    if (!is_angle(coordinate_of(driver.name, joint, driver.coordinate))) continue;
    const Real turn = fastest_rate(driver.motion, model.time.end) * model.time.step;
    if (turn > kMost)
      log.warning(fmt::format(
          "{}: driver '{}' rotates its joint by {:.3g} rad in a step of {:.4g} s at its fastest, and may "
          "bring the mechanism past a dead point unnoticed; the step should be at most {:.2g} s",
          driver.deck_label, driver.name, turn, model.time.step, 0.1 * kMost * model.time.step / turn));
  }
}

}  // namespace

void check_steps(const DeckTable& deck, const Model& model, Log& log) {
  const std::vector<PairLimit> limits = pair_limits(model);
  check_body_step(deck, model, log);
  check_corner_step(deck, model, log);
  const bool is_explicit = model.integrator.particles == ParticleIntegrator::velocity_verlet;
  const bool is_fixed = model.time.control == StepControl::fixed;
  const Real step =
      is_fixed ? model.time.step / (is_explicit ? model.integrator.substeps : 1) : model.time.max_step;
  check_driven_angles(model, log);
  check_speeds(model, step, log);
  if (is_fixed && is_explicit) check_explicit_step(deck, model, limits, log);
}

}  // namespace scree
