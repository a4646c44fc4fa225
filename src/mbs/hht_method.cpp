#include "mbs/hht_method.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

std::size_t count(int n) { return static_cast<std::size_t>(n); }

// Evaluates all terms once, so that their patterns are known; the values do not matter.
KktMatrix record_pattern(MechanicalSystem& system, const SystemInstant& at, SystemTerms& terms,
                         SystemDerivatives& derivatives) {
  const std::vector<Real> zero(count(system.coordinates()), 0), multipliers(count(system.constraints()), 0);
  terms.applied_force.assign(count(system.coordinates()), 0);
  terms.constraint.assign(count(system.constraints()), 0);
  system.evaluate({at.time, at.position, at.velocity, &multipliers}, terms);
  system.differentiate(at, {zero, zero, multipliers}, derivatives);
  // Systems without spatial rotations keep their original order of elimination, so that their results keep
  // their bits.
  const bool rotates_in_space = system.positions() != system.coordinates();
  return KktMatrix(terms, derivatives, system.coordinates(), system.constraints(), rotates_in_space);
}

}  // namespace

HhtMethod::HhtMethod(MechanicalSystem& system, Real hht_alpha, const std::vector<Real>& position,
                     const std::vector<Real>& velocity, const SparseTerm& inverse_mass)
    : system_(system),
      coefficients_(hht_coefficients(hht_alpha)),
      kkt_(record_pattern(system, {0, position, velocity}, terms_, derivatives_)),
      inertia_force_(count(system.coordinates())),
      constraint_force_(count(system.coordinates())),
      residual_(count(system.coordinates() + system.constraints())) {
  if (inverse_mass.size() > 0)
    compliance_ = RowCompliance(terms_.constraint_jacobian, inverse_mass, system.constraints());
  if (shares()) compliance_.update(terms_.constraint_jacobian);
}

std::vector<Real> HhtMethod::units() const {
  constexpr Real kPivot = 1e-4;   // a tenth of KLU's threshold
  constexpr Real kHeavy = 1e-15;  // from where on multipliers lose digits to masses: bodies of 1e6 kg
  const SparseTerm &jacobian = terms_.constraint_jacobian, &mass = terms_.mass;
  std::vector<Real> largest(compliance().size(), 0), units(inertia_force_.size(), 0);
  for (std::size_t i = 0; i < jacobian.size(); ++i)
    largest[count(jacobian.row(i))] = std::max(largest[count(jacobian.row(i))], std::abs(jacobian.value(i)));
  bool ordinary = true;
  for (std::size_t j = 0; j < largest.size(); ++j) {
    const Real c = compliance()[j];
    ordinary = ordinary && c <= kPivot * largest[j] && (c == 0 || c >= kHeavy * largest[j]);
  }
  if (ordinary) return {};
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass.row(i) == mass.column(i)) units[count(mass.row(i))] += mass.value(i);
  units.insert(units.end(), compliance().begin(), compliance().end());
  for (std::size_t i = 0; i < units.size(); ++i) {
    const Real size = i < inertia_force_.size() ? units[i] : units[i] / kRelativeCompliance;
    units[i] = size > 0 ? std::exp2(-std::round(std::log2(size) / 2)) : 1;
  }
  return units;
}

void HhtMethod::predict(const MultibodyState& state, Real t, Real h) {
  time_ = t;
  step_ = h;
  start_position_ = state.position;
  start_velocity_ = state.velocity;
  start_acceleration_ = state.acceleration;
  start_force_ = state.force;
  position_.resize(state.position.size());
  displacement_.resize(state.velocity.size());
  velocity_.resize(state.velocity.size());
  acceleration_ = state.acceleration;
  multipliers_ = state.multipliers;
  opened_ = true;
  update_motion();
}

void HhtMethod::update_motion() {
  const HhtCoefficients& c = coefficients_;
  begun_ = Begun::nothing;
  for (std::size_t i = 0; i < velocity_.size(); ++i) {
    const Real v = start_velocity_[i], a0 = start_acceleration_[i], a1 = acceleration_[i];
    displacement_[i] = newmark_displacement(c, step_, v, a0, a1);
    velocity_[i] = newmark_velocity(c, step_, v, a0, a1);
  }
  system_.displace(start_position_, displacement_, position_);
}

