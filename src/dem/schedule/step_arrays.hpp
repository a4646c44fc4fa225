// Arrays of implicit steps, kept from one step to the next. Array: std::vector, or DeviceArray.
#pragma once

#include <cstddef>

#include "base/spatial_velocity.hpp"
#include "base/types.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/implicit/friction_matrix.hpp"

namespace scree {

struct StepSizes {
  std::size_t owned, items, slots, surface_entries;  // particles, all items, of the list, of the surfaces
  bool rolls;                                        // whether the law has rolling resistance
};

// Of particles that do not rotate: see `ThreeFreedoms`.
template <template <class...> class Array>
struct ThreeFreedomArrays {
  // written by contact_force
  Array<ContactEntry> entries;
  Array<Sym3> diagonal, inverse_block;
  // written by particle_correct
  Array<Vec3> right_hand_side, correction;
  Array<Vec4> direction[2];  // all items

  void resize(const StepSizes& sizes) {
    entries.resize(sizes.slots);
    for (Array<Vec4>& of : direction) of.resize(sizes.items);
    right_hand_side.resize(sizes.owned), correction.resize(sizes.owned);
    diagonal.resize(sizes.owned), inverse_block.resize(sizes.owned);
  }
};

// Of particles that rotate: see `SixFreedoms`.
template <template <class...> class Array>
struct SixFreedomArrays {
  Array<Vec4> mean_spin;  // iterate, all items
  // written by contact_force
  Array<Vec3> start_torque, step_torque, end_torque;
  Array<Real> phase_squared;
  Array<Index> surface_count;
  FrictionEntryArrays<Array> entries;
  Array<FrictionEntry> surface_entries;
  Array<RollingEntry> surface_rolling;  // for laws with rolling resistance
  Array<ScaledMass> mass;
  Array<float> inverse_block;  // BlockSlices
  Array<Twist> residual;
  Array<Real> neighbor_limits, surface_limits;  // while the limits are lagged
  // written by particle_correct
  Array<Twistf> correction;
  Array<Twistf> direction[2];  // all items

  void resize(const StepSizes& sizes) {
    const std::size_t owned = sizes.owned;
    mean_spin.resize(sizes.items);
    for (Array<Twistf>& of : direction) of.resize(sizes.items);
    entries.resize(sizes.slots, sizes.rolls), surface_entries.resize(sizes.surface_entries);
    if (sizes.rolls) surface_rolling.resize(sizes.surface_entries);
    start_torque.resize(owned), step_torque.resize(owned), end_torque.resize(owned);
    phase_squared.resize(owned), surface_count.resize(owned);
    mass.resize(owned), inverse_block.resize(BlockSlices::size(owned)), residual.resize(owned);
    correction.resize(owned);
  }
};

template <template <class...> class Array>
struct StepArrays {
  // written by contact_force; residual: where particles rotate, only for reports
  Array<Vec3> step_force, end_force, residual;
  Array<Real> force_magnitude, stiffness_ratio;
  Array<Index> matrix_count;
  // one of these, the other is empty
  ThreeFreedomArrays<Array> three;
  SixFreedomArrays<Array> six;

  void resize(const StepSizes& sizes, bool rotates) {
    const std::size_t owned = sizes.owned;
    step_force.resize(owned), end_force.resize(owned), residual.resize(owned);
    force_magnitude.resize(owned), stiffness_ratio.resize(owned), matrix_count.resize(owned);
    rotates ? six.resize(sizes) : three.resize(sizes);
  }
};

}  // namespace scree
