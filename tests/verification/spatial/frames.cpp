// One mechanism given by centres of mass, points and axes in space, and by frames elsewhere on the bodies
// with markers: the same motion and reactions.
#include <fmt/format.h>

#include <string>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

constexpr Real kSameMotion = 1e-11;  // of numbers of size 1, round-off through 200 steps
constexpr Real kSameForce = 2e-8;    // of forces of size 1 [N]: round-off of positions over h^2 on 2 kg

const std::string kHead =
    "gravity = [0.0, 0.0, -9.81]\n[space]\ndimension = 3\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\n"
    "[time]\nend = 1.0\nstep = 1e-3\ncontrol = \"fixed\"\n[integrator]\nhht_alpha = -0.1\n";

std::string text(Vec3 v) { return fmt::format("[{:.17e}, {:.17e}, {:.17e}]", v.x, v.y, v.z); }
std::string text(const Quaternion& p) {
  return fmt::format("[{:.17e}, {:.17e}, {:.17e}, {:.17e}]", p.w, p.x, p.y, p.z);
}

// Frame of a body in the deck: its axes relative to those of the model's body, and the model's centre of
// mass in it.
struct DeckFrame {
  Quaternion axes;
  Vec3 center;

  Vec3 point(Vec3 own) const { return center + rotated(axes, own); }
};

std::string body_keys(const Body& body, const DeckFrame& frame) {
  const Quaternion p = body.orientation * conjugate(frame.axes);
  const Vec3 arm = rotated(p, frame.center), spin = rotated(body.orientation, body.spin);
  const Sym3& j = body.inertia_tensor;
  return fmt::format(
      "[[bodies]]\nname = \"{}\"\nkind = \"spatial\"\nmass = {}\ninertia_tensor = [{}, {}, {}, 0, 0, 0]\n"
      "inertia_quaternion = {}\ncenter_of_mass = {}\nposition = {}\nvelocity = {}\nquaternion = {}\n"
      "global_angular_velocity = {}\n",
      body.name, body.mass, j.xx, j.yy, j.zz, text(frame.axes), text(frame.center), text(body.position - arm),
      text(body.velocity - cross(spin, arm)), text(p), text(spin));
}

// Each joint between two markers of its own.
std::string marked_deck(const Model& model, const std::vector<DeckFrame>& frames) {
  std::string deck = kHead;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) deck += body_keys(model.bodies[b], frames[b]);
  for (const Joint& joint : model.joints) {
    for (int side = 0; side < 2; ++side) {
      const int body = joint.body[side];
      const DeckFrame frame = body == kGround ? DeckFrame{} : frames[static_cast<std::size_t>(body)];
      const std::string& name =
          body == kGround ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
      deck += fmt::format("[[markers]]\nname = \"{}.{}\"\nbody = \"{}\"\nlocal_point = {}\nquaternion = {}\n",
                          joint.name, side, name, text(frame.point(joint.point[side])),
                          text(frame.axes * joint.marker[side]));
    }
    deck += fmt::format("[[joints]]\nname = \"{0}\"\ntype = \"{1}\"\nmarkers = [\"{0}.0\", \"{0}.1\"]\n",
                        joint.name, word_of(joint.kind));
  }
  return deck;
}

}  // namespace

TEST_CASE("a slider-crank by frames and markers moves as by points and axes") {
  const Model model = slider_crank_in_space(-0.1);
  const std::vector<DeckFrame> frames{{exponential({0.3, -0.8, 1.1}), {0.03, -0.02, 0.05}},
                                      {exponential({-1.3, 0.4, 0.2}), {0.15, 0.01, -0.02}},
                                      {exponential({0, 0, 2}), {}}};
  const Model marked = model_of(marked_deck(model, frames));
  MultibodyRun one(model, 1e-13), two(marked, 1e-13);
  for (int i = 0; i < 10; ++i) {
    one.steps(20, 1e-3), two.steps(20, 1e-3);
    const std::vector<BodyMotion> a = one.multibody.motion(one.state), b = two.multibody.motion(two.state);
    for (std::size_t k = 0; k < a.size(); ++k) {
      CAPTURE(i, k);
      CHECK(norm(a[k].position - b[k].position) < kSameMotion);
      CHECK(norm(a[k].velocity - b[k].velocity) < kSameMotion);
      CHECK(norm(rotation_vector(conjugate(a[k].orientation) * b[k].orientation * frames[k].axes)) <
            kSameMotion);
      CHECK(norm(rotated(frames[k].axes, a[k].spin) - b[k].spin) < 10 * kSameMotion);
    }
    const std::vector<Reaction> f = one.multibody.reactions(one.state, one.time),
                                g = two.multibody.reactions(two.state, two.time);
    for (std::size_t k = 0; k < f.size(); ++k) {
      CAPTURE(i, k, norm(f[k].force), norm(f[k].torque));
      CHECK(norm(f[k].force - g[k].force) < kSameForce);
      CHECK(norm(f[k].torque - g[k].torque) < kSameForce);
      CHECK(norm(rotation_vector(conjugate(f[k].frame) * g[k].frame)) < kSameMotion);
    }
  }
}

