// Bodies that explicit particles press on so hard that the wrench at the predicted position is none to solve
// their step with: the wrench then follows the bodies' correction, with the contacts evaluated anew where
// each iteration has brought them (src/coupling/README.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/body_exchange.hpp"
#include "model/body_load.hpp"
#include "model/model.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Of one body: an estimate of how its contact wrench falls with its displacement, which each observed change
// corrects by the symmetric update of rank one (Nocedal, Wright, Numerical Optimization, 2006, Eq. 6.24). It
// begins at or above the true one, and is symmetric and nowhere negative throughout.
class WrenchSlope {
 public:
  // Along every axis the same [N/m], about every axis this times reach^2.
  void begin(Real stiffness, Real reach);
  // The wrench changed by `change` where the body was moved.
  void observe(const BodyMotion& from, const BodyMotion& to, const BodyWrench& change);
  // What it foretells of that change.
  BodyWrench change(const BodyMotion& from, const BodyMotion& to) const;
  std::array<Real, 21> packed() const;  // WrenchStiffness::stiffness

 private:
  using Vector = std::array<Real, 6>;  // turns times the reach, torques over it [m, N]
  Vector moved(const BodyMotion& from, const BodyMotion& to) const;
  Vector product(const Vector& move) const;

  Real reach_ = 1;                 // [m]
  std::array<Vector, 6> slope_{};  // [N/m]
};

// On rank 0.
class LoadedBodies {
 public:
  explicit LoadedBodies(const Model& model);

  // Whether particles can touch a body at all; on every rank.
  bool can_be() const { return can_be_; }
  // contacts: of particles, per carrier. Whether a step of length h [s] is one of loaded bodies.
  bool are_loaded(const std::vector<std::int64_t>& contacts, Real h) const;

  // Opens such a step. mean: the wrenches that it is to be solved with if the bodies stay on their
  // prediction, where their contacts have the wrenches `predicted`.
  void open(const std::vector<std::int64_t>& contacts, Real h, const std::vector<BodyMotion>& motion,
            const std::vector<BodyWrench>& mean, const std::vector<BodyWrench>& predicted);
  // The bodies are there now, and their contacts have the wrenches `found`.
  void follow(const std::vector<BodyMotion>& motion, const std::vector<BodyWrench>& found);
  // The same with wrenches that the slopes foretell.
  void foretell(const std::vector<BodyMotion>& motion);
  // What the next iteration is to be solved with; of `step`, the bodies' entries.
  void give(ContactWrenches& step) const;
  // Share of the accelerations at the end of the step that their mean over it has to replace: at a step in
  // which damping takes what is left of the bodies' own motion, Newmark's alternate about it.
  Real averaged_share() const { return averaged_; }

  // Once a body's phase was above kMostLoadedPhase: which body, its contacts and what to do; else empty.
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
  // Of the open step.
  std::vector<WrenchSlope> slope_;
  std::vector<BodyMotion> motion_;
  std::vector<BodyWrench> mean_, predicted_, now_;
  Real averaged_ = 0;
};

}  // namespace scree
