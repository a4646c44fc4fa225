// Device memory that arrays share which are never needed at the same time.
#pragma once

#include <cstddef>
#include <stdexcept>

#include "device.cuh"

namespace scree {

// An array that is to stand in a room, with so many values.
template <class T>
struct RoomFor {
  DeviceArray<T>& array;
  std::size_t size;

  std::size_t bytes() const {
    constexpr std::size_t kAligned = 256;  // as memory of its own is
    return (size * sizeof(T) + kAligned - 1) / kAligned * kAligned;
  }
  RoomFor unless(bool elsewhere) const { return {array, elsewhere ? 0 : size}; }
  // In the memory of another array, of whose values nothing is left once the first is written.
  template <class U>
  bool fits(const DeviceArray<U>& other) const {
    return size * sizeof(T) <= other.size() * sizeof(U);
  }
  template <class U>
  void stand_in(DeviceArray<U>& other) const {
    if (!fits(other)) throw std::logic_error("RoomFor: an array in place of a shorter one");
    array.borrow(reinterpret_cast<T*>(other.data()), size);
  }
};

class DeviceRoom {
 public:
  // These arrays stand in the room from now on, one behind the other. Those that stood there before are lost:
  // what is queued on a stream may still use them, nobody else. Throws DeviceError where the memory does not
  // suffice.
  template <class... T>
  void lay_out(const RoomFor<T>&... rooms) {
    const std::size_t needed = (rooms.bytes() + ...);
    if (needed > bytes_.size()) bytes_.resize(needed + needed / kSpare);
    std::byte* at = bytes_.data();
    ((rooms.array.borrow(reinterpret_cast<T*>(at), rooms.size), at += rooms.bytes()), ...);
  }

  std::size_t bytes() const { return bytes_.bytes(); }

 private:
  static constexpr std::size_t kSpare = 32;  // where it has to grow: one in so many for what comes
  DeviceArray<std::byte> bytes_;
};

}  // namespace scree
