// Compliance of the constraint rows where some may be redundant: it makes the reactions unique.
#pragma once

#include <vector>

#include "mbs/sparse_term.hpp"

namespace scree {

// eps. The condition number of the matrix grows with 1/eps, the violation that the compliance leaves grows
// with eps. At 1e-9 multipliers have seven digits, and rows of 1 m and 1 kg under a few N yield by 1e-15 m
// in a step of 1 ms.
inline constexpr Real kRelativeCompliance = 1e-9;

// eps S with S = diag(Phi_q M^-1 Phi_q^T), the acceleration of a row per unit of its own multiplier. A row
// thus yields by the fraction eps of its yielding without the other rows, whatever its units. Of all
// multipliers that give the same forces, the solution minimizes the sum of S lambda^2, to within eps.
class RowCompliance {
 public:
  RowCompliance() = default;  // without redundant rows: empty
  // jacobian: Phi_q, whose pattern is taken; inverse_mass: M^-1 [coordinates, coordinates], constant.
  RowCompliance(const SparseTerm& jacobian, const SparseTerm& inverse_mass, int constraints);

  bool empty() const { return of_row_.empty(); }
  void update(const SparseTerm& jacobian);
  // eps S [constraints]
  const std::vector<Real>& of_row() const { return of_row_; }

 private:
  struct Product {
    int one, other;  // entries of the Jacobian
    Real weight;     // eps times the corresponding entry of M^-1, other than 0
  };
  std::vector<Product> products_;   // row by row
  std::vector<std::size_t> first_;  // of every row, and their number
  std::vector<Real> of_row_;
};

}  // namespace scree
