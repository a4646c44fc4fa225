// HHT-I3 for a constrained mechanical system: coefficients, residual and Newton matrix, no policy.
// Negrut, Rampalli, Ottarsson, Sajdak, J. Comput. Nonlinear Dyn. 2 (2007); Jung, Jun, Sohn (2013), Eqs. 1-3,
// 14-17.
#pragma once

#include <span>
#include <vector>

#include "mbs/kkt_matrix.hpp"
#include "mbs/mechanical_system.hpp"
#include "mbs/multibody.hpp"
#include "mbs/row_compliance.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// One step from t_n to t_{n+1} = t_n + h. The unknowns are a_{n+1} and lambda_{n+1}; the displacement u of
// the step and v follow by Newmark, q_{n+1} = displace(q_n, u). The method is of second order where M is
// constant, as it is for rigid bodies in their own frames. Where M depends on q it is so for alpha = 0 only,
// because Eq. 16 takes M at t_{n+1} but a at t_{n+1} + alpha h.
class HhtMethod {
 public:
  // position, velocity: any instant at which the system can be evaluated; it gives the matrix its pattern.
  // inverse_mass: M^-1 of a system in which rows of Phi may be redundant. The multipliers are then the
  // minimum-norm solution, and all matrices here have -C = -eps S (RowCompliance) in the place of 0. Empty:
  // no row is redundant.
  HhtMethod(MechanicalSystem& system, Real hht_alpha, const std::vector<Real>& position,
            const std::vector<Real>& velocity, const SparseTerm& inverse_mass = {});

  const SparsePattern& pattern() const { return kkt_.pattern(); }
  const HhtCoefficients& coefficients() const { return coefficients_; }

  // Opens a step: a_{n+1} = a_n, lambda_{n+1} = lambda_n.
  void predict(const MultibodyState& state, Real t, Real h);

  // The residual of the current iterate: e1 (Eq. 16) in the first `coordinates` entries, e2 (Eq. 17) in the
  // others.
  //   e1 = M a / (1 + alpha) + (Phi_q^T lambda - Q)_{n+1} - alpha / (1 + alpha) (Phi_q^T lambda - Q)_n
  //   e2 = Phi / (beta h^2)
  void evaluate_residual();
  // Does what evaluate_residual() needs and the forces of contacts do not change, e2 included, so that the
  // next call for the same iterate adds these forces.
  void begin_residual();
  const std::vector<Real>& residual() const { return residual_; }
  // Eqs. 14, 15 at the iterate of the last evaluate_residual() or begin_residual(). values: [entries of
  // pattern()]. The unknown is the change of the pose over beta h^2, so that Phi_q and its transpose enter
  // unscaled:
  //   A = (M / (1 + alpha) - h gamma Q_v) T^-1 + beta h^2 ((M a)_q / (1 + alpha) + (Phi_q^T lambda - Q)_q)
  // The block Phi_q^T becomes Phi_q^T - Q_lambda.
  void newton_matrix(std::span<Real> values);
  // Whether the last newton_matrix() has a part O outside the pattern: blocks between bodies in contact, and
  // those of bodies loaded by explicit particles.
  bool is_coupled() const { return !coupling_.empty(); }
  // Whether O may be far larger than the other entries.
  bool is_loaded_by_contacts() const { return derivatives_.loaded; }
  // y += scale O x, over the coordinates.
  void add_coupled(Real scale, std::span<const Real> x, std::span<Real> y) const;

  // Subtracts `delta`, the solution of the Newton system for residual(), from (a, lambda), in a after
  // multiplication by T^-1, and updates q, v.
  void apply_correction(std::span<const Real> delta);

  // Evaluates the forces at the current iterate and writes the end of the step into `state`.
  void close(MultibodyState& state);
  // Replaces the fraction `share` of the accelerations at the end of the closed step by their mean over the
  // step.
  void average_accelerations(MultibodyState& state, Real share) const;

  // Acceleration-level system at the state's q, v and at time t:
  //   [M, Phi_q^T; Phi_q, -C] (a, lambda) = (Q, acceleration_rhs),  C = 0 without redundant rows.
  void acceleration_system(const MultibodyState& state, Real t, std::span<Real> values, std::span<Real> rhs);
  // Sets a and lambda from the solution of acceleration_system() with the applied forces Q, and the forces
  // that depend on them.
  void set_acceleration(std::span<const Real> solution, const std::vector<Real>& applied,
                        MultibodyState& state) const;

  // Velocity-level system at the state's q, v and at time t:
  //   [M, Phi_q^T; Phi_q, -C] (d, mu) = (0, velocity_rhs - Phi_q v).
  // v + d satisfies the constraints; d is the smallest such change in the norm of M.
  void velocity_system(const MultibodyState& state, Real t, std::span<Real> values, std::span<Real> rhs);

