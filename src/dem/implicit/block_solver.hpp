// Linear solver for the particles' Newton matrix: Chebyshev iteration (Golub and Varga, Numer. Math. 3, 1961)
// preconditioned with the 3x3 diagonal blocks D. It is matrix-free over the contacts, and its only reductions
// are maxima.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/implicit/step_items.hpp"
#include "partition/halo.hpp"

namespace scree {

// Weights of the iteration d <- from_last d + from_residual D^-1 r, x <- x + d, for eigenvalues of D^-1 A
// between low and high.
class ChebyshevWeights {
 public:
  ChebyshevWeights(Real low, Real high)
      : half_width_((high - low) / 2), sigma_((high + low) / 2 / half_width_), rho_(1 / sigma_) {
    from_residual = 1 / ((high + low) / 2);
  }
  void advance() {
    const Real next = 1 / (2 * sigma_ - rho_);
    from_last = next * rho_, from_residual = 2 * next / half_width_;
    rho_ = next;
  }
  Real from_last = 0, from_residual;

 private:
  Real half_width_, sigma_, rho_;
};

// Weights with the eigenvalue bounds of the particles' matrix; see `BlockSolver`.
inline ChebyshevWeights solver_weights(Real largest_stiffness_ratio) {
  return ChebyshevWeights(1 / (1 + largest_stiffness_ratio), 2);
}

// Tolerance on the largest |residual| of the linear solve for one Newton correction [N]: a tenth of the
// Newton tolerance, so that the remainder does not prevent convergence; but at least a hundredth of the
// right-hand side, because the matrix is that of the contacts before the correction, and the Newton iteration
// corrects the change anyway.
inline Real solver_tolerance(Real residual_tolerance, Real force_scale, Real right_hand_side) {
  return std::max(Real(0.1) * residual_tolerance * force_scale, Real(0.01) * right_hand_side);
}

// Tolerance of the linear solves of one step with friction. consistent: the matrix is the derivative but for
// small terms. Once the contacts have settled into sticking or sliding, the Newton residual is then as small
// as that of the linear solve; the tolerance decreases with the convergence of the last correction (Eisenstat
// and Walker, SIAM J. Sci. Comput. 17, 1996, choice 2 with the exponent 3/2).
class FrictionTolerance {
 public:
  Real next(bool consistent, Real residual_tolerance, Real force_scale, Real right_hand_side) {
    if (!consistent) return solver_tolerance(residual_tolerance, force_scale, right_hand_side);
    const Real ratio = last_ > 0 ? right_hand_side / last_ : 1, gained = ratio * std::sqrt(ratio);
    last_ = right_hand_side;
    return std::max(Real(0.1) * residual_tolerance * force_scale,
                    std::min(Real(0.01), gained) * right_hand_side);
  }

 private:
  Real last_ = 0;  // right-hand side of the last solve [N]
};

// Unit of single-precision directions and of their sum [N]: about the right-hand side, so that they do not
// underflow where all forces are very small, as for a particle in free flight. It is a power of two, so that
// no bit of a result depends on it.
inline Real direction_unit(Real right_hand_side) {
  return std::ldexp(1.0, std::ilogb(std::max(right_hand_side, std::numeric_limits<Real>::min())));
}

struct DirectionItem {
  const Sym3* inverse_block;
  const Vec3* residual;
  Real from_last, from_residual;

  SCREE_HD Vec3 next(Index i, Vec3 d) const {
    return from_last * d + from_residual * (inverse_block[i] * residual[i]);
  }
};

inline constexpr int kMostProducts = 2000;  // matrix products of one solve

// Chebyshev iteration: take(weights) finds the next directions, adds them to the solution and returns the
// largest |residual| over all ranks. Returns the number of matrix products.
template <class Take>
int iterate_chebyshev(Real largest_stiffness_ratio, Real tolerance, const Take& take) {
  ChebyshevWeights weights = solver_weights(largest_stiffness_ratio);
  int products = 0;
  while (products < kMostProducts) {
    ++products;
    if (take(weights) <= tolerance) break;
    weights.advance();
  }
  return products;
}

// The matrix is M' + sum over pairs of [b; -b][b; -b]^T with M' = mass / (1 + alpha). Each pair term is at
// most twice its own diagonal, so that the eigenvalues of D^-1 A lie between 1 / (1 +
// largest_stiffness_ratio) and 2.
class BlockSolver {
 public:
  struct System {
    SubtractMatrixItem<PackedRows> matrix;  // d and residual are set by the solver
    std::span<const Sym3> inverse_block;
    std::span<Vec3> residual;  // in: right-hand side; out: remaining residual
    const Halo& halo;
    const Ranks& ranks;
    Real largest_stiffness_ratio;
    Real tolerance;  // on the largest |residual| [N]
  };

  // Solves A x = residual into `solution` [owned]. d: search directions of all items; the caller sets the
  // entries of ghosts and shapes. Returns the number of matrix products.
  int solve(const System& system, std::vector<Vec4>& d, std::vector<Vec3>& solution) const;
};

}  // namespace scree
