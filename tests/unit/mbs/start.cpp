// The start of a multibody system: refusals, reports of failures, and consistent velocities.
#include <petscsys.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"
#include "unit/mbs/refusals.hpp"

using namespace scree;

namespace {

constexpr Real kRoundOff = 16 * kUlp;  // of the solution of a few equations

}  // namespace

TEST_CASE("joints whose sides do not meet are named with their gap") {
  Model model = hanging_disc();
  model.joints[0].point[0] = {0, 0.03, 0};
  CHECK(contains(refusal(model), "joint 'pivot'"));
  CHECK(contains(refusal(model), "0.03 m"));
  model.joints[0].point[0] = {0, 3e-9, 0};
  CHECK(contains(refusal(model), "their distance is 3e-09 m, allowed is 1e-09 m"));
  model.joints[0].point[0] = {0, 9e-10, 0};  // the tolerance equals that for decks
  CHECK(refusal(model) == "nothing was refused");
  model = hanging_disc();
  model.joints[0].kind = JointKind::fixed;
  model.joints[0].angle_offset = 0.25;
  CHECK(contains(refusal(model), "0.25 rad"));
}

TEST_CASE("start velocities that contradict a joint or driver are refused") {
  Model model = hanging_disc();
  model.bodies[0].velocity = {0.2, 0, 0};
  CHECK(contains(refusal(model), "joint 'pivot'"));
  CHECK(contains(refusal(model), "0.2 m/s"));
  model.bodies[0].velocity = {0, 1, 0};
  model.bodies[0].angular_velocity = 2;
  CHECK(refusal(model) == "nothing was refused");
  TimeFunction turn;
  turn.kind = TimeFunction::Kind::ramp;
  turn.rate = 2.5;
  model.drivers.push_back({"motor", 0, turn});
  CHECK(contains(refusal(model), "driver 'motor'"));
  CHECK(contains(refusal(model), "0.5 rad/s"));
  model.drivers[0].motion.rate = 2;
  CHECK(refusal(model) == "nothing was refused");
  model.drivers[0].motion.value = -0.1;
  CHECK(contains(refusal(model), "0.1 rad"));
}

TEST_CASE("the refusal of start velocities names the keys and values to set, with all digits") {
  Model model = hanging_disc();
  model.space.dimension = 2;
  model.drivers.push_back({"motor", 0, ramp(1.85)});
  CHECK(contains(
      refusal(model),
      "driver 'motor': the velocities at t = 0 contradict it by 1.85 rad/s, allowed is 1e-08 rad/s; set "
      "bodies.bob.velocity = [0.0, 0.925], bodies.bob.angular_velocity = "
      "1.85, or velocities = \"consistent\" at the top of the deck"));
  // The stated velocity is accepted.
  model.bodies[0].velocity = {0, 0.925, 0};
  CHECK(contains(refusal(model), "set bodies.bob.angular_velocity = 1.85, or"));
  model.bodies[0].angular_velocity = 1.85;
  CHECK(refusal(model) == "nothing was refused");
  model.bodies[0].velocity.x = 0.3;
  CHECK(contains(refusal(model), "set bodies.bob.velocity = [0.0, 0.925], or"));
  model.space.dimension = 3;
  CHECK(contains(refusal(model), "bodies.bob.velocity = [0.0, 0.925, 0.0], or"));
  model.bodies[0].in_row = true;  // its keys are those of the whole row
  CHECK(contains(refusal(model), "; set velocities = \"consistent\" at the top of the deck"));
}

// The deck gives the velocity of the frame's origin.
TEST_CASE("the keys to set are of the frame's origin where that is beside the centre of mass") {
  Model model = hanging_disc();
  model.space.dimension = 2;
  model.drivers.push_back({"motor", 0, ramp(2)});
  model.bodies[0].center_of_mass = {0.5, 0.25, 0};  // the centre moves at (0, 1)
  CHECK(contains(refusal(model),
                 "set bodies.bob.velocity = [0.5, 0.0], bodies.bob.angular_velocity = 2.0, or velocities"));
}

