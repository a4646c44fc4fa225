#include "mbs/primitive_function.hpp"

#include <utility>

namespace scree {

namespace {

// sum_k c_k m_k
class Sum final : public PrimitiveFunction {
 public:
  explicit Sum(std::vector<WeightedPrimitive> terms)
      : PrimitiveFunction(terms.front().primitive->pair()), terms_(std::move(terms)) {}

  bool is_angle() const override { return terms_.front().primitive->is_angle(); }
  Real value(const SpatialMotion& motion) const override {
    Real sum = 0;
    for (const WeightedPrimitive& t : terms_) sum += t.weight * t.primitive->value(motion);
    return sum;
  }
  PairGradient gradient(const SpatialMotion& motion) const override {
    PairGradient sum{};
    for (const WeightedPrimitive& t : terms_) {
      const PairGradient one = t.primitive->gradient(motion);
      for (std::size_t k = 0; k < 4; ++k) sum[k] += t.weight * one[k];
    }
    return sum;
  }
  Real second(const SpatialMotion& motion) const override {
    Real sum = 0;
    for (const WeightedPrimitive& t : terms_) sum += t.weight * t.primitive->second(motion);
    return sum;
  }
  void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& hessian) const override {
    for (const WeightedPrimitive& t : terms_) t.primitive->add_hessian(motion, scale * t.weight, hessian);
  }
  bool has_block(int block) const override {
    for (const WeightedPrimitive& t : terms_)
      if (t.primitive->has_block(block)) return true;
    return false;
  }
  bool has_block(int row, int column) const override {
    for (const WeightedPrimitive& t : terms_)
      if (t.primitive->has_block(row, column)) return true;
    return false;
  }

 private:
  std::vector<WeightedPrimitive> terms_;
};

}  // namespace

std::unique_ptr<PrimitiveFunction> sum_of_primitives(std::vector<WeightedPrimitive> terms) {
  return std::make_unique<Sum>(std::move(terms));
}

Real primitive_rate(const PrimitiveFunction& primitive, const SpatialMotion& motion) {
  const PairGradient g = primitive.gradient(motion);
  const SpatialPose &one = motion[primitive.pair().body[0]], &two = motion[primitive.pair().body[1]];
  return dot(g[0], one.velocity) + dot(g[1], one.spin) + dot(g[2], two.velocity) + dot(g[3], two.spin);
}

void add_block(SparseTerm& term, int row, int column, const Mat3& block) {
  if (row < 0 || column < 0) return;
  if (Real* const out = term.next(9)) {
    out[0] = block.x.x, out[1] = block.x.y, out[2] = block.x.z;
    out[3] = block.y.x, out[4] = block.y.y, out[5] = block.y.z;
    out[6] = block.z.x, out[7] = block.z.y, out[8] = block.z.z;
    return;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) term.add(row + i, column + j, component(row_of(block, i), j));
}

void add_gradient(const PrimitiveFunction& primitive, const PairGradient& gradient, int row,
                  SparseTerm& out) {
  for (int k = 0; k < 4; ++k) {
    const int column = primitive.column(k);
    if (column < 0 || !primitive.has_block(k)) continue;
    const Vec3 block = gradient[static_cast<std::size_t>(k)];
    if (Real* const values = out.next(3)) {
      values[0] = block.x, values[1] = block.y, values[2] = block.z;
      continue;
    }
    for (int j = 0; j < 3; ++j) out.add(row, column + j, component(block, j));
  }
}

void add_hessian(const PrimitiveFunction& primitive, const PairHessian& hessian, SparseTerm& out) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (primitive.has_block(i, j))
        add_block(out, primitive.column(i), primitive.column(j),
                  hessian[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
}

}  // namespace scree
