// Particles with three degrees of freedom in implicit steps: translation.
#pragma once

#include "dem/implicit/block_solver.hpp"
#include "dem/implicit/frictional_contacts.hpp"
#include "dem/implicit/line_search.hpp"
#include "dem/laws/contact_kernels.hpp"
#include "dem/schedule/step_arrays.hpp"

namespace scree {

// What both kinds of particles have in common. On: the operations of a backend, see `ImplicitSchedule`.
template <class On>
StepViews step_views(On& on) {
  return {on.now().position.data(),
          on.now().velocity.data(),
          on.now().acceleration.data(),
          on.start().position.data(),
          on.start().velocity.data(),
          on.start().acceleration.data(),
          on.now().force.data(),
          on.items().hht,
          on.h(),
          on.items().subdomain.snap_constant()};
}
template <class On>
StepForces step_forces(On& on) {
  return {on.arrays().step_force.data(), on.arrays().end_force.data(), on.arrays().force_magnitude.data()};
}
template <class On>
StepStart step_start(On& on) {
  return {on.start().position.data(), on.start().velocity.data(), on.h(),
          on.items().model.integrator.resolve_events};
}
template <class On>
NewtonWeights newton_weights(On& on) {
  return {newmark_position_gain(on.items().hht, on.h()), newmark_velocity_gain(on.items().hht, on.h())};
}
template <class On>
AcceptItem accept_item(On& on) {
  return {step_views(on), step_forces(on), on.now().force.data(), on.now().integrator_loss.data()};
}

// Items of particles that do not rotate, for `ImplicitSchedule`. Their step minimizes a potential.
template <class On>
class ThreeFreedoms {
 public:
  static constexpr bool kRotates = false;
  using Search = LineSearch;
  using Rows = typename On::Rows;

  explicit ThreeFreedoms(On& on) : on_(on), arrays_(on.arrays()), of_(on.arrays().three) {}

  // The iterate from its accelerations.
  void move() { on_.for_each(NewmarkItem{step_views(on_)}); }
  FrictionStart start(bool) { return {step_start(on_), nullptr, nullptr, {}, nullptr}; }
  StepSystem system(const FrictionStart& start) {
    return {on_.items().model.gravity, newton_weights(on_), start, step_forces(on_), matrix(), {}, {}, {}};
  }
  ResidualItem residual() {
    return {step_views(on_),         arrays_.step_force.data(), matrix(),
            arrays_.residual.data(), of_.inverse_block.data(),  arrays_.stiffness_ratio.data()};
  }
  StepNormsItem norms() {
    return {step_views(on_), arrays_.residual.data(), arrays_.force_magnitude.data(),
            arrays_.stiffness_ratio.data()};
  }
  // Largest component of the residual, of one particle and of all [N].
  NormItem size() { return NormItem{arrays_.residual.data()}; }
  static Real size(const FrictionNorms& norms) { return norms.residual; }
  void show_residual() {}  // in StepArrays::residual

  SlopeItem slope() { return {arrays_.residual.data(), of_.correction.data()}; }
  SlopeItem slope_at_start() { return {of_.right_hand_side.data(), of_.correction.data()}; }

  // The linear system. shift(): of the right-hand side, by the bodies' correction.
  SurfaceShiftItem<Rows> shift(bool) {
    return {on_.views(), newton_weights(on_), on_.surface_moves(), arrays_.residual.data()};
  }
  void begin_solve(Real, bool) { on_.copy(arrays_.residual, of_.right_hand_side); }
  auto& direction(int product) { return of_.direction[product % 2]; }
  auto first(const ChebyshevWeights& weights) {
    return FirstDirectionItem{direction_item(weights), direction(0).data(), of_.correction.data()};
  }
  // The product with this direction; weights: of the next one.
  auto product(int product, const ChebyshevWeights& weights) {
    const SubtractMatrixItem<Rows> subtract{matrix(),
                                            on_.rows(),
                                            on_.now().velocity.data(),
                                            hht_inertia_weight(on_.items().hht),
                                            direction(product).data(),
                                            arrays_.residual.data()};
    return ProductItem{subtract, direction_item(weights), direction(product + 1).data(),
                       of_.correction.data()};
  }
  CorrectItem correct(Real share) {
    return {on_.now().acceleration.data(), of_.correction.data(), on_.now().position.data(), share,
            newmark_position_gain(on_.items().hht, on_.h())};
  }

  StepErrorItem error() { return StepErrorItem{step_views(on_)}; }
  void accept() { on_.for_each(accept_item(on_)); }

 private:
  ContactMatrix matrix() { return {arrays_.matrix_count.data(), of_.entries.data(), of_.diagonal.data()}; }
  DirectionItem direction_item(const ChebyshevWeights& weights) {
    return {of_.inverse_block.data(), arrays_.residual.data(), weights.from_last, weights.from_residual};
  }

  On& on_;
  typename On::Arrays& arrays_;
  decltype(On::Arrays::three)& of_;
};

}  // namespace scree
