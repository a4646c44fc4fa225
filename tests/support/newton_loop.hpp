// The Newton loop of an implicit step of the particles alone, with the bodies held at their poses.
#pragma once

#include <memory>
#include <vector>

#include "dem/backend/backend.hpp"
#include "support/catch.hpp"

namespace scree {

inline constexpr int kShortened = -1;

// Iterates a predicted step to a relative residual of 1e-10. Calls after(linear) at the end of each iteration
// with the linear iterations of its correction, or with kShortened where the last correction was shortened
// instead.
template <class After>
void solve_step(Backend& backend, ImplicitStep& step, const std::vector<BodyMotion>& motion,
                const After& after) {
  constexpr int kMostIterations = 100;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const ParticleNorms norms = step.contact_force();
    if (norms.overshoot) {
      step.shorten_correction();
      after(kShortened);
      continue;
    }
    if (norms.residual <= 1e-10) return;
    backend.list().set_body_motion(motion);
    after(step.particle_correct().iterations);
  }
  FAIL("no convergence");
}

inline std::unique_ptr<ImplicitStep> predicted_step(Backend& backend, Real h) {
  std::unique_ptr<ImplicitStep> step = backend.open_step(h);
  step->predict();
  return step;
}

// One accepted step of length h.
inline void hht_step(Backend& backend, const std::vector<BodyMotion>& motion, Real h) {
  const std::unique_ptr<ImplicitStep> step = predicted_step(backend, h);
  solve_step(backend, *step, motion, [](int) {});
  step->accept();
}

}  // namespace scree
