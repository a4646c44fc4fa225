// Bodies that explicit particles press on so hard that the wrench at the predicted position is none to solve
// their step with: the wrench then follows the bodies' correction, with the contacts evaluated anew where
// each iteration has brought them (src/coupling/README.md).
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

// An estimate of how one body's contact wrench falls with its displacement; each observed change corrects it
// by the symmetric update of rank one (Nocedal, Wright, Numerical Optimization, 2006, Eq. 6.24). The estimate
// begins at or above the true slope; it is symmetric, and stays positive semidefinite where the wrench is
// linear with a symmetric slope.
class WrenchSlope {
 public:
  // stiffness: along every axis [N/m]; about every axis it is this times reach^2, reach in [m].
  void begin(Real stiffness, Real reach);
  // The wrench changed by `change` where the body was moved.
  void observe(const BodyMotion& from, const BodyMotion& to, const BodyWrench& change);
  // The change of the wrench that the estimate predicts.
  BodyWrench change(const BodyMotion& from, const BodyMotion& to) const;
  std::array<Real, 21> packed() const;  // WrenchStiffness::stiffness

 private:
  using Vector = std::array<Real, 6>;  // turns times the reach, torques over it [m, N]
  Vector moved(const BodyMotion& from, const BodyMotion& to) const;
  Vector product(const Vector& move) const;

  Real reach_ = 1;                 // [m]
  std::array<Vector, 6> slope_{};  // [N/m]
};

// The loaded bodies of a step. Lives on rank 0 but for can_be().
class LoadedBodies {
 public:
  explicit LoadedBodies(const Model& model);

  // Whether particles can touch a body at all; on every rank.
  bool can_be() const { return can_be_; }
  // Whether a step of length h [s] is one of loaded bodies. contacts: number of particles' contacts, per
  // carrier.
  bool are_loaded(const std::vector<std::int64_t>& contacts, Real h) const;

  // Opens such a step. mean: the wrenches that it is to be solved with if the bodies stay on their
  // prediction, where their contacts have the wrenches `predicted`.
  void open(const std::vector<std::int64_t>& contacts, Real h, const std::vector<BodyMotion>& motion,
            const std::vector<BodyWrench>& mean, const std::vector<BodyWrench>& predicted);
  // The bodies are there now, and their contacts have the wrenches `found`.
  void follow(const std::vector<BodyMotion>& motion, const std::vector<BodyWrench>& found);
  // The bodies are there now, and the slopes predict the wrenches of their contacts.
  void extrapolate(const std::vector<BodyMotion>& motion);
  // Sets the bodies' entries of `step` to the wrenches that the next iteration is solved with.
  void give(ContactWrenches& step) const;
  // Share of the accelerations at the end of the step that their mean over the step replaces: where damping
  // takes nearly all of the bodies' own motion within a step, Newmark's accelerations alternate about that
  // mean.
  Real averaged_share() const { return averaged_; }

  // Names the body whose phase was above kMostLoadedPhase, with its contacts and the remedy; empty if none
  // was.
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
  // These belong to the open step.
  std::vector<WrenchSlope> slope_;
  std::vector<BodyMotion> motion_;
  std::vector<BodyWrench> mean_, predicted_, now_;
  Real averaged_ = 0;
};

}  // namespace scree
