#include "halo_transport.cuh"

#ifdef SCREE_NCCL
#include <nccl.h>
#endif

#include <vector>

namespace scree {
namespace {

// MPI reads and writes device memory directly.
class CudaAwareTransport : public HaloTransport {
 public:
  explicit CudaAwareTransport(const Ranks& ranks) : ranks_(ranks), h_values_(kMostValues) {}
  std::string name() const override { return "CUDA-aware MPI"; }
  bool waits() const override { return true; }

  void exchange(const HaloPlan& plan, std::span<const HaloMessage> messages, cudaStream_t stream) override {
    wait_for(stream);
    plan.transfer(messages);
  }
  // up to this many values are as fast through the host
  void max(Real* values, Index n, cudaStream_t stream) override {
    const auto count = static_cast<std::size_t>(n);
    copy_async(h_values_.data(), values, count, stream);
    wait_for(stream);
    ranks_.max({h_values_.data(), count});
    copy_async(values, h_values_.data(), count, stream);
  }

 protected:
  static constexpr std::size_t kMostValues = 16;
  Ranks ranks_;
  PinnedArray<Real> h_values_;
};

// Copies in pinned host memory, which work with every MPI.
class StagedTransport : public CudaAwareTransport {
 public:
  using CudaAwareTransport::CudaAwareTransport;
  std::string name() const override { return "copies in host memory"; }

  void exchange(const HaloPlan& plan, std::span<const HaloMessage> messages, cudaStream_t stream) override {
    wait_for(stream);  // before the buffers grow: earlier copies from them may be under way
    std::vector<HaloMessage> staged;
    std::size_t bytes = 0;
    const auto reserve = [&](Index entries, std::size_t element) {
      constexpr std::size_t kAlignment = 64;
      const std::size_t at = bytes;
      bytes += (static_cast<std::size_t>(entries) * element + kAlignment - 1) / kAlignment * kAlignment;
      return at;
    };
    std::vector<std::size_t> packed, ghosts;
    for (const HaloMessage& m : messages)
      packed.push_back(reserve(plan.sent(), m.element)), ghosts.push_back(reserve(plan.ghosts(), m.element));
    buffer_.resize(bytes);
    for (std::size_t k = 0; k < messages.size(); ++k) {
      const HaloMessage& m = messages[k];
      copy_async(buffer_.data() + packed[k], static_cast<const unsigned char*>(m.packed),
                 static_cast<std::size_t>(plan.sent()) * m.element, stream);
      staged.push_back({buffer_.data() + packed[k], buffer_.data() + ghosts[k], m.element});
    }
    wait_for(stream);
    plan.transfer(staged);
    for (std::size_t k = 0; k < messages.size(); ++k) {
      const std::size_t own = static_cast<std::size_t>(plan.own()) * messages[k].element;
      copy_async(static_cast<unsigned char*>(messages[k].ghosts) + own, buffer_.data() + ghosts[k] + own,
                 static_cast<std::size_t>(plan.ghosts() - plan.own()) * messages[k].element, stream);
    }
  }

 private:
  PinnedArray<unsigned char> buffer_;
};

#ifdef SCREE_NCCL
void require_nccl(ncclResult_t status, const char* what) {
  if (status != ncclSuccess)
    throw DeviceError(std::string("nccl: ") + what + ": " + ncclGetErrorString(status));
}

// Everything is queued on the stream, and the host continues.
class NcclTransport : public HaloTransport {
 public:
  explicit NcclTransport(const Ranks& ranks) {
    ncclUniqueId id{};
    ranks.on_root([&] { require_nccl(ncclGetUniqueId(&id), "ncclGetUniqueId"); });
    ranks.broadcast(id);
    require_nccl(ncclCommInitRank(&communicator_, ranks.size(), id, ranks.rank()), "ncclCommInitRank");
    connect(ranks);
  }
  // ncclCommAbort, because after a failure ncclCommDestroy would wait for ranks that no longer take part.
  ~NcclTransport() override { ncclCommAbort(communicator_); }
  std::string name() const override { return "NCCL"; }
  bool waits() const override { return false; }

  void exchange(const HaloPlan& plan, std::span<const HaloMessage> messages, cudaStream_t stream) override {
    if (plan.neighbors().empty()) return;
    require_nccl(ncclGroupStart(), "ncclGroupStart");
    for (const HaloMessage& m : messages)
      for (const HaloNeighbor& n : plan.neighbors()) {
        const auto bytes = [&](Index entries) { return static_cast<std::size_t>(entries) * m.element; };
        if (n.sent > 0)
          require_nccl(ncclSend(static_cast<const char*>(m.packed) + bytes(n.first_sent), bytes(n.sent),
                                ncclInt8, n.rank, communicator_, stream),
                       "ncclSend");
        if (n.received > 0)
          require_nccl(ncclRecv(static_cast<char*>(m.ghosts) + bytes(n.first_received), bytes(n.received),
                                ncclInt8, n.rank, communicator_, stream),
                       "ncclRecv");
      }
    require_nccl(ncclGroupEnd(), "ncclGroupEnd");
  }
  // The bits of numbers >= 0 are ordered as the numbers, and a NaN's exceed them all.
  void max(Real* values, Index n, cudaStream_t stream) override {
    require_nccl(ncclAllReduce(values, values, static_cast<std::size_t>(n), ncclUint64, ncclMax,
                               communicator_, stream),
                 "ncclAllReduce");
  }

