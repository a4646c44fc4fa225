// Redundant constraints with minimum-norm reactions: the motion is that of a mechanism without redundant
// ones, the reactions have the least norm, and singular positions are passed.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // a false warning of GCC 12 in Eigen's AVX-512 header
#include <Eigen/Dense>
#pragma GCC diagnostic pop
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mbs/rigid_body_system.hpp"
#include "mbs/row_compliance.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/loops.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

constexpr Real kCompliance =
    1e-8;                      // of the motion, relative: more than the relative compliance of the rows, 1e-9
constexpr Real kLeast = 1e-6;  // of the multipliers: round-off over that compliance

Real difference(const std::vector<BodyMotion>& one, const std::vector<BodyMotion>& other) {
  Real largest = 0;
  for (std::size_t b = 0; b < one.size(); ++b) {
    const Real turn = norm(rotation_vector(conjugate(one[b].orientation) * other[b].orientation));
    largest = std::max({largest, turn, norm(one[b].position - other[b].position),
                        norm(one[b].velocity - other[b].velocity), norm(one[b].spin - other[b].spin)});
  }
  return largest;
}

std::vector<BodyMotion> motion_of(const MultibodyRun& run) { return run.multibody.motion(run.state); }

// Phi_q and M^-1 at a state, and sqrt(S).
struct Matrices {
  Matrices(const Model& model, const MultibodyState& state, Real t) : system(model) {
    SystemTerms terms;
    terms.applied_force.assign(static_cast<std::size_t>(system.coordinates()), 0);
    terms.constraint.assign(static_cast<std::size_t>(system.constraints()), 0);
    system.evaluate({t, state.position, state.velocity}, terms);
    jacobian = dense(terms.constraint_jacobian, system.constraints(), system.coordinates());
    inverse_mass = dense(system.inverse_mass(), system.coordinates(), system.coordinates());
    weight = (jacobian * inverse_mass * jacobian.transpose()).diagonal();
    for (const Real gap : terms.constraint) largest_gap = std::max(largest_gap, std::abs(gap));
  }
  static Eigen::MatrixXd dense(const SparseTerm& term, int rows, int columns) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, columns);
    for (std::size_t i = 0; i < term.size(); ++i) out(term.row(i), term.column(i)) += term.value(i);
    return out;
  }

  RigidBodySystem system;
  Eigen::MatrixXd jacobian, inverse_mass;
  Eigen::VectorXd weight;  // S
  Real largest_gap = 0;
};

// The lambda with the least norm of S among those with these forces Phi_q^T lambda, by singular values.
Eigen::VectorXd least(const Matrices& m, const Eigen::VectorXd& force) {
  const Eigen::VectorXd root = m.weight.cwiseSqrt();
  const Eigen::MatrixXd scaled = (root.cwiseInverse().asDiagonal() * m.jacobian).transpose();
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(1e-9);
  return root.cwiseInverse().asDiagonal() * svd.solve(force);
}

Eigen::VectorXd vector(const std::vector<Real>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

// Runs both side by side: their motion is the same, and the multipliers of the redundant one are the
// minimum-norm ones of all that give the exact one's forces.
void check_shared(const Model& shared, const Model& exact, Real h, Real span) {
  MultibodyRun one(shared, 1e-12), other(exact, 1e-12);
  Real apart = 0;
  for (int i = 1; i <= static_cast<int>(std::lround(span / h)); ++i) {
    one.step(h), other.step(h);
    apart = std::max(apart, difference(motion_of(one), motion_of(other)));
    if (i % 50 != 0) continue;
    const Matrices m(shared, one.state, one.time), n(exact, other.state, other.time);
    const Eigen::VectorXd lambda = vector(one.state.multipliers),
                          force = n.jacobian.transpose() * vector(other.state.multipliers),
                          best = least(m, force);
    CAPTURE(one.time);
    CHECK(measured("loops/reactions", "",
                   at_most((m.jacobian.transpose() * lambda - force).norm() / force.norm(), kLeast)));
    CHECK(measured("loops/reactions", "", at_most((lambda - best).norm() / best.norm(), kLeast)));
    CHECK(m.largest_gap < 1e-11);
  }
  CHECK(measured("loops/motion", "", at_most(apart, kCompliance)));
  // The reactions of the exact joints, which differ.
  const Reaction shares = one.multibody.reactions(one.state, one.time)[0],
                 carries = other.multibody.reactions(other.state, other.time)[0];
  CHECK(norm(shares.torque - carries.torque) > 0.1);
}

// Largest distance of the first bar's centre from its exact position.
Real error_of_bars(const Model& model, int loops, Real h, Real span, Real tolerance = 1e-10) {
  MultibodyRun run(model, tolerance);
  FallingBars bars(loops + 1, loops);
  Real worst = 0;
  for (int i = 0; i < static_cast<int>(std::lround(span / h)); ++i) {
    run.step(h);
    const Real angle = bars.angle(run.time);
    worst =
        std::max(worst, norm(motion_of(run)[0].position - Vec3{std::cos(angle) / 2, std::sin(angle) / 2, 0}));
  }
  return worst;
}

}  // namespace

