// Checks of the start positions and of the step size.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "model/build_parts.hpp"
#include "model/connections.hpp"
#include "model/limits.hpp"
#include "model/point_bins.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

// Phase that a body on one contact may turn in a step of a staggered run, and should.
constexpr Real kMostBodyPhase = 0.7, kGoodBodyPhase = 0.3;

// Particles and the bodies' shapes at t = 0, in this order.
struct StartItems {
  std::vector<Vec3> position;  // [m]
  std::vector<Real> radius;    // [m]
  std::vector<int> body;       // of a shape; kGround for a particle
};

// The largest overlap so far, over the smaller radius.
struct WorstOverlap {
  Real ratio = 0;
  std::string first, second;
};

StartItems collect_items(const Model& model) {
  StartItems items{model.particles.position, model.particles.radius, {}};
  items.body.assign(model.particles.size(), kGround);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    for (const Shape& shape : model.bodies[b].shapes) {
      items.position.push_back(to_global_point(model, static_cast<int>(b), shape.offset));
      items.radius.push_back(shape.radius);
      items.body.push_back(static_cast<int>(b));
    }
  }
  return items;
}

std::string item_name(const Model& model, const StartItems& items, std::size_t i) {
  if (items.body[i] == kGround) return fmt::format("particle {}", i);
  return fmt::format("body \"{}\"", model.bodies[static_cast<std::size_t>(items.body[i])].name);
}

bool is_inside(const Space& space, Vec3 p) {
  const auto within = [&](Side side, Real x, Real min, Real max) {
    return space.boundary[side] == Boundary::periodic || (x >= min && x <= max);
  };
  return within(kXMin, p.x, space.min.x, space.max.x) && within(kYMin, p.y, space.min.y, space.max.y) &&
         (space.dimension == 2 || within(kZMin, p.z, space.min.z, space.max.z));
}

void check_inside(const DeckTable& deck, const Model& model, const StartItems& items) {
  const Space& space = model.space;
  for (std::size_t i = 0; i < items.position.size(); ++i) {
    const Vec3 p = items.position[i];
    if (is_inside(space, p)) continue;
    deck.table("space").fail(
        "max", fmt::format("{} starts at ({}, {}, {}), outside the space from ({}, {}, {}) to ({}, {}, {})",
                           item_name(model, items, i), p.x, p.y, p.z, space.min.x, space.min.y, space.min.z,
                           space.max.x, space.max.y, space.max.z));
  }
}

// Displacements of the images across periodic sides, the item itself included.
std::vector<Vec3> image_shifts(const Space& space) {
  const Vec3 extent = space.max - space.min;
  const auto periods = [&](int side, Vec3 period) {
    return space.boundary[side] == Boundary::periodic ? std::vector{-period, Vec3{}, period}
                                                      : std::vector{Vec3{}};
  };
  std::vector<Vec3> shifts;
  for (const Vec3 x : periods(kXMin, {extent.x, 0, 0})) {
    for (const Vec3 y : periods(kYMin, {0, extent.y, 0})) {
      for (const Vec3 z : periods(kZMin, {0, 0, extent.z})) shifts.push_back(x + y + z);
    }
  }
  return shifts;
}

bool may_touch(const Model& model, const std::vector<std::pair<int, int>>& connected, int body_a,
               int body_b) {
  if (body_a == kGround || body_b == kGround) return true;
  if (body_a == body_b) return false;
  const std::pair<int, int> pair = std::minmax(body_a, body_b);
  return model.contact.connected_bodies_touch ||
         !std::binary_search(connected.begin(), connected.end(), pair);
}

void find_pair_overlaps(const Model& model, const StartItems& items, WorstOverlap& worst) {
  if (items.radius.empty()) return;
  const Space& space = model.space;
  const Real reach = 2 * *std::max_element(items.radius.begin(), items.radius.end());
  const std::vector<std::pair<int, int>> connected = connected_bodies(model);
  PointBins bins(space.min, space.max, reach, items.position.size());
  for (const Vec3 p : items.position) bins.insert(p);
  Space grown = space;
  grown.min -= Vec3{reach, reach, reach};
  grown.max += Vec3{reach, reach, reach};
  for (const Vec3 shift : image_shifts(space)) {
    for (std::size_t i = 0; i < items.position.size(); ++i) {
      const Vec3 p = items.position[i] + shift;
      if (!is_inside(grown, p)) continue;
      bins.for_near(p, [&](int other) {
        const auto j = static_cast<std::size_t>(other);
        const Real overlap = items.radius[i] + items.radius[j] - norm(p - items.position[j]);
        const Real ratio = overlap / std::min(items.radius[i], items.radius[j]);
        if (j < i && ratio > worst.ratio && may_touch(model, connected, items.body[i], items.body[j])) {
          worst = {ratio, item_name(model, items, j), item_name(model, items, i)};
        }
        return true;
      });
    }
  }
}

