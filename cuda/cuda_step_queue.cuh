// Queues explicit steps on the device, in double or in mixed precision.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cuda_control.cuh"
#include "dem/explicit/mixed_items.hpp"
#include "driven_surfaces.cuh"
#include "step_graph.cuh"

namespace scree {

// Workspace kept from one run to the next.
struct RunWorkspace {
  StepGraph graph;
  Event step_queued, boundary_done;
  std::unique_ptr<DrivenSurfaces> driven;  // null unless the motion of the surfaces is known ahead
};

// What orders a step and the contacts of moving surfaces.
struct MovingSurfaces {
  const Event* loads_found;  // the boundary rows wait for it; null: it is queued on the particles' stream
  Event& boundary_done;      // recorded after the boundary rows: the surfaces' next contacts need no others
};

class StepQueue {
 public:
  StepQueue(CudaItems& items, CudaList& list, RunControl& control, RunWorkspace& workspace, Real h)
      : items_(items), list_(list), control_(control), workspace_(workspace), h_(h) {}

  // Queues that many steps after each other, each with its halo exchange; each is closed and the next opened.
  // Those after a stop do nothing. moving: null for surfaces that are static or in RunWorkspace::driven,
  // whose contacts are queued with each step.
  void queue(Index steps, const MovingSurfaces* moving = nullptr) {
    items_.in_mixed ? queue_mixed(steps) : queue_double(steps, moving);
  }
  // Request of a step in double.
  VerletRequest request();
  bool in_mixed() const { return mixed_.has_value(); }
  // Copies the open step into the arrays of the state, after the host has read the control block.
  void gather_open_step();

 private:
  // Arrays that hold the open step in mixed precision.
  struct Mixed {
    QuantumGrid quanta;
    Index start;  // number of closed steps when the state was converted to mixed precision
  };
  PrunedViews pruned_views(const Vec4* position);
  void queue_double(Index steps, const MovingSurfaces* moving);
  void queue_mixed(Index steps);
  template <class QueueSurfaces, class QueueGhosts, class QueueRows>
  void queue_successively(const std::string& key, Index steps, const QueueSurfaces& queue_surfaces,
                          const QueueGhosts& queue_ghosts, const QueueRows& queue_rows,
                          Event* boundary_done = nullptr);
  template <class QueueSurfaces, class QueueGhosts, class QueueInterior, class QueueBoundary>
  void queue_with_ranks(Index steps, const QueueSurfaces& queue_surfaces, const QueueGhosts& queue_ghosts,
                        const QueueInterior& queue_interior, const QueueBoundary& queue_boundary);
  template <class QueueSurfaces, class QueueGhosts, class QueueInterior, class QueueBoundary>
  void queue_with_peers(const std::string& key, Index steps, const QueueSurfaces& queue_surfaces,
                        const QueueGhosts& queue_ghosts, const QueueInterior& queue_interior,
                        const QueueBoundary& queue_boundary);
  template <class Request>
  auto ghost_queue(const Request& request, std::string& key);
  OpenStepQuery surface_query(const VerletRequest& step);
  Vec4* spins() const;
  MixedViews mixed_views() { return items_.mixed.views(items_.other); }
  void convert_to_mixed();
  void convert_from_mixed();

  CudaItems& items_;
  CudaList& list_;
  RunControl& control_;
  RunWorkspace& workspace_;
  const Real h_;
  std::optional<Mixed> mixed_;
};

}  // namespace scree