  // [M, Phi_q^T; Phi_q, -C] (d, mu) = (0, Phi_q motion) at the state and time t.
  void constraint_system(const MultibodyState& state, Real t, const std::vector<Real>& motion,
                         std::span<Real> values, std::span<Real> rhs);

  // The rate of Phi of a state at time t, Phi_q v - velocity_rhs. Requires that the last evaluation was at
  // this state, whose Jacobian it uses.
  const std::vector<Real>& constraint_rate(const MultibodyState& state, Real t);

  // System for the change of a state at time t under changed applied forces. Their change dQ changes the
  // reactions too, and these change the forces that depend on them,
  //   [M, Phi_q^T - Q_lambda; Phi_q, -C] (d, d_lambda) = (dQ, 0),  a += share d,  lambda += d_lambda,
  // one step of Newton's method for Q(lambda). Returns false, with nothing to solve, where the forces have
  // not changed.
  bool change_system(const MultibodyState& state, Real t, std::span<Real> values, std::span<Real> rhs);
  // Does what change_system() needs for this state and time and the forces of contacts do not change: the
  // values. The next change_system() must be for the same state, if it is the method's next evaluation.
  void begin_change(const MultibodyState& state, Real t, std::span<Real> values);
  void apply_change(std::span<const Real> solution, Real share, MultibodyState& state) const;
  // The `share` of apply_change() at the end of a step, 1 + alpha; at an instant it is 1.
  Real end_weight() const { return 1 + coefficients_.hht_alpha; }

  // Whether forces depend on the reactions.
  bool is_loaded() const { return derivatives_.reaction.size() > 0; }

  // shares(): whether rows may be redundant. compliance(): C of the open step, as of its first evaluation,
  // or of the last system [constraints].
  bool shares() const { return !compliance_.empty(); }
  const std::vector<Real>& compliance() const { return compliance_.of_row(); }

  // Powers of two by which rows and unknowns are scaled for the factorizations [unknowns]; empty: none. KLU
  // accepts a pivot on the diagonal that is at least a thousandth of the largest entry of its column. An
  // entry of C must not become a pivot, as its round-off costs nine digits. With lengths and masses of the
  // order of 1 C is smaller than Phi_q by eps; with bodies of less than a milligram the scaling makes it so.
  std::vector<Real> units() const;

  // Change of the position per change of the acceleration, beta h^2 [s^2].
  Real position_gain() const { return newmark_position_gain(coefficients_, step_); }
  Real end_time() const { return time_ + step_; }
  Real step() const { return step_; }

  // Motion and multipliers of the current iterate.
  const std::vector<Real>& position() const { return position_; }
  const std::vector<Real>& displacement() const { return displacement_; }
  const std::vector<Real>& velocity() const { return velocity_; }
  const std::vector<Real>& acceleration() const { return acceleration_; }
  const std::vector<Real>& multipliers() const { return multipliers_; }
  // Terms of the last evaluate_residual().
  const SystemTerms& terms() const { return terms_; }
  const std::vector<Real>& inertia_force() const { return inertia_force_; }        // M a
  const std::vector<Real>& constraint_force() const { return constraint_force_; }  // Phi_q^T lambda
  // Motion and force at the start of the step.
  const std::vector<Real>& start_position() const { return start_position_; }
  const std::vector<Real>& start_velocity() const { return start_velocity_; }
  const std::vector<Real>& start_acceleration() const { return start_acceleration_; }
  const std::vector<Real>& start_force() const { return start_force_; }  // Q - Phi_q^T lambda

 private:
  void update_motion();
  void change_matrix(const MultibodyState& state, Real t, std::span<Real> values);
  // The matrix of an instant at a state: M with weight 1, without stiffness and damping.
  void evaluate_at(const MultibodyState& state, Real t, std::span<Real> values);

  MechanicalSystem& system_;
  HhtCoefficients coefficients_;
  SystemTerms terms_;
  SystemDerivatives derivatives_;
  KktMatrix kkt_;
  RowCompliance compliance_;
  struct Coupling {
    std::size_t row, column;
    Real value;
  };
  std::vector<Coupling> coupling_;
  bool opened_ = false;  // a step is open and its compliance is not known yet
  // What terms_ hold, without the forces of contacts: begin_residual(), or begin_change().
  enum class Begun { nothing, residual, change } begun_ = Begun::nothing;
  Real time_ = 0, step_ = 0;
  std::vector<Real> start_position_, start_velocity_, start_acceleration_, start_force_;
  std::vector<Real> displacement_, position_, velocity_, acceleration_, multipliers_;
  std::vector<Real> change_;  // of the acceleration
  std::vector<Real> inertia_force_, constraint_force_, residual_, constraint_rate_;
};

}  // namespace scree
