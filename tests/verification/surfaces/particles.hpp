// Decks of particles that collide with surfaces; walls and bodies are added by the tests.
#pragma once

#include <string>

namespace scree {

inline const std::string kFrictionPair =
    "[[contact.pairs]]\nstiffness = 1e4\nrestitution = 0.6\nfriction = 0.4\ntangential_damping_ratio = "
    "0.1\n";

// 48 particles that fall onto z = 0 in a periodic box, slide, roll and rebound; 1,500 steps. law: tables of
// materials and pairs.
inline std::string falling_grains(const std::string& method, const std::string& law = kFrictionPair) {
  return "gravity = [1.0, 0.5, -9.81]\n[space]\ndimension = 3\nmin = [0.0, 0.0, -0.1]\nmax = [0.2, 0.2, "
         "0.4]\nx_min "
         "= \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\n[time]\nend = "
         "0.09\nstep "
         "= 6e-5\ncontrol = \"fixed\"\n[integrator]\nparticles = \"" +
         method + "\"\n" + law +
         "[[particles]]\nname = \"grains\"\nkind = \"lattice\"\norigin = [0.011, 0.011, "
         "0.0101]\nspacing = "
         "[0.0485, 0.0492, 0.0211]\nsize = [4, 4, 3]\nradius = 0.01\ndensity = 2500.0\nvelocity = [0.4, "
         "-0.2, "
         "-0.1]\n[output]\nhistory_interval = 0.01\n";
}

// One particle on a floor, 1e4 steps.
inline std::string sliding_grain(const std::string& position, const std::string& velocity,
                                 const std::string& gravity) {
  return "gravity = " + gravity +
         "\n[space]\ndimension = 3\nmin = [-2.0, -2.0, -2.0]\nmax = [2.0, 2.0, 2.0]\n[time]\nend = 0.8\nstep "
         "= "
         "8e-5\ncontrol = \"fixed\"\n[integrator]\nparticles = "
         "\"velocity-verlet\"\n[[contact.pairs]]\nstiffness = "
         "1e4\nrestitution = 0.5\nfriction = 0.3\ntangential_damping_ratio = 0.3\n[[particles]]\nname = "
         "\"grain\"\nkind = \"list\"\npositions = [" +
         position + "]\nvelocity = " + velocity +
         "\nradius = 0.02\ndensity = 2500.0\n[output]\nhistory_interval = 0.1\n";
}

}  // namespace scree
