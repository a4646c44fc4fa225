// A static column of discs on a floor.
#include <cmath>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

// Contact j from the bottom, j = 1 .. n, bears n - j + 1 discs.
TEST_CASE("the overlaps of a static column of discs bear the weight above them") {
  constexpr Real kRoundOff = 1e-9;  // of overlaps of 1e-5 m: positions of 1 m carry 1e-16
  for (const std::string integrator : {"hht", "velocity-verlet"}) {
    // A residual of 1e-8 would let the column oscillate by 1e-6 of its overlaps.
    const Model model = input_model(
        "examples/column.toml",
        {"time.end=6", "integrator.particles=" + integrator, "integrator.residual_tolerance=1e-13"});
    SimulationRun run(model);
    run.run();
    const std::vector<Particle> discs = run.particles();
    const Real n = static_cast<Real>(discs.size()), weight = model.particles.mass[0] * norm(model.gravity);
    REQUIRE(discs.size() == 10);
    Real top_of_below = 0;
    for (std::size_t j = 0; j < discs.size(); ++j) {
      const Real radius = model.particles.radius[j], y = discs[j].position.y;
      const Real overlap = top_of_below - (y - radius);
      const Real exact = (n - static_cast<Real>(j)) * weight / model.contact.law(0, 0).normal_stiffness;
      CAPTURE(integrator, j, overlap, exact);
      CHECK(keeps(overlap / exact - 1, {.promise = kRoundOff, .measured = 1.6e-11}));
      CHECK(keeps(norm(discs[j].velocity), {.promise = kRoundOff, .measured = 2e-12}));
      top_of_below = y + radius;
    }
    CHECK(run.particle_ledger().contacts == 10);
  }
}
