#include <type_traits>

#include "for_each.cuh"
#include "particle_arrays.cuh"

namespace scree {
namespace {

// Scratch memory for the reordering of arrays that have no second one: the memory of the second arrays.
class ReorderScratch {
 public:
  ReorderScratch(SecondArrays& second, std::size_t n) : second_(second), n_(n) { clear(); }

  void clear() {
    for (std::size_t k = 0; k < 3; ++k) {
      DeviceArray<Vec4>& array = *second_.motion()[k];
      free_[k] = {reinterpret_cast<std::byte*>(array.data()), array.size() * sizeof(Vec4)};
    }
  }
  // As a scratch array of that type for n values; null where none is left. An empty request always fits.
  template <class T>
  T* take() {
    static_assert(sizeof(T) <= sizeof(Vec4));
    for (Free& scratch : free_) {
      if (scratch.bytes < n_ * sizeof(T)) continue;
      auto* const at = reinterpret_cast<T*>(scratch.at);
      const std::size_t taken =
          std::min(scratch.bytes, SecondArrays::whole(n_ * sizeof(T)));  // alignment of the next array
      scratch.at += taken, scratch.bytes -= taken;
      return at;
    }
    return nullptr;
  }

 private:
  struct Free {
    std::byte* at;
    std::size_t bytes;
  };
  SecondArrays& second_;
  const std::size_t n_;
  Free free_[3];
};

}  // namespace

MixedViews MixedArrays::views(SecondArrays& scratch) {
  MixedViews views{};
  const auto halve = [](DeviceArray<Vec4>& whole, auto*(&halves)[2]) {
    static_assert(2 * sizeof(*halves[0]) == sizeof(Vec4));
    halves[0] = reinterpret_cast<std::remove_reference_t<decltype(halves[0])>>(whole.data());
    halves[1] = halves[0] + whole.size();
  };
  halve(scratch.position, views.position), halve(scratch.velocity, views.motion);
  halve(scratch.angular_velocity, views.spin);
  views.fraction = fraction.data(), views.rest = rest.data(), views.spin_rest = spin_rest.data();
  return views;
}

void reorder(Device device, ParticleArrays& now, SecondArrays& second, const Index* order, Index n,
             bool in_run) {
  if (n == 0) return;
  ParticleViews motion;
  motion.position = second.position.data(), motion.velocity = second.velocity.data();
  motion.angular_velocity = second.angular_velocity.data();
  for_each(device, n, ReorderItem{views_of(now), motion, order});
  now.position.swap(second.position), now.velocity.swap(second.velocity);
  now.angular_velocity.swap(second.angular_velocity);

  ParticleViews state = views_of(now);
  if (in_run) state.force = nullptr;
  if (in_run && now.rotates)
    state.acceleration = state.angular_acceleration = nullptr, state.loss_power = nullptr;
  ReorderScratch scratch(second, static_cast<std::size_t>(n));
  ParticleViews stored;
  const auto bring_back = [&] {
    for_each(device, n, ReorderItem{state, stored, order});
    for_each(device, n, ReorderItem{stored, state, nullptr});
    stored = {}, scratch.clear();
  };
  for_each_array<kKeys | kGhostCopies | kOwnedArrays>(
      FieldsThere(now),
      [&](auto*& array, const auto* values) {
        if (values == nullptr) return;
        using T = std::remove_reference_t<decltype(*array)>;
        if ((array = scratch.take<T>()) == nullptr) bring_back(), array = scratch.take<T>();
      },
      stored, state);
  bring_back();
}

}  // namespace scree
