// Bushings between spatial bodies against closed forms.
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

Bushing bushing_between(int first, int second, Vec3 on_first, Vec3 on_second) {
  Bushing bushing;
  bushing.name = "bushing";
  bushing.body[0] = first, bushing.body[1] = second;
  bushing.point[0] = on_first, bushing.point[1] = on_second;
  return bushing;
}

Matrix6 diagonal(const std::array<Real, 6>& entries) {
  Matrix6 a{};
  for (std::size_t i = 0; i < 6; ++i) a[i][i] = entries[i];
  return a;
}

// Positive definite: B B^T + 1, times `size` along the translations and the rotations.
Matrix6 crowded(Real translation, Real rotation) {
  Matrix6 a{};
  const auto size = [&](std::size_t i) { return std::sqrt(i < 3 ? translation : rotation); };
  const auto b = [](std::size_t i, std::size_t k) {
    return 0.5 * std::sin(1.0 + 2.3 * double(i) + 0.7 * double(i * k));
  };
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) {
      Real sum = i == j ? 1 : 0;
      for (std::size_t k = 0; k < 6; ++k) sum += b(i, k) * b(j, k);
      a[i][j] = size(i) * sum * size(j);
    }
  return a;
}

using Vector6 = std::array<Real, 6>;

Vector6 times(const Matrix6& a, const Vector6& x) {
  Vector6 y{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) y[i] += a[i][j] * x[j];
  return y;
}
Matrix6 times(const Matrix6& a, const Matrix6& b) {
  Matrix6 c{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      for (std::size_t k = 0; k < 6; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}
Matrix6 transposed(const Matrix6& a) {
  Matrix6 b{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) b[j][i] = a[i][j];
  return b;
}

// Modes of a symmetric matrix by Jacobi's rotations: vectors in the columns.
struct Modes {
  std::array<Real, 6> value{};
  Matrix6 vector{};
};
Modes modes_of(Matrix6 a) {
  Modes modes;
  modes.vector = diagonal({1, 1, 1, 1, 1, 1});
  for (int sweep = 0; sweep < 30; ++sweep)
    for (std::size_t p = 0; p < 6; ++p)
      for (std::size_t q = p + 1; q < 6; ++q) {
        const Real angle = std::atan2(2 * a[p][q], a[q][q] - a[p][p]) / 2;
        Matrix6 turn = diagonal({1, 1, 1, 1, 1, 1});
        turn[p][p] = turn[q][q] = std::cos(angle);
        turn[p][q] = std::sin(angle), turn[q][p] = -std::sin(angle);
        a = times(transposed(turn), times(a, turn));
        modes.vector = times(modes.vector, turn);
      }
  for (std::size_t i = 0; i < 6; ++i) modes.value[i] = a[i][i];
  return modes;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

Model two_free_bodies() {
  Model model = spatial_model(-0.1);
  model.gravity = {};
  model.bodies = {spatial_body("one", 2, {0.1, 0.2, 0.15}, {0, 0, 0}),
                  spatial_body("two", 1, {0.05, 0.08, 0.06}, {0.3, 0.1, 0.2}, exponential({0.4, -0.5, 0.3}))};
  model.bodies[0].velocity = {0.3, -0.2, 0.1}, model.bodies[1].velocity = {-0.5, 0.3, 0.4};
  model.bodies[0].spin = {1.5, -2, 0.5}, model.bodies[1].spin = {-2, 1, 3};
  Bushing bushing = bushing_between(0, 1, {0.2, 0.1, 0.1}, {-0.15, 0.05, -0.1});
  bushing.marker[0] = exponential({0.3, 0.2, -0.4});
  bushing.marker[1] = exponential({-0.1, 0.4, 0.2});
  bushing.stiffness = crowded(60, 1.5), bushing.damping = crowded(0.4, 0.01);
  bushing.preload = {2, -1, 0.5, 0.1, 0.2, -0.3};
  model.bushings = {bushing};
  return model;
}

}  // namespace

TEST_CASE("a body on a bushing swings in six modes, those of M^-1 K") {
  const Vec3 inertia{0.3, 0.4, 0.5}, arm{0.2, -0.1, 0.3};
  Model model = spatial_model(0);
  model.gravity = {};
  model.bodies = {spatial_body("body", 2, inertia, {0, 0, 0})};
  Bushing bushing = bushing_between(kGround, 0, arm, arm);
  bushing.stiffness = crowded(900, 80);
  model.bushings = {bushing};
  // x = L (r, pi) near the start, r and pi of the centre: x_r = r + pi x arm.
  Matrix6 lever = diagonal({1, 1, 1, 1, 1, 1});
  lever[0][4] = arm.z, lever[0][5] = -arm.y, lever[1][3] = -arm.z, lever[1][5] = arm.x, lever[2][3] = arm.y,
  lever[2][4] = -arm.x;
  const std::array<Real, 6> mass{2, 2, 2, inertia.x, inertia.y, inertia.z};
  Matrix6 scaled = times(transposed(lever), times(bushing.stiffness, lever));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) scaled[i][j] /= std::sqrt(mass[i] * mass[j]);
  const Modes modes = modes_of(scaled);
  constexpr Real kAmplitude = 1e-5;
  for (std::size_t mode = 0; mode < 6; ++mode) {
    INFO("mode " << mode);
    const Real w = std::sqrt(modes.value[mode]);
    REQUIRE(w > 1);
    std::array<Real, 6> shape{};
    for (std::size_t i = 0; i < 6; ++i) shape[i] = kAmplitude * modes.vector[i][mode] / std::sqrt(mass[i]);
    model.bodies[0].position = {shape[0], shape[1], shape[2]};
    model.bodies[0].orientation = exponential({shape[3], shape[4], shape[5]});
    const auto error = [&](Real h) {
      MultibodyRun run(model, 1e-9);
      Real worst = 0;
      for (int i = 0; i < static_cast<int>(std::lround(6 / (w * h))); ++i) {
        run.step(h);
        const BodyMotion at = run.multibody.motion(run.state)[0];
        const Real c = std::cos(w * run.time);
        const Vec3 turn = rotation_vector(at.orientation);
        worst = std::max({worst, norm(at.position - c * Vec3{shape[0], shape[1], shape[2]}),
                          norm(turn - c * Vec3{shape[3], shape[4], shape[5]})});
      }
      return worst / kAmplitude;
    };
    const Real coarse = error(0.1 / w), fine = error(0.05 / w);
    CHECK(fine < 2e-3);
    CHECK(coarse / fine > 3.9);
    CHECK(coarse / fine < 4.1);
  }
}

TEST_CASE("rotated by 2.5 rad a bushing still has the torque of its angle") {
  // About one axis the rotation vector is the angle: J angle'' = -k angle.
  Model model = spatial_model(-0.02);
  model.gravity = {};
  const Vec3 axis{0.48, -0.6, 0.64};
  model.bodies = {spatial_body("body", 1, {0.2, 0.2, 0.2}, {0, 0, 0}, exponential(Real(2.5) * axis))};
  Bushing bushing = bushing_between(kGround, 0, {}, {});
  bushing.stiffness = diagonal({10, 20, 30, 5, 5, 5});
  model.bushings = {bushing};
  const auto error = [&](Real h) {
    MultibodyRun run(model, 1e-12);
    Real worst = 0;
    for (int i = 0; i < static_cast<int>(std::lround(1.2 / h)); ++i) {
      run.step(h);
      const Vec3 turn = rotation_vector(run.multibody.motion(run.state)[0].orientation);
      worst = std::max(worst, norm(turn - (2.5 * std::cos(5 * run.time)) * axis));
      const BushingSample sample = run.multibody.bushings(run.state, run.time)[0];
      CHECK(near(sample.turn, turn, {.absolute = 1e-12}));
      CHECK(near(sample.torque, Real(-5) * turn, {.absolute = 1e-11}));
    }
    return worst;
  };
  const Real coarse = error(1e-2), fine = error(5e-3);
  CHECK(fine < 1.2e-2);
  CHECK(coarse / fine > 3.7);
  CHECK(coarse / fine < 4.3);
}

TEST_CASE("a bushing that nears half a revolution ends the run with its name") {
  Model model = spatial_model(-0.1);
  model.gravity = {};
  model.bodies = {spatial_body("body", 1, {0.2, 0.2, 0.2}, {0, 0, 0})};
  model.bodies[0].spin = {0, 0, 10};
  model.bushings = {bushing_between(kGround, 0, {}, {})};
  model.bushings[0].stiffness = diagonal({10, 10, 10, 0, 0, 0});
  MultibodyRun free(model);
  free.steps(50, 1e-2);  // no force depends on the angle
  CHECK(near(free.state.velocity[5], 10, {.relative = 1e-12}));
  model.bushings[0].stiffness[5][5] = 1e-3;
  MultibodyRun run(model);
  run.steps(25, 1e-2);
  std::string message;
  try {
    run.steps(3, 1e-2);
  } catch (const SimulationError& error) {
    message = error.what();
  }
  CHECK(message.find("bushing 'bushing' is rotated by 2.") != std::string::npos);
}

TEST_CASE("in equilibrium K x + preload carries the load") {
  Model model = spatial_model(-0.1);
  model.bodies = {spatial_body("body", 2, {0.1, 0.2, 0.15}, {0, 0, 0})};
  Bushing bushing = bushing_between(kGround, 0, {}, {});
  bushing.stiffness = crowded(900, 80), bushing.damping = crowded(60, 6);
  bushing.preload = {20, -10, 30, 4, -8, 6};
  model.bushings = {bushing};
  MultibodyRun run(model);
  run.steps(400, 1e-2);
  const BushingSample at = run.multibody.bushings(run.state, run.time)[0];
  const Vector6 carried =
      times(bushing.stiffness, Vector6{at.shift.x, at.shift.y, at.shift.z, at.turn.x, at.turn.y, at.turn.z});
  for (std::size_t k = 0; k < 6; ++k) {
    INFO(k);
    CHECK(near(carried[k] + bushing.preload[k], k == 2 ? -2 * 9.81 : 0, {.absolute = 1e-6}));
  }
  CHECK(norm(at.turn) > 0.05);
  CHECK(near(at.force, Vec3{0, 0, 2 * 9.81}, {.absolute = 1e-6}));
}

TEST_CASE("two bodies on a bushing keep momentum and balance their energy, and converge with second order") {
  const Model model = two_free_bodies();
  struct Outcome {
    Real momentum = 0, spin = 0, energy = 0, turn = 0;
    std::vector<Real> position, velocity;
  };
  const auto outcome = [&](Real h) {
    MultibodyRun run(model, 1e-12);
    const auto momentum = [&](Vec3& spin) {
      const std::vector<BodyMotion> motion = run.multibody.motion(run.state);
      Vec3 sum;
      spin = {};
      for (std::size_t b = 0; b < 2; ++b) {
        const Vec3 p = model.bodies[b].mass * motion[b].velocity;
        sum += p;
        spin += cross(motion[b].position, p) +
                rotation_matrix(motion[b].orientation) * (model.bodies[b].inertia_tensor * motion[b].spin);
      }
      return sum;
    };
    Outcome out;
    Vec3 spin0, spin;
    const Vec3 p0 = momentum(spin0);
    const Real start = energy(run);
    for (int i = 0; i < static_cast<int>(std::lround(1 / h)); ++i) {
      run.step(h);
      out.energy = std::max(out.energy, std::abs(energy(run) - start));
      out.momentum = std::max(out.momentum, norm(momentum(spin) - p0));
      out.spin = std::max(out.spin, norm(spin - spin0));
      out.turn = std::max(out.turn, norm(run.multibody.bushings(run.state, run.time)[0].turn));
    }
    CHECK(run.most_iterations <= 4);
    out.position = run.state.position, out.velocity = run.state.velocity;
    return out;
  };
  const Outcome coarse = outcome(4e-3), fine = outcome(2e-3), finest = outcome(1e-3);
  CHECK(fine.turn > 0.8);
  CHECK(fine.momentum < 1e-12);
  CHECK(fine.spin < 1e-4);
  CHECK(coarse.spin / fine.spin > 3.7);
  CHECK(fine.energy < 1e-3);
  CHECK(coarse.energy / fine.energy > 3.7);
  const auto apart = [](const std::vector<Real>& a, const std::vector<Real>& b) {
    Real largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
  };
  for (const auto& part : {&Outcome::position, &Outcome::velocity}) {
    const Real ratio = apart(coarse.*part, fine.*part) / apart(fine.*part, finest.*part);
    CHECK(ratio > 3.8);
    CHECK(ratio < 4.2);
  }
}
