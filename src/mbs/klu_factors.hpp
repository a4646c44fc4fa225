// LU factors of a sparse matrix by KLU that keep their pivots from matrix to matrix. KLU: Davis, Palamadai
// Natarajan, ACM Trans. Math. Softw. 37 (2010), Algorithm 907.
#pragma once

#include <klu.h>

#include <memory>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "mbs/kkt_matrix.hpp"

namespace scree {

// The factors of every matrix are, bit for bit, those that klu_factor computes of it, whatever was factored
// before: klu_refactor, four to six times as fast, does the same arithmetic with the pivots of an earlier
// matrix, and its factors are taken where klu_factor would choose these pivots again. So a rerun and a
// restart have the same bits.
class KluFactors {
 public:
  KluFactors() { klu_defaults(&common_); }
  KluFactors(const KluFactors&) = delete;
  KluFactors& operator=(const KluFactors&) = delete;

  enum class Result { factored, refactored, singular, out_of_memory };

  // KLU's ordering, scaling and pivot tolerance are set here, before analyze().
  klu_common& options() { return common_; }

  // Orders the rows and columns of matrices with this pattern; false if they cannot be ordered. The order is
  // KLU's by AMD where that is not given otherwise and its pivots can be on the diagonal, else that by
  // COLAMD: AMD counts on the diagonal, and where its order has a weak one before all else in its row, pivots
  // are taken from elsewhere and the factors fill with entries that nothing has counted. options() stay as
  // they are from here on.
  bool analyze(const SparsePattern& pattern, bool ordering_given = false);
  // values: [entries of the pattern]. After `singular` or `out_of_memory` there are no factors.
  Result factor(std::span<const Real> values);
  // Solves in place, with the matrix or its transpose; vector: [rows]. Needs factors. False where KLU fails.
  bool solve(std::span<Real> vector);
  bool solve_transposed(std::span<Real> vector);

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
  void remember_pivots();
  void find_diagonals();
  bool pivots_stay() const;

  klu_common common_;
  SparsePattern pattern_;
  std::unique_ptr<klu_symbolic, Free> symbolic_{nullptr, Free{&common_}};
  std::unique_ptr<klu_numeric, Free> numeric_{nullptr, Free{&common_}};
  std::vector<int> diagonal_;  // of every column, the place among the pivots of the row that KLU prefers
  std::vector<std::size_t>
      ties_;  // entries of L, counted through, as large as their pivot when it was chosen
};

}  // namespace scree