 private:
  // NCCL connects two ranks at their first message, which takes up to a second: at the start, not within the
  // first steps. With many ranks, most pairs never exchange any.
  void connect(const Ranks& ranks) {
    constexpr int kFew = 8;
    const Stream stream;
    DeviceArray<Real> value;
    value.upload(std::vector<Real>(static_cast<std::size_t>(ranks.size())), stream);
    max(value.data(), 1, stream);
    if (ranks.size() <= kFew) {
      require_nccl(ncclGroupStart(), "ncclGroupStart");
      for (int other = 0; other < ranks.size(); ++other) {
        if (other == ranks.rank()) continue;
        require_nccl(ncclSend(value.data() + ranks.rank(), 1, ncclDouble, other, communicator_, stream),
                     "ncclSend");
        require_nccl(ncclRecv(value.data() + other, 1, ncclDouble, other, communicator_, stream), "ncclRecv");
      }
      require_nccl(ncclGroupEnd(), "ncclGroupEnd");
    }
    wait_for(stream);
  }

  ncclComm_t communicator_ = nullptr;
};
#endif

// Whether two ranks use the same GPU: NCCL allows one rank per GPU.
bool gpus_are_shared(const Ranks& ranks) {
  auto all = ranks.all_gather(std::vector{device_uuid()});
  std::sort(all.begin(), all.end());
  return std::adjacent_find(all.begin(), all.end()) != all.end();
}

// Why NCCL does not work here; empty if it does.
std::string nccl_error([[maybe_unused]] bool shared) {
#ifdef SCREE_NCCL
  return shared ? "two ranks share a GPU, and NCCL takes one rank per GPU" : "";
#else
  return "this program was built without NCCL";
#endif
}

std::string cuda_aware_error(const Ranks& ranks) {
  return ranks.any(!Ranks::mpi_takes_device_memory()) ? "this MPI library does not take device memory" : "";
}

struct PeerConnection {
  std::unique_ptr<Peers> peers;
  std::string error;  // why there are none
};

// shared: whether two ranks use the same GPU. They would wait for each other there, so it is not tried.
PeerConnection connect_peers(const Ranks& ranks, bool shared) {
  if (ranks.size() > kMostPeers)
    return {nullptr, "it is for at most " + std::to_string(kMostPeers) + " ranks"};
  if (ranks.any(ranks.sum_on_host(1) < ranks.size())) return {nullptr, "the ranks are on several hosts"};
  if (shared) return {nullptr, "two ranks share a GPU"};
  try {
    return {std::make_unique<Peers>(ranks), ""};
  } catch (const DeviceError& error) {  // on all ranks alike
    cudaGetLastError();                 // otherwise the next launch would report it as its own
    return {nullptr, std::string("the GPUs cannot write each other's memory (") + error.what() + ")"};
  }
}

// messages: one that works here.
std::unique_ptr<HaloTransport> make_messages(const Ranks& ranks, Transport messages) {
  if (messages == Transport::cuda_aware) return std::make_unique<CudaAwareTransport>(ranks);
#ifdef SCREE_NCCL
  if (messages == Transport::nccl) return std::make_unique<NcclTransport>(ranks);
#endif
  return std::make_unique<StagedTransport>(ranks);
}

}  // namespace

HaloTransports make_halo_transports(const Ranks& ranks, Transport transport) {
  if (ranks.alone()) return {};
  const bool shared = gpus_are_shared(ranks), automatic = transport == Transport::automatic;
  const std::string no_nccl = nccl_error(shared), no_mpi = cuda_aware_error(ranks);
  PeerConnection connection;
  if (automatic || transport == Transport::peer) connection = connect_peers(ranks, shared);
  const std::string error = transport == Transport::peer         ? connection.error
                            : transport == Transport::cuda_aware ? no_mpi
                            : transport == Transport::nccl       ? no_nccl
                                                                 : "";
  if (!error.empty()) {
    std::string allowed = "\"auto\"";
    if (transport != Transport::peer && connect_peers(ranks, shared).peers) allowed += ", \"peer\"";
    if (no_mpi.empty()) allowed += ", \"cuda-aware\"";
    if (no_nccl.empty()) allowed += ", \"nccl\"";
    throw TransportError("parallel.transport = \"" + word_of(transport) + "\": " + error +
                         "; allowed here: " + allowed + ", \"staged\"");
  }
  if (automatic || transport == Transport::peer)
    transport = no_mpi.empty()    ? Transport::cuda_aware
                : no_nccl.empty() ? Transport::nccl
                                  : Transport::staged;
  return {make_messages(ranks, transport), std::move(connection.peers)};
}

}  // namespace scree
