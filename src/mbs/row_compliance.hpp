// The compliance of the constraints' rows where some may repeat others: it makes the reactions unique.
#pragma once

#include <vector>

#include "mbs/sparse_term.hpp"

namespace scree {

// eps. The matrix' condition grows with 1/eps, the gap that the compliance leaves with eps: at 1e-9
// multipliers have seven digits, and rows of 1 m and 1 kg under a few N yield by 1e-15 m in a step of 1 ms.
inline constexpr Real kComplianceShare = 1e-9;

// eps S with S = diag(Phi_q M^-1 Phi_q^T): how much acceleration a row's own multiplier gives it. A row thus
// yields by the share eps of what it would without the others, whatever its units, and of all multipliers
// that give the same forces the solution has the least sum of S lambda^2, to within eps.
class RowCompliance {
 public:
  RowCompliance() = default;  // of rows that do not share: empty
  // jacobian: Phi_q, whose pattern is taken; inverse_mass: M^-1 [coordinates, coordinates], constant.
  RowCompliance(const SparseTerm& jacobian, const SparseTerm& inverse_mass, int constraints);

  bool empty() const { return of_row_.empty(); }
  void update(const SparseTerm& jacobian);
  // eps S [constraints]
  const std::vector<Real>& of_row() const { return of_row_; }

 private:
  struct Product {
    int row;
    std::size_t one, other;  // entries of the Jacobian
    Real weight;             // eps times their entry of M^-1
  };
  std::vector<Product> products_;
  std::vector<Real> of_row_;
};

}  // namespace scree
