// Batches of contacts in the serial backend's explicit steps: the compiler vectorizes the loop over a batch
// where the law allows it.
#pragma once

#include "dem/explicit/packed_force.hpp"

namespace scree {

// A single law for all contacts, whose slider may have a dashpot.
template <class Laws>
inline constexpr bool kMayHaveDashpot = false;
template <class Law>
requires Law::Tangential::acts inline constexpr bool kMayHaveDashpot<OneLaw<Law>> = true;

// Pairs gathered from their rows, with their history and results. For laws with `kNeedsMotion`.
template <class Laws>
class PairBatch {
 public:
  static constexpr Index kCapacity = 64;  // pairs
  using Law = LawOf<Laws>;
  using Packed = PackedForce<kLossKindsOf<Law>>;
  static constexpr Index kRecords = records_of(Law::kHistory);
  static constexpr std::int64_t first_record(Index slot) { return std::int64_t{slot} * kRecords; }

  // Stores the k-th pair and its history records.
  void put(Index k, const OverExplicitStep::Self& i, const OverExplicitStep::Self& j, const Vec4* records) {
    i_.put(k, i), j_.put(k, j);
    for (Index r = 0; r < kRecords; ++r) records_[first_record(k) + r] = records[r];
  }

  // Evaluates the first n pairs over a step. history: for the number of that step.
  [[gnu::noinline, gnu::flatten]] void evaluate(Index n, const Laws& of, const OverExplicitStep& kinematics,
                                                const HistoryViews& history) {
    if constexpr (kMayHaveDashpot<Laws>) {
      if (of.law.tangential.damping_ratio == 0) {
        // A compile-time constant lets the compiler leave out the dashpot, which most runs do not have.
        Laws without_dashpot = of;
        without_dashpot.law.tangential.damping_ratio = 0;
        return evaluate_by(without_dashpot, n, kinematics, history);
      }
    }
    evaluate_by(of, n, kinematics, history);
  }

  // Results of the k-th pair: whether the contact is closed at the end of the step, and whether it has a
  // load; a JKR contact that breaks has losses only.
  bool closed(Index k) const { return !kHasRange<Law> || closed_[k]; }
  bool acts(Index k) const { return !kHasRange<Law> || acts_[k]; }
  // Whether of_j() is valid; else the contact must be evaluated from the side of j.
  bool is_mirrored(Index k) const {
    return Law::is_mirrored(Law::read_history([&](int n) { return number_of(records(k), n); }));
  }
  // Previous and new history of the k-th pair, as i has it.
  const Vec4* old_records(Index k) const { return records_ + first_record(k); }
  const Vec4* records(Index k) const { return new_records_ + first_record(k); }
  // Loads on one side of the pairs, in parts that the compiler stores as whole vectors.
  struct Side {
    alignas(64) Vec4 part[Packed::kParts][kCapacity];

    void put(Index k, const typename Packed::Total& total) {
      for (int n = 0; n < Packed::kParts; ++n) part[n][k] = Packed::part_of(total, n);
    }
    Packed packed(Index k) const {
      Packed out;
      for (int n = 0; n < Packed::kParts; ++n) out.part[n] = scree::packed(part[n][k]);
      return out;
    }
  };
  const Side& of_i() const { return of_i_; }
  const Side& of_j() const { return of_j_; }

 private:
  void evaluate_by(const Laws& of, Index n, const OverExplicitStep& kinematics, const HistoryViews& views) {
    const Laws laws = of;
    const HistoryViews history = views;
    const Real h = kinematics.h;
#pragma GCC ivdep
    for (Index k = 0; k < n; ++k) {
      const Vec4 p = i_.position[k], u = i_.velocity[k], v = i_.spin[k];
      const Vec4 q = j_.position[k], w = j_.velocity[k], s = j_.spin[k];
      const PairState state = AtInstant::pair(p, u, q, w);
      // Not by a function that returns the pair, which gcc would copy as a whole.
      const MovingPair pair{state, OverExplicitStep{h}.motion(state, OverExplicitStep::partner(p, v),
                                                              OverExplicitStep::partner(q, s))};
      const auto old = history.template read<Law>(records_, k);
      const Law& law = laws.get(i_.material[k], j_.material[k]);
      if constexpr (kHasRange<Law>) {
        closed_[k] = law.closed(pair, old);
        acts_[k] = closed_[k] || Law::breaks(old);
        if (!acts_[k]) continue;
      }
      const auto outcome = law.load(pair, old);
      of_i_.put(k, Packed::Total::of(outcome.load, outcome.losses()));
      of_j_.put(k, Packed::Total::of(outcome.load.exchanged(), outcome.losses()));
      history.template write<Law>(new_records_, k, outcome.history);
    }
  }

  struct Items {
    alignas(64) Vec4 position[kCapacity], velocity[kCapacity], spin[kCapacity];
    int material[kCapacity];

    void put(Index k, const OverExplicitStep::Self& self) {
      position[k] = self.p, velocity[k] = self.u, spin[k] = self.spin, material[k] = self.material;
    }
  };

  Items i_, j_;
  alignas(64) Vec4 records_[kCapacity * kRecords], new_records_[kCapacity * kRecords];
  Side of_i_, of_j_;
  bool closed_[kCapacity], acts_[kCapacity];  // for laws with `kHasRange`
};

}  // namespace scree
