// A sparse matrix given as a sequence of contributions whose positions are the same in every evaluation.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"

namespace scree {

// Filled by begin() and add() in a fixed order. The first filling records the positions of the entries,
// later ones replace the values only: pattern and values come from the same code and cannot disagree.
// Entries at equal positions add up.
class SparseTerm {
 public:
  void begin() {
    recording_ = values_.empty();
    cursor_ = 0;
  }
  // row, column: from 0; an entry with a negative one (the ground, a structural zero) is omitted.
  void add(int row, int column, Real value) {
    if (row < 0 || column < 0) return;
    if (recording_)
      record(row, column, value);
    else
      values_[cursor_++] = value;
  }

  // Adds value(i, j) at all pairs (coordinate[i], coordinate[j]), row by row; no coordinate is negative.
  template <class Value>
  void add_block(std::span<const int> coordinate, const Value& value) {
    const std::size_t n = coordinate.size();
    if (recording_) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) record(coordinate[i], coordinate[j], value(i, j));
      return;
    }
    Real* out = values_.data() + cursor_;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) *out++ = value(i, j);
    cursor_ += n * n;
  }

  // The values of the next n entries, to be written; null in the first filling, which takes add() alone.
  Real* next(std::size_t n) {
    if (recording_) return nullptr;
    Real* out = values_.data() + cursor_;
    cursor_ += n;
    return out;
  }

  std::size_t size() const { return values_.size(); }
  int row(std::size_t i) const { return rows_[i]; }
  int column(std::size_t i) const { return columns_[i]; }
  Real value(std::size_t i) const { return values_[i]; }

  // y += scale A x
  void multiply(Real scale, const std::vector<Real>& x, std::vector<Real>& y) const {
    for (std::size_t i = 0; i < size(); ++i) {
      y[static_cast<std::size_t>(rows_[i])] += scale * values_[i] * x[static_cast<std::size_t>(columns_[i])];
    }
  }
  // y += scale A^T x
  void multiply_transposed(Real scale, const std::vector<Real>& x, std::vector<Real>& y) const {
    for (std::size_t i = 0; i < size(); ++i) {
      y[static_cast<std::size_t>(columns_[i])] += scale * values_[i] * x[static_cast<std::size_t>(rows_[i])];
    }
  }

 private:
  // Not inlined, so that add() is inlined into the loops of every step.
  [[gnu::noinline]] void record(int row, int column, Real value) {
    rows_.push_back(row);
    columns_.push_back(column);
    values_.push_back(value);
  }

  std::vector<int> rows_, columns_;
  std::vector<Real> values_;
  std::size_t cursor_ = 0;
  bool recording_ = true;
};

}  // namespace scree
