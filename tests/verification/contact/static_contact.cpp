// Static spheres between walls, held by friction.
#include <cmath>
#include <numbers>

#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/pack.hpp"

namespace scree {

namespace {

using Law = ContactLaw<LinearLaw, LinearSlider>;

constexpr Real kGravity = 9.81;

// The zigzag of the tables: radius, mass, stiffnesses; walls at x = 1e-6 and 0.033999.
constexpr Real kRadius = 0.01, kMass = 0.01, kStiffness = 1e6, kSlipStiffness = 8e5, kWidth = 0.034,
               kOverlap = 1e-6;
constexpr Real kRise = 2 * kRadius * 0.714142842854285;  // height from one sphere to the next

Pack<Law> zigzag(Real h) {
  std::vector<Grain> grains;
  for (int i = 0; i < 6; ++i)
    grains.push_back({.position = {i % 2 == 0 ? kRadius : kWidth - kRadius, 0, kRadius + kRise * i},
                      .radius = kRadius,
                      .mass = kMass});
  // So rough that nothing slides.
  return {{LinearLaw(kStiffness, 0, false), {kSlipStiffness, 1e3, 0}},
          std::move(grains),
          {{{kOverlap, 0, 0}, {1, 0, 0}}, {{kWidth - kOverlap, 0, 0}, {-1, 0, 0}}, {{0, 0, 0}, {0, 0, 1}}},
          {0, 0, -kGravity},
          h};
}

const ContactOutcome& contact_of(const Pack<Law>& pack, const ReferenceTable::Row& row) {
  const auto i = static_cast<std::size_t>(row["i"]);
  if (row.word("contact") == "pair") return pack.of_pair(i, static_cast<std::size_t>(row["j"]));
  return pack.of_plane(i, row.word("contact") == "floor" ? 2 : i % 2);
}

}  // namespace

TEST_CASE("six spheres in a zigzag between rough walls: static forces, positions and rotations") {
  const ReferenceTable contacts("contact/zigzag_contacts.csv"), spheres("contact/zigzag_spheres.csv");
  constexpr Real h = 2e-5, kDrag = 0.9;  // [s], per step
  Pack<Law> pack = zigzag(h);
  const std::vector<Grain> start = pack.grains;
  std::vector<Real> turned(start.size(), 0);
  for (int step = 0; step < 200000; ++step) {
    for (std::size_t i = 0; i < turned.size(); ++i) {
      Grain& g = pack.grains[i];  // strong viscous damping: no contact opens on the way to rest
      g.velocity = kDrag * g.velocity, g.spin = kDrag * g.spin;
      turned[i] += h * g.spin.y;
    }
    pack.step();
  }
  Errors forces, positions, turns;
  const Real weight = kMass * kGravity;
  Real carried = 0;
  for (const auto& row : contacts.rows()) {
    const ContactOutcome& out = contact_of(pack, row);
    const Vec3 slip_force{row["Tx"], 0, row["Tz"]};
    if (row.word("contact") == "pair") {
      forces.add((norm(out.load.force) - std::hypot(row["N"], norm(slip_force))) / weight);
      continue;
    }
    const Real to_right = static_cast<int>(row["i"]) % 2 == 0 ? 1 : -1;
    const Vec3 normal = row.word("contact") == "floor" ? Vec3{0, 0, 1} : Vec3{to_right, 0, 0};
    forces.add(norm(out.load.force - row["N"] * normal - slip_force) / weight);
    carried += out.load.force.z;
  }
  CHECK(near(carried, 6 * weight, {.relative = 1e-9}));
  for (const auto& row : spheres.rows()) {
    const auto i = static_cast<std::size_t>(row["i"]);
    const Vec3 displacement = pack.grains[i].position - start[i].position;
    positions.add(norm(displacement - Vec3{row["dx"], 0, row["dz"]}) / 1.5e-6);
    turns.add((turned[i] - row["theta"]) / 1.7e-4);
  }
  CHECK(keeps(forces.worst(), {.promise = 1e-8, .measured = 4.3e-10}));
  CHECK(keeps(positions.worst(), {.promise = 1e-8, .measured = 1.0e-10}));
  CHECK(keeps(turns.worst(), {.promise = 1e-6, .measured = 2.0e-7}));
}

TEST_CASE("a sphere clamped between two walls is held by friction above its limit, and falls below it") {
  const ReferenceTable table("contact/held_by_friction.csv");
  for (const auto& row : table.rows()) {
    const Real R = row["R"], m = row["m"], d = row["d"], period = row["period"];
    const auto dropped = [&](Real friction, Real damping_ratio, int steps) {
      return Pack<Law>{{LinearLaw(row["kn"], 0, false), {row["kt"], friction, damping_ratio}},
                       {{.radius = R, .mass = m}},
                       {{{-R + d, 0, 0}, {1, 0, 0}}, {{R - d, 0, 0}, {-1, 0, 0}}},
                       {0, 0, -kGravity},
                       period / steps};
    };
    const auto fall_of = [&](Real friction, Real damping_ratio, int periods) {
      Pack<Law> pack = dropped(friction, damping_ratio, 200);
      Real lowest = 0;
      for (int k = 0; k < 200 * periods; ++k) {
        pack.step();
        lowest = std::max(lowest, -pack.grains[0].position.z);
        CHECK(pack.grains[0].spin == Vec3{});
      }
      return std::pair{lowest, -pack.grains[0].position.z};
    };
    // Dropped without damping it needs twice the static friction.
    CHECK(near(fall_of(2.01 * row["mu_min"], 0, 3).first, row["lowest"], {.relative = 1e-4}));
    CHECK(fall_of(1.5 * row["mu_min"], 0, 3).first > 1.1 * row["lowest"]);
    CHECK(near(fall_of(2.01 * row["mu_min"], 0.5, 60).second, row["sag"], {.relative = 1e-12}));
    CHECK(fall_of(0.99 * row["mu_min"], 0.5, 60).second > 10 * row["lowest"]);
  }
}

}  // namespace scree