TEST_CASE(
    "a four-bar with four spatial revolute joints moves as with exact joints and has minimum-norm "
    "reactions") {
  Model shared = bars(1, false), exact = bars(1, true), other = bars(1, false);
  other.integrator.redundant = RedundantRows::error;  // with other joints that are not redundant
  other.joints[0].kind = JointKind::cylindrical, other.joints[2].kind = JointKind::spherical;
  for (Model* model : {&shared, &exact, &other})
    model->gravity.z = 4;  // a transverse load, which all revolute joints may carry
  check_shared(shared, exact, 1e-3, 1);
  check_shared(shared, other, 1e-3, 0.5);
}

TEST_CASE("bars in a row pass their flat position on the right branch, to second order") {
  for (const int loops : {1, 2, 4}) {
    const Real coarse = error_of_bars(bars(loops, false), loops, 2e-3, 1.5),
               fine = error_of_bars(bars(loops, false), loops, 1e-3, 1.5);
    CAPTURE(loops, coarse, fine);
    CHECK(measured("bars/position", "m", at_most(fine, 2e-5)));
    CHECK(measured("bars/order", "", in_range(std::log2(coarse / fine), 1.95, 2.05)));
  }
  CHECK(measured("bars/forty", "m", at_most(error_of_bars(bars(40, false), 40, 1e-3, 0.8, 1e-8), 5e-6)));
}

TEST_CASE("Bricard's linkage moves as with an exact joint, through the published positions") {
  check_shared(bricard(false), bricard(true), 1e-3, 0.5);
  MultibodyRun run(bricard(false), 1e-9);
  CHECK(run.multibody.redundancy().starts_with("30 rows of rank 29: joint 'hinge.0', "));
  const std::vector<BodyMotion> start = motion_of(run);
  Vec3 lowest, highest{-1, -1, -1};  // of the end of the second link
  Real nearest = kInfinity, period = 0;
  while (run.time < 5.2) {
    run.step(4e-3);
    const std::vector<BodyMotion> now = motion_of(run);
    const Vec3 end = now[1].position + rotation_matrix(now[1].orientation) * Vec3{0.5, 0, 0};
    lowest = {std::min(lowest.x, end.x), std::min(lowest.y, end.y), std::min(lowest.z, end.z)};
    highest = {std::max(highest.x, end.x), std::max(highest.y, end.y), std::max(highest.z, end.z)};
    Real off = 0;
    for (std::size_t b = 0; b < now.size(); ++b) off += norm(now[b].position - start[b].position);
    if (run.time > 4 && off < nearest) nearest = off, period = run.time;
  }
  CHECK(norm(lowest - Vec3{-1, -1, -0.5}) < 2e-4);
  CHECK(norm(highest - Vec3{1, -std::sqrt(Real(0.75)), 0}) < 2e-4);
  CHECK(near(period, 4.99, {.absolute = 0.01}));
}

