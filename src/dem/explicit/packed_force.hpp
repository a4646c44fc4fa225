// Contact loads in SIMD vectors, for the row sums of the serial backend.
#pragma once

#include <bit>
#include <cstring>

#include "dem/contact/contact_items.hpp"

namespace scree {

// Four numbers, added by one instruction where the processor supports it.
using Real4 = Real __attribute__((vector_size(4 * sizeof(Real))));

// Packs four numbers from registers, or four from memory; the opposite choice stalls the processor.
inline Real4 packed(Real a, Real b, Real c, Real d) { return Real4{a, b, c, d}; }
inline Real4 packed(const Vec4& a) { return std::bit_cast<Real4>(a); }
inline Vec4 unpacked(Real4 a) { return std::bit_cast<Vec4>(a); }

// Reads values[k] ... values[k + 3].
inline Real4 four_of(const Real* values, Index k) {
  Real4 out;
  std::memcpy(&out, values + k, sizeof(out));
  return out;
}

// Exchanges rows and columns.
inline void transpose(Real4 (&rows)[4]) {
  const Real4 a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6),
              b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7),
              c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6),
              d = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), rows[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), rows[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

// A TotalForce packed in groups of four numbers, with the same addition.
template <int kKinds>
struct alignas(64) PackedForce {
  static constexpr int kParts = (7 + kKinds + 3) / 4;
  Real4 part[kParts];

  using Total = TotalForce<kKinds>;
  static Vec4 part_of(const Total& of, int n) {
    const auto loss = [&](int k) { return k < kKinds ? of.losses.of[k] : 0; };
    return n == 0   ? vec4(of.force, of.loss_power)
           : n == 1 ? vec4(of.torque, loss(0))
                    : Vec4{loss(1), loss(2)};
  }
  static PackedForce of(const Total& total) {
    PackedForce out;
    for (int n = 0; n < kParts; ++n) {
      const Vec4 a = part_of(total, n);
      out.part[n] = packed(a.x, a.y, a.z, a.w);
    }
    return out;
  }
  Total total() const {
    Total out{{part[0][0], part[0][1], part[0][2]}, part[0][3], {part[1][0], part[1][1], part[1][2]}, {}};
    for (int k = 0; k < kKinds; ++k) out.losses.of[k] = part[(7 + k) / 4][(7 + k) % 4];
    return out;
  }
  PackedForce& operator+=(const PackedForce& b) {
    for (int n = 0; n < kParts; ++n) part[n] += b.part[n];
    return *this;
  }
};

}  // namespace scree
