#include "run/state/state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/bit_hash.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "run/state/contact_rows.hpp"
#include "run/state/state_visitors.hpp"

namespace scree {
namespace {

template <class Visitor, class StateType>
void visit_clock(Visitor& visit, StateType& clock) {
  visit("clock/time", clock.time);
  visit("clock/start", clock.start);
  visit("clock/end", clock.end);
  visit("clock/grid_steps", clock.grid_steps);
  visit("clock/grid_done", clock.grid_done);
  visit("clock/level", clock.level);
  visit("clock/parts_left", clock.parts_left);
  visit("clock/next_step", clock.next_step);
  visit("clock/just_rejected", clock.just_rejected);
}

template <class Visitor, class LedgerType>
void visit_ledger(Visitor& visit, LedgerType& ledger) {
  visit("balance/kinetic", ledger.kinetic);
  visit("balance/gravitational", ledger.gravitational);
  visit("balance/elastic_force_elements", ledger.elastic_force_elements);
  visit("balance/elastic_contacts", ledger.elastic_contacts);
  visit("balance/dissipated_force_elements", ledger.dissipated_force_elements);
  visit("balance/dissipated_contacts", ledger.dissipated_contacts);
  visit("balance/dissipated_integrator", ledger.dissipated_integrator);
  visit("balance/driver_work", ledger.driver_work);
  visit("balance/carried_out", ledger.carried_out);
  visit.if_any(kCarriedInName, ledger.carried_in);
}

// Names in the order of LossKind.
#define SCREE_LOSS_CARRIED(of, kind, field, ...) "carried_out/" #field,
constexpr std::array<const char*, kLossKinds> kCarriedLosses = {SCREE_LOSS_KINDS(SCREE_LOSS_CARRIED, )};
#undef SCREE_LOSS_CARRIED

template <class Visitor, class StateType>
void visit_population(Visitor& visit, StateType& population) {
  visit.if_any("population/due", population.due);
  visit.if_any("population/dropped", population.dropped);
  visit.if_any("population/tried", population.tried);
  visit.if_any("population/instants", population.instants);
  visit.if_any("population/classes", population.classes);
  visit.if_any("population/amounts", population.amounts);
  visit.if_any(kWaitingName, population.waiting);
  visit.if_any("population/mass", population.mass);
  visit.if_any("population/energy", population.energy);
}

template <class Visitor, class StateType>
void visit_outlets(Visitor& visit, StateType& outlets) {
  visit.if_any("outlets/removed", outlets.removed);
  visit.if_any("outlets/mass", outlets.mass);
  visit.if_any("outlets/instants", outlets.instants);
}

template <class Visitor, class StateType>
void visit_state(Visitor& visit, StateType& state) {
  visit_clock(visit, state.clock);
  visit("counts/steps", state.counts.steps);
  visit("counts/newton_iterations", state.counts.newton_iterations);
  visit("counts/linear_iterations", state.counts.linear_iterations);
  visit("counts/rejected_error", state.counts.rejected_error);
  visit("counts/rejected_newton", state.counts.rejected_newton);
  visit.poses(state.bodies.position, state.bodies.counted_angles);
  visit("bodies/velocity", state.bodies.velocity);
  visit("bodies/acceleration", state.bodies.acceleration);
  visit("bodies/multipliers", state.bodies.multipliers);
  visit("bodies/force", state.bodies.force);
  visit("bodies/applied", state.bodies.applied);
  visit.if_any("bodies/memory", state.bodies.memory);
  visit("bodies/wrench", state.bodies.wrench);
  visit.if_any("bodies/slide_power", state.bodies.belt_power);
  visit("bodies/dissipated", state.bodies.dissipated);
  visit("bodies/integrator_loss", state.bodies.integrator_loss);
  visit("bodies/driver_work", state.bodies.driver_work);
  visit("shapes/contact_loss", state.shapes.contact_loss);
  visit("shapes/loss_power", state.shapes.loss_power);
  visit("shapes/integrator_loss", state.shapes.integrator_loss);
  visit.if_any(kShapeFrictionLosses, state.shapes.tangential);
  const bool sides_only = state.shape_contacts.content == kSidesOnly;
  visit.if_any(sides_only ? kShapeSidesOf : kShapeContactsOf, state.shape_contacts.shapes);
  visit.if_any(sides_only ? kShapeSidesWith : kShapeContactsWith, state.shape_contacts.keys);
  visit.if_any(kShapeHistory, state.shape_contacts.values);
  visit.if_any(kWorksName, state.works);
  visit("carried_out/left", state.carried_out.left);
  visit("carried_out/removed", state.carried_out.removed);
  visit("carried_out/energy", state.carried_out.energy);
  visit("carried_out/contact_loss", state.carried_out.contact_loss);
  visit("carried_out/integrator_loss", state.carried_out.integrator_loss);
  if (state.there.rotates)
    for (int kind = 0; kind < kLossKinds; ++kind)
      visit(kCarriedLosses[kind], state.carried_out.losses.of[kind]);
  visit("carried_out/drifting_energy", state.carried_out.ballistic_energy);
  visit("carried_out/drifting_integrator_loss", state.carried_out.ballistic_integrator_loss);
  visit_population(visit, state.population), visit_outlets(visit, state.outlets);
  visit("bodies/least_kinetic", state.bodies.min_kinetic);
  visit("bodies/most_kinetic", state.bodies.max_kinetic);
  visit("balance/open", state.balance.open);
  visit("balance/start", state.balance.start);
  visit("balance/start_integrator", state.balance.start_integrator);
  visit("balance/exchanged", state.balance.exchanged);
  visit("balance/exchanged_before", state.balance.exchanged_under_old_deck);
  visit("balance/most_kinetic", state.balance.extremes.max_kinetic);
  visit("balance/least_elastic", state.balance.extremes.min_elastic);
  visit("balance/most_elastic", state.balance.extremes.max_elastic);
  visit("balance/least_work", state.balance.extremes.min_work);
  visit("balance/most_work", state.balance.extremes.max_work);
  visit_ledger(visit, state.balance.last);
}

// Visits values that are not part of the hash: amounts of output and what stop conditions have seen do not
// belong to the computed state, and the number of lagged steps, stored for particles that rotate, follows
// from the rest of the state.
template <class Visitor, class StateType>
void visit_output(Visitor& visit, StateType& state) {
  visit("clock/histories", state.clock.histories);
  visit("clock/snapshots", state.clock.snapshots);
  visit("clock/checkpoints", state.clock.checkpoints);
  visit("output/history_rows", state.history_rows);
  visit("output/snapshots", state.snapshots);
  visit.watches(state.stop_watches);
  if (state.there.rotates) visit("counts/frozen_steps", state.counts.lagged_steps);
}

// Visits the datasets of the particles in a checkpoint: the ids and the fields that are present. visit: as in
// for_each_field().
template <class Visit>
void for_each_dataset(const FieldsThere& there, const Visit& visit) {
  visit(ParticleField{"global_id", "1", "identity, which survives sorting and migration", kState},
        &Particle::global_id);
  for_each_field([&](const ParticleField& field, auto member) {
    if (there.has(field.parts)) visit(field, member);
  });
}

std::string dataset_name(const ParticleField& field) { return std::string("particles/") + field.name; }

template <class T>
using NumbersOf = decltype(numbers_of(std::declval<T>()));

template <class T>
void add_rows(const std::vector<Particle>& particles, const ParticleField& field, T Particle::*member,
              Checkpoint& out) {
  using Number = typename NumbersOf<T>::value_type;
  const auto copy = [member, &particles](std::int64_t first, std::int64_t count, Number* to) {
    for (std::int64_t i = first; i < first + count; ++i)
      for (const Number number : numbers_of(particles[as_size(i)].*member)) *to++ = number;
  };
  out.rows<Number>()[dataset_name(field)] = {std::tuple_size_v<NumbersOf<T>>, std::ssize(particles), copy,
                                             field.unit, field.description};
}

// Reads piece by piece, so that memory for a single piece suffices besides the particles.
template <class T>
void unpack_field(const Checkpoint& in, const std::string& name, T Particle::*member,
                  std::vector<Particle>& particles) {
  using Number = typename NumbersOf<T>::value_type;
  constexpr std::int64_t kPiece = 65536, kWidth = std::tuple_size_v<NumbersOf<T>>;
  const CheckpointRows<Number>& rows = in.row_array<Number>(name);
  if (rows.width != kWidth || rows.count != std::ssize(particles))
    throw IoError(in.path + ": the particles' arrays do not fit together");
  std::vector<Number> piece(as_size(std::min(kPiece, rows.count) * kWidth));
  for (std::int64_t first = 0; first < rows.count; first += kPiece) {
    const std::int64_t count = std::min(kPiece, rows.count - first);
    rows.copy(first, count, piece.data());
    for (std::int64_t i = 0; i < count; ++i) {
      const Number* const numbers = &piece[as_size(i * kWidth)];
      T& value = particles[as_size(first + i)].*member;
      set_value(value, numbers);
      if (std::is_integral_v<Number> && !std::ranges::equal(numbers_of(value), std::span(numbers, kWidth)))
        throw IoError(in.path + ": a value of " + name + " is too large");
    }
  }
}

std::vector<Particle> unpack_particles(const Checkpoint& in) {
  const CheckpointRows<std::int64_t>& ids = in.row_array<std::int64_t>("particles/global_id");
  std::vector<Particle> particles(as_size(ids.count));
  for_each_dataset(fields_there(in), [&](const ParticleField& field, auto member) {
    unpack_field(in, dataset_name(field), member, particles);
  });
  return particles;
}

}  // namespace

FieldsThere fields_there(const Checkpoint& in) {
  const auto has = [&](const char* name) { return in.real_rows.contains(dataset_name({name, "", "", 0})); };
  return {has("angular_velocity"), has("rolling_loss")};
}

Checkpoint pack(const State& state) {
  Checkpoint out;
  Writer writer(out);
  visit_state(writer, state), visit_output(writer, state);
  for_each_dataset(state.there, [&](const ParticleField& field, auto member) {
    add_rows(state.particles, field, member, out);
  });
  add_contacts(state.contacts, out);
  return out;
}

std::uint64_t state_hash(const State& state, bool with_rest) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    BitHash one;
    for_each_dataset(state.there, [&](const ParticleField& field, auto member) {
      if ((field.parts & kState) != 0)
        for (const auto number : numbers_of(state.particles[i].*member)) one.add(number);
    });
    if (state.contacts.content.exists()) add_contacts(state.contacts, i, one);
    sum += one.hash();
  }
  if (!with_rest) return sum;
  Hasher rest;
  visit_state(rest, state);
  return sum + rest.hash();
}