// Nothing is redundant here, so that nothing may change. The yielding of a row is relative to the mobility
// of its own bodies, which is a large part of that of both together where the load is heavy.
TEST_CASE("a light link that carries a heavy load yields nothing") {
  Model model = spatial_model(-0.1);
  model.gravity = {0, 0, -kFall};
  model.bodies = {spatial_body("link", 0.01, {3e-4, 3e-4, 3e-4}, {0.3, 0, -0.1}),
                  spatial_body("load", 1000, {30, 30, 30}, {1, -0.1, -0.1})};
  model.joints = {joint_at(JointKind::revolute, "top", kGround, 0, {}, {-0.3, 0, 0.1}),
                  joint_at(JointKind::revolute, "low", 0, 1, {0.3, 0, -0.1}, {-0.4, 0.1, -0.1})};
  for (std::size_t side = 0; side < 2; ++side)  // axes that are not parallel
    model.joints[0].marker[side] = exponential({1.3, 0.2, 0}),
    model.joints[1].marker[side] = exponential({1.7, -0.1, 0});
  Model shares = model;
  shares.integrator.redundant = RedundantRows::share;
  MultibodyRun one(shares, 1e-11), other(model, 1e-11);
  const auto apart = [&] {
    return (vector(one.state.multipliers) - vector(other.state.multipliers)).norm() /
           vector(other.state.multipliers).norm();
  };
  CHECK(apart() < 1e-7);
  Real largest = 0;
  for (int i = 0; i < 500; ++i) {
    one.step(1e-3), other.step(1e-3);
    largest = std::max(largest, apart());
  }
  CHECK(largest < 1e-6);
  CHECK(difference(motion_of(one), motion_of(other)) < kCompliance);
}

TEST_CASE("Bricard's linkage converges with second order") {
  const auto end = [](Real h) {
    MultibodyRun run(bricard(false), 1e-12);
    run.steps(static_cast<int>(std::lround(0.8 / h)), h);
    return motion_of(run);
  };
  const std::vector<BodyMotion> one = end(2e-3), two = end(1e-3), three = end(5e-4);
  const Real order = std::log2(difference(one, two) / difference(two, three));
  CHECK(order > 1.95);
  CHECK(order < 2.05);
}

