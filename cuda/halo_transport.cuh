// How ghosts travel between the GPUs of the ranks, and the maxima over all ranks that the middle of a step
// needs: as messages, or in explicit steps as writes into each other's memory (`Peers`).
#pragma once

#include <memory>
#include <span>
#include <string>

#include "dem/backend/device.hpp"
#include "device.cuh"
#include "model/data/model.hpp"
#include "partition/halo_plan.hpp"
#include "peers.cuh"

namespace scree {

class HaloTransport {
 public:
  virtual ~HaloTransport() = default;
  virtual std::string name() const = 0;
  // Whether every call waits for the stream on the host.
  virtual bool waits() const = 0;
  // Exchanges the messages of a plan whose counts are set, in device memory, in stream order. Collective.
  virtual void exchange(const HaloPlan& plan, std::span<const HaloMessage> messages, cudaStream_t stream) = 0;
  // values[0 ... n-1] >= 0 in device memory become their maxima over all ranks; a NaN is larger than any
  // number. Collective.
  virtual void max(Real* values, Index n, cudaStream_t stream) = 0;
};

struct HaloTransports {
  std::unique_ptr<HaloTransport> messages;  // null for one rank
  std::unique_ptr<Peers> peers;             // null where explicit steps send messages, too
};

// The transport that the deck names or, for automatic, the first that works here: writes into the memory of
// the other ranks, MPI if it takes device memory, NCCL if the program was built with it and no two ranks
// share a GPU, else copies in host memory. Beside peers, what is no explicit step uses the first of the
// others. Collective. Throws `TransportError` where the named one does not work here.
HaloTransports make_halo_transports(const Ranks& ranks, Transport transport);

}  // namespace scree
