// Means over a step of quantities that change linearly and are clipped at limits.
#pragma once

#include <cmath>

#include "mbs/dual.hpp"

namespace scree {

// Mean of the positive part of a line from a to b.
inline Dual positive_mean(const Dual& a, const Dual& b) {
  if (a.value >= 0 && b.value >= 0) return 0.5 * (a + b);
  if (a.value > 0) return a * a / (2 * (a - b));
  if (b.value > 0) return b * b / (2 * (b - a));
  return {};
}

// Mean of a line from a to b clipped to [-limit, limit], where the limit, never negative, changes linearly
// from `first` to `last`. The mean increases with a and b and is exact: an event within the step counts over
// the part of the step after it.
inline Dual limited_mean(const Dual& a, const Dual& b, const Dual& first, const Dual& last) {
  if (a.value >= first.value && b.value >= last.value) return 0.5 * (first + last);
  if (-a.value >= first.value && -b.value >= last.value) return -0.5 * (first + last);
  return 0.5 * (a + b) - positive_mean(a - first, b - last) + positive_mean(-a - first, -b - last);
}

}  // namespace scree