void HhtMethod::begin_residual() {
  begun_ = Begun::nothing;  // in case of an exception
  system_.evaluate_uncontacted({end_time(), position_, velocity_, &multipliers_}, terms_);
  if (opened_) compliance_.update(terms_.constraint_jacobian);
  opened_ = false;
  std::fill(inertia_force_.begin(), inertia_force_.end(), 0);
  std::fill(constraint_force_.begin(), constraint_force_.end(), 0);
  terms_.mass.multiply(1, acceleration_, inertia_force_);
  terms_.constraint_jacobian.multiply_transposed(1, multipliers_, constraint_force_);
  const std::size_t n = inertia_force_.size();
  for (std::size_t j = 0; j < terms_.constraint.size(); ++j) {
    residual_[n + j] = terms_.constraint[j] / position_gain();
  }
  begun_ = Begun::residual;
}

void HhtMethod::evaluate_residual() {
  if (begun_ != Begun::residual) begin_residual();
  begun_ = Begun::nothing;
  system_.add_contacts(terms_);
  const Real alpha = coefficients_.hht_alpha, scale = hht_inertia_weight(coefficients_);
  for (std::size_t i = 0; i < inertia_force_.size(); ++i) {
    residual_[i] = scale * inertia_force_[i] + constraint_force_[i] - terms_.applied_force[i] +
                   alpha * scale * start_force_[i];
  }
}

void HhtMethod::newton_matrix(std::span<Real> values) {
  system_.differentiate({end_time(), position_, velocity_}, {displacement_, acceleration_, multipliers_},
                        derivatives_);
  const Real scale = hht_inertia_weight(coefficients_);
  const KktWeights weights{
      scale, position_gain(), newmark_velocity_gain(coefficients_, step_), position_gain() * scale, scale, 1};
  kkt_.assemble(terms_, derivatives_, weights, compliance(), values);
  coupling_.clear();
  for (const CoupledEntry& entry : derivatives_.coupling)
    coupling_.push_back({count(entry.row), count(entry.column),
                         weights.stiffness * entry.stiffness + weights.damping * entry.damping});
}

void HhtMethod::add_coupled(Real scale, std::span<const Real> x, std::span<Real> y) const {
  for (const Coupling& entry : coupling_) y[entry.row] += scale * entry.value * x[entry.column];
}

void HhtMethod::apply_correction(std::span<const Real> delta) {
  const std::size_t n = acceleration_.size();
  change_.assign(delta.begin(), delta.begin() + static_cast<std::ptrdiff_t>(n));
  system_.pull_back(displacement_, change_);
  for (std::size_t i = 0; i < n; ++i) acceleration_[i] -= change_[i];
  for (std::size_t j = 0; j < multipliers_.size(); ++j) multipliers_[j] -= delta[n + j];
  update_motion();
}

void HhtMethod::close(MultibodyState& state) {
  evaluate_residual();
  state.position = position_;
  state.velocity = velocity_;
  state.acceleration = acceleration_;
  state.multipliers = multipliers_;
  state.applied = terms_.applied_force;
  state.force = terms_.applied_force;
  for (std::size_t i = 0; i < state.force.size(); ++i) state.force[i] -= constraint_force_[i];
}

void HhtMethod::average_accelerations(MultibodyState& state, Real share) const {
  for (std::size_t i = 0; i < start_velocity_.size(); ++i)
    state.acceleration[i] +=
        share * ((state.velocity[i] - start_velocity_[i]) / step_ - state.acceleration[i]);
}

void HhtMethod::evaluate_at(const MultibodyState& state, Real t, std::span<Real> values) {
  begun_ = Begun::nothing;
  system_.evaluate({t, state.position, state.velocity}, terms_);
  compliance_.update(terms_.constraint_jacobian);
  kkt_.assemble(terms_, derivatives_, KktWeights{}, compliance(), values);
}

void HhtMethod::acceleration_system(const MultibodyState& state, Real t, std::span<Real> values,
                                    std::span<Real> rhs) {
  evaluate_at(state, t, values);
  std::vector<Real> acceleration_rhs(terms_.constraint.size());
  system_.acceleration_rhs({t, state.position, state.velocity}, acceleration_rhs);
  std::copy(terms_.applied_force.begin(), terms_.applied_force.end(), rhs.begin());
  std::copy(acceleration_rhs.begin(), acceleration_rhs.end(), rhs.begin() + system_.coordinates());
}

