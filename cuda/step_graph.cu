#include "step_graph.cuh"

namespace scree {

StepGraph::~StepGraph() {
  for (Entry& entry : entries_)
    if (entry.graph != nullptr) cudaGraphExecDestroy(entry.graph);
}

cudaGraphExec_t StepGraph::find(const std::string& key) const {
  for (const Entry& entry : entries_)
    if (entry.graph != nullptr && entry.key == key) return entry.graph;
  return nullptr;
}

cudaGraphExec_t StepGraph::keep(const std::string& key, cudaGraph_t captured) {
  Entry& entry = entries_[oldest_];
  oldest_ = (oldest_ + 1) % entries_.size();
  if (entry.graph != nullptr) cudaGraphExecDestroy(entry.graph);
  entry = {key, nullptr};
  const cudaError_t status =
      cudaGraphInstantiate(&entry.graph, captured, cudaGraphInstantiateFlagUseNodePriority);
  cudaGraphDestroy(captured);
  require_cuda(status, "cudaGraphInstantiate");
  return entry.graph;
}

}  // namespace scree
