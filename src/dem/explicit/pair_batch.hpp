// Batches of contacts in the serial backend's explicit steps: the compiler vectorizes the loop over a batch
// where the law allows it.
#pragma once

#include <cstdint>

#include "dem/explicit/packed_force.hpp"

namespace scree {

// Loads on both sides of contacts, number by number. gcc stores these as whole vectors; it would store the
// components of one record lane by lane.
template <int kKinds, Index kSize>
class BatchLoads {
 public:
  using Packed = PackedForce<kKinds>;
  static constexpr Index kGroup = 4;  // contacts that are stored together

  void put(Index k, const ContactLoadOf<Real, Vec3>& load, const TangentialLosses& losses) {
    force_.put(k, load.force), loss_power_[k] = load.loss;
    torque_i_.put(k, load.torque_i), torque_j_.put(k, load.torque_j);
    const auto total = Packed::Total::of(load, losses);
    for (int n = 0; n < kKinds; ++n) losses_[n][k] = total.losses.of[n];
  }
  // Stores the loads of the contacts k ... k + 3; k: a multiple of 4.
  void store(Index k, Packed* const (&of_i)[kGroup], Packed* const (&of_j)[kGroup]) const {
    Real4 force[kGroup] = {force_.at(0, k), force_.at(1, k), force_.at(2, k), four_of(loss_power_, k)};
    Real4 torque_i[kGroup] = {torque_i_.at(0, k), torque_i_.at(1, k), torque_i_.at(2, k), losses_at(0, k)};
    Real4 torque_j[kGroup] = {torque_j_.at(0, k), torque_j_.at(1, k), torque_j_.at(2, k), losses_at(0, k)};
    transpose(force), transpose(torque_i), transpose(torque_j);
    for (Index n = 0; n < kGroup; ++n) {
      of_i[n]->part[0] = force[n], of_i[n]->part[1] = torque_i[n];
      // As in `ContactLoadOf::exchanged`.
      of_j[n]->part[0] = __builtin_shufflevector(Real4{} - force[n], force[n], 0, 1, 2, 7);
      of_j[n]->part[1] = torque_j[n];
    }
    if constexpr (Packed::kParts > 2) {
      Real4 more[kGroup] = {losses_at(1, k), losses_at(2, k), losses_at(3, k), losses_at(4, k)};
      transpose(more);
      for (Index n = 0; n < kGroup; ++n) of_i[n]->part[2] = of_j[n]->part[2] = more[n];
    }
  }

 private:
  Real4 losses_at(int n, Index k) const { return n < kKinds ? four_of(losses_[n], k) : Real4{}; }

  struct Vectors {
    alignas(64) Real of[3][kSize]{};

    void put(Index k, Vec3 a) { of[0][k] = a.x, of[1][k] = a.y, of[2][k] = a.z; }
    Real4 at(int axis, Index k) const { return four_of(of[axis], k); }
  };
  Vectors force_, torque_i_, torque_j_;
  alignas(64) Real loss_power_[kSize]{}, losses_[kKinds > 0 ? kKinds : 1][kSize]{};
};

// Pairs gathered from their rows, with their history and results. For laws with `kNeedsMotion`.
template <class Laws>
class PairBatch {
 public:
  static constexpr Index kCapacity = 64;  // pairs
  static constexpr Index kLanes = 8;      // pairs of a vector instruction, at most
  static constexpr Index kSize = kCapacity + kLanes;
  using Law = LawOf<Laws>;
  using Loads = BatchLoads<kLossKindsOf<Law>, kSize>;
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
  // Whether the load on j is valid; else the contact must be evaluated from the side of j.
  bool is_mirrored(Index k) const { return is_mirrored_[k]; }
  const Loads& loads() const { return loads_; }
  // Previous history of the k-th pair, as i has it, with the number of the new step.
  const Vec4* old_records(Index k) const { return records_ + first_record(k); }
  // Stores the new history of the pairs k ... k + 3; k: a multiple of 4.
  void store_records(Index k, Vec4* const (&records)[Loads::kGroup]) const {
    for (Index r = 0; r < kRecords; ++r) {
      const auto& numbers = new_records_[r];
      Real4 rows[Loads::kGroup] = {four_of(numbers[0], k), four_of(numbers[1], k), four_of(numbers[2], k),
                                   four_of(numbers[3], k)};
      transpose(rows);
      for (Index n = 0; n < Loads::kGroup; ++n) records[n][r] = unpacked(rows[n]);
    }
  }

 private:
  const Law& law_of(const Laws& of, Index k) const { return of.get(i_.material[k], j_.material[k]); }

  // The compiler leaves out parts of a law that are compile-time constants: a dashpot beside the slider,
  // which most runs do not have, and viscous rolling.
  [[gnu::noinline, gnu::flatten]] void evaluate_by(const Law& of, Index begin, Index end, Real h) {
    if constexpr (requires { of.rolling.rolling.viscous; }) {
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
      const auto old = history_of(k);
      if constexpr (kHasRange<Law>) {
        closed_[k] = law.closed(pair, old);
        acts_[k] = closed_[k] || Law::breaks(old);
        if (!acts_[k]) continue;
      }
      const auto outcome = law.respond(pair, old);
      loads_.put(k, outcome.load, outcome.losses());
      put_history(k, outcome.history);
    }
#pragma GCC ivdep
    for (Index k = begin; k < end; ++k)
      is_mirrored_[k] = Law::is_mirrored(Law::read_history([&](int n) { return new_number(n)[k]; }));
  }

  // As `HistoryViews::read` and `write`, in the form that gcc vectorizes: without branches around reads, and
  // with all four numbers of a record read.
  auto history_of(Index k) const {
    const Vec4* const records = old_records(k);
    return Law::read_history([&](int n) { return number_of(records, n); });
  }
  template <class History>
  void put_history(Index k, const History& history) {
    for (Index r = 0; r < kRecords; ++r) new_records_[r][3][k] = old_records(k)[r].w;
    Law::write_history(history, [&](int n, Real value) { new_number(n)[k] = value; });
  }
  // As `number_of()`; laws of one record have the first three numbers only.
  Real* new_number(int n) {
    if constexpr (kRecords > 2)
      if (n >= 7) return new_records_[2][n - 7];
    constexpr Index kSecond = kRecords > 1 ? 1 : 0;
    return n < 3 ? new_records_[0][n] : new_records_[kSecond][n - 3];
  }

  struct Items {
    alignas(64) Vec4 position[kSize]{}, velocity[kSize]{}, spin[kSize]{};
    int material[kSize]{};

    void put(Index k, const OverExplicitStep::Self& self) {
      position[k] = self.p, velocity[k] = self.u, spin[k] = self.spin, material[k] = self.material;
    }
  };

  Items i_, j_;
  alignas(64) Vec4 records_[kSize * kRecords]{};
  alignas(64) Real new_records_[kRecords][4][kSize]{};  // x, y, z, w
  alignas(64) std::int64_t is_mirrored_[kSize]{};       // as long as a number: gcc vectorizes no other
  Loads loads_;
  bool closed_[kCapacity], acts_[kCapacity];  // for laws with `kHasRange`
};

}  // namespace scree
