// What a step computes while the wrenches of its contacts are not known yet: the bits of the steps do not
// depend on it.
#include <algorithm>

#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/loops.hpp"

using namespace scree;

namespace {

// Wrenches of contacts that begin in step 3, and their stiffness, which only a few steps have.
ContactWrenches contacts_of(const Model& model, int step) {
  ContactWrenches contacts{std::vector<BodyWrench>(model.bodies.size()), {}};
  if (step < 3) return contacts;
  const std::size_t body = model.bodies.size() / 2;
  contacts.wrench[body] = {{0.3 * step, -2, 0.1}, {0.02, 0.01 * step, -0.03}};
  if (step % 7 != 0) return contacts;
  WrenchStiffness stiff{static_cast<int>(body), {}, {}};
  for (const int k : {0, 1, 2}) stiff.stiffness[packed6(k, k)] = 1e4, stiff.damping[packed6(k, k)] = 3;
  contacts.stiffness.push_back(stiff);
  return contacts;
}

// A step as the coupled step takes it, with or without preparation.
void step(MultibodyRun& run, const ContactWrenches& contacts, const std::vector<BodyWrench>& end,
          bool ahead) {
  constexpr Real kStep = 1e-3;
  run.multibody.predict(run.state, run.time, kStep);
  if (ahead) run.multibody.prepare();
  for (int k = 0; k < 3; ++k) run.multibody.correct(contacts);
  if (ahead) run.multibody.begin_accept(run.state);
  run.multibody.accept(run.state, end);
  run.time += kStep;
}

void check_same(const MultibodyState& a, const MultibodyState& b) {
  CHECK(same_bits(a.position, b.position));
  CHECK(same_bits(a.velocity, b.velocity));
  CHECK(same_bits(a.acceleration, b.acceleration));
  CHECK(same_bits(a.multipliers, b.multipliers));
  CHECK(same_bits(a.force, b.force));
  CHECK(same_bits(a.applied, b.applied));
  CHECK(same_bits(a.memory, b.memory));
  CHECK(same_bits(a.dissipated, b.dissipated));
  CHECK(same_bits(a.integrator_loss, b.integrator_loss));
  CHECK(same_bits(a.driver_work, b.driver_work));
}

// A disc on a guide with friction, whose force depends on the reactions.
Model sliding_disc() {
  Model model = empty_model();
  model.integrator.hht_alpha = -0.05;
  model.bodies = {paper_disc("block", 0.3, 0)};
  model.joints = {ground_pin("guide", 0, {0, 0, 0}, {0, 0, 0})};
  model.joints[0].kind = JointKind::translational, model.joints[0].axis = {1, 0, 0};
  JointFriction friction;
  friction.name = "friction", friction.joint = 0, friction.lever = 0.4, friction.stiffness = 1e4;
  model.joint_frictions = {friction};
  return model;
}

// A body whose contacts are in Newton's matrix.
Model top_with_spheres() {
  Model model = spatial_model(-0.05);
  model.bodies = {spatial_body("top", 2, {0.01, 0.01, 0.004}, {0, 0, 0.1})};
  model.bodies[0].spin = {0, 0, 40};
  model.bodies[0].shapes.push_back({{0, 0, 0.05}, 0.03, 0});
  model.joints = {joint_along(model, JointKind::spherical, "tip", kGround, 0, {0, 0, 0}, {0, 0, 1})};
  return model;
}

}  // namespace

TEST_CASE("steps that are prepared before their contacts are known have the same bits") {
  const auto [name, model] = GENERATE(table<std::string, Model>({{"redundant loops", bars(2, false)},
                                                                 {"loops", bars(2, true)},
                                                                 {"net", paper_net()},
                                                                 {"friction", sliding_disc()},
                                                                 {"top", top_with_spheres()}}));
  CAPTURE(name);
  MultibodyRun plain(model), prepared(model);
  for (int i = 0; i < 40; ++i) {
    const ContactWrenches contacts = contacts_of(model, i);
    const std::vector<BodyWrench> end = contacts_of(model, i + i % 2).wrench;
    step(plain, contacts, end, false), step(prepared, contacts, end, true);
  }
  check_same(plain.state, prepared.state);
  CHECK(std::ranges::any_of(plain.state.acceleration, [](Real a) { return a != 0; }));
}

TEST_CASE("a step that was prepared can be left and repeated") {
  const Model model = bars(2, false);
  MultibodyRun plain(model), disturbed(model);
  const ContactWrenches contacts = contacts_of(model, 5);
  for (int i = 0; i < 5; ++i) {
    disturbed.multibody.predict(disturbed.state, disturbed.time, 2e-3);
    disturbed.multibody.prepare();
    step(plain, contacts, contacts.wrench, false), step(disturbed, contacts, contacts.wrench, i % 2 == 0);
  }
  check_same(plain.state, disturbed.state);
}
