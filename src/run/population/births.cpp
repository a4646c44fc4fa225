#include "run/population/births.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/index.hpp"
#include "dem/backend/explicit_run.hpp"
#include "dem/search/candidate_grid.hpp"
#include "physics/energy.hpp"
#include "physics/particle_mass.hpp"

namespace scree {
namespace {

// Round-off of an instant, relative to the interval.
constexpr Real kInstantRoundOff = 1e-9;

// Number of regular instants of an inserter up to time t.
std::int64_t instants_until(const Inserter& inserter, Real t) {
  const Real intervals = (t - inserter.schedule.start()) / inserter.interval;
  return std::llround(std::floor(intervals + kInstantRoundOff)) + 1;
}

}  // namespace

// What births at one instant need.
struct Births::Instant {
  std::span<const BodyMotion> motion;
  Obstacles obstacles;
  RankParticles& particles;
  std::vector<Particle> born = {};
};

Births::Births(const Model& model) : model_(model), subdomain_(model.space) {
  std::size_t first = 0;
  for (const Inserter& of : model.inserters)
    first_class_.push_back(first), first += as_size(of.mixture->classes());
  first_class_.push_back(first);
}

PopulationState Births::start() const {
  PopulationState state;
  const std::size_t n = model_.inserters.size();
  if (n == 0) return state;
  for (auto* counts : {&state.due, &state.dropped, &state.tried, &state.instants}) counts->assign(n, 0);
  state.classes.assign(first_class_.back(), 0), state.amounts.assign(n, 0);
  state.mass.assign(FixedSum::kNumbers, 0), state.energy = {0};
  return state;
}

std::span<const std::int64_t> Births::classes_of(std::size_t i, const PopulationState& state) const {
  return {state.classes.data() + first_class_[i], first_class_[i + 1] - first_class_[i]};
}

Real Births::amount_of(std::size_t i, const Mixture::Particle& particle) const {
  switch (inserter(i).amount) {
    case Amount::number:
      return 1;
    case Amount::mass:
      return particle.mass;
    case Amount::volume:
      break;
  }
  return solid_size(particle.radius, model_.space.dimension);
}

Births::Candidate Births::next_candidate(std::size_t i, const PopulationState& state) const {
  const Mixture& mixture = *inserter(i).mixture;
  const std::int64_t n = state.due[i];
  const int size_class = mixture.next(n, classes_of(i, state)).size_class;
  return {n, size_class, mixture.particle(n, size_class)};
}

Real Births::next_of(std::size_t i, const PopulationState& state) const {
  const Inserter& of = inserter(i);
  const Real start = of.schedule.start();
  const auto instant = [&](Real k) { return start + (k - kInstantRoundOff) * of.interval; };
  const Real from_now = instant(static_cast<Real>(state.instants[i]));
  if (state.waiting_of(static_cast<int>(i)) > 0) return of.interval > 0 ? from_now : -kInfinity;
  const Real due = of.schedule.time_of(state.amounts[i] + amount_of(i, next_candidate(i, state).particle));
  if (due == kInfinity || of.interval == 0) return due;
  const Real regular = std::max(from_now, instant(std::ceil((due - start) / of.interval - kInstantRoundOff)));
  return std::min(regular, of.schedule.end() - kInstantRoundOff * of.interval);
}

Real Births::next(const PopulationState& state) const {
  Real earliest = kInfinity;
  for (std::size_t i = 0; i < model_.inserters.size(); ++i) earliest = std::min(earliest, next_of(i, state));
  return earliest;
}

std::optional<Real> Births::instant_reached(std::size_t i, Real t, const PopulationState& state) const {
  const Inserter& of = inserter(i);
  if (of.interval == 0) return t >= of.schedule.start() ? std::optional(t) : std::nullopt;
  const Real end = of.schedule.end();
  const Real regular = of.schedule.start() + static_cast<Real>(instants_until(of, t) - 1) * of.interval;
  const bool is_new = instants_until(of, t) > state.instants[i];
  // The end of the schedule is an instant, too, for what has become due since the last regular one.
  const auto is_owing = [&] {
    return of.schedule.is_due(state.amounts[i] + amount_of(i, next_candidate(i, state).particle), end);
  };
  if (t >= end - kInstantRoundOff * of.interval && regular < end && is_owing()) return end;
  return is_new ? std::optional(regular) : std::nullopt;
}

// The waiting particles of the inserter, which are removed from the state, then those that have become due.
std::vector<Births::Candidate> Births::take_due(std::size_t i, Real instant, Real t,
                                                PopulationState& state) const {
  const Inserter& of = inserter(i);
  std::vector<Candidate> candidates;
  std::vector<std::int64_t> of_others;
  for (std::size_t k = 0; k < state.waiting.size(); k += kWaitingNumbers) {
    const std::int64_t *const one = &state.waiting[k], n = one[1];
    const int size_class = static_cast<int>(one[2]);
    if (one[0] == static_cast<std::int64_t>(i))
      candidates.push_back({n, size_class, of.mixture->particle(n, size_class)});
    else
      of_others.insert(of_others.end(), one, one + kWaitingNumbers);
  }
  state.waiting = std::move(of_others);
  for (;;) {
    Candidate next = next_candidate(i, state);
    const Real amount = state.amounts[i] + amount_of(i, next.particle);
    if (!of.schedule.is_due(amount, instant)) break;
    if (of.region.kind == InserterKind::face)
      next.elapsed = std::max<Real>(0, t - of.schedule.time_of(amount));
    state.amounts[i] = amount, ++state.due[i];
    ++state.classes[first_class_[i] + as_size(next.size_class)];
    candidates.push_back(next);
  }
  return candidates;
}

Particle Births::born(std::size_t i, const Candidate& candidate, const Birth& birth) const {
  Particle p;
  p.global_id = model_.particles.id_of_birth(static_cast<int>(i), candidate.n);
  p.position = subdomain_.wrap(snap(birth.position, subdomain_.snap_constant()), p.image);
  p.image = {};
  p.velocity = birth.velocity;
  p.radius = candidate.particle.radius, p.mass = candidate.particle.mass;
  p.material = candidate.particle.material;
  p.moment_of_inertia = moment_of_inertia(candidate.particle.inertia_factor, p.mass, p.radius);
  p.acceleration = model_.gravity, p.force = p.mass * model_.gravity;
  // The accounting of explicit steps contains this function of the acceleration. It is not an energy that the
  // particle carries in.
  p.integrator_loss = verlet_energy_shift(verlet_step(model_), p.mass, p.acceleration);
  return p;
}

void Births::account(const Particle& p, PopulationState& state) const {
  FixedSum sum;
  std::ranges::copy(state.mass, sum.word);
  sum.add(p.mass), sum.normalize();
  std::ranges::copy(sum.word, state.mass.begin());
  state.energy.front() +=
      kinetic_energy(p.mass, p.velocity) + gravitational_energy(p.mass, model_.gravity, p.position);
}

// By rounds: in each one, every candidate without a position tries one, and takes it if it is free of
// particles, surfaces and of the positions taken before it, in the order of the candidates. The candidates
// that are left have found no free position.
void Births::find_positions(std::size_t i, std::vector<Candidate>& candidates, Instant& now,
                            PopulationState& state) const {
  const Inserter& of = inserter(i);
  const BirthPositions positions(model_, of, now.motion);
  const Real largest = model_.particles.totals.largest_radius;
  for (std::int64_t round = 0; round < of.tries && !candidates.empty(); ++round) {
    std::vector<std::optional<Particle>> trial;
    std::vector<Vec4> spheres;
    std::vector<std::size_t> tried;  // candidate of each sphere
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const Candidate& one = candidates[c];
      const CounterRandom random(static_cast<std::uint64_t>(of.seed), RandomStream::birth, state.tried[i]++);
      const std::optional<Birth> birth = positions.draw(random, one.particle.radius, one.elapsed);
      trial.push_back(birth ? std::optional(born(i, one, *birth)) : std::nullopt);
      if (trial.back() && !now.obstacles.is_clear(trial.back()->position, one.particle.radius, of.gap))
        trial.back().reset();
      if (!trial.back()) continue;
      spheres.push_back(vec4(trial.back()->position, one.particle.radius + of.gap)), tried.push_back(c);
    }
    if (spheres.empty()) continue;
    const CandidateGrid grid(spheres, subdomain_.period(), largest);
    std::vector<std::uint8_t> blocked = now.particles.overlapped(grid);
    // now.born of this instant are not yet among the particles.
    for (const Particle& p : now.born)
      grid.views().for_each_near(p.position, [&](Index number, const Vec4& sphere) {
        const Vec3 d = p.position - xyz(sphere);
        const Real touch = p.radius + sphere.w;
        if (dot(d, d) < touch * touch) blocked[as_size(number)] = 1;
      });
    std::vector<std::uint8_t> found(candidates.size(), 0);
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      if (blocked[k] != 0) continue;
      const Particle& p = *trial[tried[k]];
      found[tried[k]] = 1;
      now.born.push_back(p), account(p, state);
      grid.views().for_each_near(p.position, [&](Index number, const Vec4& sphere) {
        const Vec3 d = p.position - xyz(sphere);
        const Real touch = p.radius + sphere.w;
        if (as_size(number) > k && dot(d, d) < touch * touch) blocked[as_size(number)] = 1;
      });
    }
    std::size_t left = 0;
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (found[c] == 0) candidates[left++] = candidates[c];
    candidates.resize(left);
  }
}

