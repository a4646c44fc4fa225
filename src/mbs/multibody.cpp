#include "mbs/multibody.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "mbs/dead_point.hpp"
#include "mbs/energy_ledger.hpp"
#include "mbs/multibody_impl.hpp"
#include "mbs/start_velocities.hpp"
#include "model/derived/connections.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

namespace {

// Ratio of the reactions' alternating part to the largest mean part from which shorter steps do not help.
constexpr Real kOscillation = 10;
// Ratios, of reactions and of velocities, at which the run ends in any case where both are exceeded.
constexpr Real kRuin = 100, kRuinedVelocity = 1e-3;
constexpr Real kGoverns = 0.3;  // of the tolerance: bodies' error that governs the step size

MultibodyState checked_start(const Model& model, RigidBodySystem& system, StartFindings& findings) {
  MultibodyState state;
  state.position.resize(static_cast<std::size_t>(system.positions()));
  state.velocity.resize(static_cast<std::size_t>(system.coordinates()));
  for (const auto& kind : system.kinds()) kind->start(state.position, state.velocity);
  state.multipliers.assign(static_cast<std::size_t>(system.constraints()), 0);
  state.counted_angles = static_cast<std::size_t>(system.counted_angles());
  system.count_revolutions(system.poses_at({0, state.position, state.velocity}), state.position);
  findings = check_start(model, system, state.position, state.velocity);
  return state;
}

}  // namespace

Multibody::Impl::Impl(const Model& model)
    : system(model),
      start(checked_start(model, system, findings)),
      method(system, model.integrator.hht_alpha, start.position, start.velocity,
             model.integrator.redundant == RedundantRows::share ? system.inverse_mass() : SparseTerm{}),
      newton(system, method),
      readings(model, system.layout()),
      watch(system.coordinate_scale(), system.constraint_scale()),
      time_control(model.time),
      corrects_start(model.integrator.corrected_start && has_spatial_bodies(model)),
      start_elements(model),
      motion(model.bodies.size()) {
  for (const Body& body : model.bodies) weight += body.mass * norm(model.gravity);
  start.memory.assign(system.joint_forces().memory().size(), 0);
  settle_velocities(model);
}

// Efforts that depend on the reactions are set by the reactions found without them.
void Multibody::Impl::solve_acceleration(MultibodyState& state, Real t) {
  open_step(state, t, 0);
  newton.solve_acceleration(state, t);
  if (!system.joint_forces().are_loaded()) return;
  open_step(state, t, 0);
  newton.solve_acceleration(state, t);
}

void Multibody::Impl::settle_velocities(const Model& model) {
  if (system.constraints() == 0) return;
  const std::vector<Real> given = start.velocity;
  const std::string trouble = velocity_trouble(system, method.constraint_rate(start, 0), given);
  if (trouble.empty() && !model.consistent_velocities) return;
  newton.solve_velocity(start, 0);
  if (method.shares()) {
    const std::string conflict = velocity_trouble(system, method.constraint_rate(start, 0), start.velocity);
    if (!conflict.empty())
      throw InputError(conflict + ", and no velocities satisfy it and the others that fix the same motion");
  }
  if (model.consistent_velocities) {
    check_redundant_accelerations(system, findings.repeated, start.position, start.velocity);
    start_change = largest_change(system, given, start.velocity);
    return;
  }
  const std::string keys = keys_to_set(system, given, start.velocity, model.space.dimension);
  throw InputError(fmt::format("{}; set {}{}velocities = \"consistent\" at the top of the deck", trouble,
                               keys, keys.empty() ? "" : ", or "));
}

// With alpha < 0 the accelerations are those at t + alpha h. The constraints remove the local position error
// h^3 c in their directions at each step, and so hold the velocities off the exact ones by h^2 c. A start
// from exact velocities and accelerations is therefore a jump, which the reactions show as a disturbance of
// first order. It is removed by
//   a_0 = a(0) + alpha h a'(0),   v_0 = v(0) - h^2 d,   [M, Phi_q^T; Phi_q, 0] (d, mu) = (0, Phi_q c)
//   c = (1/12 + alpha^2/4) a'(0) - (0; w x w'/12 per spatial body)
MultibodyState Multibody::Impl::corrected_start(const MultibodyState& state, Real h) {
  const HhtCoefficients& coefficients = method.coefficients();
  const Real tau = h / 100;  // step of the finite difference for a'
  MultibodyState before = state_after(state, -tau), after = state_after(state, tau);
  newton.solve_acceleration(before, -tau);
  newton.solve_acceleration(after, tau);
  MultibodyState corrected = state;
  std::vector<Real> c(state.velocity.size());
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Real change = (after.acceleration[i] - before.acceleration[i]) / (2 * tau);
    corrected.acceleration[i] += coefficients.hht_alpha * h * change;
    c[i] = coefficients.error_constant * change;
  }
  for (const auto& kind : system.kinds()) kind->subtract_commutator(state, c);
  if (system.constraints() == 0) return corrected;
  const std::vector<Real> d = newton.constrained_part(state, c);
  for (std::size_t i = 0; i < d.size(); ++i) corrected.velocity[i] -= h * h * d[i];
  return corrected;
}

