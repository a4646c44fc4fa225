#include <algorithm>

#include "step_graph.cuh"

namespace scree {

StepGraph::~StepGraph() {
  for (Entry& entry : entries_)
    if (entry.graph != nullptr) cudaGraphExecDestroy(entry.graph);
}

StepGraph::Entry* StepGraph::find(const std::string& key) {
  const auto entry =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& of) { return of.key == key; });
  return entry == entries_.end() ? nullptr : &*entry;
}

StepGraph::Entry& StepGraph::remember(const std::string& key) {
  Entry& entry = entries_[oldest_];
  oldest_ = (oldest_ + 1) % entries_.size();
  if (entry.graph != nullptr) cudaGraphExecDestroy(entry.graph);
  entry = {key, nullptr};
  return entry;
}

cudaGraphExec_t StepGraph::instantiate(cudaGraph_t captured) {
  cudaGraphExec_t graph = nullptr;
  const cudaError_t status = cudaGraphInstantiate(&graph, captured, cudaGraphInstantiateFlagUseNodePriority);
  cudaGraphDestroy(captured);
  require_cuda(status, "cudaGraphInstantiate");
  return graph;
}

}  // namespace scree