void Births::leave_blocked(std::size_t i, const std::vector<Candidate>& blocked,
                           PopulationState& state) const {
  if (blocked.empty()) return;
  const Inserter& of = inserter(i);
  const auto count = std::ssize(blocked);
  const std::string what =
      fmt::format("stage insert: inserter \"{}\" found no free position for {} in {} tries each", of.name,
                  count == 1 ? "a particle" : fmt::format("{} particles", count), of.tries);
  const char* const remedy = "a larger region, a lower rate or more tries are needed";
  switch (of.blocked) {
    case BlockedPolicy::error:
      throw SimulationError(fmt::format("{}; {}; or blocked = \"wait\" or \"drop\"", what, remedy));
    case BlockedPolicy::drop:
      state.dropped[i] += count;
      return;
    case BlockedPolicy::wait:
      if (count > of.most_waiting)
        throw SimulationError(fmt::format("{}; most_waiting = {}; {}", what, of.most_waiting, remedy));
      for (const Candidate& one : blocked)
        state.waiting.insert(state.waiting.end(), {static_cast<std::int64_t>(i), one.n, one.size_class});
  }
}

std::vector<Particle> Births::births_at(Real t, std::span<const BodyMotion> motion, RankParticles& particles,
                                        PopulationState& state) const {
  if (t < next(state)) return {};
  Instant now{motion, Obstacles(model_, motion), particles};
  // A copy, so that a checkpoint after an error counts no particle that is not there.
  PopulationState after = state;
  for (std::size_t i = 0; i < model_.inserters.size(); ++i) {
    const std::optional<Real> instant = instant_reached(i, t, after);
    if (!instant) continue;
    if (inserter(i).interval > 0)
      after.instants[i] = std::max(after.instants[i], instants_until(inserter(i), t));
    std::vector<Candidate> candidates = take_due(i, *instant, t, after);
    find_positions(i, candidates, now, after);
    leave_blocked(i, candidates, after);
  }
  state = std::move(after);
  return now.born;
}

}  // namespace scree
