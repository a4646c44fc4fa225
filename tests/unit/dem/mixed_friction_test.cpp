// Explicit steps with friction and rolling resistance in mixed precision, item by item on the host, against
// the backend in double precision.
#include <algorithm>
#include <cstring>
#include <vector>

#include "dem/explicit/mixed_friction_items.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/catch.hpp"
#include "support/colliding_spheres.hpp"
#include "support/near.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {
namespace {

// Rows that are summed as on a GPU, contact by contact.
struct SharedRows {
  static constexpr bool kShared = true;
  const Index *offsets, *neighbors;

  template <class Test, class Evaluate, class Sum>
  Index sum_contacts(Index i, const Test& test, const Evaluate& evaluate, Sum& sum) const {
    constexpr std::size_t kWords = sizeof(Sum) / sizeof(double);
    double sums[kWords];
    std::memcpy(sums, &sum, sizeof sum);
    Index found = 0;
    for (Index slot = offsets[i]; slot < offsets[i + 1]; ++slot) {
      if (!test(neighbors[slot])) continue;
      const auto result = evaluate(i, neighbors[slot], slot);
      static_assert(sizeof result == kWords * sizeof(float));
      float words[kWords];
      std::memcpy(words, &result, sizeof result);
      for (std::size_t k = 0; k < kWords; ++k) sums[k] += static_cast<double>(words[k]);
      ++found;
    }
    std::memcpy(&sum, sums, sizeof sum);
    return found;
  }
};

// A run of free particles in mixed precision; every particle is in the row of every other one.
template <class Law>
struct MixedRun {
  MixedRun(const Model& of, const Law& of_pairs, Real step)
      : model(of), law(of_pairs), h(step), planes(wall_planes(of)) {
    const Index n = static_cast<Index>(model.particles.size());
    const std::vector<Particle> records = initial_records(model.particles, Subdomain(model.space));
    for (Index i = 0; i < n; ++i) {
      const Particle& p = records[as_size(i)];
      const Vec3 middle = p.velocity + (h / 2) * model.gravity;
      position.push_back(vec4(p.position + h * middle, p.radius)), velocity.push_back(vec4(middle, p.mass));
      spin.push_back(vec4(p.angular_velocity, p.moment_of_inertia)), orientation.push_back(p.orientation);
      row_start.push_back(i * (n - 1)), wall_start.push_back(i), walls.push_back(0);
      for (Index j = 0; j < n; ++j)
        if (j != i) neighbors.push_back(j);
    }
    row_start.push_back(n * (n - 1)), wall_start.push_back(n);
    acceleration.resize(as_size(n)), material.resize(as_size(n));
    for (auto* losses : {&contact, &friction, &rolling, &twisting}) losses->resize(as_size(n));
    records_of_pairs.resize(2 * neighbors.size()), records_of_walls.resize(2 * as_size(n));
    for (int k = 0; k < 2; ++k)
      fixed[k].resize(as_size(n)), motion[k].resize(as_size(n)), spins[k].resize(as_size(n));
    fraction.resize(as_size(n)), rest.resize(as_size(n)), spin_rest.resize(as_size(n));
    convert();
  }

  MixedViews views() {
    return {{fixed[0].data(), fixed[1].data()},
            {motion[0].data(), motion[1].data()},
            fraction.data(),
            rest.data(),
            {spins[0].data(), spins[1].data()},
            spin_rest.data()};
  }
  void convert() {
    const ToMixedItem item{position.data(),
                           velocity.data(),
                           spin.data(),
                           acceleration.data(),
                           views(),
                           grid,
                           Subdomain(model.space).box(),
                           h,
                           0};
    for (Index i = 0; i < size(); ++i) item(i);
    parity = 0;
  }
  // Closes so many steps and opens the next ones.
  void advance(int steps) {
    for (int k = 0; k < steps; ++k, ++step, parity = 1 - parity) {
      HistoryViews history;
      history.neighbors = records_of_pairs.data(), history.ground = records_of_walls.data();
      history.step = step;
      const ContactViews<SharedRows> in{
          position.data(),   nullptr,      material.data(),    {row_start.data(), neighbors.data()},
          wall_start.data(), walls.data(), {planes.data(), 1}, nullptr,
          nullptr,           history};
      const MixedFrictionItem<OneLaw<Law>, SharedRows> item{
          {in,
           {law},
           {{fixed[parity].data(), motion[parity].data(), fraction.data(), grid}, spins[parity].data(), h}},
          model.gravity,
          views(),
          orientation.data(),
          parity,
          rolling.data(),
          twisting.data()};
      for (Index i = 0; i < size(); ++i) {
        const auto self = item.walk.self(i);
        auto total = item.weight(self);
        item.add_neighbors(self, total);
        item.add_surfaces(self, total);
        item.advance(self, total);
      }
    }
    const std::vector<std::uint8_t> drifting(as_size(size()), 0);
    const FromMixedItem back{views(),
                             parity,
                             grid,
                             position.data(),
                             velocity.data(),
                             spin.data(),
                             acceleration.data(),
                             contact.data(),
                             friction.data(),
                             drifting.data(),
                             model.gravity,
                             h,
                             steps};
    for (Index i = 0; i < size(); ++i) back(i);
    convert();
  }
  Index size() const { return static_cast<Index>(position.size()); }

