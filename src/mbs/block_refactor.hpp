// KLU's refactorization of a small matrix, eight rows at once.
#pragma once

#include <klu.h>

#include <cstdint>
#include <vector>

#include "mbs/kkt_matrix.hpp"

namespace scree {

// Computes the factors of a matrix with the pivots of given ones, in place, as klu_refactor does: every entry
// is the same sum in the same order, so that its bits are the same. KLU adds one entry at a time. Here a
// column of L is one of blocks of eight consecutive rows, whose other entries are zeros; these change no
// entry, as none is -0. Where many rows of a block are in use this takes seven tenths of the time.
class BlockRefactor {
 public:
  // Takes the pivots and the pattern of these factors of `values`, and repeats the factorization. It stays
  // without a plan where the matrix has several blocks of KLU's, many rows, scaled rows or thin columns, or
  // where a bit differs: another compiler has made KLU.
  void plan(const SparsePattern& pattern, const double* values, const klu_symbolic& symbolic,
            klu_numeric& numeric);
  void forget() { columns_.clear(); }
  bool has_plan() const { return !columns_.empty(); }

  // Writes the factors of these values. False where a pivot is zero; the factors are then incomplete.
  bool refactor(const double* values, klu_numeric& numeric);

 private:
  static constexpr int kWidth = 8;
  using Block = double __attribute__((vector_size(kWidth * sizeof(double))));
  using Mask = long long __attribute__((vector_size(kWidth * sizeof(double))));

  // block `target` of the matrix -= block `factor` of L times entry `scale` of the matrix
  struct Update {
    std::uint16_t target, factor, scale;
  };
  struct Copy {
    int from, to;
  };
  // A column's last update, and its blocks of L.
  struct Column {
    int updates_end, first_block, end_block;
  };

  void plan_columns(const klu_symbolic& symbolic, const klu_numeric& numeric);
  void plan_updates(const klu_numeric& numeric);
  std::vector<double> numbers(const klu_numeric& numeric) const;

  int row_blocks_ = 0;  // of a column
  std::vector<Column> columns_;
  std::vector<Update> updates_;
  std::vector<Copy> entries_;             // from the values to the matrix
  std::vector<Copy> upper_, lower_;       // from the matrix, and from the blocks of L, to KLU's factors
  std::vector<std::uint16_t> of_matrix_;  // the block of the matrix that a block of L is made of
  std::vector<Mask> mask_;                // of the entries of L in a block
  std::vector<Block> matrix_, l_;         // the matrix by columns, and the blocks of L
};

}  // namespace scree
