// Births of the inserters' particles during a run.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dem/backend/rank_particles.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "model/derived/mixture.hpp"
#include "partition/subdomain.hpp"
#include "run/population/birth_positions.hpp"
#include "run/population/obstacles.hpp"
#include "run/population/population_state.hpp"

namespace scree {

// Which particles are due follows from the time and the state alone, and their positions from the state and
// from the particles present, so that all ranks find the same births on any number of ranks and either
// backend. Must not outlive its model.
class Births {
 public:
  explicit Births(const Model& model);

  // The state at t = 0, before any birth.
  PopulationState start() const;
  // The instant at which the next particles may be born [s]; infinite where none will be. A step that reaches
  // it must end with births_at().
  Real next(const PopulationState& state) const;
  // Counts the particles that are due at time t, and returns those that are born: equal on every rank, in the
  // order of the inserters and, of each, in the order in which they found their positions; with the state
  // from which a step starts. motion: of the bodies, then of the walls with a pose. Throws SimulationError
  // where the deck's limit of blocked births is exceeded, and leaves the state as it was. Collective.
  std::vector<Particle> births_at(Real t, std::span<const BodyMotion> motion, RankParticles& particles,
                                  PopulationState& state) const;

 private:
  // A particle that is due and has no position yet.
  struct Candidate {
    std::int64_t n = 0;
    int size_class = 0;
    Mixture::Particle particle;
    Real elapsed = 0;  // since it passed a face [s]
  };
  struct Instant;

  const Inserter& inserter(std::size_t i) const { return model_.inserters[i]; }
  std::span<const std::int64_t> classes_of(std::size_t i, const PopulationState& state) const;
  Real amount_of(std::size_t i, const Mixture::Particle& particle) const;
  Candidate next_candidate(std::size_t i, const PopulationState& state) const;
  Real next_of(std::size_t i, const PopulationState& state) const;
  // The instant of births of an inserter that time t has reached [s]; none where there is no new one.
  std::optional<Real> instant_reached(std::size_t i, Real t, const PopulationState& state) const;
  std::vector<Candidate> take_due(std::size_t i, Real instant, Real t, PopulationState& state) const;
  void find_positions(std::size_t i, std::vector<Candidate>& candidates, Instant& now,
                      PopulationState& state) const;
  Particle born(std::size_t i, const Candidate& candidate, const Birth& birth) const;
  void account(const Particle& particle, PopulationState& state) const;
  void leave_blocked(std::size_t i, const std::vector<Candidate>& blocked, PopulationState& state) const;

  const Model& model_;
  Subdomain subdomain_;
  std::vector<std::size_t> first_class_;  // of each inserter, in PopulationState::classes
};

}  // namespace scree
