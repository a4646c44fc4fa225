// LU factors of a sparse matrix by KLU that reuse their pivots from matrix to matrix. KLU: Davis, Palamadai
// Natarajan, ACM Trans. Math. Softw. 37 (2010), Algorithm 907.
#pragma once

#include <klu.h>

#include <memory>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "mbs/block_refactor.hpp"
#include "mbs/kkt_matrix.hpp"

namespace scree {

// The factors of every matrix are bitwise those that klu_factor computes, whatever was factored before.
// klu_refactor is four to six times as fast and does the same arithmetic with the pivots of an earlier
// matrix; its factors are used only where klu_factor would choose these pivots again. Reruns and restarts
// are therefore bitwise identical.
class KluFactors {
 public:
  KluFactors() { klu_defaults(&common_); }
  KluFactors(const KluFactors&) = delete;
  KluFactors& operator=(const KluFactors&) = delete;

  enum class Result { factored, refactored, singular, out_of_memory };

  // KLU's ordering, scaling and pivot tolerance are set here, before analyze().
  klu_common& options() { return common_; }

  // Orders the rows and columns of matrices with this pattern; false if they cannot be ordered. Unless an
  // ordering is given, it is KLU's AMD ordering where the pivots can be on the diagonal, else COLAMD. AMD
  // assumes pivots on the diagonal: where a weak diagonal comes before all other entries of its row, the
  // pivot is taken from elsewhere and the factors fill with entries that the ordering has not counted.
  // options() must not change afterwards.
  bool analyze(const SparsePattern& pattern, bool ordering_given = false);
  // values: [entries of the pattern]. After `singular` or `out_of_memory` there are no factors.
  Result factor(std::span<const Real> values);
  // Solves in place, with the matrix or its transpose; vector: [rows]. Requires factors. False where KLU
  // fails.
  bool solve(std::span<Real> vector);
  bool solve_transposed(std::span<Real> vector);
  // Whether the next matrix is refactored in blocks of rows, after several with the same pivots.
  bool uses_blocks() const { return blocks_.has_plan(); }

 private:
  struct Free {
    klu_common* common;
    void operator()(klu_symbolic* symbolic) const { klu_free_symbolic(&symbolic, common); }
    void operator()(klu_numeric* numeric) const { klu_free_numeric(&numeric, common); }
  };

  bool order();
  bool needs_other_pivots() const;
  Result factor_anew(double* values);
  bool refactor(double* values);
  void record_pivots();
  void find_diagonals();
  bool pivots_unchanged() const;

  klu_common common_;
  SparsePattern pattern_;
  std::unique_ptr<klu_symbolic, Free> symbolic_{nullptr, Free{&common_}};
  std::unique_ptr<klu_numeric, Free> numeric_{nullptr, Free{&common_}};
  std::vector<int> diagonal_;  // for every column, the position among the pivots of the row that KLU prefers
  // Entries of L, counted consecutively, as large as their pivot when it was chosen.
  std::vector<std::size_t> ties_;
  BlockRefactor blocks_;
  int refactored_ = 0;  // matrices with the present pivots
};

}  // namespace scree
