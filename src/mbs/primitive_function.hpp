// Primitive constraint functions (Haug): scalar functions of the poses of two spatial bodies, from which
// joints, drivers and forces between them are built.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mbs/sparse_term.hpp"
#include "mbs/spatial_motion.hpp"
#include "physics/orientation.hpp"

namespace scree {

// Derivatives by the changes of the poses, (r_1 | pi_1 | r_2 | pi_2): r global, pi a rotation in the body's
// own frame, dA = A dpi~.
using PairGradient = std::array<Vec3, 4>;
using PairHessian = std::array<std::array<Mat3, 4>, 4>;

// c, with c' = gradient . (v_1, w_1, v_2, w_2) and c'' = gradient . accelerations + second(). Notation in
// the files: s_i, a, b fixed to bodies, P_i = r_i + A_i s_i, d = P_2 - P_1, al = A_1 a, be = A_2 b; d''_0 =
// A_2 w_2~^2 s_2 - A_1 w_1~^2 s_1, al''_0 = A_1 w_1~^2 a, be''_0 likewise.
class PrimitiveFunction {
 public:
  explicit PrimitiveFunction(const SpatialPair& pair) : pair_(pair) {}
  virtual ~PrimitiveFunction() = default;

  virtual bool is_angle() const = 0;  // or a cosine: [1]; otherwise a length [m]
  virtual Real value(const SpatialMotion& motion) const = 0;
  virtual PairGradient gradient(const SpatialMotion& motion) const = 0;
  virtual Real second(const SpatialMotion& motion) const = 0;
  // Adds scale times the derivative of the gradient: row blocks of the gradient, column blocks of the change.
  virtual void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& hessian) const = 0;
  // Whether a block of the gradient, or of the Hessian, can be other than zero.
  virtual bool has_block(int block) const = 0;
  virtual bool has_block(int row, int column) const = 0;

  const SpatialPair& pair() const { return pair_; }
  // First of a block's three columns; -1 where the body is the ground.
  int column(int block) const {
    const int first = pair_.column[block / 2];
    return first < 0 ? -1 : first + 3 * (block % 2);
  }

 private:
  SpatialPair pair_;
};

// Primitive functions, each in a file of its own.
//   dot1: al.be
std::unique_ptr<PrimitiveFunction> dot1_primitive(const SpatialPair& pair, Vec3 a, Vec3 b);
//   dot2: al.d [m]
std::unique_ptr<PrimitiveFunction> dot2_primitive(const SpatialPair& pair, Vec3 a);
//   distance: |d| [m]; undefined where the points coincide
std::unique_ptr<PrimitiveFunction> distance_primitive(const SpatialPair& pair);
//   angle: that of a joint, whole revolutions included [rad]. cosine, sine: each a dot1 of axes of the two
//   bodies; undefined where both are 0. number: of SpatialMotion::counted_angle, which keeps the revolutions.
std::unique_ptr<PrimitiveFunction> angle_primitive(std::unique_ptr<PrimitiveFunction> cosine,
                                                   std::unique_ptr<PrimitiveFunction> sine, int number);

//   rotation_vector: component k of the rotation vector from the first of two frames fixed to the bodies to
//   the second one, the same along the axes of either frame [rad]. frame: its orientation in the frame of its
//   body. The rotation vector jumps at half a revolution.
std::unique_ptr<PrimitiveFunction> rotation_vector_primitive(const SpatialPair& pair,
                                                             const Quaternion (&frame)[2], int k);

// One term of sum_of_primitives(): weight times function. All terms are of one pair of bodies; the sum is an
// angle if the first term is one.
struct WeightedPrimitive {
  Real weight;
  std::unique_ptr<PrimitiveFunction> primitive;
};
std::unique_ptr<PrimitiveFunction> sum_of_primitives(std::vector<WeightedPrimitive> terms);

// The rate of a primitive function, gradient . velocities.
Real primitive_rate(const PrimitiveFunction& primitive, const SpatialMotion& motion);
// Writes a 3x3 block at the first row and column given (nothing where one is negative).
void add_block(SparseTerm& term, int row, int column, const Mat3& block);
// Add the blocks that the primitive function has.
void add_gradient(const PrimitiveFunction& primitive, const PairGradient& gradient, int row, SparseTerm& out);
void add_hessian(const PrimitiveFunction& primitive, const PairHessian& hessian, SparseTerm& out);

}  // namespace scree