namespace {

// Derives the number of values per contact from the array lengths, unless the contacts store sides alone.
void count_numbers(const std::string& path, ShapeContacts& contacts) {
  const std::size_t count = contacts.shapes.size(), values = contacts.values.size();
  const bool has_values = contacts.content != kSidesOnly && count > 0;
  if (contacts.keys.size() != count || (has_values ? values == 0 || values % count > 0 : values > 0))
    throw IoError(fmt::format("{}: the arrays {}, {} and {} do not fit together", path, kShapeContactsOf,
                              kShapeContactsWith, kShapeHistory));
  if (contacts.content != kSidesOnly)
    contacts.content = HistoryContent::of_law(count > 0 ? static_cast<int>(values / count) : 0);
  for (std::size_t k = 1; k < count; ++k)
    if (std::pair(contacts.shapes[k - 1], contacts.keys[k - 1]) >=
        std::pair(contacts.shapes[k], contacts.keys[k]))
      throw IoError(path + ": the contacts of the bodies' shapes are out of order");
}

}  // namespace

HistoryContent shape_content_in(const Checkpoint& in) {
  return in.integers.count(kShapeSidesOf) > 0 ? kSidesOnly : kNoHistory;
}

State unpack(const Checkpoint& checkpoint, const Ranks& ranks) {
  State state;
  ranks.collectively([&] {  // one rank's rows may be unreadable
    Reader reader(checkpoint);
    state.there = fields_there(checkpoint);
    state.shape_contacts.content = shape_content_in(checkpoint);
    visit_state(reader, state), visit_output(reader, state);
    count_numbers(checkpoint.path, state.shape_contacts);
    state.particles = unpack_particles(checkpoint);
  });
  state.contacts = unpack_contacts(checkpoint, ranks);
  return state;
}

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw IoError(path + ": not a valid checkpoint: " + what);
}

