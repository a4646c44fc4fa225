// Two bars for one error: the promise, and some three times the measured value, so that a loss of digits
// shows long before a promise is broken.
#pragma once

#include <cmath>
#include <ostream>

#include "base/types.hpp"

namespace scree {

// The bars, in the unit of the error.
struct Bars {
  Real promise;  // stated in the documents or by the method
  // The largest error seen when the test was written; of round-off, which compilers and libraries change,
  // three times that, and no less than some last places of the values.
  Real measured;
};

// Result of keeps(): true where an error is below both bars, with all data for a failure's message.
struct Kept {
  static constexpr Real kSpread = 3;  // of the error over machines, compilers and backends

  Real error;
  Bars bars;

  bool promise() const { return std::abs(error) < bars.promise; }  // false where it is NaN
  bool digits() const { return std::abs(error) <= kSpread * bars.measured; }
  explicit operator bool() const { return promise() && digits(); }
};

inline std::ostream& operator<<(std::ostream& out, const Kept& kept) {
  out << "error " << kept.error << ", promised " << kept.bars.promise << ", measured " << kept.bars.measured;
  if (!kept.promise()) return out << ": the promise is broken";
  return out << (kept.digits() ? "" : ": more than three times as large as it was");
}

inline Kept keeps(Real error, Bars bars) { return {error, bars}; }

}  // namespace scree
