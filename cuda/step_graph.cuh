// Batches of explicit steps as CUDA graphs: one launch instead of one or two per step.
#pragma once

#include <array>
#include <string>

#include "device.cuh"

namespace scree {

// Part of a key: one argument of a launch.
template <class T>
std::string key_of(const T& value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
}

class StepGraph {
 public:
  static constexpr int kSteps = 16;  // steps per graph

  StepGraph() = default;
  ~StepGraph();
  StepGraph(const StepGraph&) = delete;
  StepGraph& operator=(const StepGraph&) = delete;

  // Queues `steps` calls of queue_one(), which queues one step on the stream. key: everything that the
  // launches depend on; a batch with a known key is launched without being captured again. Steps of a new key
  // are first queued one by one, so that the GPU is busy while the host captures the graph.
  template <class QueueOne>
  void queue(cudaStream_t stream, const std::string& key, int steps, const QueueOne& queue_one) {
    if (steps >= kSteps) {
      cudaGraphExec_t graph = find(key);
      if (graph == nullptr) {
        for (int step = 0; step < kSteps; ++step) queue_one();
        steps -= kSteps;
        graph = capture(stream, key, queue_one);
      }
      for (; steps >= kSteps; steps -= kSteps)
        require_cuda(cudaGraphLaunch(graph, stream), "cudaGraphLaunch");
    }
    for (; steps > 0; --steps) queue_one();
  }

 private:
  struct Entry {
    std::string key;
    cudaGraphExec_t graph = nullptr;
  };
  cudaGraphExec_t find(const std::string& key) const;
  cudaGraphExec_t keep(const std::string& key, cudaGraph_t captured);

  template <class QueueOne>
  cudaGraphExec_t capture(cudaStream_t stream, const std::string& key, const QueueOne& queue_one) {
    require_cuda(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
    for (int step = 0; step < kSteps; ++step) queue_one();
    cudaGraph_t captured = nullptr;
    require_cuda(cudaStreamEndCapture(stream, &captured), "cudaStreamEndCapture");
    return keep(key, captured);
  }

  // The sort swaps the arrays of the particles, so that two keys alternate; two more are a reserve.
  std::array<Entry, 4> entries_;
  std::size_t oldest_ = 0;
};

}  // namespace scree
