// Contact stages of one law; included where they are instantiated.
#pragma once

#include <type_traits>
#include <utility>
#include <variant>

#include "base/for_each.hpp"
#include "base/reproducible_sum.hpp"
#include "dem/explicit/paired_rows.hpp"
#include "dem/laws/contact_kernels.hpp"

namespace scree {

template <class Laws>
class CpuContactKernels : public ContactKernels {
 public:
  explicit CpuContactKernels(Laws laws) : laws_(laws) {}

  LawTraits traits() const override { return LawTraits::of<LawOf<Laws>>(); }
  void run(const ContactViews<PackedRows>& in, Index n, const CpuRequest& request) const override {
    with_requested_item(in, laws_, request, [&](const auto& item) { for_each(Serial{}, n, item); });
  }
  Real verlet_finish(const ContactViews<PackedRows>& in, PairList& pairs, Vec3 gravity, Index n,
                     const VerletViews& state, Vec3* force) override {
    return max_over(
        Serial{}, n,
        VerletFinishItem<Laws, StepRows>{{explicit_walk(over_step(in, pairs), laws_, state.h), gravity, force,
                                          state.loss_power, state.angular_acceleration},
                                         state});
  }
  // Flattened into one function, so that the sums stay in registers.
  [[gnu::flatten]] Real verlet_advance(const ContactViews<PackedRows>& in, PairList& pairs, Vec3 gravity,
                                       Index n, const VerletViews& state) override {
    return max_over(Serial{}, n,
                    VerletAdvanceItem<Laws, StepRows>{{explicit_walk(over_step(in, pairs), laws_, state.h),
                                                       gravity, nullptr, nullptr, nullptr},
                                                      state});
  }
  void return_records(PairList& pairs, const HistoryViews& history) const override {
    if constexpr (kPaired) ::scree::return_records<LawOf<Laws>>(pairs, history);
  }
  [[gnu::flatten]] void surface_loads(const SurfaceViews& in, Index n, SurfaceLoad* loads) const override {
    for_each(Serial{}, n, SurfaceLoadItem<Laws>{in, laws_, loads});
  }
  void surface_steps(const SurfaceViews& in, Index n, const FrictionStart& start,
                     const SurfacePose* start_surface_poses, const SurfaceStepsTo& to) const override {
    if constexpr (kFreedoms == 6)
      for_each(Serial{}, n,
               SurfaceFrictionItem<Laws>{in, start, start_surface_poses, laws_, to.friction_steps});
    else if constexpr (kFreedoms == 3)
      for_each(Serial{}, n, SurfaceStepItem<Laws>{in, start.step, start_surface_poses, laws_, to.steps});
    else
      throw std::logic_error("surface_steps: the law has no implicit steps");
  }
  void wall_sums(const ContactViews<PackedRows>& in, Index n, const WallChoice& choice, const Ranks& ranks,
                 Real (&sums)[kWallTerms]) const override {
    reproducible_sums(n, WallContactItem<Laws, PackedRows>{{in, laws_}, choice}, sums, ranks);
  }
  void shown_surfaces(const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                      ShownContact* shown) const override {
    for_each(Serial{}, n, ShownSurfaceItem<Laws>{in, laws_, loads, shown});
  }

 private:
  static constexpr int kFreedoms = kStepFreedoms<LawOf<Laws>>;
  // Evaluating a contact twice is faster than storing its result for laws without `kNeedsMotion`.
  static constexpr bool kPaired = LawOf<Laws>::kNeedsMotion;
  using StepRows = std::conditional_t<kPaired, PairedRows<Laws>, PackedRows>;
  // Views for an explicit step.
  ContactViews<StepRows> over_step(const ContactViews<PackedRows>& in, PairList& pairs) {
    if constexpr (kPaired) {
      sweep_.begin(pairs);
      return paired_views(in, sweep_);
    } else {
      return in;
    }
  }

  Laws laws_;
  std::conditional_t<kPaired, PairSweep<Laws>, std::monostate> sweep_;
};

// Owns the table of laws that the kernels refer to.
template <class Law>
class CpuTableKernels : public CpuContactKernels<LawTable<Law>> {
 public:
  CpuTableKernels(std::vector<Law> table, int materials)
      : CpuContactKernels<LawTable<Law>>({table.data(), materials}), table_(std::move(table)) {}

 private:
  std::vector<Law> table_;
};

template <class Law>
std::unique_ptr<ContactKernels> cpu_kernels(const std::vector<Law>& laws, int materials) {
  if (laws.size() == 1) return std::make_unique<CpuContactKernels<OneLaw<Law>>>(OneLaw<Law>{laws[0]});
  return std::make_unique<CpuTableKernels<Law>>(laws, materials);
}

}  // namespace scree
