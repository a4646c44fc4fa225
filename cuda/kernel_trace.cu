#include "kernel_trace.cuh"

#ifdef SCREE_CUPTI

#include <cupti.h>
#include <cxxabi.h>
#include <dlfcn.h>

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <regex>
#include <string>
#include <utility>

#include "device.cuh"

namespace scree {
namespace {

// CUPTI's records get longer with its versions, and the members used here keep their offsets since these.
using KernelRecord = CUpti_ActivityKernel4;
using CopyRecord = CUpti_ActivityMemcpy;

// The functions of CUPTI, from the library of the toolkit's major version.
struct Cupti {
  void* library = dlopen(("libcupti.so." + std::to_string(CUDART_VERSION / 1000)).c_str(), RTLD_NOW);
  decltype(&cuptiActivityRegisterCallbacks) register_callbacks = nullptr;
  decltype(&cuptiActivityRegisterTimestampCallback) register_clock = nullptr;
  decltype(&cuptiActivityEnable) enable = nullptr;
  decltype(&cuptiActivityDisable) disable = nullptr;
  decltype(&cuptiActivityFlushAll) flush = nullptr;
  decltype(&cuptiActivityGetNextRecord) next = nullptr;

  template <class Function>
  bool find(Function& function, const char* name) {
    return (function = reinterpret_cast<Function>(dlsym(library, name))) != nullptr;
  }
  // Whether all functions exist.
  bool load() {
    return library != nullptr && find(register_callbacks, "cuptiActivityRegisterCallbacks") &&
           find(register_clock, "cuptiActivityRegisterTimestampCallback") &&
           find(enable, "cuptiActivityEnable") && find(disable, "cuptiActivityDisable") &&
           find(flush, "cuptiActivityFlushAll") && find(next, "cuptiActivityGetNextRecord");
  }
};

Cupti& cupti() {
  static Cupti library;
  return library;
}

constexpr CUpti_ActivityKind kKinds[] = {CUPTI_ACTIVITY_KIND_CONCURRENT_KERNEL, CUPTI_ACTIVITY_KIND_MEMCPY};

// CUPTI hands over records on a thread of its own.
std::mutex events_mutex;
std::vector<DeviceTrace::Event> recorded;

// The name of a kernel, or of the item that for_each applies, without namespaces and the laws.
std::string short_name(const char* symbol) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> demangled(
      abi::__cxa_demangle(symbol, nullptr, nullptr, &status), std::free);
  const std::string name = status == 0 ? demangled.get() : symbol;
  static const std::regex item("for_each_kernel<.*?(\\w+Item)\\b"), kernel("(\\w+)\\s*(<|\\()");
  std::smatch found;
  if (std::regex_search(name, found, item)) return found[1];
  const std::size_t room = name.find("scree::");
  const std::string rest = room == std::string::npos ? name : name.substr(room + 7);
  return std::regex_search(rest, found, kernel) ? std::string(found[1]) : rest;
}

void add_event(std::uint64_t begin, std::uint64_t end, std::uint32_t stream, const std::string& name) {
  DeviceTrace::Event event{
      static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), static_cast<int>(stream), {}};
  name.copy(event.label.data(), event.label.size() - 1);
  const std::lock_guard lock(events_mutex);
  recorded.push_back(event);
}

void add_record(const CUpti_Activity& record) {
  if (record.kind == CUPTI_ACTIVITY_KIND_CONCURRENT_KERNEL) {
    const auto& kernel = reinterpret_cast<const KernelRecord&>(record);
    add_event(kernel.start, kernel.end, kernel.streamId, short_name(kernel.name));
  } else if (record.kind == CUPTI_ACTIVITY_KIND_MEMCPY) {
    const auto& copy = reinterpret_cast<const CopyRecord&>(record);
    add_event(copy.start, copy.end, copy.streamId,
              copy.copyKind == CUPTI_ACTIVITY_MEMCPY_KIND_HTOD   ? "copy to the device"
              : copy.copyKind == CUPTI_ACTIVITY_MEMCPY_KIND_DTOH ? "copy to the host"
                                                                 : "copy");
  }
}

void CUPTIAPI get_buffer(std::uint8_t** buffer, std::size_t* size, std::size_t* most_records) {
  constexpr std::size_t kBytes = std::size_t{1} << 20, kAlignment = 8;
  *buffer = static_cast<std::uint8_t*>(std::aligned_alloc(kAlignment, kBytes));
  *size = *buffer != nullptr ? kBytes : 0;
  *most_records = 0;  // as many as fit
}

void CUPTIAPI take_buffer(CUcontext, std::uint32_t, std::uint8_t* buffer, std::size_t, std::size_t valid) {
  CUpti_Activity* record = nullptr;
  while (cupti().next(buffer, valid, &record) == CUPTI_SUCCESS) add_record(*record);
  std::free(buffer);
}

std::uint64_t CUPTIAPI now() {
  const auto time = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(time).count());
}

class KernelTrace : public DeviceTrace {
 public:
  ~KernelTrace() override { stop(); }
  void start() override {
    for (const CUpti_ActivityKind kind : kKinds) cupti().enable(kind);
  }
  std::vector<Event> stop() override {
    cudaDeviceSynchronize();
    for (const CUpti_ActivityKind kind : kKinds) cupti().disable(kind);
    cupti().flush(CUPTI_ACTIVITY_FLAG_FLUSH_FORCED);
    const std::lock_guard lock(events_mutex);
    return std::exchange(recorded, {});
  }
};

}  // namespace

std::unique_ptr<DeviceTrace> make_kernel_trace() {
  if (!cupti().load() || cupti().register_callbacks(get_buffer, take_buffer) != CUPTI_SUCCESS ||
      cupti().register_clock(now) != CUPTI_SUCCESS)
    return nullptr;
  return std::make_unique<KernelTrace>();
}

}  // namespace scree

#else

namespace scree {

std::unique_ptr<DeviceTrace> make_kernel_trace() { return nullptr; }

}  // namespace scree

#endif
