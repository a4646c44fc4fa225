// Interface between the coupled step and the backend that computes the particles: the CPU, or one GPU.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/device_trace.hpp"
#include "dem/backend/explicit_run.hpp"
#include "dem/backend/implicit_step.hpp"
#include "dem/backend/rank_list.hpp"
#include "dem/backend/rank_particles.hpp"
#include "dem/backend/reports.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The particles of one rank on its backend; the objects below give access to them. With several ranks, every
// rank has a backend, and all member functions of its objects are collective unless stated otherwise: every
// rank calls them in the same order, and results and errors are the same on every rank unless stated
// otherwise.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string description() const = 0;

  virtual RankParticles& particles() = 0;
  virtual RankList& list() = 0;
  virtual Reports& reports() = 0;

  // Opens a step from a committed state of the particles, on a list that covers them; one step at a time. h:
  // its length [s].
  virtual std::unique_ptr<ImplicitStep> open_step(Real h) = 0;
  virtual std::unique_ptr<ExplicitRun> start_run(Real h) = 0;

  // Whether steps continue while the host does other work.
  virtual bool computes_asynchronously() const { return false; }
  // Whether explicit steps compute contact forces in single precision. The last step of `take_steps`, which
  // opens no further one, uses double precision: results depend bitwise on where runs end.
  virtual bool is_mixed() const { return false; }
  // Records the work of this rank's device for a timeline; null if there is none, or if that cannot be
  // recorded here.
  virtual std::unique_ptr<DeviceTrace> device_trace() { return nullptr; }
  // Work for the host, called by asynchronous backends where they would only wait: from within `take_steps`
  // and `particle_correct`. It must not change the backend.
  void set_idle_work(std::function<void()> work) { idle_work_ = std::move(work); }

 protected:
  std::function<void()> idle_work_;
};

// The objects of both backends throw a SimulationError that names stage and global id where a value is not
// finite.
std::unique_ptr<Backend> make_cpu_backend(const Model& model, const Ranks& ranks = {});

}  // namespace scree