// The crank's revolute joint transmits no torque about its axis, the ground's x: the marker's z.
TEST_CASE("reactions along the axes of the joint's first marker") {
  MultibodyRun run(slider_crank_in_space(-0.1), 1e-13);
  run.steps(100, 1e-3);
  const std::vector<Reaction> reactions = run.multibody.reactions(run.state, run.time);
  const Vec3 hinge = rotated(conjugate(reactions[0].frame), reactions[0].torque);
  CHECK(std::abs(hinge.z) < 1e-10);
  CHECK(norm(hinge) > 1e-3);
  // The cross transmits a torque about the axis normal to both its arms alone: the first is x of its marker.
  const Vec3 cross = rotated(conjugate(reactions[2].frame), reactions[2].torque);
  CHECK(std::abs(cross.x) < 1e-10);
  CHECK(norm(cross) > 1e-6);
}

// A body that flips while it spins passes through w = 0 many times.
TEST_CASE("quaternions keep their sign through all rotations") {
  MultibodyRun run(free_body(-0.02), 1e-12);
  Quaternion before = run.multibody.motion(run.state)[0].orientation;
  int changes = 0;
  for (int i = 0; i < 1000; ++i) {
    run.steps(5, 2e-3);
    const Quaternion now = run.multibody.motion(run.state)[0].orientation;
    REQUIRE(dot(before, now) > 0.99);
    changes += (before.w < 0) != (now.w < 0);
    before = now;
  }
  CHECK(changes > 10);
}

// n is rotated by 0.5 rad from m about their common axis.
TEST_CASE("the angle of a joint by markers is that between their x axes") {
  Model model = model_of(
      kHead +
      "[[bodies]]\nname = \"a\"\nkind = \"spatial\"\nposition = [0.0, 0.0, 0.0]\nmass = 2.0\ninertia_tensor "
      "= "
      "[0.2, 0.3, 0.4, 0, 0, 0]\nbody_angular_velocity = [0.0, 0.0, 2.0]\n[[markers]]\nname = \"m\"\nbody = "
      "\"ground\"\n[[markers]]\nname = \"n\"\nbody = \"a\"\nrotation_axis = [0, 0, 1]\nrotation_angle = "
      "0.5\n[[joints]]\nname = \"j\"\ntype = \"revolute\"\nmarkers = [\"m\", \"n\"]\n");
  model.output.history_coordinates = 1;
  MultibodyRun run(model, 1e-13);
  CHECK(std::abs(run.multibody.joint_readings(run.state, 0).front().value - 0.5) < 1e-15);
  run.steps(100, 1e-3);
  CHECK(std::abs(run.multibody.joint_readings(run.state, run.time).front().value - 0.7) < 1e-12);
}

// 6 N along the marker's z axis, which is the body's x and the global y, on 2 kg; in its centre of mass.
TEST_CASE("a force that follows its body acts along its marker") {
  const std::string body =
      "gravity = [0.0, 0.0, 0.0]\n" + kHead.substr(kHead.find("[space]")) +
      "[[bodies]]\nname = \"a\"\nkind = \"spatial\"\nposition = [0.0, 0.0, 0.0]\nx_axis = [0, 1, 0]\nz_axis "
      "= [0, 0, "
      "1]\nmass = 2.0\ninertia_tensor = [0.2, 0.3, 0.4, 0, 0, 0]\ncenter_of_mass = [0.3, 0.0, 0.0]\n"
      "[[markers]]\nname = \"m\"\nbody = \"a\"\nlocal_point = [0.3, 0.0, 0.0]\nz_axis = [1, 0, 0]\n"
      "[[applied_forces]]\nname = \"f\"\nmarker = \"m\"\nfz = 6.0\n";
  const auto moved = [&](const std::string& keys) {
    MultibodyRun run(model_of(body + keys), 1e-13);
    run.steps(100, 1e-3);
    return run.multibody.motion(run.state)[0].position - Vec3{0, 0.3, 0};
  };
  CHECK(norm(moved("follows_body = true\n") - Vec3{0, 0.015, 0}) < 1e-12);
  CHECK(norm(moved("") - Vec3{0, 0, 0.015}) < 1e-12);
}

