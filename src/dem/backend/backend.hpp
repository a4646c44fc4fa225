// The seam between the coupled step and the machine that computes the particles: the CPU, or one GPU.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "dem/backend/explicit_run.hpp"
#include "dem/backend/implicit_step.hpp"
#include "dem/backend/rank_list.hpp"
#include "dem/backend/rank_particles.hpp"
#include "dem/backend/reports.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The particles of one rank on their machine: what can be done with them follows from the objects below. With
// several ranks, each has a backend, and the functions of all objects are collective unless these say
// otherwise: every rank calls them in the same order, and what they return is the same on every rank, except
// where a comment says otherwise. So are the errors.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string description() const = 0;

  virtual RankParticles& particles() = 0;
  virtual RankList& list() = 0;
  virtual Reports& reports() = 0;

  // The particles at rest on a list that covers them, a step is opened; one at a time. h: its length [s].
  virtual std::unique_ptr<ImplicitStep> open_step(Real h) = 0;
  virtual std::unique_ptr<ExplicitRun> start_run(Real h) = 0;

  // Whether steps go on while the host does something else.
  virtual bool computes_asynchronously() const { return false; }
  // Whether explicit steps get their contact forces in single precision. The step that take_steps closes
  // without opening another gets them in double even so: where runs end changes bits.
  virtual bool is_mixed() const { return false; }
  // Called by backends that compute asynchronously where they would only wait: from within take_steps and
  // particle_correct. It must not change the backend.
  void set_idle_work(std::function<void()> work) { idle_work_ = std::move(work); }

 protected:
  std::function<void()> idle_work_;
};

// What its objects throw of values that are not finite is a SimulationError that names stage and global id;
// the same holds of the GPU's.
std::unique_ptr<Backend> make_cpu_backend(const Model& model, const Ranks& ranks = {});

}  // namespace scree
