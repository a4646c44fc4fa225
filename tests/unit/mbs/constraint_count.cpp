// The model's number of constraint equations, with which checkpoints are compared, is that of the system.
#include "mbs/rigid_body_system.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"

namespace scree {

TEST_CASE("constraints are counted as the system has them, driven or not") {
  const auto is_planar = [](JointKind kind) {
    return kind == JointKind::revolute || kind == JointKind::translational || kind == JointKind::fixed ||
           kind == JointKind::distance;
  };
  for (const Word<BodyKind>& bodies : kWords<BodyKind>)
    for (const Word<JointKind>& kind : kWords<JointKind>)
      for (const bool driven : {false, true}) {
        const bool spatial = bodies.value == BodyKind::spatial;
        if (!spatial && !is_planar(kind.value)) continue;
        if (driven && coordinates_of(kind.value).empty()) continue;
        CAPTURE(bodies.text, kind.text, driven);
        Model model = empty_model();
        model.bodies.push_back(paper_disc("a", 1, 0));
        model.bodies[0].kind = bodies.value;
        model.joints.push_back(ground_pin("joint", 0, {}, {}));
        model.joints[0].kind = kind.value, model.joints[0].distance = 1;
        if (driven) model.drivers.push_back({"driver", 0, {}});
        CHECK(constraint_count(model) == RigidBodySystem(model).constraints());
      }
}

}  // namespace scree
