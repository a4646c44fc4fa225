// Bushings: six-dimensional springs with dampers between the frames of two spatial bodies.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mbs/force_elements.hpp"
#include "mbs/primitive_function.hpp"
#include "model/data/bodies.hpp"

namespace scree {

// Deflection and load of a bushing at one instant, along the axes of the first body's frame.
struct BushingLoad {
  Vec3 shift, turn;    // the deflection x [m, rad]
  Vec3 force, torque;  // on the second body, about its point [N, N m]
};

// s = K x + C x' + preload with x of six primitive functions x_a, of gradients g_a and Hessians H_a:
//   Q = -s_a g_a,  -Q_q = g_a (K_ab g_b + C_ab H_b^T v)^T + s_a H_a,  -Q_v T^-1 = C_ab g_a (T^-T g_b)^T
// The three rotational functions are left out where no stiffness or damping depends on them. Evaluation
// throws SimulationError with the name of the bushing where its rotation exceeds 2.6 rad: the rotation
// vector jumps at half a revolution.
class BushingElement final : public ForceElement {
 public:
  BushingElement(const Bushing& bushing, const BodyLayout& layout);

  const std::string& name() const { return bushing_.name; }
  BushingLoad load(const BodyPoses& poses) const;

  Real add_force(const BodyPoses& poses, Real t, Real length, std::vector<Real>& force) override;
  void add_derivatives(const BodyPoses& poses, Real t, SparseTerm& stiffness,
                       SparseTerm& damping) const override;
  void add_powers(const BodyPoses& poses, Real t, Powers& powers) const override;
  Real elastic_energy(const BodyPoses& poses) const override;
  Real elastic_scale(Real length) const override;

 private:
  struct Deflection {
    std::array<PairGradient, 6> gradient{};
    std::array<Real, 6> value{}, rate{}, tension{};  // x, x', s
  };
  Deflection deflection(const BodyPoses& poses) const;
  int column(std::size_t block) const { return primitives_.front()->column(static_cast<int>(block)); }

  Bushing bushing_;
  // Three, or six where the bushing resists rotation.
  std::vector<std::unique_ptr<PrimitiveFunction>> primitives_;
};

}  // namespace scree
