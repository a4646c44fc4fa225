// Parts of a contact law that are left out, and the input and result of rolling laws: all that
// physics/contact_law.hpp needs of tangential and rolling laws. The laws themselves are included only where a
// law is chosen or compiled.
#pragma once

#include "base/hd.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_motion.hpp"
#include "physics/normal_contact.hpp"
#include "physics/spring_slider.hpp"

namespace scree {

// No tangential force.
struct Frictionless {
  static constexpr bool acts = false;
  static constexpr int kHistory = 0;
};

// No moment against rolling, nor against twisting.
struct FreeRolling {
  static constexpr bool acts = false;
  static constexpr int kHistory = 0;
};

// Input of a rolling law: a contact over a step.
struct RollingContact {
  const PairSize& size;
  const ContactMotion& motion;
  const NormalContact& normal;
  const SpringSlider& friction;  // of the tangential law; all zero without friction
};

// Result of a rolling and twisting law over a step; losses: by rolling.
struct RollingStep : SpringStep {
  SpringLosses twisting;
};

}  // namespace scree
