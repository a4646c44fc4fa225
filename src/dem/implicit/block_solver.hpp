// Linear solver for the particles' Newton matrix: Chebyshev iteration (Golub and Varga, Numer. Math. 3, 1961)
// preconditioned with the diagonal blocks D of the particles. It is matrix-free over the contacts, and its
// only reductions are maxima. Its loops are those of the backends: cpu/cpu_solver.hpp, cuda/cuda_solver.cuh.
//
// The matrix A is M' + sum over pairs of [b; -b][b; -b]^T with M' = mass / (1 + alpha). Each pair term is at
// most twice its own diagonal, so that the eigenvalues of D^-1 A lie between 1 / (1 +
// largest_stiffness_ratio) and 2.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/spatial_velocity.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/implicit/step_items.hpp"

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

// Weights with the eigenvalue bounds of the particles' matrix.
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

// How directions are stored: that of a particle without rotation is as long as a load of four numbers.
SCREE_HD Vec3 direction_of(Vec4 stored) { return xyz(stored); }
SCREE_HD Twistf direction_of(Twistf stored) { return stored; }
SCREE_HD void store_direction(Vec3 d, Vec4& to) { to = vec4(d, 0); }
SCREE_HD void store_direction(Twistf d, Twistf& to) { to = d; }

// Square of the largest component of a residual [N^2].
SCREE_HD Real largest_square(Vec3 residual) { return dot(residual, residual); }
SCREE_HD Real largest_square(const Twist& residual) {
  const Real move = dot(residual.move, residual.move), turn = dot(residual.turn, residual.turn);
  return move > turn ? move : turn;
}

// Begins a solve. Direction: `DirectionItem` or `TwistDirectionItem`.
template <class Direction, class Stored, class Correction>
struct FirstDirectionItem {
  Direction direction;
  Stored* first;
  Correction* solution;

  SCREE_HD void operator()(Index i) const {
    store_direction(direction.next(i, {}), first[i]);
    solution[i] = {};
  }
};
template <class Direction, class Stored, class Correction>
FirstDirectionItem(Direction, Stored*, Correction*) -> FirstDirectionItem<Direction, Stored, Correction>;

// One step of the solve: adds the direction to the solution, subtracts its product with the matrix from the
// residual, and finds the next direction. Returns the square of the particle's residual.
template <class Subtract, class Direction, class Stored, class Correction>
struct ProductItem {
  Subtract subtract;    // reads the directions of all items
  Direction direction;  // weights of the next direction
  Stored* next;
  Correction* solution;

  SCREE_HD Real operator()(Index i) const {
    const auto d = direction_of(subtract.d[i]);
    solution[i] += d;
    subtract(i);
    store_direction(direction.next(i, d), next[i]);
    return square(i);
  }
  // The same in two passes over the particles: on the CPU, a loop over the directions alone is vectorized.
  SCREE_HD Real subtract_product(Index i) const {
    solution[i] += direction_of(subtract.d[i]);
    subtract(i);
    return square(i);
  }
  SCREE_HD void find_next(Index i) const {
    store_direction(direction.next(i, direction_of(subtract.d[i])), next[i]);
  }

 private:
  SCREE_HD Real square(Index i) const { return largest_square(subtract.residual[i]); }
};
template <class Subtract, class Direction, class Stored, class Correction>
ProductItem(Subtract, Direction, Stored*, Correction*)
    -> ProductItem<Subtract, Direction, Stored, Correction>;

inline constexpr int kMostProducts = 2000;  // matrix products of one solve

}  // namespace scree
