// Where the loops over items run on a GPU, its memory, and how its errors become ours.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace scree {

// The counterpart of Serial: work is queued on the stream and this returns before it is done.
struct Device {
  cudaStream_t stream = nullptr;
};

// Of the GPU.
std::size_t multiprocessors();
std::array<char, 16> device_uuid();

// Throws DeviceError with the runtime's text. what: the call that failed, for the message. Where memory was
// wanting the device works on, and the runtime forgets the error: the next launch would report it as its own.
inline void require_cuda(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  if (status == cudaErrorMemoryAllocation) cudaGetLastError();
  throw DeviceError(std::string("cuda: ") + what + ": " + cudaGetErrorString(status));
}

inline void wait_for(cudaStream_t stream) {
  require_cuda(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
}

// urgent: its blocks start before those that wait on other streams.
enum class Priority { normal, urgent };

// A stream of its own, and an event on it.
class Stream {
 public:
  explicit Stream(Priority priority = Priority::normal) {
    int least = 0, greatest = 0;
    require_cuda(cudaDeviceGetStreamPriorityRange(&least, &greatest), "cudaDeviceGetStreamPriorityRange");
    require_cuda(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking,
                                              priority == Priority::urgent ? greatest : least),
                 "cudaStreamCreate");
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
  void wait() const { require_cuda(cudaEventSynchronize(event_), "cudaEventSynchronize"); }

 private:
  cudaEvent_t event_ = nullptr;
};

// An event that knows when it was.
class TimedEvent {
 public:
  TimedEvent() { require_cuda(cudaEventCreate(&event_), "cudaEventCreate"); }
  ~TimedEvent() { cudaEventDestroy(event_); }
  TimedEvent(const TimedEvent&) = delete;
  TimedEvent& operator=(const TimedEvent&) = delete;
  void record(cudaStream_t stream) { require_cuda(cudaEventRecord(event_, stream), "cudaEventRecord"); }
  // Both have been [s].
  double seconds_since(const TimedEvent& before) const {
    float milliseconds = 0;
    require_cuda(cudaEventElapsedTime(&milliseconds, before.event_, event_), "cudaEventElapsedTime");
    return 1e-3 * static_cast<double>(milliseconds);
  }

 private:
  cudaEvent_t event_ = nullptr;
};

// Leaves all but `shared` bytes of a multiprocessor's fast memory, and what the driver takes for itself, to
// its cache. Without this the driver takes more for shared memory than the blocks need.
template <class Kernel>
void prefer_cache(Kernel* kernel, std::size_t shared) {
  constexpr std::size_t kDriver = 16 * 1024;  // 1 KB per block
  int device = 0, most = 0;
  require_cuda(cudaGetDevice(&device), "cudaGetDevice");
  require_cuda(cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerMultiprocessor, device),
               "cudaDeviceGetAttribute");
  const auto percent =
      static_cast<int>(std::min<std::size_t>(100, 100 * (shared + kDriver) / static_cast<std::size_t>(most)));
  require_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout, percent),
               "cudaFuncSetAttribute");
}

// What the code of a kernel that this GPU runs was compiled for: 90 for generation 9.0.
template <class Kernel>
int generation_of(Kernel* kernel) {
  cudaFuncAttributes attributes{};
  require_cuda(cudaFuncGetAttributes(&attributes, kernel), "cudaFuncGetAttributes");
  return attributes.ptxVersion;
}

// n values, queued on the stream. from and to: device and pinned memory.
template <class T>
void copy_async(T* to, const T* from, std::size_t n, cudaStream_t stream) {
  if (n > 0)
    require_cuda(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDefault, stream), "cudaMemcpyAsync");
}

// Device memory that the arrays below hold now [B].
std::size_t& device_bytes_in_use();

// An array on the device. Its contents are lost where it has to grow.
template <class T>
class DeviceArray {
 public:
  static constexpr std::size_t kSpare = 8;  // an array that grows gets 1 / kSpare more than asked for

  DeviceArray() = default;
  explicit DeviceArray(std::size_t size) { resize(size); }
  ~DeviceArray() { release(); }
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    swap(other);
    return *this;
  }

  // Throws DeviceError where the memory does not suffice; the array is then empty.
  void resize(std::size_t size) {
    if (size > capacity_) {
      release();
      require_cuda(cudaMalloc(&data_, size * sizeof(T)), "device memory");
      capacity_ = size;
      device_bytes_in_use() += size * sizeof(T);
    }
    size_ = size;
  }
  // The same, with room for more where the array has to grow: for sizes that change a little each time.
  void resize_with_spare(std::size_t size) {
    if (size > capacity_) resize(size + size / kSpare);
    size_ = size;
  }
  // The same for records that travel to the host whole: bytes between their members, which nobody writes, are
  // zero.
  void resize_clean(std::size_t size, cudaStream_t stream) {
    if (size <= capacity_) {
      size_ = size;
      return;
    }
    resize(size);
    zero(stream);
  }
  // The same, with the first `keep` values kept where the array has to grow, and room for more. Waits if it
  // grows.
  void grow(std::size_t size, std::size_t keep, cudaStream_t stream) {
    if (size > capacity_) {
      DeviceArray larger(keep > 0 ? size + size / kSpare : size);
      copy_async(larger.data_, data_, keep, stream);
      wait_for(stream);
      swap(larger);
    }
    size_ = size;
  }
  // Gives back what it has beyond twice the room for more; the first `keep` values stay. Waits if it does.
  void trim(std::size_t keep, cudaStream_t stream) {
    if (borrowed_ || capacity_ <= size_ + 2 * (size_ / kSpare)) return;
    DeviceArray smaller(size_ + size_ / kSpare);
    copy_async(smaller.data_, data_, keep, stream);
    wait_for(stream);
    smaller.size_ = size_;
    swap(smaller);
  }
  // So many values stand at `data` from now on, in memory that another holds. Where the array has to grow it
  // takes memory of its own.
  void borrow(T* data, std::size_t size) {
    release();
    data_ = data, size_ = capacity_ = size, borrowed_ = true;
  }
  // It is empty afterwards.
  void release() {
    if (data_ != nullptr && !borrowed_) {
      cudaFree(data_);
      device_bytes_in_use() -= capacity_ * sizeof(T);
    }
    data_ = nullptr, size_ = capacity_ = 0, borrowed_ = false;
  }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return borrowed_ ? 0 : capacity_ * sizeof(T); }  // that it holds
  T* data() { return data_; }
  const T* data() const { return data_; }
  void swap(DeviceArray& other) noexcept {
    std::swap(data_, other.data_), std::swap(size_, other.size_), std::swap(capacity_, other.capacity_);
    std::swap(borrowed_, other.borrowed_);
  }
  void zero(cudaStream_t stream) {
    if (size_ > 0) require_cuda(cudaMemsetAsync(data_, 0, size_ * sizeof(T), stream), "cudaMemsetAsync");
  }

  // Whole vectors; both wait until the copy is done.
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
  bool borrowed_ = false;
};

// A library call that needs space on the device: call(nullptr, bytes) asks for how much, call(at, bytes) does
// the work.
template <class Call>
void with_space(DeviceArray<unsigned char>& space, const Call& call) {
  std::size_t bytes = 0;
  call(nullptr, bytes);
  space.resize(std::max<std::size_t>(bytes, 1));
  call(space.data(), bytes);
}

// An array in host memory that the device copies to and from without waiting.
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
