// Linear solve of the particles' Newton matrix, matrix-free over the touching pairs and free of reductions
// other than maxima: Chebyshev iteration (Golub and Varga, Numer. Math. 3, 1961) with the 3x3 diagonal blocks
// D.
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

// Bounds for the particles' matrix; see BlockSolver.
inline ChebyshevWeights solver_weights(Real largest_stiffening) {
  return ChebyshevWeights(1 / (1 + largest_stiffening), 2);
}

// The largest |residual| [N] that the solve for one Newton correction may leave. A tenth of what the Newton
// iteration asks for, so that what is left does not keep it from ending; but no less than a hundredth of the
// right-hand side, because the matrix is that of the contacts before the correction, and the iteration has to
// correct what changes in any case.
inline Real solver_tolerance(Real residual_tolerance, Real force_scale, Real right_hand_side) {
  return std::max(Real(0.1) * residual_tolerance * force_scale, Real(0.01) * right_hand_side);
}

// The same where contacts rub. consistent: the matrix is the derivative but for small terms. What a
// correction leaves is then as small as what the linear solve leaves, once the contacts have found whether
// they stick, and the more the last one has gained, the further the solve goes (Eisenstat and Walker, SIAM J.
// Sci. Comput. 17, 1996, choice 2 with the exponent 3/2). Of one step.
class RubbingTolerance {
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

// What directions in single precision, and their sum, are in units of [N]: about the right-hand side, so that
// they do not vanish where all forces are very small, as of a particle that flies off. A power of two: no
// bits of a result depend on which.
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

// The iteration itself: take(weights) finds the next directions and adds them to the solution, and returns
// the largest |residual| that is left, over all ranks. Returns the number of matrix products.
template <class Take>
int iterate_chebyshev(Real largest_stiffening, Real tolerance, const Take& take) {
  ChebyshevWeights weights = solver_weights(largest_stiffening);
  int products = 0;
  while (products < kMostProducts) {
    ++products;
    if (take(weights) <= tolerance) break;
    weights.advance();
  }
  return products;
}

// The matrix is M' + sum over pairs of [b; -b][b; -b]^T with M' = mass / (1 + alpha): each pair term is at
// most twice its own diagonal, so D^-1 A has no eigenvalue above 2, and none below 1 / (1 + largest
// stiffening).
class BlockSolver {
 public:
  struct System {
    SubtractMatrixItem<PackedRows> matrix;  // d and residual are set by the solver
    std::span<const Sym3> inverse_block;
    std::span<Vec3> residual;  // in: right-hand side; out: what is left of it
    const Halo& halo;
    const Ranks& ranks;
    Real largest_stiffening;
    Real tolerance;  // on the largest |residual| [N]
  };

  // Solves A x = residual into `solution` [owned]. d: search directions of all items; the caller has set the
  // entries of ghosts and shapes. Returns the number of matrix products.
  int solve(const System& system, std::vector<Vec4>& d, std::vector<Vec3>& solution) const;
};

}  // namespace scree
