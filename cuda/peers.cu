#include "peers.cuh"

namespace scree {
namespace {

// Memory of other processes is mapped in pieces of this size, and smaller allocations share a piece: what is
// shared gets pieces of its own.
constexpr std::size_t kPiece = std::size_t{1} << 21;  // [B]
constexpr std::size_t pieces_for(std::size_t bytes) { return (bytes + kPiece - 1) / kPiece * kPiece; }

// Opens what each of the other ranks passes as `own`, the start of an allocation. Collective; throws on every
// rank where one cannot.
std::vector<PeerMemory> open_peers(const Ranks& ranks, void* own) {
  cudaIpcMemHandle_t handle{};
  ranks.collectively([&] { require_cuda(cudaIpcGetMemHandle(&handle, own), "cudaIpcGetMemHandle"); });
  const std::vector<cudaIpcMemHandle_t> handles = ranks.all_gather(std::vector{handle});
  std::vector<PeerMemory> opened(handles.size());
  ranks.collectively([&] {
    for (std::size_t rank = 0; rank < handles.size(); ++rank)
      if (static_cast<int>(rank) != ranks.rank()) opened[rank] = PeerMemory(handles[rank]);
  });
  return opened;
}

__global__ void greet_kernel(const __grid_constant__ PeerLinks peers) {
  if (static_cast<int>(threadIdx.x) < peers.size) peers.flags[threadIdx.x]->greeted[peers.rank] = 1;
}

}  // namespace

Peers::Peers(const Ranks& ranks) : ranks_(ranks) {
  ranks.collectively([&] {
    own_flags_.resize(pieces_for(sizeof(PeerFlags)));
    own_flags_.zero(nullptr);
    wait_for(nullptr);
  });
  flags_ = open_peers(ranks, own_flags_.data());
  links_.rank = ranks.rank(), links_.size = ranks.size();
  for (int rank = 0; rank < links_.size; ++rank)
    links_.flags[rank] = reinterpret_cast<PeerFlags*>(
        rank == links_.rank ? own_flags_.data() : flags_[static_cast<std::size_t>(rank)].at());
  greet();
}

// Whether what a rank writes reaches the others: where memory can be opened, it need not.
void Peers::greet() {
  ranks_.collectively([&] {
    greet_kernel<<<1, kMostPeers>>>(links_);
    require_cuda(cudaGetLastError(), "peer memory");
    wait_for(nullptr);
  });
  ranks_.collectively([&] {
    PeerFlags own{};
    require_cuda(cudaMemcpy(&own, own_flags_.data(), sizeof own, cudaMemcpyDeviceToHost), "cudaMemcpy");
    for (int rank = 0; rank < links_.size; ++rank)
      if (own.greeted[rank] != 1) throw DeviceError("cuda: what another GPU writes does not arrive");
  });
}

void Peers::set_plan(const HaloPlan& plan) {
  struct Mailbox {
    Index received;
    Index first[kMostPeers];  // by sender: where its ghosts begin
  };
  Mailbox own{plan.ghosts() - plan.own(), {}};
  for (const HaloNeighbor& n : plan.neighbors()) own.first[n.rank] = n.first_received - plan.own();
  const std::vector<Mailbox> all = ranks_.all_gather(std::vector{own});
  Index most = 1;
  for (const Mailbox& mailbox : all) most = std::max(most, mailbox.received);
  reserve(most);
  own_ = plan.own(), entries_ = plan.own() + plan.sent(), received_ = own.received;
  neighbors_ = {};
  for (const HaloNeighbor& n : plan.neighbors()) {
    const int k = neighbors_.count++;
    neighbors_.rank[k] = n.rank, end_[k] = n.first_sent + n.sent;
    first_[k] = all[static_cast<std::size_t>(n.rank)].first[links_.rank] - n.first_sent;
  }
}

// All ranks have the same capacity, so they grow together. A rank's memory is released only once no other
// rank has it open.
void Peers::reserve(Index ghosts) {
  if (ghosts <= capacity_) return;
  constexpr std::size_t kGhostBytes = kFields * sizeof(Vec4), kSpare = 8, kAligned = 8;
  const auto needed = static_cast<std::size_t>(ghosts);
  const std::size_t bytes = pieces_for(kGhostBytes * (needed + needed / kSpare + kAligned));
  ranks_.collectively([&] { mailboxes_.clear(); });
  ranks_.collectively([&] { own_mailbox_.resize(bytes); });
  mailboxes_ = open_peers(ranks_, own_mailbox_.data());
  for (int rank = 0; rank < links_.size; ++rank)
    mailbox_of_[rank] = static_cast<std::byte*>(
        rank == links_.rank ? own_mailbox_.data() : mailboxes_[static_cast<std::size_t>(rank)].at());
  capacity_ = static_cast<Index>(bytes / kGhostBytes / kAligned * kAligned);
}

}  // namespace scree
