#include <array>
#include <cmath>
#include <utility>

#include "mbs/primitive_function.hpp"

namespace scree {

namespace {

// theta    = atan2(s, c); where s = y_1.x_2, c = x_1.x_2 the rotation of frame 2 against frame 1 about their
// z gradient = f_c c_q + f_s s_q; where the axes are parallel 0, -u, 0, A_2^T A_1 u, u = z_1 in body 1
// Hessian  = f_c c_qq + f_s s_qq + f_cc c_q c_q^T + f_ss s_q s_q^T + f_cs (c_q s_q^T + s_q c_q^T)
// second   = f_c c''_0 + f_s s''_0 + f_cc c'^2 + f_ss s'^2 + 2 f_cs c' s'
// with f_c = -s / r, f_s = c / r, f_cc = -f_ss = 2 s c / r^2, f_cs = (s^2 - c^2) / r^2, r = s^2 + c^2: exact
// also where the axes are not parallel yet, in Newton's iterations.
class AnglePrimitive final : public PrimitiveFunction {
 public:
  AnglePrimitive(std::unique_ptr<PrimitiveFunction> cosine, std::unique_ptr<PrimitiveFunction> sine,
                 int number)
      : PrimitiveFunction(cosine->pair()),
        cosine_(std::move(cosine)),
        sine_(std::move(sine)),
        number_(number) {}

  bool is_angle() const override { return true; }
  // The branch nearest to the angle of the last accepted step.
  Real value(const SpatialMotion& motion) const override {
    const Real wrapped = std::atan2(sine_->value(motion), cosine_->value(motion));
    return wrapped + 2 * M_PI * std::round((motion.counted_angle(number_) - wrapped) / (2 * M_PI));
  }
  PairGradient gradient(const SpatialMotion& motion) const override {
    const Slopes f = slopes(motion);
    const PairGradient c = cosine_->gradient(motion), s = sine_->gradient(motion);
    PairGradient sum{};
    for (const std::size_t k : {1, 3}) sum[k] = f.c * c[k] + f.s * s[k];
    return sum;
  }
  Real second(const SpatialMotion& motion) const override {
    const Slopes f = slopes(motion);
    const Real c = primitive_rate(*cosine_, motion), s = primitive_rate(*sine_, motion);
    return f.c * cosine_->second(motion) + f.s * sine_->second(motion) + f.cc * (c * c - s * s) +
           2 * f.cs * c * s;
  }
  void add_hessian(const SpatialMotion& motion, Real scale, PairHessian& k) const override {
    const Slopes f = slopes(motion);
    cosine_->add_hessian(motion, scale * f.c, k);
    sine_->add_hessian(motion, scale * f.s, k);
    const PairGradient c = cosine_->gradient(motion), s = sine_->gradient(motion);
    for (const std::size_t i : {1, 3})
      for (const std::size_t j : {1, 3})
        k[i][j] = k[i][j] + outer(scale, c[i], f.cc * c[j] + f.cs * s[j]) +
                  outer(scale, s[i], f.cs * c[j] - f.cc * s[j]);
  }
  bool has_block(int block) const override { return block % 2 == 1; }
  bool has_block(int row, int column) const override { return row % 2 == 1 && column % 2 == 1; }

 private:
  struct Slopes {
    Real c, s, cc, cs;
  };
  Slopes slopes(const SpatialMotion& motion) const {
    const Real c = cosine_->value(motion), s = sine_->value(motion), r = 1 / (c * c + s * s);
    return {-s * r, c * r, 2 * s * c * r * r, (s * s - c * c) * r * r};
  }

  std::unique_ptr<PrimitiveFunction> cosine_, sine_;
  int number_;
};

}  // namespace

std::unique_ptr<PrimitiveFunction> angle_primitive(std::unique_ptr<PrimitiveFunction> cosine,
                                                   std::unique_ptr<PrimitiveFunction> sine, int number) {
  return std::make_unique<AnglePrimitive>(std::move(cosine), std::move(sine), number);
}

}  // namespace scree