// Extrapolates the state by tau [s] along its velocities and accelerations.
MultibodyState Multibody::Impl::state_after(const MultibodyState& state, Real tau) const {
  MultibodyState moved = state;
  std::vector<Real> displacement(state.velocity.size());
  for (std::size_t i = 0; i < displacement.size(); ++i) {
    displacement[i] = tau * state.velocity[i] + tau * tau / 2 * state.acceleration[i];
    moved.velocity[i] += tau * state.acceleration[i];
  }
  system.displace(state.position, displacement, moved.position);
  return moved;
}

Multibody::Multibody(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Multibody::~Multibody() = default;

MultibodyState Multibody::initial_state(const std::vector<BodyWrench>& wrench) {
  MultibodyState state = impl_->start;
  impl_->system.set_contacts({wrench, {}});
  impl_->solve_acceleration(state, 0);
  state.wrench = wrench;
  state.min_kinetic = state.max_kinetic = energies(state, 0).kinetic;
  if (impl_->method.shares())
    check_start_accelerations(impl_->system, impl_->newton.misfit(), state.acceleration);
  return state;
}

std::vector<std::string> Multibody::start_warnings() {
  if (impl_->start_elements.empty()) return {};
  const MultibodyState state = initial_state(std::vector<BodyWrench>(impl_->motion.size()));
  return impl_->start_elements.findings(impl_->system, state, impl_->weight);
}

void Multibody::solve_acceleration(MultibodyState& state, Real t, const std::vector<BodyWrench>& wrench) {
  impl_->system.set_contacts({wrench, {}});
  check_joints_hold(impl_->system, state.position, state.velocity, t);
  impl_->solve_acceleration(state, t);
  state.wrench = wrench;
}

void Multibody::predict(const MultibodyState& state, Real t, Real h) {
  impl_->time = t;
  if (t == 0 && impl_->corrects_start) {
    // The forces of the start, whatever was solved since, or before a restart.
    impl_->system.set_forces(impl_->wrench_of_bodies(state));
    impl_->open_step(state, t, 0);  // the correction is for accelerations of instants
    impl_->predict(impl_->corrected_start(state, h), t, h);
  } else {
    impl_->predict(state, t, h);
  }
  impl_->newton.begin_step();
  impl_->closed = false;
  impl_->update_motion();
}

void Multibody::prepare() {
  impl_->system.drop_stiffness();  // of the last step
  impl_->newton.prepare();
}

IterationNorms Multibody::correct(const ContactWrenches& contacts) {
  impl_->system.set_contacts(contacts);
  impl_->norms = impl_->newton.iterate();
  impl_->update_motion();
  return impl_->norms;
}

std::string Multibody::trouble() {
  Impl& impl = *impl_;
  const std::vector<Real>&gap = impl.method.terms().constraint, &scale = impl.system.constraint_scale();
  Real largest = 0;
  for (std::size_t i = 0; i < gap.size(); ++i) largest = std::max(largest, std::abs(gap[i]) / scale[i]);
  std::string text;
  if (largest > 0 && largest >= impl.norms.residual / 2)
    text = "; the largest gaps are those of " + largest_gaps(impl.system, gap);
  const std::string dead = dead_point();
  if (!dead.empty()) return text + "; " + dead;
  if (impl.method.shares())
    return text.empty() ? "" : text + ": redundant constraints must not contradict each other";
  const std::string near = near_singular(impl.system, impl.method.start_position(), impl.time);
  return near.empty() ? text : text + "; " + near + kSingularPosition;
}

std::string Multibody::dead_point() {
  const HhtMethod& method = impl_->method;
  return scree::dead_point(impl_->system, {impl_->time, method.start_position(), method.start_velocity()},
                           method.step(), impl_->findings.repeated);
}

Real Multibody::error() const { return impl_->error(); }

Real Multibody::Impl::error() const {
  Real largest = 0;
  for (const auto& kind : system.kinds())
    largest = larger_error(largest, kind->error(method, system.length_scale()));
  return largest;
}

// What does not depend on the wrenches at the end of the step.
void Multibody::Impl::close_step(const MultibodyState& state) {
  method.close(end);
  watch_reactions(state);
  account_step(system, state, time, method.step(), end);
  end.memory = system.joint_forces().memory();
  system.count_revolutions(system.poses(), end.position);
  end.counted_angles = state.counted_angles;
  efforts_differ = system.joint_forces().end_step();
  // The whole change of the joints' efforts counts: with alpha < 0 the impulse of a step with an event is
  // then right wherever in the step the event is (mbs/README.md, "Events").
  if (efforts_differ) newton.change_forces(end, method.end_time(), 1);
  closed = true;
}

// The wrenches of contacts change in an explicit step, as a rule.
void Multibody::begin_accept(const MultibodyState& state) {
  impl_->close_step(state);
  if (impl_->system.has_contacts()) impl_->newton.prepare_change(impl_->end, impl_->method.end_time());
}

void Multibody::accept(MultibodyState& state, const std::vector<BodyWrench>& end_wrench) {
  Impl& impl = *impl_;
  if (!impl.closed) impl.close_step(state);
  impl.closed = false;
  impl.end.wrench = end_wrench;
  const bool contacts_differ = !impl.system.has_forces_of(end_wrench);
  if (contacts_differ) {
    impl.system.set_forces(end_wrench);
    impl.newton.change_forces(impl.end, impl.method.end_time(), impl.method.end_weight());
  }
  if (impl.efforts_differ || contacts_differ) impl.follow_load();
  std::swap(state, impl.end);
}

void Multibody::average_accelerations(MultibodyState& state, Real share) const {
  impl_->method.average_accelerations(state, share);
}

// A sliding friction spring is at the limit under the reactions that end the step. The energy that this adds
// or removes counts as friction's.
void Multibody::Impl::follow_load() {
  const JointForces& forces = system.joint_forces();
  if (!forces.are_loaded()) return;
  const Real t = method.end_time(), stored = forces.elastic_energy(system.poses(), t, end.memory);
  end.memory = forces.memory();
  end.dissipated += stored - forces.elastic_energy(system.poses(), t, end.memory);
}

void Multibody::check_reactions() const {
  if (impl_->watch.oscillates() && impl_->watch.share() >= kOscillation) impl_->fail_for_oscillation();
}

// Adaptive steps that the oscillation governs would become shorter and shorter without gain.
void Multibody::Impl::watch_reactions(const MultibodyState& state) {
  if (system.constraints() == 0) return;
  watch.observe(state, end, method.constraint_rate(end, method.end_time()));
  if (!watch.oscillates()) return;
  const bool governs =
      time_control.control == StepControl::adaptive && error() >= kGoverns * time_control.tolerance;
  const bool ruined = watch.share() >= kRuin && watch.relative_gap() >= kRuinedVelocity;
  if (ruined || (governs && watch.share() >= kOscillation)) fail_for_oscillation();
}

void Multibody::Impl::fail_for_oscillation() const {
  throw SimulationError("stage accept: " + oscillation_text(watch.share(), method.coefficients().hht_alpha));
}

std::string Multibody::reaction_warning() const {
  const Real share = impl_->watch.worst_ratio(), alpha = impl_->method.coefficients().hht_alpha;
  return share < kOscillation ? "" : oscillation_text(share, alpha);
}

const std::vector<BodyMotion>& Multibody::motion() const { return impl_->motion; }

std::vector<BodyMotion> Multibody::motion(const MultibodyState& state, Real tau) const {
  std::vector<BodyMotion> out;
  motion(state, tau, out);
  return out;
}

void Multibody::motion(const MultibodyState& state, Real tau, std::vector<BodyMotion>& out) const {
  out.resize(impl_->motion.size());
  for (const auto& kind : impl_->system.kinds()) kind->motion_after(state, tau, out);
}

int Multibody::coordinates() const { return impl_->system.coordinates(); }
int Multibody::constraints() const { return impl_->system.constraints(); }
const std::string& Multibody::start_change() const { return impl_->start_change; }
const std::string& Multibody::redundancy() const { return impl_->findings.redundancy; }
std::string Multibody::solver_description() const { return impl_->newton.description(); }

}  // namespace scree
