// Shared parts of tests of refused starts: models of a few discs, and the message of the refusal.
#pragma once

#include <string>

#include "base/error.hpp"
#include "support/decks.hpp"
#include "support/multibody_run.hpp"

namespace scree {

template <class Error, class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was refused";
}

inline std::string refusal(const Model& model) {
  petsc();
  return message_of<InputError>([&] { const Multibody refused(model); });
}

inline Model hanging_disc() {
  Model model = empty_model();
  model.bodies.push_back(paper_disc("bob", 0.5, 0));
  model.joints.push_back(ground_pin("pivot", 0, {0, 0, 0}, {-0.5, 0, 0}));
  return model;
}

inline TimeFunction ramp(Real rate) {
  TimeFunction function;
  function.kind = TimeFunction::Kind::ramp;
  function.rate = rate;
  return function;
}

// Ground - one - two - ground: a closed chain of two discs on three pins.
inline Model closed_chain() {
  Model model = empty_model();
  model.bodies = {paper_disc("one", 0.5, 0), paper_disc("two", 1, 0.5)};
  model.joints.push_back(ground_pin("left", 0, {0, 0, 0}, {-0.5, 0, 0}));
  model.joints.push_back(ground_pin("middle", 1, {0.5, 0, 0}, {0, -0.5, 0}));
  model.joints[1].body[0] = 0;
  model.joints.push_back(ground_pin("right", 1, {1, 1, 0}, {0, 0.5, 0}));
  return model;
}

}  // namespace scree
