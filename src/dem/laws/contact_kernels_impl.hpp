// Contact stages of one law; included where they are instantiated.
#pragma once

#include <stdexcept>
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

  int history() const override { return ContactWalk<Laws, PackedRows>::Law::kHistory; }
  bool rolls() const override { return LawOf<Laws>::Rolling::acts; }
  void forces(const ContactViews<PackedRows>& in, Vec3 gravity, Index n, Vec3* force, Real* loss_power,
              Vec3* angular_acceleration) const override {
    for_each(
        Serial{}, n,
        ContactForceItem<Laws, PackedRows>{{in, laws_}, gravity, force, loss_power, angular_acceleration});
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
      refuse_implicit();
  }
  void body_loads(const ContactViews<PackedRows>& in, Index n, const BodyQuery& query,
                  BodyLoad* out) const override {
    if constexpr (LawOf<Laws>::kNeedsMotion)
      if (query.h > 0) {
        using Item = BodyLoadItem<Laws, PackedRows, OverExplicitStep>;
        return for_each(Serial{}, n, Item{{in, laws_, {query.h}}, query.arm, out});
      }
    for_each(Serial{}, n,
             BodyLoadItem<Laws, PackedRows, InstantKinematics<Laws>>{{in, laws_}, query.arm, out});
  }
  void body_steps(const ContactViews<PackedRows>& in, Index n, const FrictionStart& start, const Vec3* arm,
                  BodyStep* out, const ShapeContactsTo& to) const override {
    if constexpr (kFreedoms == 6)
      for_each(Serial{}, n, BodyFrictionItem<Laws, PackedRows>{{in, laws_, {start}}, arm, out, to});
    else if constexpr (kFreedoms == 3)
      for_each(Serial{}, n, BodyStepItem<Laws, PackedRows>{{in, laws_, {start.step}}, arm, out, to});
    else
      refuse_implicit();
  }
  void wall_sums(const ContactViews<PackedRows>& in, Index n, const WallChoice& choice, const Ranks& ranks,
                 Real (&sums)[kWallTerms]) const override {
    reproducible_sums(n, WallContactItem<Laws, PackedRows>{{in, laws_}, choice}, sums, ranks);
  }
  void energies(const ContactViews<PackedRows>& in, Index n, const EnergyOutputs& out) const override {
    for_each(Serial{}, n, ContactEnergyItem<Laws, PackedRows>{{in, laws_}, out});
  }
  void output(const ContactViews<PackedRows>& in, const OutputRequest& request) const override {
    with_contact_output(request, ContactWalk<Laws, PackedRows>{in, laws_},
                        [&](const auto& item) { for_each(Serial{}, request.n, item); });
  }
  void shown_surfaces(const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                      ShownContact* shown) const override {
    for_each(Serial{}, n, ShownSurfaceItem<Laws>{in, laws_, loads, shown});
  }
  void contact_lines(const ContactViews<PackedRows>& in, Index n, const LineRequest& request) const override {
    for_each(Serial{}, n, ContactLineItem<Laws, PackedRows>{{in, laws_}, request});
  }
  void system(const ContactViews<PackedRows>& in, Index n, const StepSystem& r) const override {
    if constexpr (kFreedoms == 6)
      for_each(Serial{}, n,
               FrictionSystemItem<Laws, PackedRows>{{in, laws_, {r.start}},
                                                    r.gravity,
                                                    r.weights,
                                                    r.forces,
                                                    r.torques,
                                                    r.friction_matrix,
                                                    r.phase_squared});
    else if constexpr (kFreedoms == 3)
      for_each(Serial{}, n,
               ContactSystemItem<Laws, PackedRows>{
                   {in, laws_, {r.start.step}}, r.gravity, r.weights, r.forces, r.matrix});
    else
      refuse_implicit();
  }
  void step_losses(const ContactViews<PackedRows>& in, Index n, const FrictionStart& start,
                   const FrictionLossOutputs& to) const override {
    if constexpr (kFreedoms == 6)
      for_each(Serial{}, n, FrictionLossesItem<Laws, PackedRows>{{in, laws_, {start}}, to});
    else if constexpr (kFreedoms == 3)
      for_each(Serial{}, n,
               ContactLossesItem<Laws, PackedRows>{{in, laws_, {start.step}}, to.contact, to.integrator});
    else
      refuse_implicit();
  }
  void store_lagged_limits(const ContactViews<PackedRows>& in, Index n, const FrictionStart& start,
                           const LaggedLimits& to) const override {
    if constexpr (kFreedoms == 6)
      for_each(Serial{}, n, LaggedLimitItem<Laws, PackedRows>{{in, laws_, {start}}, to});
    else
      refuse_implicit();
  }
  void escaped_particles(const ContactViews<PackedRows>& in, const OpenBox& box, Index n,
                         EscapedParticle* escaped_particles) const override {
    for_each(Serial{}, n, EscapeEnergyItem<Laws, PackedRows>{{in, laws_}, box, escaped_particles});
  }
  void departures(const ContactViews<PackedRows>& in, Vec3 gravity, const OpenBox& box, Index n,
                  const StartViews& start) const override {
    for_each(Serial{}, n, EscapedContactsItem<Laws, PackedRows>{{in, laws_}, gravity, box, start});
  }

 private:
  static constexpr int kFreedoms = kStepFreedoms<LawOf<Laws>>;
  [[noreturn]] static void refuse_implicit() {
    throw std::logic_error("CpuContactKernels: the law has no such implicit steps");
  }

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
