// Bodies outside the domain are counted by their centres.
#include "run/report/bodies_outside.hpp"

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

TEST_CASE("bodies are outside where their centres are, beyond walls and open sides") {
  const Model model = model_of(kSmallDeck + R"([[bodies]]
name = "row"
count = 4
mass = 1.0
inertia = 0.01
position = [0.0, 0.0]
)",
                               {"space.x_min=periodic", "space.x_max=periodic", "space.y_min=wall"});
  MultibodyState state;
  CHECK(bodies_outside(model, state).count == 0);
  state.position = {0, 0, 0, 5, 0, 0, 0, 1, 0, 0, -1, 0};  // x, y, angle: one far along the periodic axis
  CHECK(bodies_outside(model, state).count == 0);
  state.position[10] = -1.001;
  CHECK(bodies_outside(model, state).count == 1);
  CHECK(bodies_outside(model, state).first == 3);
  state.position[7] = 1.001;
  CHECK(bodies_outside(model, state).count == 2);
  CHECK(bodies_outside(model, state).first == 2);
}

}  // namespace scree
