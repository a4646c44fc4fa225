// Particles with six degrees of freedom in implicit steps: translation and rotation.
#pragma once

#include "dem/implicit/rotation_items.hpp"
#include "dem/schedule/three_freedoms.hpp"
#include "dem/surface_contact/friction_surfaces.hpp"

namespace scree {

// Residual and block of a particle from its row of the Newton matrix.
template <class Rows, bool kRolls>
struct RowResidualItem {
  FrictionResidualItem<kRolls> residual;
  FrictionMatrix matrix;
  Rows rows;
  const Index* surface_offsets;

  SCREE_HD void operator()(Index i) const { residual(i, matrix, rows, surface_offsets[i]); }
};

// Sum of both parts: not finite where one of them is not.
struct SumOfPartsItem {
  const Twist* twist;
  Vec3* sum;

  SCREE_HD void operator()(Index i) const { sum[i] = twist[i].move + twist[i].turn; }
};

// Items of particles that rotate, see `ThreeFreedoms`. With friction there is no potential. kRolls: whether
// the law has rolling resistance.
template <class On, bool kRolls>
class SixFreedomsOf {
 public:
  static constexpr bool kRotates = true;
  using Search = ResidualSearch;
  using Rows = typename On::Rows;

  explicit SixFreedomsOf(On& on) : on_(on), arrays_(on.arrays()), of_(on.arrays().six) {}

  void move() {
    on_.for_each(SpinUpdateItem{step_views(on_), rotation()});
    on_.for_each(NewmarkItem{step_views(on_)});
  }
  FrictionStart start(bool lagged) {
    return {step_start(on_), on_.start().angular_velocity.data(), of_.mean_spin.data(),
            lagged ? limits() : LaggedLimits{}, on_.items().surfaces.friction_steps()};
  }
  LaggedLimits limits() { return {of_.neighbor_limits.data(), of_.surface_limits.data()}; }
  StepSystem system(const FrictionStart& start) {
    return {on_.items().model.gravity, newton_weights(on_), start, step_forces(on_), {}, torques(), matrix(),
            of_.phase_squared.data()};
  }
  RowResidualItem<Rows, kRolls> residual() {
    return {{step_views(on_),
             rotation(),
             step_forces(on_),
             torques(),
             of_.residual.data(),
             of_.mass.data(),
             {of_.inverse_block.data()},
             arrays_.stiffness_ratio.data()},
            matrix(),
            on_.rows(),
            on_.surface_offsets()};
  }
  FrictionNormsItem norms() {
    return {step_views(on_),
            of_.residual.data(),
            of_.mass.data(),
            arrays_.force_magnitude.data(),
            arrays_.stiffness_ratio.data(),
            of_.phase_squared.data(),
            kRolls ? on_.start().angular_acceleration.data() : nullptr};
  }
  TwistSizeItem size() { return TwistSizeItem{of_.residual.data()}; }
  static Real size(const FrictionNorms& norms) { return scaled_residual(norms) * norms.force; }
  void show_residual() { on_.for_each(SumOfPartsItem{of_.residual.data(), arrays_.residual.data()}); }

  FrictionShiftItem shift(bool consistent) {
    return {matrix(),
            on_.surface_offsets(),
            on_.surface_entries(),
            on_.items().surfaces.numbers(),
            on_.items().surfaces.friction_steps(),
            newton_weights(on_),
            consistent,
            on_.surface_moves(),
            of_.residual.data()};
  }
  // size: of the right-hand side [N].
  void begin_solve(Real size, bool consistent) { unit_ = direction_unit(size), consistent_ = consistent; }
  auto& direction(int product) { return of_.direction[product % 2]; }
  auto first(const ChebyshevWeights& weights) {
    return FirstDirectionItem{direction_item(weights), direction(0).data(), of_.correction.data()};
  }
  auto product(int product, const ChebyshevWeights& weights) {
    const SubtractFrictionItem<Rows, kRolls> subtract{
        matrix(),        on_.rows(),         on_.surface_offsets(),
        of_.mass.data(), consistent_,        direction(product).data(),
        unit_,           of_.residual.data()};
    return ProductItem{subtract, direction_item(weights), direction(product + 1).data(),
                       of_.correction.data()};
  }
  FrictionCorrectItem correct(Real share) {
    return {on_.now().acceleration.data(),
            on_.now().angular_acceleration.data(),
            of_.correction.data(),
            unit_,
            on_.now().position.data(),
            share,
            newmark_position_gain(on_.items().hht, on_.h())};
  }

  RotationErrorItem error() { return {step_views(on_), rotation()}; }
  void accept() {
    on_.for_each(BalanceItem{step_views(on_), rotation(), step_forces(on_), torques()});
    on_.for_each(accept_item(on_));
    on_.for_each(AcceptRotationItem{step_views(on_), rotation(), torques(), on_.now().orientation.data(),
                                    on_.now().integrator_loss.data()});
  }

 private:
  RotationViews rotation() {
    return {on_.now().angular_velocity.data(), of_.mean_spin.data(), on_.now().angular_acceleration.data(),
            on_.start().angular_velocity.data(), on_.start().angular_acceleration.data()};
  }
  StepTorques torques() { return {of_.start_torque.data(), of_.step_torque.data(), of_.end_torque.data()}; }
  FrictionMatrix matrix() {
    return {arrays_.matrix_count.data(), of_.surface_count.data(), of_.entries.views(),
            of_.surface_entries.data(), of_.surface_rolling.data()};
  }
  TwistDirectionItem direction_item(const ChebyshevWeights& weights) {
    return {
        {of_.inverse_block.data()}, of_.residual.data(), weights.from_last, weights.from_residual / unit_};
  }

  On& on_;
  typename On::Arrays& arrays_;
  decltype(On::Arrays::six)& of_;
  Real unit_ = 0;            // of the correction and the directions, direction_unit [N]
  bool consistent_ = false;  // of the last solve, see `FrictionEntry`
};
template <class On>
using SixFreedoms = SixFreedomsOf<On, false>;
template <class On>
using RollingFreedoms = SixFreedomsOf<On, true>;

}  // namespace scree