void check_ids_increase(const std::string& path, GlobalId before, GlobalId id) {
  if (id <= before)
    refuse(path, fmt::format("particle {} comes after particle {}; ids must increase", id, before));
}

bool is_finite(const Particle& p) {
  bool finite = true;
  for_each_field([&](const ParticleField&, auto member) {
    for (const auto number : numbers_of(p.*member))
      finite = finite && std::isfinite(static_cast<Real>(number));
  });
  return finite;
}

void check_particles(const State& state, const std::string& path, GlobalId bound) {
  const Particle* before = nullptr;
  for (const Particle& p : state.particles) {
    if (p.global_id < 0 || p.global_id >= bound)
      refuse(path, fmt::format("particle id {}; the deck has the ids 0 to {}", p.global_id, bound - 1));
    if (before != nullptr) check_ids_increase(path, before->global_id, p.global_id);
    before = &p;
    if (!is_finite(p)) refuse(path, fmt::format("a value of particle {} is not finite", p.global_id));
  }
}

}  // namespace

std::int64_t particles_so_far(const ParticleSet& particles, const PopulationState& population) {
  return particles.totals.at_start + population.born();
}

GlobalId id_bound(const ParticleSet& particles, const PopulationState& population) {
  GlobalId bound = particles.totals.at_start;
  for (int i = 0; i < std::ssize(population.due); ++i)
    bound = std::max(bound, particles.id_of_birth(i, population.due[as_size(i)]));
  return bound;
}

