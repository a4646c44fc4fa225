// Decks of one sphere and one wall that moves or has a surface velocity.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "support/models.hpp"
#include "support/simulation_run.hpp"

namespace scree {

// A sphere of radius 0.1 m and mass 1 kg between z = -1 m and z = 2 m.
struct WallDeck {
  std::string wall;     // keys of it, in one or more lines
  std::string contact;  // keys of the pair
  std::string grain;    // position and motion
  std::string gravity = "[0, 0, 0]";
  Real step = 1e-4, end = 1;  // [s]
  std::string particles = "hht";
  std::string rest = {};  // further tables

  std::string text() const {
    return fmt::format(
        "gravity = {}\n[space]\ndimension = 3\nmin = [-4, -4, -1]\nmax = [4, 4, 2]\n[time]\nend = {}\nstep = "
        "{}\n"
        "control = \"fixed\"\n[integrator]\nparticles = \"{}\"\n[[contact.pairs]]\n{}\n"
        "[[walls]]\nname = \"plate\"\n{}\n[[particles]]\nname = \"ball\"\nkind = \"list\"\nradius = 0.1\n"
        "mass = 1\n{}\n{}",
        gravity, end, step, particles, contact, wall, grain, rest);
  }
  Model model(const std::vector<std::string>& settings = {}) const { return model_of(text(), settings); }
};

inline const std::string kFloor = "point = [0, 0, 0]\nnormal = [0, 0, 1]\n";
// The face as a part of a mesh whose frame is the global one.
inline const std::string kPlateWall = "mesh = \"box\"\n";
inline const std::string kPlateMesh = "[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [6, 6, 0.5]\n";

inline std::string motions(const std::string& list) { return "motions = [" + list + "]\n"; }

}  // namespace scree
