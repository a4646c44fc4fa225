// Batches of explicit steps as CUDA graphs: one launch instead of one or two per step.
#pragma once

#include <array>
#include <string>

#include "device.cuh"

namespace scree {

// Part of a key: of what a launch is given.
template <class T>
std::string key_of(const T& value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
}

class StepGraph {
 public:
  static constexpr int kSteps = 16;  // in one graph

  StepGraph() = default;
  ~StepGraph();
  StepGraph(const StepGraph&) = delete;
  StepGraph& operator=(const StepGraph&) = delete;

  // Queues `steps` calls of queue_one(), which queues one step on the stream. key: all that the launches
  // depend on; a batch of a key that has a graph is launched without capturing it again. Steps of a new key
  // are queued one by one first, so that the GPU has work while the host makes the graph; where it would not
  // be launched now, it is made when the key comes again.
  template <class QueueOne>
  void queue(cudaStream_t stream, const std::string& key, int steps, const QueueOne& queue_one) {
    if (steps >= kSteps) {
      Entry* entry = find(key);
      const bool pays = entry != nullptr || steps >= 2 * kSteps;
      if (entry == nullptr) entry = &remember(key);
      if (entry->graph == nullptr) {
        for (int step = 0; step < kSteps; ++step) queue_one();
        steps -= kSteps;
        if (pays) entry->graph = capture(stream, queue_one);
      }
      for (; entry->graph != nullptr && steps >= kSteps; steps -= kSteps)
        require_cuda(cudaGraphLaunch(entry->graph, stream), "cudaGraphLaunch");
    }
    for (; steps > 0; --steps) queue_one();
  }

 private:
  struct Entry {
    std::string key;
    cudaGraphExec_t graph = nullptr;  // null: the key was seen, but has none yet
  };
  Entry* find(const std::string& key);
  Entry& remember(const std::string& key);
  static cudaGraphExec_t instantiate(cudaGraph_t captured);

  template <class QueueOne>
  static cudaGraphExec_t capture(cudaStream_t stream, const QueueOne& queue_one) {
    require_cuda(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
    for (int step = 0; step < kSteps; ++step) queue_one();
    cudaGraph_t captured = nullptr;
    require_cuda(cudaStreamEndCapture(stream, &captured), "cudaStreamEndCapture");
    return instantiate(captured);
  }

  // Sorting swaps the arrays of the particles, so that two keys alternate; two more are slack.
  std::array<Entry, 4> entries_;
  std::size_t oldest_ = 0;
};

}  // namespace scree
