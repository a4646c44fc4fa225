// Loaded bodies: bodies on whose contacts with explicit particles the step depends so strongly that the
// wrench at the predicted position does not suffice. Their wrench follows the bodies' correction, with the
// contacts evaluated anew at the position of each iteration (src/coupling/README.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/checks/body_load.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Estimate of the stiffness of one body's contact wrench. Each observed change corrects it by the symmetric
// rank-one update (Nocedal, Wright, Numerical Optimization, 2006, Eq. 6.24). The initial estimate is an upper
// bound; the estimate is symmetric, and stays positive semidefinite for wrenches that are linear with a
// symmetric slope.
class WrenchSlope {
 public:
  // stiffness: along every axis [N/m]; about every axis the stiffness is this times reach^2. reach: lever arm
  // [m].
  void begin(Real stiffness, Real reach);
  // Corrects the estimate by an observed change of the wrench between two poses of the body.
  void observe(const BodyMotion& from, const BodyMotion& to, const BodyWrench& change);
  // The predicted change of the wrench between two poses.
  BodyWrench change(const BodyMotion& from, const BodyMotion& to) const;
  std::array<Real, 21> packed() const;  // WrenchStiffness::stiffness

 private:
  using Vector = std::array<Real, 6>;  // rotations times reach, torques over reach [m, N]
  Vector moved(const BodyMotion& from, const BodyMotion& to) const;
  Vector product(const Vector& move) const;

  Real reach_ = 1;                 // [m]
  std::array<Vector, 6> slope_{};  // [N/m]
};

// The loaded bodies of a step. All functions run on rank 0 but can_be().
class LoadedBodies {
 public:
  explicit LoadedBodies(const Model& model);

  // Whether particles can touch a body at all; on every rank.
  bool can_be() const { return can_be_; }
  // Whether bodies are loaded in a step of length h [s]. contacts: number of particle contacts per parent.
  bool are_loaded(const std::vector<std::int64_t>& contacts, Real h) const;

  // Opens a step of loaded bodies. mean: wrenches for the solution if the bodies stay at their predicted
  // pose; predicted: contact wrenches at that pose.
  void open(const std::vector<std::int64_t>& contacts, Real h, const std::vector<BodyMotion>& motion,
            const std::vector<BodyWrench>& mean, const std::vector<BodyWrench>& predicted);
  // Takes over the bodies' new motion and the contact wrenches `found` there.
  void follow(const std::vector<BodyMotion>& motion, const std::vector<BodyWrench>& found);
  // Takes over the bodies' new motion and extrapolates the contact wrenches by the slopes.
  void extrapolate(const std::vector<BodyMotion>& motion);
  // Sets the bodies' entries of `step` to the wrenches for the next iteration.
  void give(ContactWrenches& step) const;
  // Share of the accelerations at the end of the step that is replaced by their mean over the step. If
  // damping takes nearly all of the bodies' own motion within a step, Newmark's accelerations alternate about
  // that mean.
  Real averaging_weight() const { return averaged_; }

  // The warning for the body with the largest phase above kMostLoadedPhase, with its contacts and the remedy;
  // empty if there is none.
  std::string warning() const;

 private:
  struct Worst {
    std::size_t body = 0;
    std::int64_t contacts = 0;
    Real phase = 0, step = 0;  // step [s]
  };
  void watch(const std::vector<std::int64_t>& contacts, Real h);

  const Model& model_;
  const HhtCoefficients coefficients_;
  std::vector<PressedBody> bodies_;
  bool can_be_ = false;
  Worst worst_;
  // Data of the open step.
  std::vector<WrenchSlope> slope_;
  std::vector<BodyMotion> motion_;
  std::vector<BodyWrench> mean_, predicted_, now_;
  Real averaged_ = 0;
};

}  // namespace scree
