// The energy balance of impacts on rotating surfaces.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

// An elastic impact on a spinning free box.
std::string spinning_box(Real step, const std::string& law) {
  return fmt::format(
      "[space]\ndimension = 3\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\n[time]\nend = 0.011\nstep = {}\ncontrol "
      "= "
      "\"fixed\"\n[integrator]\nparticles = \"hht\"\nhht_alpha = 0.0\n[[contact.pairs]]\nstiffness = "
      "1e5\n{}[[meshes]]\nname = "
      "\"box\"\nkind = \"box\"\nsize = [0.3, 0.2, 0.16]\n[[bodies]]\nname = \"box\"\nkind = "
      "\"spatial\"\nposition = [0, 0, 0]\nmass = 2\ninertia_tensor = [0.011, 0.0193, 0.0217, 0, 0, "
      "0]\nglobal_angular_velocity = [0, 0, 40]\nmeshes = [{{ mesh = \"box\" }}]\n[[particles]]\nname = "
      "\"ball\"\nkind = \"list\"\npositions = [[0.1801, 0.05, 0]]\nradius = 0.03\nmass = 0.3\nvelocity = "
      "[-4, "
      "0, 0]\n",
      step, law);
}

// A disc on a line that oscillates 20 times a second.
std::string swinging_line(const std::string& control, const std::string& law) {
  return fmt::format(
      "gravity = [0, -9.81]\n[space]\ndimension = 2\nmin = [-1, -1]\nmax = [1, 1]\nleaving = "
      "\"ballistic\"\n[time]\nend = "
      "0.1\n{}[integrator]\nparticles = \"hht\"\n[[contact.pairs]]\nstiffness = 1e4\ndamping = "
      "1\n{}[[walls]]\nname = \"line\"\npoint = [0, 0]\nnormal = [0, 1]\nmotions = [{{ type = \"rotation\", "
      "point = [0, 0], angle = {{ kind = \"sine\", amplitude = 0.3, frequency = 20 }} "
      "}}]\n[[particles]]\nname "
      "= \"disc\"\nkind = \"list\"\npositions = [[0.2, 0.021]]\nradius = 0.02\nmass = 0.1\nvelocity = [0.3, "
      "-1]\n",
      control, law);
}

}  // namespace

TEST_CASE(
    "an impact on a spinning free box is accounted for to round-off, and its energy kept at second order") {
  Real taken[2];
  for (const int fine : {0, 1}) {
    SimulationRun run(model_of(spinning_box(fine == 0 ? 5e-4 : 2.5e-4, "")));
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);  // it has rebounded
    REQUIRE(run.particles()[0].velocity.x > 0);
    CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-10, .measured = 1e-11}));
    taken[fine] = std::abs(run.ledger().dissipated_integrator);
  }
  CAPTURE(taken[0], taken[1]);
  CHECK(taken[1] < 2e-4);
  CHECK(taken[0] > 3 * taken[1]);
  SimulationRun frictional(model_of(spinning_box(2.5e-4, "friction = 0.3\n")));
  frictional.run();
  CHECK(keeps(frictional.balance_error() / frictional.exchanged(), {.promise = 1e-10, .measured = 1e-11}));
}

TEST_CASE(
    "the work of a swinging line on a disc is accounted for to round-off, in fixed and adaptive steps") {
  for (const std::string control : {"step = 1e-3\ncontrol = \"fixed\"\n", "step = 1e-4\n"})
    for (const std::string law : {"", "friction = 0.4\ntangential_damping_ratio = 0.2\n"}) {
      CAPTURE(control, law);
      SimulationRun run(model_of(swinging_line(control, law)));
      run.run();
      CHECK(run.exchanged() > 1);
      CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-12, .measured = 1e-14}));
    }
}

}  // namespace scree
