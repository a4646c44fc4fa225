// Decks of spheres with friction on the plane z = 0 or on each other, and final states of their runs.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/models.hpp"
#include "support/simulation_run.hpp"
#include "verification/contact/leapfrog.hpp"

namespace scree {

inline std::string toml(Vec3 a) { return fmt::format("[{}, {}, {}]", a.x, a.y, a.z); }

// Implicit steps of a fixed length.
inline std::vector<std::string> implicit_steps(Real hht_alpha) {
  return {"integrator.particles=hht", "time.control=fixed",
          fmt::format("integrator.hht_alpha={}", hht_alpha)};
}

struct GrainDeck {
  std::string law;  // keys of the pairs
  std::vector<Grain> grains;
  Real step, end;              // [s]
  std::string materials = {};  // tables of "grain" and "plate"; none: one material
  Vec3 gravity = {};
  bool plane = true;
  std::vector<std::string> settings = {};  // as on the command line

  std::string text() const {
    Vec3 lower = {1, 1, 1}, upper = {-1, -1, -1};
    for (const Grain& g : grains) {
      const Vec3 reach = (4 * g.radius + end * norm(g.velocity) + end * end * norm(gravity)) * Vec3{1, 1, 1};
      const Vec3 below = g.position - reach, above = g.position + reach;
      lower = {std::min(lower.x, below.x), std::min(lower.y, below.y), std::min(lower.z, below.z)};
      upper = {std::max(upper.x, above.x), std::max(upper.y, above.y), std::max(upper.z, above.z)};
    }
    if (plane) lower.z = 0;
    std::string out = fmt::format("gravity = {}\n[space]\ndimension = 3\nmin = {}\nmax = {}\n", toml(gravity),
                                  toml(lower), toml(upper));
    if (plane) out += "z_min = \"wall\"\n";
    if (plane && !materials.empty()) out += "wall_material = \"plate\"\n";
    out += fmt::format("[time]\nend = {}\nstep = {}\n[integrator]\nparticles = \"velocity-verlet\"\n", end,
                       step);
    return out + materials + pairs() + groups();
  }
  Model model() const { return model_of(text(), settings); }

 private:
  std::string pairs() const {
    if (materials.empty()) return "[[contact.pairs]]\n" + law;
    std::string out;
    for (const char* partner : {"grain", "plate"})
      out += fmt::format("[[contact.pairs]]\nmaterials = [\"grain\", \"{}\"]\n", partner) + law;
    return out;
  }
  std::string groups() const {
    std::string out;
    for (std::size_t k = 0; k < grains.size(); ++k) {
      const Grain& g = grains[k];
      out += fmt::format(
          "[[particles]]\nname = \"grain{}\"\nkind = \"list\"\npositions = [{}]\nvelocity = {}\n"
          "angular_velocity = {}\nradius = {}\nmass = {}\n{}",
          k, toml(g.position), toml(g.velocity), toml(g.spin), g.radius, g.mass,
          materials.empty() ? "" : "material = \"grain\"\n");
    }
    return out;
  }
};

// The material of the particles, and a rigid plate.
inline std::string hertz_materials(Real young, Real poisson) {
  return fmt::format(
      "[[materials]]\nname = \"grain\"\nyoung_modulus = {}\npoisson_ratio = {}\n"
      "[[materials]]\nname = \"plate\"\nyoung_modulus = 1e40\npoisson_ratio = {}\n",
      young, poisson, poisson);
}

}  // namespace scree