  Model model;
  Law law;
  Real h, step = 1;
  std::vector<WallPlane> planes;
  QuantumGrid grid = make_quantum_grid(8);
  int parity = 0;
  std::vector<Vec4> position, velocity, spin, records_of_pairs, records_of_walls;
  std::vector<Vec3> acceleration;
  std::vector<Quaternion> orientation;
  std::vector<int> material;
  std::vector<Index> row_start, neighbors, wall_start, walls;
  std::vector<Real> contact, friction, rolling, twisting;  // losses [J]
  std::vector<FixedPointPosition> fixed[2];
  std::vector<MixedMotion> motion[2];
  std::vector<MixedSpin> spins[2];
  std::vector<MixedFraction> fraction;
  std::vector<MixedRest> rest;
  std::vector<MixedSpinRest> spin_rest;
};

template <class Law>
void check_collisions(const NormalLawParameters& normal) {
  const Model model = colliding_spheres(normal);
  LoadedBox exact(model, model.contact.skin);
  REQUIRE(verlet_steps(exact, kCollisionStep, kCollisionSteps) == kCollisionSteps);
  MixedRun<Law> mixed(model,
                      {typename Law::Normal(normal), Law::Tangential::of(model.contact.friction[0]),
                       Law::Rolling::of(model.contact.rolling[0])},
                      kCollisionStep);
  // Converted in the middle of the contacts.
  mixed.advance(150), mixed.advance(kCollisionSteps - 1 - 150);
  TangentialLosses losses{}, exact_losses{};
  Real velocity = 0, spin = 0, changed = 0;
  const std::vector<Particle> records = exact.backend->particles().records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Particle& p = records[i];
    CHECK(norm(xyz(mixed.position[i]) - p.position) < 1e-5);
    velocity = std::max(velocity, norm(xyz(mixed.velocity[i]) - p.velocity));
    spin = std::max(spin, norm(xyz(mixed.spin[i]) - p.angular_velocity));
    changed = std::max(changed, norm(p.angular_velocity - model.particles.angular_velocity[i]));
    losses.add(TangentialLosses{{mixed.friction[i], mixed.rolling[i], mixed.twisting[i]}});
    exact_losses.add(TangentialLosses{{p.friction_loss, p.rolling_loss, p.twisting_loss}});
    CHECK(near(mixed.contact[i], p.contact_loss, {.relative = 1e-3, .absolute = 1e-6}));
  }
  CHECK(changed > 0.3);
  CHECK(velocity < 1e-4);
  CHECK(spin < 4e-4);
  for (int kind = 0; kind < kLossKinds; ++kind) {
    CAPTURE(kind);
    CHECK(exact_losses.of[kind] > 1e-6);
    CHECK(near(losses.of[kind], exact_losses.of[kind], {.relative = 1e-3}));
  }
}

}  // namespace

TEST_CASE("mixed precision: collisions with rolling resistance are those of double precision") {
  check_collisions<ContactLaw<LinearRestitutionLaw, LinearSlider, AnyRolling>>(kCollisionLaws[0]);
  check_collisions<ContactLaw<HertzLaw, MindlinSlider, AnyRolling>>(kCollisionLaws[1]);
  check_collisions<ContactLaw<PowerLaw, LinearSlider, AnyRolling>>(kCollisionLaws[2]);
}

}  // namespace scree