TEST_CASE("consistent start velocities change the given ones least in the norm of M") {
  // The pivot at (-0.5, 0) in the disc's frame leaves the motion (0, 1/2, 1) w: with the masses (1, 1, J) the
  // nearest to (u, v, s) has w = (v/2 + J s)/(1/4 + J).
  Model model = hanging_disc();
  model.consistent_velocities = true;
  model.bodies[0].velocity = {3, 0.4, 0};
  model.bodies[0].angular_velocity = -2;
  petsc();
  Multibody swinging(model);
  const Real w = (0.2 - 2 * 0.005) / (0.25 + 0.005);
  MultibodyState state = swinging.initial_state(std::vector<BodyWrench>(1));
  CHECK(near(state.velocity[0], 0, {.absolute = kRoundOff}));
  CHECK(near(state.velocity[1], w / 2, {.relative = kRoundOff}));
  CHECK(near(state.velocity[2], w, {.relative = kRoundOff}));
  CHECK(near(state.acceleration[0], -w * w / 2, {.relative = kRoundOff}));  // with the new velocity
  CHECK(contains(swinging.start_change(), "x component of the velocity of body 'bob' (id 0) from 3.0 to "));
  // A driver leaves no choice; free bodies keep their velocities.
  model.drivers.push_back({"motor", 0, ramp(1.85)});
  model.bodies.push_back(paper_disc("free", 3, 0));
  model.bodies[1].velocity = {0.1, -0.2, 0};
  Multibody driven(model);
  state = driven.initial_state(std::vector<BodyWrench>(2));
  CHECK(near(state.velocity[1], 0.925, {.relative = kRoundOff}));
  CHECK(near(state.velocity[2], 1.85, {.relative = kRoundOff}));
  CHECK(state.velocity[3] == 0.1);
  CHECK(state.velocity[4] == -0.2);
  CHECK(near(driven.energies(state, 0).kinetic, (0.925 * 0.925 + 0.005 * 1.85 * 1.85 + 0.01 + 0.04) / 2,
             {.relative = kRoundOff}));
  // Consistent velocities are unchanged.
  model.bodies[0].velocity = {0, 0.925, 0};
  model.bodies[0].angular_velocity = 1.85;
  Multibody same(model);
  state = same.initial_state(std::vector<BodyWrench>(2));
  CHECK(state.velocity[1] == 0.925);
  CHECK(state.velocity[2] == 1.85);
  CHECK(same.start_change().empty());
  // Redundant constraints are refused as without consistent velocities.
  model.drivers.push_back({"second", 0, ramp(1.85)});
  CHECK(contains(refusal(model), "driver 'motor', driver 'second'"));
}

TEST_CASE("elements that make no sense are refused by name") {
  Model model = hanging_disc();
  model.joints[0].kind = JointKind::fixed;
  model.drivers.push_back({"motor", 0, {}});
  CHECK(contains(refusal(model), "driver 'motor': joint 'pivot' is fixed"));
  model = hanging_disc();
  model.joints[0].kind = JointKind::distance;
  model.joints[0].point[1] = {0, 0, 0};
  CHECK(contains(refusal(model), "joint 'pivot': distance 0 m"));
  model = hanging_disc();
  model.spring_dampers.push_back({"spring", {kGround, 0}, {{0.5, 0.1, 0}, {0, 0.1, 0}}, 10, 0, 1, {}});
  CHECK(contains(refusal(model), "spring-damper 'spring'"));
}

TEST_CASE("the start has consistent accelerations and multipliers") {
  // A disc that swings past its lowest point: moment about the pivot, and the centripetal force.
  Model model = hanging_disc();
  model.bodies[0].angular_velocity = 2;
  model.bodies[0].velocity = {0, 1, 0};
  petsc();
  Multibody multibody(model);
  std::vector<BodyWrench> wrench(1);
  wrench[0].torque.z = 0.3;
  const MultibodyState state = multibody.initial_state(wrench);
  const Real angular = (0.3 - kGravity * 0.5) / (0.005 + 0.25);
  CHECK(near(state.acceleration[2], angular, {.relative = kRoundOff}));
  CHECK(near(state.acceleration[0], -0.5 * 4, {.relative = kRoundOff}));
  CHECK(near(state.acceleration[1], 0.5 * angular, {.relative = kRoundOff}));
  const std::vector<Reaction> reactions = multibody.reactions(state, 0);
  REQUIRE(reactions.size() == 1);
  CHECK(reactions[0].joint == "pivot");
  CHECK(near(reactions[0].force.x, -2, {.relative = kRoundOff}));
  CHECK(near(reactions[0].force.y, 0.5 * angular + kGravity, {.absolute = kRoundOff * kGravity}));
  CHECK(near(state.force[1], 0.5 * angular, {.relative = kRoundOff}));
  CHECK(state.applied[1] == -kGravity);
}