void find_wall_overlaps(const Model& model, const StartItems& items, WorstOverlap& worst) {
  for (const Wall& wall : model.walls) {
    for (std::size_t i = 0; i < items.position.size(); ++i) {
      const Real overlap = items.radius[i] - dot(wall.normal, items.position[i] - wall.point);
      const Real ratio = overlap / items.radius[i];
      if (ratio > worst.ratio)
        worst = {ratio, item_name(model, items, i), fmt::format("wall \"{}\"", wall.name)};
    }
  }
}

// n = 1 has an exact limit, other exponents an estimate: an error and a warning.
void check_explicit_step(const DeckTable& deck, const Model& model, const std::vector<PairLimit>& limits,
                         Log& log) {
  const std::optional<PairLimit> tightest = smallest_explicit_step(limits);
  const Real step = model.time.step / model.integrator.substeps;
  if (!tightest || step <= tightest->explicit_step) return;
  const std::vector<std::string>& names = model.contact.material_names;
  const auto a = static_cast<std::size_t>(tightest->material[0]),
             b = static_cast<std::size_t>(tightest->material[1]);
  const std::string problem = fmt::format(
      "a velocity-verlet step of step / substeps = {:.4g} s is unstable in dense contacts of \"{}\" and "
      "\"{}\"; it must be at most {:.4g} s",
      step, names[a], names[b], tightest->explicit_step);
  if (model.contact.law(tightest->material[0], tightest->material[1]).exponent == 1) {
    deck.table("time").fail("step", problem);
  }
  log.warning("time.step: " + problem + " (estimated for an overlap of 1 % of the radius)");
}

// The bodies see the contact force at the end of their step, while the particles take substeps: staggered,
// and stable only while the step is short against the oscillation of a body on its contacts.
void check_body_step(const DeckTable& deck, const Model& model, Log& log) {
  if (model.integrator.particles != ParticleIntegrator::velocity_verlet || model.particles.size() == 0)
    return;
  const std::vector<MaterialUse> uses = material_uses(model);
  Real fastest = 0;
  for (int a = 0; a < model.contact.materials(); ++a) {
    for (int b = 0; b < model.contact.materials(); ++b) {
      const Real mass = uses[static_cast<std::size_t>(a)].smallest_body_mass;
      if (mass > 0 && uses[static_cast<std::size_t>(b)].particles > 0)
        fastest = std::max(fastest, contact_frequency(model.contact.law(a, b).normal_stiffness, mass));
    }
  }
  const Real phase = fastest * model.time.step;
  const std::string finding = fmt::format(
      "a body on a contact oscillates with {:.4g} rad/s; with velocity-verlet particles the bodies' step "
      "must be at "
      "most {:.3g} s",
      fastest, kMostBodyPhase / fastest);
  if (phase > kMostBodyPhase) deck.table("time").fail("step", finding);
  if (phase > kGoodBodyPhase)
    log.warning(
        fmt::format("time.step: {}, and should be at most {:.3g} s", finding, kGoodBodyPhase / fastest));
}

}  // namespace

void check_start_positions(const DeckTable& deck, const Model& model, Log& log) {
  // Round-off of exactly touching neighbours.
  constexpr Real kRoundOff = 1e-9;
  const StartItems items = collect_items(model);
  check_inside(deck, model, items);
  WorstOverlap worst;
  find_pair_overlaps(model, items, worst);
  find_wall_overlaps(model, items, worst);
  if (worst.ratio <= kRoundOff) return;
  const DeckTable& contact = deck.table("contact");
  const std::string finding = fmt::format("{} and {} overlap at t = 0 by {:.4g} of the smaller radius",
                                          worst.first, worst.second, worst.ratio);
  const Real limit = contact.real("max_start_overlap");
  if (worst.ratio > limit)
    contact.fail("max_start_overlap", fmt::format("{}; allowed: at most {}", finding, limit));
  log.warning(finding + ", the worst of all pairs");
}

void check_steps(const DeckTable& deck, const Model& model, Log& log) {
  const std::vector<PairLimit> limits = pair_limits(model);
  check_body_step(deck, model, log);
  const std::optional<PairLimit> shortest = shortest_contact(limits);
  if (!shortest || model.time.control == StepControl::adaptive) return;
  const bool is_explicit = model.integrator.particles == ParticleIntegrator::velocity_verlet;
  if (is_explicit) check_explicit_step(deck, model, limits, log);
  const Real step = is_explicit ? model.time.step / model.integrator.substeps : model.time.step;
  if (step <= 0.2 * shortest->contact_time) return;
  const std::vector<std::string>& names = model.contact.material_names;
  log.warning(
      fmt::format("time.step: steps of {:.4g} s are large for contacts of \"{}\" and \"{}\" that last {:.4g} "
                  "s; impacts are "
                  "resolved below {:.2g} s, or with time.control = \"adaptive\"",
                  step, names[static_cast<std::size_t>(shortest->material[0])],
                  names[static_cast<std::size_t>(shortest->material[1])], shortest->contact_time,
                  0.2 * shortest->contact_time));
}

}  // namespace scree