void HhtMethod::velocity_system(const MultibodyState& state, Real t, std::span<Real> values,
                                std::span<Real> rhs) {
  evaluate_at(state, t, values);
  const std::vector<Real>& rate = constraint_rate(state, t);
  std::fill(rhs.begin(), rhs.end(), 0);
  for (std::size_t j = 0; j < rate.size(); ++j) rhs[state.velocity.size() + j] = -rate[j];
}

void HhtMethod::constraint_system(const MultibodyState& state, Real t, const std::vector<Real>& motion,
                                  std::span<Real> values, std::span<Real> rhs) {
  evaluate_at(state, t, values);
  std::vector<Real> rate(terms_.constraint.size(), 0);
  terms_.constraint_jacobian.multiply(1, motion, rate);
  std::fill(rhs.begin(), rhs.end(), 0);
  std::copy(rate.begin(), rate.end(), rhs.begin() + system_.coordinates());
}

const std::vector<Real>& HhtMethod::constraint_rate(const MultibodyState& state, Real t) {
  std::vector<Real>& rate = constraint_rate_;
  rate.assign(count(system_.constraints()), 0);
  system_.velocity_rhs({t, state.position, state.velocity}, rate);
  for (Real& r : rate) r = -r;
  terms_.constraint_jacobian.multiply(1, state.velocity, rate);
  return rate;
}

void HhtMethod::begin_change(const MultibodyState& state, Real t, std::span<Real> values) {
  // Phi_q is that of the state's position.
  system_.evaluate_uncontacted_forces({t, state.position, state.velocity, &state.multipliers}, terms_);
  change_matrix(state, t, values);
  begun_ = Begun::change;
}

void HhtMethod::change_matrix(const MultibodyState& state, Real t, std::span<Real> values) {
  const SystemInstant at{t, state.position, state.velocity, &state.multipliers};
  compliance_.update(terms_.constraint_jacobian);
  const std::vector<Real> zero(state.velocity.size(), 0);  // -Q_lambda does not depend on the displacement
  if (is_loaded()) system_.differentiate(at, {zero, state.acceleration, state.multipliers}, derivatives_);
  kkt_.assemble(terms_, derivatives_, {.reaction = 1}, compliance(), values);
}

bool HhtMethod::change_system(const MultibodyState& state, Real t, std::span<Real> values,
                              std::span<Real> rhs) {
  const bool begun = begun_ == Begun::change;
  begun_ = Begun::nothing;
  if (!begun)
    system_.evaluate_uncontacted_forces({t, state.position, state.velocity, &state.multipliers}, terms_);
  system_.add_contacts(terms_);
  if (terms_.applied_force == state.applied) return false;
  if (!begun) change_matrix(state, t, values);
  std::fill(rhs.begin(), rhs.end(), 0);
  for (std::size_t i = 0; i < state.applied.size(); ++i) rhs[i] = terms_.applied_force[i] - state.applied[i];
  return true;
}

void HhtMethod::apply_change(std::span<const Real> solution, Real share, MultibodyState& state) const {
  const std::size_t n = state.acceleration.size();
  std::vector<Real> change(solution.begin() + static_cast<std::ptrdiff_t>(n), solution.end());
  for (std::size_t i = 0; i < n; ++i) {
    state.acceleration[i] += share * solution[i];
    state.force[i] += terms_.applied_force[i] - state.applied[i];
  }
  for (std::size_t j = 0; j < change.size(); ++j) state.multipliers[j] += change[j];
  terms_.constraint_jacobian.multiply_transposed(-1, change, state.force);
  state.applied = terms_.applied_force;
  for (std::vector<Real>* force : {&state.force, &state.applied})
    derivatives_.reaction.multiply_transposed(-1, change, *force);
}

void HhtMethod::set_acceleration(std::span<const Real> solution, const std::vector<Real>& applied,
                                 MultibodyState& state) const {
  const auto multipliers = solution.begin() + system_.coordinates();
  state.acceleration.assign(solution.begin(), multipliers);
  state.multipliers.assign(multipliers, solution.end());
  state.applied = applied;
  state.force = applied;
  terms_.constraint_jacobian.multiply_transposed(-1, state.multipliers, state.force);
}

}  // namespace scree
