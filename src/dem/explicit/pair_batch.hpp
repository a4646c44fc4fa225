// Batches of contacts in the serial backend's explicit steps: the compiler vectorizes the loop over a batch
// where the law allows it.
#pragma once

#include "dem/explicit/packed_force.hpp"

namespace scree {

// Pairs gathered from their rows, with their history and results. For laws with `kNeedsMotion`.
template <class Laws>
class PairBatch {
 public:
  static constexpr Index kCapacity = 64;  // pairs
  static constexpr Index kLanes = 8;      // pairs of a vector instruction, at most
  static constexpr Index kSize = kCapacity + kLanes;
  using Law = LawOf<Laws>;
  using Packed = PackedForce<kLossKindsOf<Law>>;
  static constexpr Index kRecords = records_of(Law::kHistory);
  static constexpr std::int64_t first_record(Index slot) { return std::int64_t{slot} * kRecords; }

  // Stores the k-th pair and its history: that of zeros if the last accepted step, of this number, did not
  // write the records.
  void put(Index k, const OverExplicitStep::Self& i, const OverExplicitStep::Self& j, const Vec4* records,
           Real step) {
    i_.put(k, i), j_.put(k, j);
    const bool lasts = records->w == step;
    Vec4* const own = records_ + first_record(k);
    for (Index r = 0; r < kRecords; ++r) own[r] = lasts ? records[r] : Vec4{};
    own->w = step + 1;
  }

  // Evaluates the first n pairs over a step of h [s], neighbours of one law together.
  void evaluate(Index n, const Laws& of, Real h) {
    for (Index begin = 0, end = 1; begin < n; begin = end++) {
      const Law& law = law_of(of, begin);
      while (end < n && &law_of(of, end) == &law) ++end;
      evaluate_by(law, begin, end, h);
    }
  }

  // Results of the k-th pair: whether the contact is closed at the end of the step, and whether it has a
  // load; a JKR contact that breaks has losses only.
  bool closed(Index k) const { return !kHasRange<Law> || closed_[k]; }
  bool acts(Index k) const { return !kHasRange<Law> || acts_[k]; }
  // Whether of_j() is valid; else the contact must be evaluated from the side of j.
  bool is_mirrored(Index k) const {
    return Law::is_mirrored(Law::read_history([&](int n) { return number_of(records(k), n); }));
  }
  // Previous and new history of the k-th pair, as i has it, both with the number of the new step.
  const Vec4* old_records(Index k) const { return records_ + first_record(k); }
  const Vec4* records(Index k) const { return new_records_ + first_record(k); }
  // Loads on one side of the pairs, in parts that the compiler stores as whole vectors.
  struct Side {
    alignas(64) Vec4 part[Packed::kParts][kSize];

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
  const Law& law_of(const Laws& of, Index k) const { return of.get(i_.material[k], j_.material[k]); }

  // The compiler leaves out parts of a law that are compile-time constants: a dashpot beside the slider,
  // which most runs do not have, and viscous rolling.
  [[gnu::noinline, gnu::flatten]] void evaluate_by(const Law& of, Index begin, Index end, Real h) {
    if constexpr (Law::Rolling::acts) {
      if (of.rolling.rolling.viscous.damping == 0 && of.rolling.rolling.spring.friction > 0) {
        Law law = of;
        law.rolling.rolling.viscous.damping = 0;
        return evaluate_pairs(law, begin, end, h);
      }
    } else if constexpr (Law::Tangential::acts) {
      if (of.tangential.damping_ratio == 0) {
        Law law = of;
        law.tangential.damping_ratio = 0;
        return evaluate_pairs(law, begin, end, h);
      }
    }
    evaluate_pairs(of, begin, end, h);
  }

  void evaluate_pairs(const Law& of, Index begin, Index end, Real h) {
    const Law law = of;
    // Whole vectors; what the last one has beyond the end is not used, or evaluated again with its own law.
    if constexpr (!kHasRange<Law>) end = begin + (end - begin + kLanes - 1) / kLanes * kLanes;
#pragma GCC ivdep
    for (Index k = begin; k < end; ++k) {
      const Vec4 p = i_.position[k], u = i_.velocity[k], v = i_.spin[k];
      const Vec4 q = j_.position[k], w = j_.velocity[k], s = j_.spin[k];
      const PairState state = AtInstant::pair(p, u, q, w);
      // Not by a function that returns the pair, which gcc would copy as a whole.
      const MovingPair pair{state, OverExplicitStep{h}.motion(state, OverExplicitStep::partner(p, v),
                                                              OverExplicitStep::partner(q, s))};
      const ContactHistory old = history_of(k);
      if constexpr (kHasRange<Law>) {
        closed_[k] = law.closed(pair, old);
        acts_[k] = closed_[k] || Law::breaks(old);
        if (!acts_[k]) continue;
      }
      const auto outcome = law.load(pair, old);
      of_i_.put(k, Packed::Total::of(outcome.load, outcome.losses()));
      of_j_.put(k, Packed::Total::of(outcome.load.exchanged(), outcome.losses()));
      put_history(k, outcome.history);
    }
  }

  // As `HistoryViews::read` and `write`, in the form that gcc vectorizes: without branches around reads, and
  // with all four numbers of a record read and written.
  ContactHistory history_of(Index k) const {
    const Vec4* const records = old_records(k);
    return Law::read_history([&](int n) { return number_of(records, n); });
  }
  void put_history(Index k, const ContactHistory& history) {
    Vec4* const records = new_records_ + first_record(k);
    for (Index r = 0; r < kRecords; ++r) records[r].w = old_records(k)[r].w;
    Law::write_history(history, [&](int n, Real value) { number_of(records, n) = value; });
  }

  struct Items {
    alignas(64) Vec4 position[kSize]{}, velocity[kSize]{}, spin[kSize]{};
    int material[kSize]{};

    void put(Index k, const OverExplicitStep::Self& self) {
      position[k] = self.p, velocity[k] = self.u, spin[k] = self.spin, material[k] = self.material;
    }
  };

  Items i_, j_;
  alignas(64) Vec4 records_[kSize * kRecords]{}, new_records_[kSize * kRecords]{};
  Side of_i_, of_j_;
  bool closed_[kCapacity], acts_[kCapacity];  // for laws with `kHasRange`
};

}  // namespace scree
