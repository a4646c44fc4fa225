#include <cstring>

#include "dependent_launch.cuh"
#include "device_poses.cuh"
#include "for_each.cuh"

namespace scree {
namespace {

constexpr std::size_t kWord = sizeof(uint4);  // what a thread reads at once
// A block of so few threads, with 32 registers each, fits beside three blocks of the particles' kernel.
constexpr int kSendThreads = 32;
constexpr Index kAtOnce = 2, kSentByBlock = kAtOnce * kSendThreads;  // reads that do not wait for each other

__global__ void __launch_bounds__(kSendThreads) send_kernel(Index words, const uint4* from, uint4* to) {
  admit_next_kernel();
  const Index first = static_cast<Index>(blockIdx.x) * kSentByBlock + static_cast<Index>(threadIdx.x);
  uint4 word[kAtOnce];
#pragma unroll
  for (Index k = 0; k < kAtOnce; ++k)
    if (const Index at = first + k * kSendThreads; at < words) word[k] = __ldcv(from + at);
#pragma unroll
  for (Index k = 0; k < kAtOnce; ++k)
    if (const Index at = first + k * kSendThreads; at < words) to[at] = word[k];
}

std::size_t rounded_up(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

}  // namespace

// One array for all: a transfer takes longer to begin than to move these bytes.
void DevicePoses::write(const SurfacePoses& poses, Bytes& to) {
  const std::size_t of_poses = poses.placed.size_bytes(), of_frames = poses.frames.size_bytes(),
                    of_bodies = poses.free_bodies.size_bytes();
  count_ = poses.placed.size();
  frames_at_ = rounded_up(of_poses, alignof(SurfaceFrame));
  free_bodies_at_ = rounded_up(frames_at_ + of_frames, alignof(FreeBody)), has_free_bodies_ = of_bodies > 0;
  to.resize(rounded_up(free_bodies_at_ + of_bodies, kWord)), posed_.resize(to.size());
  std::memcpy(to.data(), poses.placed.data(), of_poses);
  if (of_frames > 0) std::memcpy(to.data() + frames_at_, poses.frames.data(), of_frames);
  if (of_bodies > 0) std::memcpy(to.data() + free_bodies_at_, poses.free_bodies.data(), of_bodies);
}

// Until the last copy has read the pinned memory, and written what another stream will overwrite.
void DevicePoses::await_upload() {
  if (uploading_) uploaded_.wait();
  uploading_ = false;
}

void DevicePoses::upload(Device device, const SurfacePoses& poses) {
  await_upload();
  write(poses, h_uploaded_);
  copy_async(posed_.data(), h_uploaded_.data(), posed_.size(), device.stream);
  uploaded_.record(device.stream);
  uploading_ = true;
}

void DevicePoses::send(Device device, const SurfacePoses& poses) {
  await_upload();
  write(poses, h_sent_);
  const auto words = static_cast<Index>(h_sent_.size() / kWord);
  send_kernel<<<blocks_for(words, kSentByBlock), kSendThreads, 0, device.stream>>>(
      words, reinterpret_cast<const uint4*>(h_sent_.data()), reinterpret_cast<uint4*>(posed_.data()));
  require_cuda(cudaGetLastError(), "poses of surfaces");
}

void DevicePoses::store_start(Device device) {
  start_.resize(count_);
  copy_async(start_.data(), placed(), count_, device.stream);
}

}  // namespace scree
