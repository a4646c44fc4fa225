// Device memory shared by arrays that are never needed at the same time.
#pragma once

#include <cstddef>
#include <stdexcept>

#include "device.cuh"

namespace scree {

// An array to be laid out in an arena, and its size.
template <class T>
struct ArenaArray {
  DeviceArray<T>& array;
  std::size_t size;

  std::size_t bytes() const {
    constexpr std::size_t kAligned = 256;  // sizes are multiples of this, as the alignment of allocations
    return (size * sizeof(T) + kAligned - 1) / kAligned * kAligned;
  }
  ArenaArray unless(bool elsewhere) const { return {array, elsewhere ? 0 : size}; }
  // Uses the memory of another array, whose values are lost once the first value is written.
  template <class U>
  bool fits(const DeviceArray<U>& other) const {
    return size * sizeof(T) <= other.size() * sizeof(U);
  }
  template <class U>
  void alias(DeviceArray<U>& other) const {
    if (!fits(other)) throw std::logic_error("RoomFor: an array cannot alias a shorter one");
    array.alias_memory(reinterpret_cast<T*>(other.data()), size);
  }
};

class DeviceArena {
 public:
  // Lays the arrays out one after the other. The contents of the previous ones are lost; work already queued
  // on a stream may still use them, nothing else may. Throws `DeviceError` where memory does not suffice.
  template <class... T>
  void lay_out(const ArenaArray<T>&... arrays) {
    const std::size_t needed = (arrays.bytes() + ...);
    if (needed > bytes_.size()) bytes_.resize(needed + needed / kSpare);
    std::byte* at = bytes_.data();
    ((arrays.array.alias_memory(reinterpret_cast<T*>(at), arrays.size), at += arrays.bytes()), ...);
  }

  std::size_t bytes() const { return bytes_.bytes(); }

 private:
  static constexpr std::size_t kSpare = 32;  // reserve when it grows: 1 / kSpare
  DeviceArray<std::byte> bytes_;
};

}  // namespace scree