void check_state(const State& state, const std::string& path, const ParticleSet& particles,
                 const Ranks& ranks) {
  if (std::ssize(state.population.due) != particles.inserters)
    refuse(path, fmt::format("it has {} inserters; the deck has {}", state.population.due.size(),
                             particles.inserters));
  const std::int64_t found = ranks.sum(std::ssize(state.particles)), removed = state.carried_out.removed,
                     so_far = particles_so_far(particles, state.population);
  if (found != so_far - removed)
    refuse(path,
           fmt::format("{} particles; the deck has {}, of which {} were removed", found, so_far, removed));
  const GlobalId bound = id_bound(particles, state.population);
  ranks.collectively([&] {
    FiniteCheck finite;
    visit_state(finite, state);
    if (!finite.name().empty()) refuse(path, "'" + finite.name() + "' is not finite");
    check_particles(state, path, bound);
    const std::string wrong = contacts_error(state.contacts, state.particles, bound);
    if (!wrong.empty()) refuse(path, wrong);
  });
  std::vector<GlobalId> ends;  // first and last id of each rank's part
  if (!state.particles.empty()) ends = {state.particles.front().global_id, state.particles.back().global_id};
  ends = ranks.all_gather(ends);
  for (std::size_t k = 2; k < ends.size(); k += 2) check_ids_increase(path, ends[k - 1], ends[k]);
}

void check_constants(const State& state, const std::string& path, const ParticleTotals& deck) {
  const auto check = [&](const Particle& p, const char* what, Real value, Real smallest, Real largest) {
    if (!(value >= smallest && value <= largest))
      refuse(path, fmt::format("the {} of particle {} is {}; the deck's are {} to {}", what, p.global_id,
                               value, smallest, largest));
  };
  for (const Particle& p : state.particles) {
    check(p, "radius", p.radius, deck.smallest_radius, deck.largest_radius);
    check(p, "mass", p.mass, deck.smallest_mass, deck.largest_mass);
    check(p, "material", p.material, 0, static_cast<Real>(deck.materials.size()) - 1);
  }
}

}  // namespace scree