TEST_CASE("a singular matrix names the body that has no inertia") {
  Model model = empty_model();
  model.bodies = {paper_disc("solid", 0, 0), paper_disc("ghost", 1, 0)};
  model.bodies[1].inertia = 0;
  petsc();
  Multibody multibody(model);
  const std::string text =
      message_of<SimulationError>([&] { multibody.initial_state(std::vector<BodyWrench>(2)); });
  CHECK(contains(text, "mbs_correct, rank 0"));
  CHECK(contains(text, "singular"));
  CHECK(contains(text, "body 'ghost' (id 1)"));
  CHECK(!contains(text, "solid"));
}

TEST_CASE(
    "a wrench that is not a number stops the step by the body's name, and the step can be taken again") {
  petsc();
  Multibody multibody(closed_chain());
  ContactWrenches contacts{std::vector<BodyWrench>(2), {}};
  MultibodyState state = multibody.initial_state(contacts.wrench);
  const MultibodyState before = state;
  multibody.predict(state, 0, 1e-3);
  contacts.wrench[1].force.x = std::numeric_limits<Real>::quiet_NaN();
  CHECK(contains(message_of<SimulationError>([&] { multibody.correct(contacts); }), "body 'two' (id 1)"));
  contacts.wrench[1] = {};
  contacts.stiffness.resize(1);  // of body 0
  contacts.stiffness[0].stiffness[packed6(0, 0)] = std::numeric_limits<Real>::quiet_NaN();
  multibody.predict(state, 0, 1e-3);
  CHECK(contains(message_of<SimulationError>([&] { multibody.correct(contacts); }),
                 "not finite at body 'one' (id 0)"));
  CHECK(same_bits(state.position, before.position));
  contacts.stiffness.clear();
  multibody.predict(state, 0, 1e-3);
  for (int i = 0; i < 5; ++i) multibody.correct(contacts);
  CHECK(multibody.correct(contacts).residual < 1e-12);
}

// The rows of parallel axes are satisfied there, too.
TEST_CASE("a spatial revolute joint with opposite axes is refused") {
  Model model = spatial_model(-0.1);
  model.bodies = {spatial_body("flap", 1, {1, 1, 1}, {})};
  model.joints = {joint_at(JointKind::revolute, "hinge", kGround, 0, {}, {})};
  model.joints[0].marker[1] = exponential({M_PI, 0, 0});
  CHECK(contains(refusal(model), "joint 'hinge': its axes on the two bodies are opposite"));
  model.joints[0].marker[1] = exponential({0, 0, 3});
  model.drivers = {{"drive", 0, {}}};
  CHECK(contains(refusal(model), "driver 'drive': its motion and the joint's coordinate at t = 0 differ by"));
  model.drivers[0].motion.value = 3;
  CHECK(refusal(model) == "nothing was refused");
}

TEST_CASE("PETSc's options: words that are none, unused ones, packages") {
  CHECK(contains(message_of<InputError>([] { const PetscSession refused("test", {"ksp_view"}); }),
                 "'ksp_view'"));
  CHECK(petsc().unused_options() == std::vector<std::string>{"-mbs_misspelt 7"});
  CHECK(contains(petsc_version(), "."));
  const auto set = [](const char* value) {
    PetscOptionsSetValue(nullptr, "-mbs_pc_factor_mat_solver_type", value);
  };
  Multibody default_solver(paper_net());
  const MultibodyState expected = default_solver.initial_state(std::vector<BodyWrench>(20));
  CHECK(contains(default_solver.solver_description(), "preonly + lu ("));
  for (const std::string package : {"klu_refactor", "klu", "superlu", "umfpack", "mumps", "petsc"}) {
    set(package.c_str());
    const std::string text = message_of<InputError>([&] {
      MultibodyRun run(paper_net());
      CHECK(contains(run.multibody.solver_description(), "(" + package + ")"));
      for (std::size_t i = 0; i < expected.acceleration.size(); ++i) {
        CHECK(near(run.state.acceleration[i], expected.acceleration[i], {.absolute = kRoundOff * kGravity}));
      }
      run.steps(20, 1e-3);
      CHECK(run.most_iterations <= 3);
    });
    // A PETSc without this package refuses it.
    if (text != "nothing was refused") CHECK(contains(text, "this PETSc has no such LU"));
  }
  set("nonsense");
  CHECK(contains(refusal(paper_net()), "-mbs_pc_factor_mat_solver_type nonsense"));
  PetscOptionsClearValue(nullptr, "-mbs_pc_factor_mat_solver_type");
}
