// How loops over items run on a GPU, its memory, and the conversion of its errors to exceptions.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/stage_trace.hpp"

namespace scree {

// The counterpart of `Serial`: work is queued on the stream, and the call returns before it is done.
struct Device {
  cudaStream_t stream = nullptr;
};

// Of the GPU that this rank uses.
std::size_t multiprocessors();
std::array<char, 16> device_uuid();

// Throws `DeviceError` with the runtime's text. what: the call that failed, for the message. After a lack of
// memory the device still works, and the error is cleared: otherwise the next launch would report it as its
// own.
inline void require_cuda(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  if (status == cudaErrorMemoryAllocation) cudaGetLastError();
  throw DeviceError(std::string("cuda: ") + what + ": " + cudaGetErrorString(status));
}

inline void wait_for(cudaStream_t stream) {
  const StageTrace::Wait wait;
  require_cuda(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
}

// Blocks of a stream with a higher priority are scheduled before all others that wait.
enum class Priority { normal, high, urgent };

// A stream and an event, each owned by its object.
class Stream {
 public:
  explicit Stream(Priority priority = Priority::normal) {
    int least = 0, greatest = 0;
    require_cuda(cudaDeviceGetStreamPriorityRange(&least, &greatest), "cudaDeviceGetStreamPriorityRange");
    const int value = priority == Priority::normal ? least
                      : priority == Priority::high ? std::min(greatest + 1, least)
                                                   : greatest;
    require_cuda(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, value), "cudaStreamCreate");
  }
  ~Stream() { cudaStreamDestroy(stream_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  operator cudaStream_t() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

class Event {
 public:
  Event() { require_cuda(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "cudaEventCreate"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  void record(cudaStream_t stream) { require_cuda(cudaEventRecord(event_, stream), "cudaEventRecord"); }
  void hold(cudaStream_t stream) const {
    require_cuda(cudaStreamWaitEvent(stream, event_), "cudaStreamWaitEvent");
  }
  void wait() const {
    const StageTrace::Wait traced;
    require_cuda(cudaEventSynchronize(event_), "cudaEventSynchronize");
  }

 private:
  cudaEvent_t event_ = nullptr;
};

// An event that records its time.
class TimedEvent {
 public:
  TimedEvent() { require_cuda(cudaEventCreate(&event_), "cudaEventCreate"); }
  ~TimedEvent() { cudaEventDestroy(event_); }
  TimedEvent(const TimedEvent&) = delete;
  TimedEvent& operator=(const TimedEvent&) = delete;
  void record(cudaStream_t stream) { require_cuda(cudaEventRecord(event_, stream), "cudaEventRecord"); }
  // Time between two recorded events [s].
  double seconds_since(const TimedEvent& before) const {
    float milliseconds = 0;
    require_cuda(cudaEventElapsedTime(&milliseconds, before.event_, event_), "cudaEventElapsedTime");
    return 1e-3 * static_cast<double>(milliseconds);
  }

 private:
  cudaEvent_t event_ = nullptr;
};

// Leaves the on-chip memory of a multiprocessor to the L1 cache, except for `shared` bytes and what the
// driver reserves. By default the driver assigns more to shared memory than the blocks need.
template <class Kernel>
void prefer_cache(Kernel* kernel, std::size_t shared) {
  constexpr std::size_t kDriver = 16 * 1024;  // reserved by the driver: 1 KB per block
  int device = 0, most = 0;
  require_cuda(cudaGetDevice(&device), "cudaGetDevice");
  require_cuda(cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerMultiprocessor, device),
               "cudaDeviceGetAttribute");
  const auto percent =
      static_cast<int>(std::min<std::size_t>(100, 100 * (shared + kDriver) / static_cast<std::size_t>(most)));
  require_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout, percent),
               "cudaFuncSetAttribute");
}

// The architecture for which the code of a kernel on this GPU was compiled: 90 for compute capability 9.0.
template <class Kernel>
int generation_of(Kernel* kernel) {
  cudaFuncAttributes attributes{};
  require_cuda(cudaFuncGetAttributes(&attributes, kernel), "cudaFuncGetAttributes");
  return attributes.ptxVersion;
}

// Queues a copy of n values on the stream. from and to: device or pinned memory.
template <class T>
void copy_async(T* to, const T* from, std::size_t n, cudaStream_t stream) {
  if (n > 0)
    require_cuda(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDefault, stream), "cudaMemcpyAsync");
}

// Device memory that all `DeviceArray`s hold now [B].
std::size_t& device_bytes_in_use();

// An array on the device. Its contents are lost when it grows.
template <class T>
class DeviceArray {
 public:
  static constexpr std::size_t kSpare = 8;  // reserve of a growing array: 1 / kSpare of its size

  DeviceArray() = default;
  explicit DeviceArray(std::size_t size) { resize(size); }
  ~DeviceArray() { release(); }
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    swap(other);
    return *this;
  }

  // Throws `DeviceError` where memory does not suffice; the array is then empty.
  void resize(std::size_t size) {
    if (size > capacity_) {
      release();
      require_cuda(cudaMalloc(&data_, size * sizeof(T)), "device memory");
      capacity_ = size;
      device_bytes_in_use() += size * sizeof(T);
    }
    size_ = size;
  }
  // The same, with a reserve when the array grows: for sizes that vary a little.
  void resize_with_spare(std::size_t size) {
    if (size > capacity_) resize(size + size / kSpare);
    size_ = size;
  }
  // The same for records that are copied to the host whole: it clears the padding bytes between their
  // members, which nothing else writes.
  void resize_clean(std::size_t size, cudaStream_t stream) {
    if (size <= capacity_) {
      size_ = size;
      return;
    }
    resize(size);
    zero(stream);
  }
  // The same, keeping the first `keep` values when the array grows, with a reserve. Waits if it grows.
  void grow(std::size_t size, std::size_t keep, cudaStream_t stream) {
    if (size > capacity_) {
      DeviceArray larger(keep > 0 ? size + size / kSpare : size);
      copy_async(larger.data_, data_, keep, stream);
      wait_for(stream);
      swap(larger);
    }
    size_ = size;
  }
  // Shrinks to twice the reserve if it is larger; keeps the first `keep` values. Waits if it shrinks.
  void trim(std::size_t keep, cudaStream_t stream) {
    if (is_alias_ || capacity_ <= size_ + 2 * (size_ / kSpare)) return;
    DeviceArray smaller(size_ + size_ / kSpare);
    copy_async(smaller.data_, data_, keep, stream);
    wait_for(stream);
    smaller.size_ = size_;
    swap(smaller);
  }
  // From now on the n values are at `data`, in memory that another array owns. If the array has to grow it
  // allocates its own.
  void alias_memory(T* data, std::size_t size) {
    release();
    data_ = data, size_ = capacity_ = size, is_alias_ = true;
  }
  // The array is empty afterwards.
  void release() {
    if (data_ != nullptr && !is_alias_) {
      cudaFree(data_);
      device_bytes_in_use() -= capacity_ * sizeof(T);
    }
    data_ = nullptr, size_ = capacity_ = 0, is_alias_ = false;
  }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return is_alias_ ? 0 : capacity_ * sizeof(T); }  // none for an alias [B]
  T* data() { return data_; }
  const T* data() const { return data_; }
  void swap(DeviceArray& other) noexcept {
    std::swap(data_, other.data_), std::swap(size_, other.size_), std::swap(capacity_, other.capacity_);
    std::swap(is_alias_, other.is_alias_);
  }
  void zero(cudaStream_t stream) {
    if (size_ > 0) require_cuda(cudaMemsetAsync(data_, 0, size_ * sizeof(T), stream), "cudaMemsetAsync");
  }

