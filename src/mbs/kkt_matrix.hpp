// The saddle-point matrix [A, Phi_q^T; Phi_q, -C] in compressed rows, filled through slots found once.
#pragma once

#include <span>
#include <vector>

#include "mbs/mechanical_system.hpp"

namespace scree {

// Compressed rows: the columns of row i, in increasing order, are column[row_start[i]] ...
// column[row_start[i+1]-1].
struct SparsePattern {
  std::vector<int> row_start;  // [rows + 1]
  std::vector<int> column;     // [entries]
  // From this row on diagonal entries are 0 or nearly so until others are eliminated; -1: not known.
  int first_weak_diagonal = -1;

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
};

// A = mass M T^-1 + stiffness (Phi_q^T lambda - Q)_q + damping (-Q_v T^-1) + inertia_stiffness (M a)_q, T =
// 1 at the acceleration level. The upper right block is Phi_q^T + reaction (-Q_lambda).
struct KktWeights {
  Real mass = 1, stiffness = 0, damping = 0, inertia_stiffness = 0, tangent = 0, reaction = 0;
};

class KktMatrix {
 public:
  // The terms must have been evaluated once, so that their patterns are known. knows_diagonals: whether the
  // pattern marks weak diagonal entries.
  KktMatrix(const SystemTerms& terms, const SystemDerivatives& derivatives, int coordinates, int constraints,
            bool knows_diagonals);

  const SparsePattern& pattern() const { return pattern_; }
  // compliance: C's diagonal [constraints], or empty: C = 0. values: [entries of the pattern]. Cost is linear
  // in the number of contributions.
  void assemble(const SystemTerms& terms, const SystemDerivatives& derivatives, const KktWeights& weights,
                std::span<const Real> compliance, std::span<Real> values) const;

 private:
  std::vector<int> slots_of(const SparseTerm& term, int row_offset, bool transposed) const;
  int slot_of(int row, int column) const;

  SparsePattern pattern_;
  std::vector<int> mass_, stiffness_, damping_, inertia_stiffness_, tangent_inertia_, jacobian_,
      jacobian_transposed_, reaction_;
  std::vector<int> diagonal_;  // of the constraints' rows
};

}  // namespace scree
