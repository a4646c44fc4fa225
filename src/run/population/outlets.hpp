// Outlets during a run: which of them remove particles now, and what they have removed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/fixed_sum.hpp"
#include "dem/reports/escape_items.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

// Particles removed so far, as part of the state; empty in a model without outlets.
struct OutletState {
  std::vector<std::int64_t> removed;   // particles, per outlet
  std::vector<std::int64_t> mass;      // FixedSum of their masses: its words, outlet after outlet
  std::vector<std::int64_t> instants;  // instants reached, per outlet

  Real mass_of(int outlet) const;  // [kg]
  std::int64_t removed_of_all() const;
};

// Must not outlive its model.
class Outlets {
 public:
  explicit Outlets(const Model& model) : model_(model) {}

  OutletState start() const;
  // The next instant of any outlet [s]; infinite where there is none.
  Real next(const OutletState& state) const;
  // The outlets whose instant time t has reached, in their order, and their regions; counts the instants.
  // motion: of the bodies, then of the walls with a pose.
  struct Open {
    std::vector<int> numbers;
    std::vector<OutletRegion> regions;
  };
  Open open_at(Real t, std::span<const BodyMotion> motion, OutletState& state) const;
  // Counts removed particles. leaving: found with the regions of `open`.
  void account(const std::vector<EscapedParticle>& leaving, const Open& open, OutletState& state) const;

 private:
  Real next_of(std::size_t outlet, const OutletState& state) const;

  const Model& model_;
};

}  // namespace scree