  // Copies of whole vectors; both wait until the copy is done.
  void upload(const std::vector<T>& values, cudaStream_t stream) {
    resize(values.size());
    copy(data_, values.data(), size_, cudaMemcpyHostToDevice, stream);
  }
  std::vector<T> download(cudaStream_t stream) const {
    std::vector<T> values(size_);
    copy(values.data(), data_, size_, cudaMemcpyDeviceToHost, stream);
    return values;
  }

 private:
  static void copy(T* to, const T* from, std::size_t n, cudaMemcpyKind kind, cudaStream_t stream) {
    if (n == 0) return;
    require_cuda(cudaMemcpyAsync(to, from, n * sizeof(T), kind, stream), "cudaMemcpyAsync");
    wait_for(stream);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
  bool is_alias_ = false;
};

// A library call with scratch memory on the device: call(nullptr, bytes) sets the size that it needs,
// call(at, bytes) runs.
template <class Call>
void with_space(DeviceArray<unsigned char>& space, const Call& call) {
  std::size_t bytes = 0;
  call(nullptr, bytes);
  space.resize_with_spare(std::max<std::size_t>(bytes, 1));
  call(space.data(), bytes);
}

// A page-locked array of the host, for asynchronous copies.
template <class T>
class PinnedArray {
 public:
  PinnedArray() = default;
  explicit PinnedArray(std::size_t size) { resize(size); }
  ~PinnedArray() { cudaFreeHost(data_); }
  PinnedArray(const PinnedArray&) = delete;
  PinnedArray& operator=(const PinnedArray&) = delete;

  void resize(std::size_t size) {
    if (size > capacity_) {
      cudaFreeHost(data_);
      data_ = nullptr, capacity_ = 0;
      require_cuda(cudaMallocHost(&data_, size * sizeof(T)), "pinned host memory");
      capacity_ = size;
    }
    size_ = size;
  }
  // As of `DeviceArray`: page-locking waits for the device.
  void resize_with_spare(std::size_t size) {
    if (size > capacity_) resize(size + size / DeviceArray<T>::kSpare);
    size_ = size;
  }
  std::size_t size() const { return size_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace scree