// The parallelogram with a third rocker of planar bodies.
TEST_CASE("redundant planar joints have minimum-norm reactions, too") {
  Model model = empty_model();
  model.gravity = {0, -kFall, 0};
  model.integrator.hht_alpha = -0.1;
  const auto add = [&](const std::string& name, Vec3 from, Vec3 to, Vec3 velocity, Real spin) {
    Body body;
    body.name = name, body.mass = 1, body.inertia = 1.0 / 12;
    body.position = Real(0.5) * (from + to), body.velocity = velocity, body.angular_velocity = spin;
    model.bodies.push_back(body);
  };
  for (int i = 0; i < 3; ++i)
    add("rocker." + std::to_string(i), {i / 2.0, 0, 0}, {i / 2.0, 1, 0}, {0.5, 0, 0}, -1);
  add("coupler", {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, 0);
  for (int i = 0; i < 3; ++i) {
    model.joints.push_back(ground_pin("foot." + std::to_string(i), i, {i / 2.0, 0, 0}, {0, -0.5, 0}));
    model.joints.push_back(ground_pin("top." + std::to_string(i), 3, {0, 0.5, 0}, {i / 2.0 - 0.5, 0, 0}));
    model.joints.back().body[0] = i;
  }
  petsc();
  CHECK_THROWS_AS(Multibody(model), InputError);
  model.integrator.redundant = RedundantRows::share;
  CHECK(Multibody(model).redundancy().starts_with("12 rows of rank 11: "));
  const auto error = [&](Real h) {
    MultibodyRun run(model, 1e-11);
    FallingBars bars(3, 1);
    Real worst = 0;
    while (run.time < 1.5) {
      run.step(h);
      worst = std::max(worst, std::abs(run.x(0) - std::cos(bars.angle(run.time)) / 2));
    }
    const Matrices m(model, run.state, run.time);
    const Eigen::VectorXd lambda = vector(run.state.multipliers),
                          best = least(m, m.jacobian.transpose() * lambda);
    CHECK((lambda - best).norm() < kLeast * best.norm());
    return worst;
  };
  const Real coarse = error(2e-3), fine = error(1e-3);
  CAPTURE(coarse, fine);
  CHECK(fine < 2e-5);
  CHECK(std::log2(coarse / fine) > 1.95);
  CHECK(std::log2(coarse / fine) < 2.05);
}

// The digits of a deck leave gaps far above the yielding of redundant rows.
TEST_CASE("a gap in redundant rows alone loads nothing") {
  Model model = bars(1, false);
  const Model exact = model;
  model.joints[3].point[0].z += 5e-10;  // along the revolute joint
  model.joints[0].marker[0] = exponential({3e-11, 0, 0}) * model.joints[0].marker[0];
  for (const Real h : {1e-3, 1e-5}) {
    const auto multipliers = [&](const Model& start) {
      petsc();
      Multibody multibody(start);
      const ContactWrenches none{std::vector<BodyWrench>(start.bodies.size()), {}};
      MultibodyState state = multibody.initial_state(none.wrench);
      for (int i = 0; i < 200; ++i) {  // until the initial jump has decayed
        multibody.predict(state, i * h, h);
        for (int k = 0; k < 4; ++k) multibody.correct(none);
        multibody.accept(state, none.wrench);
      }
      return vector(state.multipliers);
    };
    const Eigen::VectorXd lambda = multipliers(exact), other = multipliers(model);
    CAPTURE(h, lambda, other);
    CHECK((other - lambda).norm() < 5e-5 * lambda.norm());  // round-off over h^2
  }
}

TEST_CASE("a linkage keeps its joints closed and its energy balanced over 100,000 steps") {
  const Model model = bricard(false);
  MultibodyRun run(model, 1e-10);
  const auto balance = [&] {
    const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
    return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
           run.state.driver_work;
  };
  const Real start = balance();
  Real gap = 0, loss = 0, off = 0;
  for (int thousand = 0; thousand < 100; ++thousand) {
    run.steps(1000, 1e-3);
    gap = std::max(gap, Matrices(model, run.state, run.time).largest_gap);
    off = std::max(off, std::abs(balance() - start));
    loss = std::max(loss, std::abs(run.state.integrator_loss));
  }
  CAPTURE(gap, off, loss);
  CHECK(measured("loops/gap", "m", at_most(gap, 1e-11)));
  CHECK(loss < 1.5e-5);  // [J]; 9.0e-6 measured, of 40 J exchanged
  CHECK(off < 1e-12);
}

TEST_CASE("minimum-norm reactions continue from a state with the same bits") {
  for (const Model& model : {bars(2, false), bars(6, false), bricard(false)}) {
    MultibodyRun whole(model), second(model);
    whole.steps(100, 1e-3);
    second.state = whole.state, second.time = whole.time;
    whole.steps(100, 1e-3), second.steps(100, 1e-3);
    CHECK(same_bits(whole.state.position, second.state.position));
    CHECK(same_bits(whole.state.velocity, second.state.velocity));
    CHECK(same_bits(whole.state.multipliers, second.state.multipliers));
  }
}

// With an axis slightly off its loop has rank 18, in exact arithmetic, with a row close to a combination of
// others, which must not hide the two that are dependent.
TEST_CASE("a loop with an axis that is a little off is refused, too") {
  petsc();
  for (const Real off : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    Model model = bars(1, false);
    model.integrator.redundant = RedundantRows::error;
    Joint& last = model.joints.back();
    last.marker[0] = last.marker[0] * exponential({off, 0, 0});
    last.marker[1] = last.marker[1] * exponential({off, 0, 0});
    std::string text;
    try {
      const Multibody refused(model);
    } catch (const InputError& error) {
      text = error.what();
    }
    INFO(off << ": " << text);
    CHECK(text.find("20 rows have rank 18") != std::string::npos);
  }
}

TEST_CASE("the refusal of a loop of revolute joints names a remedy that works") {
  Model model = bars(1, false);
  model.integrator.redundant = RedundantRows::error;
  petsc();
  std::string text;
  try {
    const Multibody refused(model);
  } catch (const InputError& error) {
    text = error.what();
  }
  CHECK(
      text ==
      "redundant constraints: joint 'foot.0', joint 'left.0', joint 'foot.1', joint 'right.1' fix the same "
      "motion more than once, 20 rows have rank 17; the motion is unique, the reactions of these are not. "
      "Remove or change one; or set integrator.redundant = \"minimum-norm\" for minimum-norm reactions; or, "
      "for the "
      "same "
      "motion without any, make joint 'foot.0' spherical and joint 'right.1' cylindrical");
  model.joints.front().kind = JointKind::spherical, model.joints.back().kind = JointKind::cylindrical;
  CHECK_NOTHROW(Multibody(model));
}
