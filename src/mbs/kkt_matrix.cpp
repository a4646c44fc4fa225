#include "mbs/kkt_matrix.hpp"

#include <algorithm>

namespace scree {

namespace {

using Columns = std::vector<std::vector<int>>;  // of every row

void mark(const SparseTerm& term, Columns& columns) {
  for (std::size_t i = 0; i < term.size(); ++i) {
    columns[static_cast<std::size_t>(term.row(i))].push_back(term.column(i));
  }
}

SparsePattern compress(Columns& columns) {
  SparsePattern pattern;
  pattern.row_start.push_back(0);
  for (std::vector<int>& row : columns) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.row_start.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

void scatter(const SparseTerm& term, const std::vector<int>& slots, Real weight, std::span<Real> values) {
  if (weight == 0) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    values[static_cast<std::size_t>(slots[i])] += weight * term.value(i);
  }
}

}  // namespace

KktMatrix::KktMatrix(const SystemTerms& terms, const SystemDerivatives& derivatives, int coordinates,
                     int constraints, bool knows_diagonals) {
  Columns columns(static_cast<std::size_t>(coordinates + constraints));
  for (const SparseTerm* term : {&terms.mass, &derivatives.stiffness, &derivatives.damping,
                                 &derivatives.inertia_stiffness, &derivatives.tangent_inertia}) {
    mark(*term, columns);
  }
  const SparseTerm& jacobian = terms.constraint_jacobian;
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    const int row = coordinates + jacobian.row(i), column = jacobian.column(i);
    columns[static_cast<std::size_t>(row)].push_back(column);
    columns[static_cast<std::size_t>(column)].push_back(row);
  }
  for (std::size_t i = 0; i < derivatives.reaction.size(); ++i)
    columns[static_cast<std::size_t>(derivatives.reaction.column(i))].push_back(coordinates +
                                                                                derivatives.reaction.row(i));
  // PETSc's own LU requires every diagonal entry to be present, also zeros.
  for (int row = 0; row < coordinates + constraints; ++row) {
    columns[static_cast<std::size_t>(row)].push_back(row);
  }
  pattern_ = compress(columns);
  if (knows_diagonals) pattern_.first_weak_diagonal = coordinates;
  mass_ = slots_of(terms.mass, 0, false);
  stiffness_ = slots_of(derivatives.stiffness, 0, false);
  damping_ = slots_of(derivatives.damping, 0, false);
  inertia_stiffness_ = slots_of(derivatives.inertia_stiffness, 0, false);
  tangent_inertia_ = slots_of(derivatives.tangent_inertia, 0, false);
  jacobian_ = slots_of(jacobian, coordinates, false);
  jacobian_transposed_ = slots_of(jacobian, coordinates, true);
  for (int row = coordinates; row < coordinates + constraints; ++row) diagonal_.push_back(slot_of(row, row));
  reaction_ = slots_of(derivatives.reaction, coordinates, true);
}

std::vector<int> KktMatrix::slots_of(const SparseTerm& term, int row_offset, bool transposed) const {
  std::vector<int> slots(term.size());
  for (std::size_t i = 0; i < term.size(); ++i) {
    int row = term.row(i) + row_offset, column = term.column(i);
    if (transposed) std::swap(row, column);
    slots[i] = slot_of(row, column);
  }
  return slots;
}

int KktMatrix::slot_of(int row, int column) const {
  const auto begin = pattern_.column.begin() + pattern_.row_start[static_cast<std::size_t>(row)];
  const auto end = pattern_.column.begin() + pattern_.row_start[static_cast<std::size_t>(row) + 1];
  return static_cast<int>(std::lower_bound(begin, end, column) - pattern_.column.begin());
}

void KktMatrix::assemble(const SystemTerms& terms, const SystemDerivatives& derivatives,
                         const KktWeights& weights, std::span<const Real> compliance,
                         std::span<Real> values) const {
  std::fill(values.begin(), values.end(), 0);
  scatter(terms.mass, mass_, weights.mass, values);
  scatter(derivatives.stiffness, stiffness_, weights.stiffness, values);
  scatter(derivatives.damping, damping_, weights.damping, values);
  scatter(derivatives.inertia_stiffness, inertia_stiffness_, weights.inertia_stiffness, values);
  scatter(derivatives.tangent_inertia, tangent_inertia_, weights.tangent, values);
  scatter(derivatives.reaction, reaction_, weights.reaction, values);
  scatter(terms.constraint_jacobian, jacobian_, 1, values);
  scatter(terms.constraint_jacobian, jacobian_transposed_, 1, values);
  for (std::size_t j = 0; j < compliance.size(); ++j)
    values[static_cast<std::size_t>(diagonal_[j])] -= compliance[j];
}

}  // namespace scree