// Rods with a spherical joint to the next, the first one on the ground.
TEST_CASE("a row of ten bodies on the markers of a chain moves as on points given one by one") {
  const std::string rods = kHead +
                           "[[bodies]]\nname = \"rod\"\nkind = \"spatial\"\ncount = 10\nspacing = [0.1, 0.0, "
                           "0.0]\nposition = [0.0, "
                           "0.0, "
                           "0.0]\nmass = 0.1\ninertia_tensor = [1.1e-5, 8.7e-5, 9.1e-5, 0, 0, 0]\n";
  const std::string centered = "center_of_mass = [0.05, 0.0, 0.0]\n";
  const Model marked = model_of(
      rods + centered +
      "[[markers]]\nname = \"wall\"\nbody = \"ground\"\n[[markers]]\nname = \"root\"\nbody = \"rod.0\"\n"
      "[[markers]]\nname = \"tail\"\nbody = \"rod\"\n[[markers]]\nname = \"tip\"\nbody = "
      "\"rod\"\nlocal_point = "
      "[0.1, "
      "0.0, 0.0]\n[[joints]]\nname = \"root\"\ntype = \"spherical\"\nmarkers = [\"wall\", "
      "\"root\"]\n[[joints]]\nname = \"ball\"\ntype = \"spherical\"\nchain = \"rod\"\nmarkers = [\"tip\", "
      "\"tail\"]\n");
  Model plain = chain20(-0.1);
  plain.bodies.resize(10), plain.joints.resize(10);
  for (Body& body : plain.bodies) body.velocity = body.spin = {};
  MultibodyRun one(plain, 1e-13), two(marked, 1e-13);
  one.steps(200, 1e-3), two.steps(200, 1e-3);
  const std::vector<BodyMotion> a = one.multibody.motion(one.state), b = two.multibody.motion(two.state);
  for (std::size_t k = 0; k < a.size(); ++k) {
    CAPTURE(k);
    CHECK(norm(a[k].position - b[k].position) < 1e-10);
    CHECK(norm(a[k].velocity - b[k].velocity) < 1e-8);
  }
}

// Pendulums side by side, each on its own revolute joint: each moves as a single one.
TEST_CASE("each body of a row hangs on its own revolute joint") {
  const auto pendulums = [](int count) {
    return kHead +
           fmt::format(
               "[[bodies]]\nname = \"arm\"\nkind = \"spatial\"\ncount = {}\nspacing = [0.0, 0.0, "
               "0.0]\nposition = [0.0, 0.0, 0.0]\ncenter_of_mass = [0.05, 0.0, 0.01]\nmass = "
               "0.1\ninertia_tensor = [1.1e-5, 8.7e-5, 9.1e-5, 1e-6, 0, 0]\n[[markers]]\nname = "
               "\"axle\"\nbody = \"ground\"\nz_axis = [0.0, 1.0, 0.0]\n[[markers]]\nname = "
               "\"bush\"\nbody = \"arm\"\nz_axis = [0.0, 1.0, 0.0]\n[[joints]]\nname = \"hinge\"\ntype = "
               "\"revolute\"\neach = \"arm\"\nmarkers = [\"axle\", \"bush\"]\n",
               count);
  };
  MultibodyRun one(model_of(pendulums(1)), 1e-13), ten(model_of(pendulums(10)), 1e-13);
  one.steps(200, 1e-3), ten.steps(200, 1e-3);
  const std::vector<BodyMotion> all = ten.multibody.motion(ten.state);
  REQUIRE(all.size() == 10);
  for (const BodyMotion& arm : all)
    CHECK(norm(arm.position - one.multibody.motion(one.state)[0].position) < kSameMotion);
  CHECK(norm(all[0].position - Vec3{0.05, 0, 0.01}) > 0.05);
}
