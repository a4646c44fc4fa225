// Poses of the placed surfaces on the device.
#pragma once

#include "dem/surfaces/surfaces.hpp"
#include "device.cuh"

namespace scree {

class DevicePoses {
 public:
  // Queues the copy of new poses; the next call waits for it.
  void upload(Device device, const SurfacePoses& poses);
  // The same in a step of which the host awaits a result before it calls this again: a kernel reads the poses
  // from the host's memory, which takes the host and the device less time than to begin a copy.
  void send(Device device, const SurfacePoses& poses);
  // Queues a copy of the poses of the start of an implicit step.
  void store_start(Device device);

  const SurfacePose* placed() const { return reinterpret_cast<const SurfacePose*>(posed_.data()); }
  const SurfaceFrame* frames() const {
    return reinterpret_cast<const SurfaceFrame*>(posed_.data() + frames_at_);
  }
  // Null where there are none.
  const FreeBody* free_bodies() const {
    return has_free_bodies_ ? reinterpret_cast<const FreeBody*>(posed_.data() + free_bodies_at_) : nullptr;
  }
  const SurfacePose* start() const { return start_.data(); }

 private:
  using Bytes = PinnedArray<unsigned char>;

  void await_upload();
  void write(const SurfacePoses& poses, Bytes& to);

  // Poses of the surfaces, their frames from byte frames_at_ on, and their bodies from free_bodies_at_ on.
  Bytes h_uploaded_, h_sent_;
  DeviceArray<unsigned char> posed_;
  std::size_t frames_at_ = 0, free_bodies_at_ = 0, count_ = 0;
  bool has_free_bodies_ = false;
  Event uploaded_;
  bool uploading_ = false;  // whether the last copy may be under way
  DeviceArray<SurfacePose> start_;
};

}  // namespace scree
